"""From the formation's reference path to the table of one vehicle's own path."""

import math
from collections.abc import Sequence

import numpy as np

from cardume.paths import table
from cardume.paths.corner import OwnSegment, corner_angle, join_corner, offset_segment
from cardume.paths.curve import Curve, bends_of_turn
from cardume.paths.segment import GeometryError, Segment


def offset_path(
    segments: Sequence[Segment], starboard: float = 0.0, ahead: float = 0.0, speed: float = math.nan
) -> np.ndarray:
    """Offset the reference path to starboard by a constant, and write the vehicle's path table.

    An arc of radius R and sense sigma gets the radius R - sigma * starboard; a point of a curve, where the
    curvature is c, the curvature c / (1 - c * starboard).  At a sharp corner the own
    path is rounded by an arc about the corner (outer side) or cut back to where its parts cross (inner).

    Args:
        segments: the reference path.
        starboard: [m] offset, < 0 to port.
        ahead: [m] how far ahead of the formation's state the vehicle belongs, on the reference path.
        speed: [m/s] v_L of the segments that have none of their own.

    Returns:
        [any] (HEADER_WIDTH + segments * SEGMENT_WIDTH,) the table of `table.py`.

    Raises:
        GeometryError: the offset does not fit; the text says the largest that does.
    """
    if not segments:
        raise GeometryError("the path has no segment; it needs at least one line or arc")
    if not (math.isfinite(starboard) and math.isfinite(ahead)):
        raise GeometryError(f"the offset is {starboard:g} m to starboard, {ahead:g} m ahead; both must be finite")
    try:
        own = own_path(segments, starboard)
    except GeometryError as problem:
        fits = largest_offset(segments, starboard)
        if fits is None:  # not the offset's fault
            raise
        side = "starboard" if starboard > 0.0 else "port"
        raise GeometryError(
            f"an offset of {abs(starboard):.6g} m to {side} does not fit: {problem};"
            f" the largest offset to {side} that fits is {fits:.3f} m: reduce it, or widen the path there"
        ) from None
    return write_table(own, ahead, speed)


def own_path(segments: Sequence[Segment], starboard: float) -> list[OwnSegment]:
    """The segments of the own path.

    Args:
        segments: the reference path.
        starboard: [m] offset.

    Raises:
        GeometryError: the offset does not fit.
    """
    own = [offset_segment(segments[0], starboard)]
    for before, after in zip(segments, segments[1:], strict=False):
        angle = corner_angle(before, after)
        own[-1:] = join_corner(own[-1], offset_segment(after, starboard), angle, starboard)
    return own


def largest_offset(segments: Sequence[Segment], starboard: float) -> float | None:
    """The largest offset to the side of one that does not fit.

    Args:
        segments: the reference path.
        starboard: [m] an offset that does not fit.

    Returns:
        [m] > 0, rounded down to millimeters; None if even no offset does not.
    """
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        try:
            own_path(segments, middle * starboard)
            low = middle
        except GeometryError:
            high = middle
    if low == 0.0:
        return None
    return math.floor(low * abs(starboard) * 1000.0 - 1e-6) / 1000.0


def write_table(own: Sequence[OwnSegment], ahead: float, speed: float) -> np.ndarray:
    """Write the header and one row per own segment.

    Args:
        own: the own path.
        ahead: [m] see `offset_path`.
        speed: [m/s] where a segment has none.

    Returns:
        [any] (n,) path table.

    Raises:
        GeometryError: too many segments for one table.
    """
    if len(own) > table.MAX_SEGMENTS:
        raise GeometryError(f"the path has {len(own)} segments; at most {table.MAX_SEGMENTS} fit: split the mission")
    rows = np.zeros((len(own), table.SEGMENT_WIDTH))
    lead = next((k for k, segment in enumerate(own) if not segment.shape.beyond), 0)
    count = sum(not segment.shape.beyond for segment in own)
    arc_start = -math.fsum(segment.shape.length for segment in own[:lead])
    reference_start = -math.fsum(segment.reference_length for segment in own[:lead])
    for k, (row, segment) in enumerate(zip(rows, own, strict=True)):
        if k == lead:
            arc_start = reference_start = 0.0
        _write_row(row, segment, speed)
        row[table.ARC_START], row[table.REFERENCE_START] = arc_start, reference_start
        arc_start += row[table.LENGTH]
        reference_start += row[table.REFERENCE_LENGTH]
    last = rows[lead + count - 1]
    own_length = last[table.ARC_START] + last[table.LENGTH]
    reference_length = last[table.REFERENCE_START] + last[table.REFERENCE_LENGTH]
    curves = sum(segment.shape.curve is not None for segment in own)
    return np.concatenate([[len(own), own_length, reference_length, ahead, curves], rows.ravel()])


def _write_row(row: np.ndarray, segment: OwnSegment, speed: float) -> None:
    shape, reference_length = segment.shape, segment.reference_length
    sin_course, cos_course = math.sin(shape.course), math.cos(shape.course)
    row[table.START_NORTH], row[table.START_EAST] = shape.north, shape.east
    row[table.START_COURSE] = shape.course
    row[table.SIN_COURSE], row[table.COS_COURSE] = sin_course, cos_course
    row[table.CURVATURE], row[table.LENGTH] = shape.curvature, shape.length
    if shape.curvature:
        row[table.CENTER_NORTH] = shape.north - sin_course / shape.curvature
        row[table.CENTER_EAST] = shape.east + cos_course / shape.curvature
        row[table.RADIUS] = 1.0 / abs(shape.curvature)
    row[table.REFERENCE_LENGTH] = reference_length
    row[table.SPEED] = speed if shape.speed is None else shape.speed
    row[table.STRETCH] = shape.length / reference_length if reference_length else 1.0
    row[table.REFERENCE_RATE] = reference_length / shape.length
    if shape.curve:
        _write_curve(row, shape, shape.curve)


def curve_of(row: np.ndarray) -> Curve:
    """The curve that a row of a path table describes.

    Args:
        row: [any] (SEGMENT_WIDTH,).
    """

    def numbers(first: int, count: int) -> tuple[float, ...]:
        return tuple(float(x) for x in row[first : first + count])

    turned, length = numbers(table.TURNED, table.DEGREE), float(row[table.REFERENCE_LENGTH])
    return Curve(
        length=length,
        turned=turned,
        ahead=numbers(table.GONE_AHEAD, table.PLACE_DEGREE),
        starboard=numbers(table.GONE_STARBOARD, table.PLACE_DEGREE),
        bends=bends_of_turn(turned, length),
        speed=float(row[table.SPEED]),
        gained_speed=numbers(table.GAINED_SPEED, table.DEGREE),
    )


def _write_curve(row: np.ndarray, shape: Segment, curve: Curve) -> None:
    row[table.IS_CURVE], row[table.OFFSET] = 1.0, shape.offset
    row[table.TURNED : table.TURNED + table.DEGREE] = curve.turned
    row[table.GONE_AHEAD : table.GONE_AHEAD + table.PLACE_DEGREE] = curve.ahead
    row[table.GONE_STARBOARD : table.GONE_STARBOARD + table.PLACE_DEGREE] = curve.starboard
    if shape.speed is None and curve.speed is not None:
        row[table.SPEED] = curve.speed
        row[table.GAINED_SPEED : table.GAINED_SPEED + table.DEGREE] = curve.gained_speed
