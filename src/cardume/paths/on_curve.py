"""One curve of a path table: its points, the point abeam of a vehicle, and the lengths along it.

tau is the share of the curve's reference length that has gone by.  Beyond its ends a curve goes on
straight; within a path its neighbors take over there.  A point of the parallel curve at D to
starboard lies abeam of the same point of the reference curve, so with the reference curve's turned
angle chi(s), curvature c(s) and cross-track error e the own path has exactly

    e_own = e - D,   c_own = c / (1 - c D),   h = 1 - c D,   s_own = s - D (chi(s) - chi(0))
"""

from typing import NamedTuple

from cardume.compiler import Rows, compiled, some, where
from cardume.maths import clip, sincos
from cardume.paths.table import (
    DEGREE,
    GAINED_SPEED,
    GONE_AHEAD,
    GONE_STARBOARD,
    IS_CURVE,
    LENGTH,
    OFFSET,
    PLACE_DEGREE,
    REFERENCE_LENGTH,
    REFERENCE_RATE,
    TURNED,
    segment_value,
)

STEPS = 60  # of a search, at most; from where the vehicle was two or three do
RESOLVED = 1e-13  # of the length of a curve
ROUNDING = 4e-16  # of the distance of the vehicle
STEEPEST = 0.1  # of 1 - c e: a longer step of Newton's would leave the curve that it was drawn from


class CurvePoint(NamedTuple):
    """A point of a reference curve, in the axes of the curve's start."""

    ahead: float  # [m]
    starboard: float  # [m]
    turned: float  # [rad] since the start
    curvature: float  # [1/m] > 0 to starboard
    sine: float  # [-] of the turned angle
    cosine: float  # [-]


class CurveFoot(NamedTuple):
    """The point of a reference curve that a vehicle is abeam of."""

    along: float  # [m] from the start of the curve, on the reference curve
    own_along: float  # [m] the same on the own path
    cross_track: float  # [m] from the own path
    turned: float  # [rad] since the start
    curvature: float  # [1/m] of the own path
    stretch: float  # [-] of the own path


class Bracket(NamedTuple):
    """Between which arc lengths a point is; an end is firm once the point is known to lie inside it."""

    low: float  # [m]
    high: float  # [m]
    low_firm: float  # [-] 1
    high_firm: float  # [-] 1


@compiled
def is_curve(path: Rows, segment: float) -> bool:
    """Whether a segment, by its number [-], is a curve."""
    return segment_value(path, segment, IS_CURVE) > 0.5


@compiled
def share_of(path: Rows, segment: float, along: float) -> float:
    """tau: the share [-] of a curve's reference length; 0 for what is no curve.

    Args:
        path: (n,) path table.
        segment: [-] its number.
        along: [m] from the start of the curve, on the reference curve.
    """
    return where(is_curve(path, segment), along / segment_value(path, segment, REFERENCE_LENGTH), 0.0)


@compiled
def curve_point(path: Rows, segment: float, along: float) -> CurvePoint:
    """A point of a reference curve.

    Args:
        path: (n,) path table.
        segment: [-] number of the curve.
        along: [m] from its start, between 0 and its reference length.
    """
    tau = share_of(path, segment, along)
    ahead, starboard = 0.0 * tau, 0.0 * tau
    for k in range(PLACE_DEGREE - 1, -1, -1):
        ahead = ahead * tau + segment_value(path, segment, GONE_AHEAD + k)
        starboard = starboard * tau + segment_value(path, segment, GONE_STARBOARD + k)
    turned, curvature = turning(path, segment, tau)
    sine, cosine = sincos(turned)
    return CurvePoint(ahead * tau, starboard * tau, turned, curvature, sine, cosine)


@compiled
def turning(path: Rows, segment: float, tau: float) -> tuple[float, float]:
    """Turned angle [rad] since the start of a curve, and the reference curvature [1/m].

    Args:
        path: (n,) path table.
        segment: [-] number of the curve.
        tau: [-] share of its reference length.
    """
    per_tau, slope = 0.0 * tau, 0.0 * tau
    for k in range(DEGREE - 1, -1, -1):
        slope = slope * tau + per_tau
        per_tau = per_tau * tau + segment_value(path, segment, TURNED + k)
    length = segment_value(path, segment, REFERENCE_LENGTH)
    return per_tau * tau, (per_tau + tau * slope) / where(length > 0.0, length, 1.0)


@compiled
def gained_speed(path: Rows, segment: float, along: float) -> float:
    """By how much v_L [m/s] differs from that at the start of a segment; 0 on lines and arcs.

    Args:
        path: (n,) path table.
        segment: [-] its number.
        along: [m] from its start, on the reference path.
    """
    tau = clip(share_of(path, segment, along), 0.0, 1.0)
    gained = 0.0 * tau
    for k in range(DEGREE - 1, -1, -1):
        gained = gained * tau + segment_value(path, segment, GAINED_SPEED + k)
    return gained * tau


