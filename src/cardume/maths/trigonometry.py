"""Circular functions and their inverses; errors, edges and how they are written: `elementary.py`."""

from cardume.compiler import compiled, polynomial, sqrt, turned, where
from cardume.maths.elementary import INF, NAN, ROUNDER

__all__ = [
    "ANGLE_LIMIT",
    "HALF_PI",
    "PI",
    "TWO_PI",
    "acos",
    "asin",
    "atan",
    "atan2",
    "cos",
    "sin",
    "sincos",
    "sincos_turns",
    "tan",
]

PI = 3.141592653589793
TWO_PI = 6.283185307179586
HALF_PI = 1.5707963267948966
QUARTER_PI = 0.7853981633974483

ANGLE_LIMIT = 1048576.0  # [rad] 2^20: so far q PIO2_HIGH is exact, 20 + 33 bits, and x - q PIO2_HIGH too
TWO_OVER_PI = 0.6366197723675814
PIO2_HIGH, PIO2_MIDDLE, PIO2_LOW = 1.5707963267341256, 6.077100506506192e-11, 3.5215598651832e-27
TAN_PI_8 = 0.41421356237309503

# sin y = y + y z p(z) and cos y = 1 - z / 2 + z^2 p(z), z = y^2, |y| <= pi / 4
SIN = (
    -0.16666666666666632, 0.008333333333322425, -0.00019841269829817576,
    2.755731369536661e-06, -2.505075866653152e-08, 1.589682830418914e-10,
)  # fmt: skip
COS = (
    0.0416666666666666, -0.001388888888887414, 2.4801587289492427e-05,
    -2.755731435538615e-07, 2.08757237003518e-09, -1.1359670513630591e-11,
)  # fmt: skip
# atan t = t - t z p(z), z = t^2, |t| <= tan(pi / 8)
ATAN = (
    0.333333333333332, -0.19999999999954085, 0.1428571428024924, -0.11111110786183016,
    0.09090897837826449, -0.07692061661595218, 0.06663120654840822, -0.058480108146351927,
    0.05039853710424068, -0.038078520293368695, 0.01792248806354138,
)  # fmt: skip
# asin s = s + s z p(z), z = s^2, |s| <= 1 / 2
ASIN = (
    0.1666666666666538, 0.07500000000343145, 0.04464285682345504, 0.03038195933130096,
    0.02237175353616429, 0.017359770790875525, 0.013884602296490692, 0.012173251605584313,
    0.006510978871700707, 0.019573556259544187, -0.016293523780122582, 0.03195859236014525,
)  # fmt: skip

_sine, _cosine = polynomial(*SIN), polynomial(-0.5, *COS)
# long ones in two halves, which wait for each other only at the end
_atan_even, _atan_odd = polynomial(*ATAN[::2]), polynomial(*ATAN[1::2])
_asin_even, _asin_odd = polynomial(*ASIN[::2]), polynomial(*ASIN[1::2])


@compiled
def _sincos_octant(y: float) -> tuple[float, float]:
    """sin and cos for abs(y) <= pi / 4."""
    z = y * y
    return y + y * z * _sine(z), 1.0 + z * _cosine(z)


@compiled
def sincos(x: float) -> tuple[float, float]:
    """Sine and cosine of the same angle, for little more than the price of one.

    x = q pi / 2 + y, |y| <= pi / 4, with pi / 2 in three parts (Cody and Waite)

    Args:
        x: [rad] within +-ANGLE_LIMIT, otherwise both results are NaN.

    Returns:
        (sin x, cos x).
    """
    raised = x * TWO_OVER_PI + ROUNDER
    q = raised - ROUNDER
    y = ((x - q * PIO2_HIGH) - q * PIO2_MIDDLE) - q * PIO2_LOW
    s, c = _sincos_octant(where(abs(x) <= ANGLE_LIMIT, y, NAN))
    return turned(raised, s, c)


