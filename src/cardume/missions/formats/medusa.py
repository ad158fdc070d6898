"""The mission text of MEDUSA vehicles and the Farol stack (PONTE writes it).

    # comment
    3                                                        version
    491854.338 4290819.848 29S                               reference: UTM easting, northing, zone and band
    FORMATION id x y ...                                     x along the path, y to the LEFT of it [m]
    LINE xInit yInit xEnd yEnd speed                         then, each optional: vehicle, gamma, anything
    ARC xInit yInit xCenter yCenter xEnd yEnd speed direction radius
    POINT x y radius speed heading time
    DEPTH depth time
    ALT altitude time

x is east and y north of the reference [m]; vehicle -1 means all; direction -1 is clockwise on the
map, a turn to starboard.  BIAS has the form of FORMATION but leaves the paths where they are: only
the positions along them differ.  A gamma is read and kept; the path's own arc length is what counts.

Source: dsor-isr/farol, farol_addons/console_path_parser (README and ConsolePathParserNode.cpp).
"""

import math
import re
from dataclasses import dataclass
from typing import Any

from cardume.errors import InputError, MissionError, Position, Problem
from cardume.missions.formats.plan import Member
from cardume.missions.geodesy import GeoPoint, GridPoint, utm_to_geographic
from cardume.units import nearest, printable, show_text

ALL = -1
BYTE_ORDER_MARK = "\ufeff"
FIELDS = {
    "LINE": ("xInit", "yInit", "xEnd", "yEnd", "speed"),
    "ARC": ("xInit", "yInit", "xCenter", "yCenter", "xEnd", "yEnd", "speed", "direction", "radius"),
    "POINT": ("x", "y", "radius", "speed", "heading", "time"),
    "DEPTH": ("depth", "time"),
    "ALT": ("altitude", "time"),
}
KEYWORDS = (*FIELDS, "FORMATION", "BIAS")
NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
WHOLE = re.compile(r"[-+]?[0-9]+")
ZONE = re.compile(r"([0-9]{1,2})([A-Za-z])")
FARTHEST = 1e6  # [m]
RADIUS_ROUNDING = 0.1  # [m] what the radius written may differ from the one drawn


@dataclass(frozen=True, kw_only=True, slots=True)
class Item:
    """One line of the file after its reference.

    Attributes:
        line: its number.
        keyword: LINE, ARC, POINT, DEPTH or ALT.
        values: its numbers by the names above, in the file's units.
        vehicle: whom it is for; -1: all.
        gamma: [m] as written; None if it is not.
    """

    line: int
    keyword: str
    values: dict[str, float]
    vehicle: int = ALL
    gamma: float | None = None

    @property
    def is_path(self) -> bool:
        """Whether it is a part of the path."""
        return self.keyword in ("LINE", "ARC")


@dataclass(frozen=True, kw_only=True, slots=True)
class MedusaMission:
    """A mission file, as written.

    Attributes:
        source: the file.
        reference: UTM coordinates of x = y = 0.
        place: the same in latitude and longitude.
        formation: the members; empty if the file names none.
        is_biased: whether the members came with BIAS.
        items: what is to be done, in order.
    """

    source: str
    reference: GridPoint
    place: GeoPoint
    formation: tuple[Member, ...]
    is_biased: bool
    items: tuple[Item, ...]


def parse_medusa(text: str, source: str) -> MedusaMission:
    """Read a mission text.

    Args:
        text: its contents.
        source: what messages call it.

    Raises:
        MissionError: all that is wrong, by line.
    """
    return _Reader(source).read(text)


def refused(source: str, line: int, keyword: str, message: str) -> MissionError:
    """An error about one line, to raise."""
    return MissionError([Problem(Position(source, line, keyword), message)])


