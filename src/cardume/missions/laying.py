"""From what a mission file says of its path to the reference path."""

from functools import lru_cache
from typing import Any, cast

from cardume.missions.route import (
    ArcPath,
    ArcSegment,
    CirclePath,
    ClothoidSegment,
    LawnmowerPath,
    LemniscatePath,
    LinePath,
    SplinePath,
    WaypointsPath,
)
from cardume.paths.arc import arc
from cardume.paths.circle import Center, circle
from cardume.paths.lawnmower import lawnmower
from cardume.paths.lemniscate import lemniscate
from cardume.paths.line import line
from cardume.paths.segment import ReferencePath, Start, Turn
from cardume.paths.segments import ArcPiece, ClothoidPiece, LinePiece, segments
from cardume.paths.spline import spline
from cardume.paths.waypoints import Joint, waypoints


@lru_cache(maxsize=16)  # many runs of a study share one path
def lay_path(path: Any) -> ReferencePath:
    """The reference path of a mission, unless that stands in a file of its own.

    Args:
        path: one of the records of `route.py`.

    Raises:
        GeometryError: it cannot be built.
    """
    if isinstance(path, CirclePath):
        return circle(_place(path.centre), path.radius, cast(Turn, path.turn), path.start_bearing)
    if isinstance(path, LemniscatePath):
        return lemniscate(
            _place(path.centre),
            path.half_width,
            path.axis,
            cast(Turn, path.turn),
            start_parameter=path.start_parameter,
            parameter_rate=path.parameter_rate,
            laps=path.laps,
        )
    if isinstance(path, SplinePath):
        return spline([_place(point) for point in path.points], closed=path.shape == "closed", laps=path.laps)
    if isinstance(path, WaypointsPath):
        return waypoints([_place(point) for point in path.points], path.turn_radius, cast(Joint, path.joint))
    start = Start(path.start.north, path.start.east, path.start.course)
    if isinstance(path, LinePath):
        return line(start, path.length)
    if isinstance(path, ArcPath):
        return arc(start, path.radius, cast(Turn, path.turn), path.angle)
    if isinstance(path, LawnmowerPath):
        return lawnmower(start, path.leg, path.legs, path.spacing, cast(Turn, path.turn))
    return segments(start, [_piece(piece) for piece in path.segments])


def _place(point: Any) -> Center:
    return Center(point.north, point.east)


def _piece(piece: Any) -> LinePiece | ArcPiece | ClothoidPiece:
    if isinstance(piece, ArcSegment):
        return ArcPiece(arc=piece.arc, turn=cast(Turn, piece.turn), angle=piece.angle, speed=piece.speed)
    if isinstance(piece, ClothoidSegment):
        return ClothoidPiece(
            clothoid=piece.clothoid, radius=piece.radius, turn=cast(Turn, piece.turn), speed=piece.speed
        )
    return LinePiece(line=piece.line, speed=piece.speed)
