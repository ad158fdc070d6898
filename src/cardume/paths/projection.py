"""Orthogonal projection: the point of the path that a vehicle is abeam of.

Lines and arcs are one formula.  In the axes of a segment's start (x ahead, y to starboard), with
curvature c,

    e = (2 y - c (x^2 + y^2)) / (1 + sqrt((c x)^2 + (1 - c y)^2))
    s = atan2(|c| x, 1 - c y) / |c|,   s = x for a line

e is sigma (R - rho), eq. (52) with its missing -R and the sense of turn, written so that nothing
cancels when the arc is nearly straight.  s is an angle, known up to whole laps: the lap is the one
nearest to where the vehicle was, so gamma never wraps.  On a curve the foot is searched for, from
where the vehicle was (`on_curve.py`).
"""

from typing import NamedTuple

from cardume.compiler import Rows, compiled, inlined, load, some, where
from cardume.maths import atan2, clip, hypot, sincos, unwrap_near, wrap_angle
from cardume.paths.base import reference_point_law
from cardume.paths.on_curve import curve_point, foot_on_curve, gained_speed, is_curve, reference_along
from cardume.paths.table import (
    AHEAD,
    ARC_START,
    LENGTH_OWN,
    NUM_SEGMENTS,
    OFFSET,
    REFERENCE_START,
    SPEED,
    PathPlace,
    Segment,
    has_curves,
    segment_at,
    segment_near,
    segment_of,
    segment_value,
)
from cardume.signals import NOTHING, PathError, Place

MOVES = 4  # segments that a vehicle may pass in one tick; a jump over more takes several ticks
MOVES_ON_CURVES = 400  # the same where a bend is many short curves
AT_CENTER = 1e-9  # radii from an arc's center within which every point of the arc is equally near


class Foot(NamedTuple):
    """The projection onto one segment, extended at both ends."""

    segment: float  # [-]
    along: float  # [m] from the segment's start
    length: float  # [m] of the segment
    cross_track: float  # [m] > 0 to starboard
    course: float  # [rad]
    curvature: float  # [1/m]
    stretch: float  # [-]
    gained: float  # [m] along on the reference path
    row: Segment  # of the table


class PointAhead(NamedTuple):
    """A point of the path."""

    north: float  # [m]
    east: float  # [m]
    course: float  # [rad] (-pi, pi]
    sin_course: float  # [-]
    cos_course: float  # [-]


@compiled
def foot_on(place: Place, segment: float, last: float, arc_length: float) -> Foot:
    """Project onto one segment.

    Args:
        place: position and path.
        segment: [-] its number.
        last: [-] number of the last one.
        arc_length: [m] where the vehicle was: the lap of an arc is the one nearest to it.
    """
    row = segment_of(place.path, segment)
    c, length = row.curvature, row.length
    north, east = place.north - row.start_north, place.east - row.start_east
    x = north * row.cos_course + east * row.sin_course
    y = east * row.cos_course - north * row.sin_course
    to_center = hypot(c * x, 1.0 - c * y)  # in radii; 1 for a line
    cross_track = (2.0 * y - c * (x * x + y * y)) / (1.0 + to_center)
    along, course = x, row.start_course
    curved = c != 0.0
    if some(curved):
        turning = where(curved, abs(c), 1.0)
        was = arc_length - row.arc_start
        was = where((segment > 0.0) & (was < 0.0), 0.0, where((segment < last) & (was > length), length, was))
        turned = where(to_center > AT_CENTER, atan2(turning * x, 1.0 - c * y), turning * was)
        along = where(curved, unwrap_near(turned, turning * was) / turning, x)
        course = course + where(curved, where(c > 0.0, turned, -turned), 0.0)
    foot = Foot(segment, along, length, cross_track, course, c, row.stretch, along * row.reference_rate, row)
    if has_curves(place.path):
        foot = where(is_curve(place.path, segment), _foot_on_curve(place, foot, arc_length, x, y), foot)
    return foot


@compiled
def _foot_on_curve(place: Place, straight: Foot, arc_length: float, x: float, y: float) -> Foot:
    """The foot on a curve, of the segment of a foot that took it for a line."""
    path, row, segment = place.path, straight.row, straight.segment
    was = (arc_length - row.arc_start) * row.reference_rate
    foot = foot_on_curve(path, segment, x, y, was)
    course = row.start_course + foot.turned
    return Foot(
        segment, foot.own_along, row.length, foot.cross_track, course, foot.curvature, foot.stretch, foot.along, row
    )