@compiled
def foot_on_curve(path: Rows, segment: float, ahead: float, starboard: float, was: float) -> CurveFoot:
    """The point of a curve abeam of a vehicle, downhill from where the vehicle was.

    Newton's method for (p - p(s)) . t(s) = 0, kept between points on either side of the foot.  It goes
    the way in which the distance falls, so it never settles on the farthest point of a bend; an end of
    the curve stands for what lies beyond it.

    Args:
        path: (n,) path table.
        segment: [-] number of the curve.
        ahead: [m] of the vehicle, in the axes of the start of the own path.
        starboard: [m] of the vehicle.
        was: [m] where on the reference curve the search begins.
    """
    length, offset = segment_value(path, segment, REFERENCE_LENGTH), segment_value(path, segment, OFFSET)
    beside = starboard + offset
    smallest = RESOLVED * length + ROUNDING * (abs(ahead) + abs(beside))
    s = clip(was, 0.0, length)
    zero = 0.0 * s
    between = Bracket(zero, length + zero, zero, zero)
    point = curve_point(path, segment, s)
    for _ in range(STEPS):
        onward, e = to_vehicle(point, ahead, beside)
        room = 1.0 - point.curvature * e
        wanted = s + onward / where(room > STEEPEST, room, STEEPEST)
        between = narrowed(between, s, onward)
        moves = abs(clip(wanted, 0.0, length) - s) > smallest
        if some(moves):
            s = where(moves, within(between, wanted), s)
            point = where(moves, curve_point(path, segment, s), point)
        else:
            break
    onward, e = to_vehicle(point, ahead, beside)
    before, after = (s <= smallest) & (onward < 0.0), (s >= length - smallest) & (onward > 0.0)
    straight = before | after
    beyond = where(straight, onward, 0.0)
    stretch = 1.0 - point.curvature * offset
    return CurveFoot(
        s + beyond,
        s - offset * point.turned + beyond,
        e - offset,
        point.turned,
        where(straight, 0.0, point.curvature / stretch),
        where(straight, 1.0, stretch),
    )


@compiled
def to_vehicle(point: CurvePoint, ahead: float, starboard: float) -> tuple[float, float]:
    """How far [m] along and to starboard of the course at a point a vehicle is.

    Args:
        point: of the curve.
        ahead: [m] of the vehicle, in the same axes.
        starboard: [m] of the vehicle.
    """
    x, y = ahead - point.ahead, starboard - point.starboard
    return x * point.cosine + y * point.sine, y * point.cosine - x * point.sine


@compiled
def narrowed(between: Bracket, s: float, onward: float) -> Bracket:
    """The bracket, knowing now which way the point lies from s.

    Args:
        between: so far.
        s: [m] inside it.
        onward: [m] > 0: the point lies further.
    """
    is_low, is_high = onward > 0.0, onward < 0.0
    return Bracket(
        where(is_low, s, between.low),
        where(is_high, s, between.high),
        where(is_low, 1.0, between.low_firm),
        where(is_high, 1.0, between.high_firm),
    )


@compiled
def within(between: Bracket, wanted: float) -> float:
    """The arc length [m] to try next: as wanted, an end not tried yet, or the middle.

    Args:
        between: where it is.
        wanted: [m] by Newton.
    """
    tried_low = (wanted <= between.low) & (between.low_firm > 0.5)
    tried_high = (wanted >= between.high) & (between.high_firm > 0.5)
    return where(tried_low | tried_high, 0.5 * (between.low + between.high), clip(wanted, between.low, between.high))


@compiled
def own_along(path: Rows, segment: float, along: float) -> float:
    """Length [m] on the own path from the start of a curve; extends beyond its ends.

    Args:
        path: (n,) path table.
        segment: [-] number of the curve.
        along: [m] on the reference curve.
    """
    inside = clip(along, 0.0, segment_value(path, segment, REFERENCE_LENGTH))
    turned, _ = turning(path, segment, share_of(path, segment, inside))
    return along - segment_value(path, segment, OFFSET) * turned


@compiled
def reference_along(path: Rows, segment: float, along: float) -> float:
    """Length [m] on the reference curve from its start; extends beyond its ends.

    Args:
        path: (n,) path table.
        segment: [-] number of the curve.
        along: [m] on the own path.
    """
    length, offset = segment_value(path, segment, REFERENCE_LENGTH), segment_value(path, segment, OFFSET)
    inside = clip(along, 0.0, segment_value(path, segment, LENGTH))
    zero = 0.0 * inside
    between = Bracket(zero, length + zero, zero + 1.0, zero + 1.0)
    s = inside * segment_value(path, segment, REFERENCE_RATE)
    if some(offset != 0.0):
        for _ in range(STEPS):
            turned, curvature = turning(path, segment, share_of(path, segment, s))
            onward = inside - (s - offset * turned)
            between = narrowed(between, s, onward)
            wanted = s + onward / (1.0 - offset * curvature)
            moves = (abs(wanted - s) > RESOLVED * length) & (offset != 0.0) & is_curve(path, segment)
            if some(moves):
                s = where(moves, within(between, wanted), s)
            else:
                break
    return s + (along - inside)
