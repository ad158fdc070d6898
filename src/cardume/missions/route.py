"""The forms a reference path may take in a mission file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cardume.missions.schema import POSITIVE, File, Forms, Group, ListOf, Quantity, Whole, Word

Meters = Annotated[float, Quantity("m")]
PositiveMeters = Annotated[float, Quantity("m", POSITIVE)]
Angle = Annotated[float, Quantity("rad")]
PositiveAngle = Annotated[float, Quantity("rad", POSITIVE)]
SpeedOrNone = Annotated[float | None, Quantity("m/s", POSITIVE)]
MOST_LAPS = 10_000
Turn = Annotated[str, Word(("starboard", "port"))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """A horizontal position, NED."""

    north: Annotated[Meters, "north of the origin"]
    east: Annotated[Meters, "east of the origin"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PathStart:
    """Where the reference path begins, and its course there."""

    north: Annotated[Meters, "north of the origin"] = 0.0
    east: Annotated[Meters, "east of the origin"] = 0.0
    course: Annotated[Angle, "clockwise from north"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePath:
    """A straight line."""

    start: Annotated[PathStart, Group(PathStart), "where it begins"] = PathStart()
    length: Annotated[PositiveMeters, "its length"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcPath:
    """An arc of a circle."""

    start: Annotated[PathStart, Group(PathStart), "where it begins"] = PathStart()
    radius: Annotated[PositiveMeters, "of the reference path"]
    turn: Annotated[Turn, "starboard: clockwise seen from above"] = "starboard"
    angle: Annotated[PositiveAngle, "by which the course changes"]


@dataclass(frozen=True, slots=True, kw_only=True)
class CirclePath:
    """A whole circle."""

    centre: Annotated[Point, Group(Point), "of the circle"]
    radius: Annotated[PositiveMeters, "of the reference path"]
    turn: Annotated[Turn, "starboard: clockwise seen from above"] = "starboard"
    start_bearing: Annotated[Angle, "of the first point, seen from the centre"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LawnmowerPath:
    """Parallel legs joined by half circles of radius spacing / 2."""

    start: Annotated[PathStart, Group(PathStart), "where the first leg begins"] = PathStart()
    leg: Annotated[PositiveMeters, "length of a leg"]
    legs: Annotated[int, Whole(1, 10_000), "number of legs"]
    spacing: Annotated[PositiveMeters, "between neighboring legs"]
    turn: Annotated[Turn, "sense of the first half circle"] = "starboard"


@dataclass(frozen=True, slots=True, kw_only=True)
class LineSegment:
    """A straight piece of a path; without a speed, the formation's."""

    line: Annotated[PositiveMeters, "its length"]
    speed: Annotated[SpeedOrNone, "along it, instead of the formation's"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcSegment:
    """A round piece of a path; without a speed, the formation's."""

    arc: Annotated[PositiveMeters, "its radius"]
    turn: Annotated[Turn, "starboard: clockwise seen from above"] = "starboard"
    angle: Annotated[PositiveAngle, "by which the course changes"]
    speed: Annotated[SpeedOrNone, "along it, instead of the formation's"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ClothoidSegment:
    """A piece whose curvature changes evenly, from that of the piece before; without a radius it ends straight."""

    clothoid: Annotated[PositiveMeters, "its length"]
    radius: Annotated[float | None, Quantity("m", POSITIVE), "at its end"] = None
    turn: Annotated[Turn, "at its end; starboard: clockwise seen from above"] = "starboard"
    speed: Annotated[SpeedOrNone, "along it, instead of the formation's"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentsPath:
    """Lines, arcs and clothoids, each continuing where the one before ends."""

    start: Annotated[PathStart, Group(PathStart), "where the first piece begins"] = PathStart()
    segments: Annotated[
        tuple[LineSegment | ArcSegment | ClothoidSegment, ...],
        ListOf(Forms((LineSegment, ArcSegment, ClothoidSegment))),
        "the pieces, each {line: ...}, {arc: ..., turn: ..., angle: ...} or {clothoid: ..., radius: ..., turn: ...}",
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class WaypointsPath:
    """Straight legs from point to point."""

    points: Annotated[tuple[Point, ...], ListOf(Group(Point)), "two or more, in the order in which they are passed"]
    turn_radius: Annotated[float | None, Quantity("m", POSITIVE), "of its turns; without one corners are sharp"] = None
    joint: Annotated[str, Word(("arc", "clothoid")), "how legs join; a clothoid's curvature does not jump"] = "arc"


@dataclass(frozen=True, slots=True, kw_only=True)
class SplinePath:
    """A smooth curve through points, the natural cubic spline."""

    points: Annotated[tuple[Point, ...], ListOf(Group(Point)), "three or more, in the order in which they are passed"]
    shape: Annotated[str, Word(("open", "closed")), "closed: from the last point back to the first"] = "open"
    laps: Annotated[int, Whole(1, MOST_LAPS), "how many times round a closed one"] = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class LemniscatePath:
    """A figure of eight, the lemniscate of Bernoulli."""

    centre: Annotated[Point, Group(Point), "where it crosses itself"]
    half_width: Annotated[PositiveMeters, "from the crossing to a tip"]
    axis: Annotated[Angle, "course from the crossing to the first tip"] = 0.0
    turn: Annotated[Turn, "round the first tip; starboard: clockwise seen from above"] = "starboard"
    start_parameter: Annotated[Angle, "t where it begins, 0 at the first tip"] = 0.0
    parameter_rate: Annotated[
        float | None, Quantity("1/s", POSITIVE), "dt/dt; makes the speed along it, instead of the formation's"
    ] = None
    laps: Annotated[int, Whole(1, MOST_LAPS), "how many times round"] = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class FilePath:
    """A path read from another file."""

    file: Annotated[str, File(), "the path file"]


PATHS = {
    "line": LinePath,
    "arc": ArcPath,
    "circle": CirclePath,
    "lawnmower": LawnmowerPath,
    "segments": SegmentsPath,
    "waypoints": WaypointsPath,
    "spline": SplinePath,
    "lemniscate": LemniscatePath,
    "file": FilePath,
}
AnyPath = (
    LinePath
    | ArcPath
    | CirclePath
    | LawnmowerPath
    | SegmentsPath
    | WaypointsPath
    | SplinePath
    | LemniscatePath
    | FilePath
)