class _Reader:
    """Reads line by line and gathers what is wrong."""

    def __init__(self, source: str) -> None:
        self.source, self.problems = source, list[Problem]()
        self.line, self.keyword = 0, ""
        self.formation: tuple[Member, ...] = ()
        self.is_biased = False
        self.items: list[Item] = []

    def read(self, text: str) -> MedusaMission:
        """The whole file."""
        numbered = enumerate(text.lstrip(BYTE_ORDER_MARK).splitlines(), 1)
        lines = [(number, words) for number, line in numbered if (words := line.partition("#")[0].split())]
        if len(lines) < 2:
            raise refused(
                self.source, 0, "", "holds no mission; it begins with the version, 3, and then the reference point"
            )
        self._read_version(*lines[0])
        reference, place = self._read_reference(*lines[1])
        for self.line, words in lines[2:]:
            self.keyword = words[0]
            self._read_item(words[0], words[1:])
        if self.problems or reference is None or place is None:
            raise MissionError(self.problems)
        return MedusaMission(
            source=self.source,
            reference=reference,
            place=place,
            formation=self.formation,
            is_biased=self.is_biased,
            items=tuple(self.items),
        )

    def _wrong(self, message: str) -> None:
        self.problems.append(Problem(Position(self.source, self.line, printable(self.keyword[:40])), message))

    def _read_version(self, line: int, words: list[str]) -> None:
        self.line, self.keyword = line, "version"
        if words != ["3"]:
            raise refused(
                self.source, line, "version", f"is {show_text(' '.join(words))}; the version that is read is 3"
            )

    def _read_reference(self, line: int, words: list[str]) -> tuple[GridPoint | None, GeoPoint | None]:
        self.line, self.keyword = line, "reference"
        zone = ZONE.fullmatch("".join(words[2:]))
        if len(words) not in (3, 4) or not zone:
            self._wrong(
                f"is {show_text(' '.join(words))}; give UTM easting, northing, and zone with its latitude band,"
                " such as 491854.338 4290819.848 29S"
            )
            return None, None
        easting, northing = self._number("easting", words[0]), self._number("northing", words[1])
        reference = GridPoint(easting, northing, int(zone[1]), zone[2].upper())
        try:
            return reference, utm_to_geographic(reference) if easting == easting and northing == northing else None
        except InputError as problem:
            self._wrong(str(problem))
            return None, None

    def _read_item(self, keyword: str, words: list[str]) -> None:
        if keyword in ("FORMATION", "BIAS"):
            self._read_formation(words)
        elif keyword in FIELDS:
            self._read_fields(keyword, words)
        else:
            hint = nearest(keyword, list(KEYWORDS))
            self._wrong(f"{show_text(keyword)} is no keyword; valid are {', '.join(KEYWORDS)}{hint}")

    def _read_formation(self, words: list[str]) -> None:
        if self.formation:
            self._wrong("is a second formation; give one FORMATION or one BIAS")
        elif not words or len(words) % 3:
            self._wrong(f"has {len(words)} values; give id, x (along the path) and y (to its left) for each vehicle")
        else:
            triples = [words[k : k + 3] for k in range(0, len(words), 3)]
            self.is_biased = self.keyword == "BIAS"
            self.formation = tuple(
                Member(id=self._vehicle(i), ahead=self._near("x", x), starboard=0.0 - self._near("y", y))
                for i, x, y in triples
            )
            ids = [member.id for member in self.formation]
            if len(set(ids)) < len(ids) or ALL in ids:
                self._wrong(f"names the vehicles {', '.join(map(str, ids))}; each needs an id of its own, 0 or more")

    def _read_fields(self, keyword: str, words: list[str]) -> None:
        names, before = FIELDS[keyword], len(self.problems)
        if len(words) < len(names):
            self._wrong(f"has {len(words)} of its {len(names)} values: {' '.join(names)}")
            return
        values = {name: self._near(name, word) for name, word in zip(names, words, strict=False)}
        more = words[len(names) :]
        vehicle = self._vehicle(more[0]) if more else ALL
        gamma = self._number("gamma", more[1]) if len(more) > 1 else None
        if len(self.problems) == before:
            self._check(values)
        self.items.append(Item(line=self.line, keyword=keyword, values=values, vehicle=vehicle, gamma=gamma))

    def _check(self, values: dict[str, Any]) -> None:
        """What holds for numbers of their kind."""
        for name in {"speed", "radius"} & values.keys():
            if values[name] <= 0.0 and self.keyword != "POINT":
                self._wrong(f"{name} is {values[name]:g}; it must be > 0")
        for name in {"depth", "altitude"} & values.keys():
            if values[name] < 0.0:
                self._wrong(f"{name} is {values[name]:g} m; it must be 0 or more")
        if self.keyword != "ARC":
            return
        if values["direction"] not in (-1.0, 1.0):
            self._wrong(f"direction is {values['direction']:g}; it is -1 (clockwise on the map) or 1")
        drawn = math.hypot(values["xInit"] - values["xCenter"], values["yInit"] - values["yCenter"])
        if abs(drawn - values["radius"]) > RADIUS_ROUNDING:
            self._wrong(
                f"radius is {values['radius']:g} m, but the arc starts {drawn:.6g} m from its center; they must agree"
                f" to {RADIUS_ROUNDING:g} m"
            )

    def _number(self, name: str, word: str) -> float:
        """The number; NaN where there is none, which was then noted."""
        if NUMBER.fullmatch(word) and math.isfinite(float(word)):
            return float(word)
        point = "; the decimal sign is a point" if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", word) else ""
        self._wrong(f"{name} is {show_text(word)}; it must be a finite number, such as -24.57{point}")
        return math.nan

    def _near(self, name: str, word: str) -> float:
        """A number of a mission's own size; NaN where there is none, which was then noted."""
        number = self._number(name, word)
        if abs(number) > FARTHEST:
            self._wrong(f"{name} is {number:g}; no number of a mission is beyond {FARTHEST:g}")
            return math.nan
        return number

    def _vehicle(self, word: str) -> int:
        if WHOLE.fullmatch(word) and len(word) < 10 and int(word) >= ALL:
            return int(word)
        self._wrong(f"vehicle is {show_text(word)}; it must be a whole number, an id or {ALL} for all")
        return ALL