@compiled
def sincos_turns(turns: float) -> tuple[float, float]:
    """(sin, cos) of 2 pi turns, turns [-] below 2^49 in size; whole turns are taken off exactly."""
    raised = 4.0 * turns + ROUNDER
    s, c = _sincos_octant((turns - 0.25 * (raised - ROUNDER)) * TWO_PI)
    return turned(raised, s, c)


@compiled
def sin(x: float) -> float:
    """Sine of an angle [rad]; NaN beyond +-ANGLE_LIMIT."""
    return sincos(x)[0]


@compiled
def cos(x: float) -> float:
    """Cosine of an angle [rad]; NaN beyond +-ANGLE_LIMIT."""
    return sincos(x)[1]


@compiled
def tan(x: float) -> float:
    """Tangent of an angle [rad]; NaN beyond +-ANGLE_LIMIT."""
    s, c = sincos(x)
    return s / c  # no float is a multiple of pi / 2 but 0, so c is never 0


@compiled
def _atan_ratio(low: float, high: float) -> float:
    """atan(low / high) in [0, pi / 4], for 0 <= low <= high, high > 0."""
    is_steep = low > TAN_PI_8 * high
    t = where(is_steep, low - high, low) / where(is_steep, low + high, high)  # |t| <= tan(pi / 8)
    z = t * t
    p = _atan_even(z * z) + z * _atan_odd(z * z)
    return where(is_steep, QUARTER_PI, 0.0) + (t - t * (z * p))


@compiled
def atan(x: float) -> float:
    """Arc tangent [rad], in [-pi / 2, pi / 2]."""
    a = abs(x)
    is_large = a > 1.0
    r = _atan_ratio(where(is_large, 1.0, a), where(is_large, a, 1.0))
    r = where(is_large, HALF_PI - r, r)
    return where(x < 0.0, -r, r)


@compiled
def atan2(y: float, x: float) -> float:
    """Angle of the point (x, y) from the x axis towards the y axis; of (east, north): course from north, clockwise.

    Args:
        y: [any] the side opposite the angle; -0 counts as +0.
        x: [any] the side along the axis, in the same unit.

    Returns:
        The angle [rad] in [-pi, pi]; 0 at the origin.  -pi only where y < 0 is too small beside x to tell.
    """
    along, across = abs(x), abs(y)
    is_swapped = across > along
    low = where(is_swapped, along, across)
    high = where(is_swapped, across, along)
    is_endless = high == INF
    low = where(is_endless, where(low == INF, 1.0, 0.0 * low), low)  # 0 * low keeps a NaN
    high = where(is_endless | (high == 0.0), 1.0, high)
    r = _atan_ratio(low, high)
    r = where(is_swapped, -r, r)
    r = where(x < 0.0, -r, r)
    base = where(is_swapped, HALF_PI, where(x < 0.0, PI, 0.0))
    r = base + r
    return where(y < 0.0, -r, r)


@compiled
def _arc_sine_core(x: float) -> tuple[float, float]:
    """(s, p): s + p = asin(abs(x)) up to 1/2, and asin(sqrt((1 - abs(x)) / 2)) above; NaN beyond 1."""
    a = abs(x)
    is_large = a > 0.5
    z = where(is_large, 0.5 * (1.0 - a), a * a)
    s = where(is_large, sqrt(z), a)
    return s, s * (z * (_asin_even(z * z) + z * _asin_odd(z * z)))


@compiled
def asin(x: float) -> float:
    """Arc sine [rad], in [-pi / 2, pi / 2]; NaN beyond +-1."""
    s, p = _arc_sine_core(x)
    r = where(abs(x) > 0.5, (HALF_PI - 2.0 * s) - 2.0 * p, s + p)
    return where(x < 0.0, -r, r)


@compiled
def acos(x: float) -> float:
    """Arc cosine [rad], in [0, pi]; NaN beyond +-1."""
    s, p = _arc_sine_core(x)
    r = s + p
    return where(x > 0.5, 2.0 * r, where(x < -0.5, PI - 2.0 * r, HALF_PI - where(x < 0.0, -r, r)))
