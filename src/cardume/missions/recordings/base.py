"""What a recording holds of a vehicle, in whatever format it came: NED, SI, radians, seconds from its first moment."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cardume.errors import DataError, InputError
from cardume.missions.geodesy import GeoPoint
from cardume.units import printable

MOST_BYTES = 2_000_000_000  # of a recording
LONGEST = 7 * 86_400.0  # [s] of a recording
NO_TIMES = np.zeros(0)
REPLAYED = "# Around the vehicles while a recording"  # how the mission in the log of a replay begins


class Stream(NamedTuple):
    """The readings of one sensor."""

    times: np.ndarray = NO_TIMES  # (n,) [s] increasing
    values: np.ndarray = np.zeros((0, 2))  # (n, k)

    @property
    def is_there(self) -> bool:
        """Whether there is any reading."""
        return len(self.times) > 0

    def held(self, times: np.ndarray) -> np.ndarray:
        """The last reading at each of some times; before the first one that one; (len(times), k).

        Args:
            times: (m,) [s]
        """
        found: np.ndarray = self.values[np.maximum(np.searchsorted(self.times, times + 1e-9, side="right") - 1, 0)]
        return found

    def between(self, times: np.ndarray) -> np.ndarray:
        """Readings interpolated at some times, NaN before the first and after the last; (len(times), k).

        Args:
            times: (m,) [s]
        """
        columns = [np.interp(times, self.times, column, np.nan, np.nan) for column in self.values.T]
        return np.column_stack(columns)


class Sighted(NamedTuple):
    """One fix, or only a range, as it was recorded."""

    heard: float  # [s] when the vehicle had it
    valid: float  # [s] when it was true
    source: str  # who or what measured it
    north: float  # [m] of the vehicle; where `range` is a number, of the source
    east: float  # [m]
    north_variance: float = np.nan  # [m^2] of north and east; NaN: not told
    covariance: float = np.nan  # [m^2]
    east_variance: float = np.nan  # [m^2]
    range: float = np.nan  # [m] slant, or level where `depth` is NaN; NaN: a position
    depth: float = np.nan  # [m] of the source of a slant range
    range_variance: float = np.nan  # [m^2] NaN: not told


class Way(NamedTuple):
    """A step of dead reckoning of a vehicle that has no compass."""

    time: float  # [s] at its end
    ahead: float  # [m]
    turned: float  # [rad] to starboard


@dataclass(frozen=True, kw_only=True, eq=False)
class Recorded:
    """One vehicle of a recording.

    Attributes:
        name: of the vehicle.
        attitude: heading [rad] and yaw rate [rad/s], NaN where that was not measured.
        velocity: surge and sway [m/s] through the water.
        depth: [m] below the surface.
        sighted: fixes and ranges, in the order in which they were heard.
        truth: north and east [m].
        start: [m] north and east where it began, where that is known.
        start_heading: [rad] then; NaN: not known.
        ways: steps of dead reckoning, in the place of attitude and velocity.
    """

    name: str
    attitude: Stream = Stream()
    velocity: Stream = Stream()
    depth: Stream = Stream(NO_TIMES, np.zeros((0, 1)))
    sighted: tuple[Sighted, ...] = ()
    truth: Stream = Stream()
    start: tuple[float, float] | None = None
    start_heading: float = np.nan
    ways: tuple[Way, ...] = ()

    @property
    def sources(self) -> tuple[str, ...]:
        """Who or what measured its fixes, in the order of their names."""
        return tuple(sorted({s.source for s in self.sighted}))

    @property
    def last(self) -> float:
        """[s] of the last thing in it."""
        times = [s.times[-1] for s in (self.attitude, self.velocity, self.depth, self.truth) if s.is_there]
        return max([*times, *(s.heard for s in self.sighted), *(w.time for w in self.ways)], default=0.0)

    @property
    def has_positions(self) -> bool:
        """Whether any fix is a position, not a range."""
        return any(np.isnan(s.range) for s in self.sighted)


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """All vehicles of a recording.

    Attributes:
        kind: the format that it came in.
        vehicles: at least one.
        origin: where north = east = 0 lies; None: not known.
        began: when its first moment was, as text; empty: not known.
        notes: what a person must know of how it was read.
    """

    kind: str
    vehicles: tuple[Recorded, ...]
    origin: GeoPoint | None = None
    began: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Options:
    """What a person may say of a recording beside its file.

    Attributes:
        sound_speed: [m/s] by which travel times become ranges.
        depth: [m] of the vehicle, where the recording does not say it; NaN: not known.
        head: [m] north and east of what measures relative positions, where the recording does not say it.
        topics: of a bag: role and topic.
        fix_sigma: [m] of fixes that do not tell their own; NaN: the position law's.
    """

    sound_speed: float = 1500.0
    depth: float = np.nan
    head: tuple[float, float] = (0.0, 0.0)
    topics: tuple[tuple[str, str], ...] = ()
    fix_sigma: float = np.nan


class LeftOut:
    """Counts what could not be used, by reason, and remembers the first line of each."""

    def __init__(self) -> None:
        self._found: dict[str, list[int]] = {}

    def note(self, line: int, reason: str) -> None:
        """Count one line.

        Args:
            line: [-] its number in the file.
            reason: why it is left out.
        """
        self._found.setdefault(reason, []).append(line)

    def has(self, line: int) -> bool:
        """Whether a line was left out.

        Args:
            line: [-] its number in the file.
        """
        return any(line in lines for lines in self._found.values())

    def texts(self) -> list[str]:
        """One sentence for each reason."""
        return [
            f"{len(lines)} line{'s' if len(lines) > 1 else ''} left out, the first is {lines[0]}: {reason}"
            for reason, lines in self._found.items()
        ]


def stream_of(rows: Sequence[tuple[float, ...]], width: int) -> Stream:
    """A stream of rows of a time and values, sorted; of equal times the last counts.

    Args:
        rows: time [s], then values.
        width: [-] values in a row.
    """
    if not rows:
        return Stream(NO_TIMES, np.zeros((0, width)))
    table = np.array(rows, float)
    table = table[np.argsort(table[:, 0], kind="stable")]
    is_last = np.append(np.diff(table[:, 0]) > 0.0, True)
    return Stream(table[is_last, 0], table[is_last, 1:])


def nearest_of(times: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Which of some times is nearest to each of others; (len(wanted),).

    Args:
        times: (n,) [s] sorted, at least one.
        wanted: (m,) [s]
    """
    after = np.minimum(np.searchsorted(times, wanted), len(times) - 1)
    before = np.maximum(after - 1, 0)
    found: np.ndarray = np.where(wanted - times[before] <= times[after] - wanted, before, after)
    return found


def read_lines(path: Path) -> list[str]:
    """The lines of a text, whatever bytes stand in it.

    Args:
        path: of the file.

    Raises:
        DataError: it cannot be read, is empty, or is binary.
    """
    name = printable(str(path))
    try:
        if path.stat().st_size > MOST_BYTES:
            raise DataError(f"{name} has more than {MOST_BYTES:,} bytes; cut it into parts")
        data = path.read_bytes()
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror}; give the file of a recording") from None
    if not data.strip():
        raise DataError(f"{name} is empty; give the file of a recording")
    if b"\0" in data[:4096]:
        raise DataError(f"{name} is binary, not a text; say what it is with --format, or give another file")
    return data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n").split("\n")


def check_length(seconds: float, name: str) -> None:
    """Refuse a recording whose times are nonsense.

    Args:
        seconds: [s] that it lasts.
        name: of its file.

    Raises:
        InputError: it lasts longer than a week, or no time at all.
    """
    if not 0.0 < seconds <= LONGEST:
        raise InputError(
            f"{name}: its times reach over {seconds:g} s; more than 0 s and at most {LONGEST:g} s can be replayed:"
            " look at the clocks of the first and the last entry"
        )
