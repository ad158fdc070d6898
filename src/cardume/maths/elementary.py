"""Elementary functions from + - * / sqrt and selection alone: the same bits on every processor.

No call reaches the C library and nothing branches, so the scalar build and eight lanes at once agree to the last bit.
Plain Python differs in the last digit, for it rounds twice where compiled code fuses a product and a sum.  This file
has the exponential family, the next one, `trigonometry.py`, the circular one.  Errors, measured against references of
64 bits and more, in `tests/maths/test_accuracy.py`:

| function | error, at most | domain | outside it |
|---|---|---|---|
| sin, cos, sincos | 2.5e-16, and 4e-16 relative | abs(x) <= ANGLE_LIMIT = 2^20 rad | NaN, also for +-inf |
| tan | 7e-16 relative | as sin | NaN |
| asin, acos | 4e-16 relative | abs(x) <= 1 | NaN: clip first where rounding may leave it |
| atan, atan2 | 4e-16 relative | all; atan2: magnitudes up to 1e307 | infinities as in C |
| tanh | 6e-16 relative | all | tanh(+-inf) = +-1 |
| exp | 3e-16 relative | all | inf above 709.78; 0 where the result would be below 2^-1022 |
| log | 3e-16 relative | x > 0, denormal numbers too | log(0) = -inf, log(x < 0) = NaN, log(inf) = inf |
| hypot | 3e-16 relative | 0 and magnitudes 1e-140 to 1e150 | inf above 1e154 |

In all of these NaN in gives NaN out.  The sign of zero: sin, tan, asin, atan and tanh return +0 at -0, and atan2 takes
either zero for +0, so atan2(0, 0) = 0 and atan2(-0, -1) = +pi.  The odd functions are odd and the even ones even to
the last bit.

The polynomials are minimax approximations computed for this library: `tests/maths/minimax.py`.
"""

from cardume.compiler import compiled, floor, polynomial, scale2, split2, sqrt, where

__all__ = [
    "clip",
    "exp",
    "floor",
    "hypot",
    "log",
    "maximum",
    "minimum",
    "round_even",
    "sign",
    "signed_root",
    "signed_square",
    "sqrt",
    "tanh",
]

INF = float("inf")
NAN = float("nan")
ROUNDER = 6755399441055744.0  # 1.5 * 2^52: adding it leaves no room for a fraction
SMALLEST_NORMAL = 2.2250738585072014e-308
TWO_TO_54 = 18014398509481984.0

LN2_HIGH, LN2_LOW = 0.6931471803691238, 1.9082149292705877e-10  # HIGH has 32 bits: a whole number times it is exact
LOG2_E = 1.4426950408889634
EXP_MAX, EXP_MIN = 709.782712893384, -708.3964185322641  # log of the largest and of the smallest normal number
# r coth(r / 2) = 2 + z p(z), z = r^2, |r| <= 0.51 log 2
COTH = (
    0.16666666666666588,
    -0.002777777777688546,
    6.613756284841763e-05,
    -1.653386223912748e-06,
    4.136650099095235e-08,
)
# 2 artanh(s) = 2 s + s z p(z), z = s^2, |s| <= 3 - 2 sqrt(2)
ARTANH = (
    0.6666666666666734, 0.3999999999941465, 0.2857142874239978, 0.22222198571523796,
    0.1818356442935653, 0.15314047566953803, 0.14795982288958837,
)  # fmt: skip

_coth, _artanh = polynomial(2.0, *COTH), polynomial(*ARTANH)


@compiled
def round_even(x: float) -> float:
    """The nearest whole number, the even one of two equally near; abs(x) < 2^51."""
    return (x + ROUNDER) - ROUNDER


@compiled
def minimum(a: float, b: float) -> float:
    """The smaller of two numbers; b if one is NaN."""
    return where(a < b, a, b)


@compiled
def maximum(a: float, b: float) -> float:
    """The larger of two numbers; b if one is NaN."""
    return where(a > b, a, b)


@compiled
def clip(x: float, low: float, high: float) -> float:
    """x limited to low [any] and high [any] of the same kind; NaN stays NaN."""
    return where(x < low, low, where(x > high, high, x))


@compiled
def sign(x: float) -> float:
    """-1, 0 or 1; NaN stays NaN."""
    return where(x > 0.0, 1.0, where(x < 0.0, -1.0, x))


@compiled
def signed_square(x: float) -> float:
    """x abs(x), the shape of quadratic drag and of a thruster curve."""
    return x * abs(x)


@compiled
def signed_root(x: float) -> float:
    """The inverse of signed_square: sign(x) sqrt(abs(x))."""
    root = sqrt(abs(x))
    return where(x < 0.0, -root, root)


@compiled
def hypot(x: float, y: float) -> float:
    """sqrt(x^2 + y^2), without care for squares that leave the range of float64."""
    return sqrt(x * x + y * y)


@compiled
def _r_coth_half(r: float) -> float:
    """r coth(r / 2), which is even; exp(r) = 1 + 2 r / (this - r)."""
    return _coth(r * r)


@compiled
def exp(x: float) -> float:
    """e to the x; inf above 709.78, 0 where the result would be below 2^-1022: no denormal results.

    x = k log 2 + r, |r| <= log(2) / 2;   e^x = 2^k (1 + 2 r / (r coth(r / 2) - r))
    """
    inside = where(x <= EXP_MAX, where(x >= EXP_MIN, x, EXP_MIN), EXP_MAX)  # also for NaN, which has no k
    k = round_even(inside * LOG2_E)
    high, low = inside - k * LN2_HIGH, k * LN2_LOW
    r = high - low
    d = _r_coth_half(r) - r
    e = 1.0 + (high - (low - r * ((2.0 - d) / d)))  # 1 + r + r (2 - d) / d
    is_top = k > 1023.0  # 2^1024 is no number, but e < 1 there
    e = scale2(where(is_top, 2.0 * e, e), where(is_top, 1023.0, k))
    return where(x <= EXP_MAX, where(x >= EXP_MIN, e, 0.0), where(x > EXP_MAX, INF, x))


@compiled
def tanh(x: float) -> float:
    """Hyperbolic tangent, accurate to its last digits near zero too.

    2 |x| = k log 2 + r;   tanh |x| = (T + t) / (1 + T t),  T = (2^k - 1) / (2^k + 1),  t = tanh(r / 2)
    """
    a = where(abs(x) <= 20.0, abs(x), 20.0)  # tanh(20) rounds to 1; NaN comes back in the last line
    k = round_even(2.0 * a * LOG2_E)
    r = (2.0 * a - k * LN2_HIGH) - k * LN2_LOW
    w = _r_coth_half(r)  # t = r / w
    power = scale2(1.0, k)
    t = ((power + 1.0) * r + (power - 1.0) * w) / ((power - 1.0) * r + (power + 1.0) * w)
    return where(x < 0.0, -t, where(x >= 0.0, t, x))


@compiled
def log(x: float) -> float:
    """Natural logarithm; -inf at 0, NaN below.

    x = 2^k m, m in [1/sqrt(2), sqrt(2));   log m = 2 artanh((m - 1) / (m + 1))
    """
    is_tiny = x < SMALLEST_NORMAL
    scaled = where(is_tiny, TWO_TO_54 * x, x)
    is_regular = (scaled > 0.0) & (scaled < INF)
    k, m = split2(where(is_regular, scaled, 1.0))
    k = where(is_tiny, k - 54.0, k)
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    p = z * _artanh(z)
    h = 0.5 * f * f
    # log m = 2 s + s p = f - (h - s (h + p)): the part that rounds is small beside f
    r = k * LN2_HIGH - ((h - (s * (h + p) + k * LN2_LOW)) - f)
    return where(is_regular, r, where(x == 0.0, -INF, where(x > 0.0, x, NAN)))
