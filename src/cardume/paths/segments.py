"""A path given piece by piece."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from cardume.laws import Meters, MetersPerSecond, Positive, Radians
from cardume.paths.segment import GeometryError, ReferencePath, Segment, Start, Turn, bend, chain, positive, straight


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


def segments(start: Start, segments: Sequence[LinePiece | ArcPiece]) -> ReferencePath:
    """Lines and arcs, each going on as the last one ended.

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
    return chain(start, [_labelled(piece, number) for number, piece in enumerate(segments, 1)])


def _labelled(piece: LinePiece | ArcPiece, number: int) -> Segment:
    shape = (
        straight(piece.line, "line")
        if isinstance(piece, LinePiece)
        else bend(piece.arc, piece.turn, piece.angle, "arc")
    )
    speed = None if piece.speed is None else positive("speed", piece.speed, "m/s")
    return replace(shape, speed=speed, label=f"segment {number}")