@compiled
def find_foot(place: Place, memory: PathPlace) -> Foot:
    """Project onto the segment where the vehicle is now, starting from where it was.

    It goes on to the next segment past the end of one, and back before its start.  On the outer side
    of a corner both ask to be left: then it stays on the later one.

    Args:
        place: position and path.
        memory: where the vehicle was.
    """
    last = load(place.path, NUM_SEGMENTS) - 1.0
    foot = foot_on(place, clip(memory.segment, 0.0, where(last > 0.0, last, 0.0)), last, memory.arc_length)
    may_return = foot.segment >= 0.0
    for _ in range(MOVES_ON_CURVES if has_curves(place.path) else MOVES):
        onward = (foot.along > foot.length) & (foot.segment < last)
        back = (foot.along < 0.0) & (foot.segment > 0.0) & may_return
        may_return = may_return & (foot.along <= foot.length)
        moved = onward | back
        if some(moved):
            segment = foot.segment + where(onward, 1.0, where(back, -1.0, 0.0))
            foot = where(moved, foot_on(place, segment, last, memory.arc_length), foot)
        else:
            break
    return foot


@compiled
def formation_speed(path: Rows, segment: float, path_parameter: float) -> float:
    """v_L [m/s] where the formation is: that of the segment, unless the vehicle is ahead of or behind it.

    Args:
        path: (n,) path table.
        segment: [-] where the vehicle is.
        path_parameter: [m] where the formation is.
    """
    return _speed_there(path, segment, segment_of(path, segment), path_parameter)


@inlined
def _speed_there(path: Rows, segment: float, row: Segment, path_parameter: float) -> float:
    """`formation_speed` by a segment that was looked up already."""
    ahead, speed, begin = load(path, AHEAD), row.speed, row.reference_start
    if some(ahead != 0.0):
        segment = where(ahead != 0.0, segment_at(path, path_parameter, REFERENCE_START), segment)
        speed, begin = segment_value(path, segment, SPEED), segment_value(path, segment, REFERENCE_START)
    if has_curves(path):
        speed = speed + gained_speed(path, segment, path_parameter - begin)
    return speed


@compiled
def project(place: Place, memory: PathPlace) -> tuple[PathError, PathPlace]:
    """Compare a vehicle with its path at the point it is abeam of.

    Exact on lines and arcs of both senses at any distance; before the start and past the end the first
    and last segments go on, arcs as their circle, closed curves as one more lap, others straight.  At an
    arc's center the angle stays as it was.  Within the corner of a sharp turn gamma waits at the corner.
    gamma jumps only where the nearest point does: beyond an arc's center, and on the inner side of a
    corner.  On a curve the foot is the nearest point around the last one: where the path crosses itself,
    the vehicle stays on its branch.

    Args:
        place: position and path.
        memory: where on the path the vehicle was.

    Returns:
        The path error, its `speed` left at 0, and where on the path the vehicle is.
    """
    path, foot = place.path, find_foot(place, memory)
    last = load(path, NUM_SEGMENTS) - 1.0
    segment, row = foot.segment, foot.row
    # Only a corner leaves the foot beyond an inner end.
    short = (segment > 0.0) & (foot.along < 0.0)
    long = (segment < last) & (foot.along > foot.length)
    along = where(short, 0.0, where(long, foot.length, foot.along))
    gained = where(short | long, along * row.reference_rate, foot.gained)
    arc_length = row.arc_start + along
    path_parameter = row.reference_start + gained - load(path, AHEAD)
    finished = (segment >= last) & (along >= foot.length)
    if has_curves(path):  # a closed one goes on
        finished = finished | (arc_length >= load(path, LENGTH_OWN))
    error = PathError(
        wrap_angle(foot.course),
        foot.curvature,
        foot.cross_track,
        0.0 * along,
        path_parameter,
        foot.stretch,
        _speed_there(path, segment, row, path_parameter),
        arc_length,
        where(finished, 1.0, 0.0),
        0.0 * along,
        NOTHING + 0.0 * along,
        path,
    )
    # A position that is not a number must not be remembered.
    return error, PathPlace(segment, where(arc_length == arc_length, arc_length, memory.arc_length))


@compiled
def point_at(path: Rows, arc_length: float) -> PointAhead:
    """The point of a vehicle's own path at an arc length, exact, and extended beyond both ends.

    Args:
        path: (n,) path table.
        arc_length: [m] on the own path.

    Returns:
        Position [m], course [rad] in (-pi, pi], and its sine and cosine.
    """
    return point_on(path, segment_at(path, arc_length, ARC_START), arc_length)


