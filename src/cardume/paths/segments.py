"""A path given piece by piece."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from cardume.laws import Meters, MetersPerSecond, Positive, Radians
from cardume.paths.segment import (
    GeometryError,
    ReferencePath,
    Segment,
    Start,
    Turn,
    bend,
    chain,
    positive,
    sense,
    straight,
)
from cardume.paths.tracing import clothoid


@dataclass(frozen=True, kw_only=True, slots=True)
class LinePiece:
    """A straight piece.

    Attributes:
        line: [m] length > 0.
        speed: [m/s] v_L on it; None: the formation's.
    """

    line: Positive[Meters]
    speed: Positive[MetersPerSecond] | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class ArcPiece:
    """A turn.

    Attributes:
        arc: [m] radius > 0.
        turn: starboard (clockwise seen from above) or port.
        angle: [rad] > 0.
        speed: [m/s] v_L on it; None: the formation's.
    """

    arc: Positive[Meters]
    turn: Turn
    angle: Positive[Radians]
    speed: Positive[MetersPerSecond] | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class ClothoidPiece:
    """A piece whose curvature changes evenly, from that of the piece before.

    Attributes:
        clothoid: [m] length > 0.
        radius: [m] at its end, > 0; None: it ends straight.
        turn: at its end, starboard (clockwise seen from above) or port.
        speed: [m/s] v_L on it; None: the formation's.
    """

    clothoid: Positive[Meters]
    radius: Positive[Meters] | None = None
    turn: Turn = "starboard"
    speed: Positive[MetersPerSecond] | None = None


Piece = LinePiece | ArcPiece | ClothoidPiece


def segments(start: Start, segments: Sequence[Piece]) -> ReferencePath:
    """Lines, arcs and clothoids, each going on as the last one ended.

    Args:
        start: where the first one begins, and its course.
        segments: at least one.

    Returns:
        The reference path.

    Raises:
        GeometryError: there is none, or one that is not positive.
    """
    if not segments:
        raise GeometryError("segments is empty; give at least one, such as {line: 30 m}")
    laid: list[Segment] = []
    curvature = 0.0
    for number, piece in enumerate(segments, 1):
        speed = None if piece.speed is None else positive("speed", piece.speed, "m/s")
        shapes, curvature = _shapes(piece, curvature)
        laid += [replace(shape, speed=speed, label=f"segment {number}") for shape in shapes]
    return chain(start, laid)


def _shapes(piece: Piece, before: float) -> tuple[list[Segment], float]:
    """What to lay for a piece after a curvature [1/m], and the curvature at its end."""
    if isinstance(piece, LinePiece):
        return [straight(piece.line, "line")], 0.0
    if isinstance(piece, ArcPiece):
        return [bend(piece.arc, piece.turn, piece.angle, "arc")], sense(piece.turn) / piece.arc
    length = positive("clothoid", piece.clothoid)
    after = 0.0 if piece.radius is None else sense(piece.turn) / positive("radius", piece.radius)
    return clothoid(before, after, length), after
