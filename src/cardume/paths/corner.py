"""Where an offset path meets a sharp corner of the reference path.

On the outer side of the corner the own path goes round it on an arc; on the inner side the two
neighbors are cut back to where they cross.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from cardume.paths.segment import GeometryError, PathPoint, Segment, bends_of, end_of, point_on

KINK = 1e-9  # [rad] a turn at a joint below this is rounding, not a corner
GAP = 1e-6  # [m]
HAIRPIN = 1e-6  # [rad] as near to a half turn as this, either way round is the outer side


@dataclass(frozen=True, kw_only=True, slots=True)
class OwnSegment:
    """A segment of a vehicle's own path, and what it stands for.

    Attributes:
        shape: the own segment; its speed is that of the formation.
        reference_length: [m] on the reference path; 0 where the own path rounds a corner.
    """

    shape: Segment
    reference_length: float


def offset_segment(segment: Segment, starboard: float) -> OwnSegment:
    """The segment moved to starboard: an arc of radius R gets R - sigma * offset, a curve all its parallel points.

    Args:
        segment: of the reference path.
        starboard: [m] offset.

    Raises:
        GeometryError: the arc, or the tightest bend of the curve, vanishes.
    """
    for bend in bends_of(segment):
        if not 1.0 - bend * starboard > 0.0:
            radius = 1.0 / abs(bend)
            raise GeometryError(f"the {segment} would get the radius {(1.0 - bend * starboard) * radius:.6g} m")
    stretch = 1.0 - segment.curvature * starboard
    if segment.curve:
        stretch = 1.0 - starboard * segment.curve.whole_turn / segment.length
    shape = replace(
        segment,
        north=segment.north - starboard * math.sin(segment.course),
        east=segment.east + starboard * math.cos(segment.course),
        curvature=segment.curvature / stretch,
        length=segment.length * stretch,
        offset=starboard,
    )
    return OwnSegment(shape=shape, reference_length=segment.length)


def corner_angle(before: Segment, after: Segment) -> float:
    """Angle [rad] of the reference path's corner, > 0 to starboard; 0 where it is smooth.

    Raises:
        GeometryError: the two do not meet.
    """
    end = end_of(before)
    gap = math.hypot(after.north - end.north, after.east - end.east)
    if gap > GAP:
        raise GeometryError(f"the {after} starts {gap:.6g} m from the end of the {before}; they must meet")
    angle = math.remainder(after.course - end.course, 2.0 * math.pi)
    return angle if abs(angle) > KINK else 0.0


def join_corner(before: OwnSegment, after: OwnSegment, angle: float, starboard: float) -> list[OwnSegment]:
    """What stands in the place of two own segments that meet at a corner.

    Args:
        before: the first.
        after: the second.
        angle: [rad] of the reference path's corner.
        starboard: [m] offset.

    Returns:
        The two, cut back (inner side) or with an arc between them (outer side).

    Raises:
        GeometryError: the corner leaves nothing of one of them.
    """
    if angle == 0.0 or starboard == 0.0:
        return [before, after]
    if before.shape.curve or after.shape.curve:
        raise GeometryError(
            f"the {before.shape} and the {after.shape} meet at a corner of {math.degrees(angle):.4g} deg;"
            " beside a curve only smooth joints can be offset: fly it without an offset, or round the corner"
        )
    if math.pi - abs(angle) < HAIRPIN:
        angle = -math.copysign(angle, starboard)
    if angle * starboard < 0.0:
        return [before, _round_corner(before.shape, after.shape, angle, abs(starboard)), after]
    kept, cut = _crossing(before.shape, after.shape, abs(starboard) * math.tan(0.5 * abs(angle)))
    if not (kept > 0.0 and cut < after.shape.length):
        short = before.shape if kept <= 0.0 else after.shape
        raise GeometryError(f"nothing is left of the {short} after the corner of {math.degrees(angle):.4g} deg is cut")
    start = point_on(after.shape, cut)
    rest = replace(
        after.shape, north=start.north, east=start.east, course=start.course, length=after.shape.length - cut
    )
    return [replace(before, shape=replace(before.shape, length=kept)), replace(after, shape=rest)]


def _round_corner(before: Segment, after: Segment, angle: float, radius: float) -> OwnSegment:
    start = end_of(before)
    slowest = before.speed
    if before.speed is not None and after.speed is not None:
        slowest = min(before.speed, after.speed)
    shape = replace(
        after,
        north=start.north,
        east=start.east,
        course=start.course,
        curvature=math.copysign(1.0 / radius, angle),
        length=radius * abs(angle),
        speed=slowest,
    )
    return OwnSegment(shape=shape, reference_length=0.0)


def _crossing(before: Segment, after: Segment, cut: float) -> tuple[float, float]:
    """Arc lengths on both at which they cross, by Newton's method from the crossing of their tangents.

    Raises:
        GeometryError: they do not cross.
    """
    at = np.array([before.length - cut, cut])
    for _ in range(50):
        one, other = point_on(before, float(at[0])), point_on(after, float(at[1]))
        gap = np.array([one.north - other.north, one.east - other.east])
        slopes = np.column_stack([_direction(one), [-x for x in _direction(other)]])
        if abs(np.linalg.det(slopes)) < 1e-12:
            break
        step = np.linalg.solve(slopes, gap)
        at = at - step
        if np.abs(step).max() <= 1e-13 * (1.0 + np.abs(at).max()):
            return float(at[0]), float(at[1])
    raise GeometryError(f"the {before} and the {after} do not cross after the offset")


def _direction(point: PathPoint) -> list[float]:
    return [math.cos(point.course), math.sin(point.course)]