@inlined
def point_of_formation(path: Rows, path_parameter: float, guess: float) -> PointAhead:
    """Where a vehicle belongs when the formation has this coordination state.

    Args:
        path: (n,) path table.
        path_parameter: [m] gamma less the vehicle's `ahead`.
        guess: [-] number of the segment where it probably is.

    Returns:
        The point of its own path.
    """
    gamma = path_parameter + load(path, AHEAD)
    segment = segment_near(path, gamma, REFERENCE_START, guess)
    row = segment_of(path, segment)
    beyond = gamma - row.reference_start
    point = _point_along(row, beyond * row.stretch)
    if has_curves(path):
        point = where(is_curve(path, segment), _point_along_curve(path, segment, beyond), point)
    return point


@compiled
def point_on(path: Rows, segment: float, arc_length: float) -> PointAhead:
    """A point of one segment, extended beyond its ends.

    Args:
        path: (n,) path table.
        segment: [-] its number.
        arc_length: [m] on the own path.

    Returns:
        Position [m], course [rad] in (-pi, pi], and its sine and cosine.
    """
    row = segment_of(path, segment)
    along = arc_length - row.arc_start
    point = _point_along(row, along)
    if has_curves(path):
        on_curve = _point_along_curve(path, segment, reference_along(path, segment, along))
        point = where(is_curve(path, segment), on_curve, point)
    return point


@inlined
def _point_along(row: Segment, s: float) -> PointAhead:
    """The point s [m] from the start of a line or an arc."""
    c, sin_start, cos_start = row.curvature, row.sin_course, row.cos_course
    curved = c != 0.0
    x, y, turned = s, 0.0 * s, c * s
    sin_turned, cos_turned = 0.0 * s, 1.0 + 0.0 * s
    if some(curved):
        # 1 - cos loses digits where an arc is nearly straight: half angles
        turned = wrap_angle(turned)
        sin_half, cos_half = sincos(0.5 * turned)
        diameter = 2.0 / where(curved, c, 1.0)
        x = where(curved, diameter * sin_half * cos_half, s)
        y = where(curved, diameter * sin_half * sin_half, 0.0)
        sin_turned, cos_turned = 2.0 * sin_half * cos_half, 1.0 - 2.0 * sin_half * sin_half
    return PointAhead(
        row.start_north + x * cos_start - y * sin_start,
        row.start_east + x * sin_start + y * cos_start,
        wrap_angle(row.start_course + turned),
        sin_start * cos_turned + cos_start * sin_turned,
        cos_start * cos_turned - sin_start * sin_turned,
    )


@compiled
def _point_along_curve(path: Rows, segment: float, along: float) -> PointAhead:
    """The own point abeam of the one that lies `along` [m] from the start of a reference curve."""
    row = segment_of(path, segment)
    inside = clip(along, 0.0, row.reference_length)
    point, beyond, offset = curve_point(path, segment, inside), along - inside, segment_value(path, segment, OFFSET)
    x = point.ahead + beyond * point.cosine - offset * point.sine
    y = point.starboard + beyond * point.sine + offset * (point.cosine - 1.0)
    return PointAhead(
        row.start_north + x * row.cos_course - y * row.sin_course,
        row.start_east + x * row.sin_course + y * row.cos_course,
        wrap_angle(row.start_course + point.turned),
        row.sin_course * point.cosine + row.cos_course * point.sine,
        row.cos_course * point.cosine - row.sin_course * point.sine,
    )


@reference_point_law
def projection(place: Place, memory: PathPlace) -> tuple[PathError, PathPlace]:
    """Compare the vehicle with the point of its path that it is abeam of; see `project`.

    e = sigma (R - rho) on an arc, s1 = 0, gamma = gamma_start + (s - s_start) / h - ahead

    with sigma = 1 for a turn to starboard, rho the distance to the arc's center, s the arc length on
    the vehicle's own path and h its stretch.

    Args:
        place: position [m] and path table of the vehicle.
        memory: where on its path it was.

    Returns:
        The path error (its `speed` is the agent's to fill in) and the next memory.

    Source: paper eqs. (5)-(8) with s1 = 0 and c = sigma / R; (50)-(52), in meters, any sense of turn,
    the angle unwrapped, and the -R that (52) lost.
    """
    return project(place, memory)
