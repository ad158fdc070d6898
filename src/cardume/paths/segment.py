"""Reference paths: chains of lines, arcs and curves, in plain Python, made once per mission.

One file per kind of path builds the chain from what a mission says; `offset_path` turns it into the
table of each vehicle.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

from cardume.errors import InputError
from cardume.laws import Meters, Radians
from cardume.paths.curve import Curve

Turn = Literal["starboard", "port"]


class GeometryError(InputError):
    """A path that cannot be built, or an offset from it that does not fit; `label` says which part."""

    def __init__(self, message: str, label: str = "") -> None:
        super().__init__(message)
        self.label = label


class Start(NamedTuple):
    """Where a path starts and which way it goes."""

    north: Meters = 0.0  # [m]
    east: Meters = 0.0  # [m]
    course: Radians = 0.0  # [rad]


class PathPoint(NamedTuple):
    """A point of a path and its direction there."""

    north: float  # [m]
    east: float  # [m]
    course: float  # [rad]


@dataclass(frozen=True, kw_only=True, slots=True)
class Segment:
    """A line, an arc or a curve of the reference path.

    Attributes:
        north, east: [m] start.
        course: [rad] at the start.
        curvature: [1/m] > 0 turns to starboard; 0 for a line, and for a curve, which has its own.
        length: [m] > 0.
        speed: [m/s] v_L here; None: the formation's, or the curve's own.
        label: where it was given, for messages, such as "line 7".
        curve: how it bends, where that is neither a line nor an arc.
        offset: [m] of this segment to starboard of its curve; 0 on a reference path.
        beyond: whether it only says how a closed path goes on, before its start or past its end.
    """

    north: float
    east: float
    course: float
    curvature: float
    length: float
    speed: float | None = None
    label: str = ""
    curve: Curve | None = None
    offset: float = 0.0
    beyond: bool = False

    def __str__(self) -> str:
        where = f" ({self.label})" if self.label else ""
        if self.curve:
            tightest = max(map(abs, self.curve.bends))
            shape = f"that bends to a radius of {1.0 / tightest:.6g} m" if tightest else "that is straight"
            return f"curve {shape}, {self.length:.6g} m long{where}"
        kind = f"arc of radius {1.0 / abs(self.curvature):.6g} m" if self.curvature else "line"
        return f"{kind}, {self.length:.6g} m long{where}"


ReferencePath = tuple[Segment, ...]


def point_on(segment: Segment, arc_length: float) -> PathPoint:
    """The point of a segment at an arc length from its start, extended beyond both ends."""
    course, curvature = segment.course, segment.curvature
    turned = curvature * arc_length
    if segment.curve:
        ahead, starboard, turned = segment.curve.own_at(arc_length, segment.offset)
    elif curvature:
        # 1 - cos(turned) loses digits where an arc is nearly straight
        ahead, starboard = math.sin(turned) / curvature, 2.0 * math.sin(0.5 * turned) ** 2 / curvature
    else:
        ahead, starboard = arc_length, 0.0
    return PathPoint(
        segment.north + ahead * math.cos(course) - starboard * math.sin(course),
        segment.east + ahead * math.sin(course) + starboard * math.cos(course),
        course + turned,
    )


def end_of(segment: Segment) -> PathPoint:
    """Where a segment ends and its direction there."""
    return point_on(segment, segment.length)


def sense(turn: Turn) -> float:
    """sigma: 1 for a turn to starboard (clockwise seen from above), -1 to port.

    Raises:
        GeometryError: it is neither.
    """
    if turn not in ("starboard", "port"):
        raise GeometryError(f"turn is {turn!r}; it is starboard or port")
    return 1.0 if turn == "starboard" else -1.0


def chain(start: Start, pieces: Iterable[Segment]) -> ReferencePath:
    """Lay pieces one after the other, each going on where and as the last one ended.

    Args:
        start: where the first one begins.
        pieces: their own starts are ignored.

    Returns:
        The reference path.
    """
    path: list[Segment] = []
    place = PathPoint(*check_start(start))
    for piece in pieces:
        path.append(replace(piece, north=place.north, east=place.east, course=place.course))
        place = end_of(path[-1])
    return tuple(path)


def straight(length: float, name: str = "length") -> Segment:
    """A line to lay in a `chain`; `name` is what messages call its length."""
    return Segment(north=0.0, east=0.0, course=0.0, curvature=0.0, length=positive(name, length))


def bend(radius: float, turn: Turn, angle: float, name: str = "radius") -> Segment:
    """An arc to lay in a `chain`; `name` is what messages call its radius."""
    radius = positive(name, radius)
    length = radius * positive("angle", angle, "rad")
    return Segment(north=0.0, east=0.0, course=0.0, curvature=sense(turn) / radius, length=length)


def positive(name: str, value: float, unit: str = "m") -> float:
    """The value, if it is a finite number > 0.

    Raises:
        GeometryError: otherwise.
    """
    if not 0.0 < value < math.inf:
        raise GeometryError(f"{name} is {value:g} {unit}; it must be a finite number > 0")
    return float(value)


def check_start(start: Start) -> Start:
    """The start, if all its numbers are finite.

    Raises:
        GeometryError: otherwise.
    """
    if not all(math.isfinite(value) for value in start):
        raise GeometryError(f"start is {tuple(start)}; north, east and course must be finite numbers")
    return start


def bends_of(segment: Segment) -> tuple[float, float]:
    """The least and the greatest curvature [1/m] along a segment of a reference path."""
    return segment.curve.bends if segment.curve else (segment.curvature, segment.curvature)


def length_of(path: Iterable[Segment]) -> float:
    """Length of a reference path [m]."""
    return math.fsum(segment.length for segment in path if not segment.beyond)
