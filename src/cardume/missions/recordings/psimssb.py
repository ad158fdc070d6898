"""PSIMSSB: where a USBL on a ship hears a transponder.

$PSIMSSB,hhmmss.ss,TpCode,status,error,coordinates,orientation,filter,X,Y,depth,accuracy,information,value 1,value 2*hh

Its traps: status A (good) beside an error code, with zeros for coordinates; what X and Y are depends on two letters
before them; and a manual prints a checksum that does not fit its text.

Source: the fields as in Tritech, MicronNav manual 0656-SOM section 7.2.10; head-up axes (X to starboard, Y ahead) as
in Water Linked's writer for Olex; north-up (X north, Y east) and east-up (X east, Y north) as in EvoLogics' converter.
"""

import math
from typing import NamedTuple

from cardume.units import printable

CARTESIAN, POLAR, UTM, RADIANS = "C", "P", "U", "R"
HEAD_UP, NORTH_UP, EAST_UP = "H", "N", "E"


class Relative(NamedTuple):
    """A transponder as the ship's USBL sees it."""

    time: float  # [s] of the day
    name: str
    coordinates: str  # C, U or R
    orientation: str  # H, N or E
    first: float  # [m] or [rad] X
    second: float  # [m] or [rad] Y
    depth: float  # [m] NaN: not told
    accuracy: float  # [m] NaN: not told

    @property
    def north_east(self) -> tuple[float, float]:
        """Of coordinates that are north up or east up: north and east [m]; UTM: northing and easting."""
        return (self.second, self.first) if self.orientation == EAST_UP else (self.first, self.second)

    def turned(self, heading: float) -> tuple[float, float]:
        """North and east [m] from the ship.

        Args:
            heading: [rad] of the ship.
        """
        if self.orientation != HEAD_UP:
            return self.north_east
        starboard, ahead, sine, cosine = self.first, self.second, math.sin(heading), math.cos(heading)
        return ahead * cosine - starboard * sine, ahead * sine + starboard * cosine


def relative_of(time: float, words: list[str]) -> Relative:
    """The fields of a sentence.

    Args:
        time: [s] of the day, which the first of them says.
        words: the fields behind PSIMSSB.

    Raises:
        ValueError: the sentence says itself that it is no good, or cannot be used.
    """
    if len(words) < 10:
        raise ValueError(f"PSIMSSB has {len(words)} fields; at least time to depth, 10, are needed")
    name, status, error, coordinates, orientation = words[1:6]
    if status != "A":
        raise ValueError("PSIMSSB says that it is not valid (status V)")
    if error:
        raise ValueError(f"PSIMSSB has the error code {printable(error)[:8]} beside status A")
    if coordinates not in (CARTESIAN, UTM, RADIANS):
        what = "polar coordinates (P)" if coordinates == POLAR else f"coordinates '{printable(coordinates)[:8]}'"
        raise ValueError(f"PSIMSSB has {what}; cartesian (C), UTM (U) and radians (R) are read")
    if coordinates == CARTESIAN and orientation not in (HEAD_UP, NORTH_UP, EAST_UP):
        raise ValueError(f"PSIMSSB has the orientation '{printable(orientation)[:8]}'; H, N and E are known")
    x, y, depth = (number(words[k]) for k in (7, 8, 9))
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError("PSIMSSB has no coordinates")
    if x == y == 0.0 and not depth > 0.0:
        raise ValueError("PSIMSSB has zeros for coordinates")
    accuracy = number(words[10]) if len(words) > 10 else math.nan
    return Relative(
        time,
        printable(name)[:20] or "?",
        coordinates,
        orientation,
        x,
        y,
        depth,
        accuracy if accuracy > 0.0 else math.nan,
    )


def number(text: str) -> float:
    """A number, NaN where there is none.

    Args:
        text: a field.
    """
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan
