"""Angles on the circle: wrapped to (-pi, pi], or continued without jumps."""

from cardume.compiler import compiled, where
from cardume.maths.elementary import NAN, round_even
from cardume.maths.trigonometry import ANGLE_LIMIT, PI, TWO_PI

__all__ = ["angle_difference", "unwrap_near", "wrap_angle"]

ONE_OVER_TWO_PI = 0.15915494309189535
TWO_PI_HIGH, TWO_PI_LOW = 6.2831853069365025, 2.430840202602477e-10  # 2 pi = their sum to 1e-26; HIGH has 33 bits


@compiled
def wrap_angle(angle: float) -> float:
    """The same direction in (-pi, pi].

    What already lies there comes back unchanged to the last bit, so wrapping twice is wrapping once; -pi becomes pi.
    Whole turns are those of the true 2 pi, not of the float nearest to it, so sin(wrap_angle(x)) is sin(x) however
    many turns x has made; the price is that wrap_angle(2.0 * PI) is -2.4e-16, not 0.

    Args:
        angle: [rad] within +-ANGLE_LIMIT = 2^20; beyond, NaN.

    Returns:
        The wrapped angle [rad], > -PI and <= PI, good to 5e-16.
    """
    q = round_even(angle * ONE_OVER_TWO_PI)  # 0 for +-PI: the product is +-0.5, and 0 is the even neighbor
    r = (angle - q * TWO_PI_HIGH) - q * TWO_PI_LOW
    r = where(r > PI, r - TWO_PI, r)  # past an end by a rounding
    r = where(r <= -PI, r + TWO_PI, r)
    return where(abs(angle) <= ANGLE_LIMIT, r, NAN)


@compiled
def angle_difference(actual: float, desired: float) -> float:
    """actual - desired by the shorter way round, in (-pi, pi].

    Args:
        actual: [rad]
        desired: [rad]

    Returns:
        The difference [rad]; > 0: actual lies clockwise of desired (NED).  Half a turn is +pi, never -pi.
    """
    return wrap_angle(actual - desired)


@compiled
def unwrap_near(angle: float, reference: float) -> float:
    """The same direction as `angle`, whole turns chosen so that it lies within half a turn of `reference`.

    Args:
        angle: [rad] a direction.
        reference: [rad] for instance the value one tick ago of an angle that must not jump.

    Returns:
        An angle [rad] in (reference - pi, reference + pi], up to rounding.
    """
    return reference + wrap_angle(angle - reference)
