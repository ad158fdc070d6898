"""Steps in time: the exact step of a first-order lag, and the weights of Runge-Kutta, Gauss and Simpson."""

import math

from cardume.compiler import compiled, where
from cardume.maths.elementary import exp

__all__ = ["approach", "gauss_slopes", "remaining", "runge_kutta_mean", "simpson_mean"]


def _dense_weights(t: float) -> tuple[float, float, float]:
    """What k1, k2 + k3 and k4 weigh in x(t dt) - x(0), for the third-order interpolation of Runge-Kutta's method."""
    return t - 1.5 * t**2 + 2.0 / 3.0 * t**3, t**2 - 2.0 / 3.0 * t**3, -0.5 * t**2 + 2.0 / 3.0 * t**3


FIRST = _dense_weights(0.5 - math.sqrt(3.0) / 6.0)  # at the two points of Gauss's rule
SECOND = _dense_weights(0.5 + math.sqrt(3.0) / 6.0)


@compiled
def remaining(time_constant: float, dt: float) -> float:
    """What is left of a first-order lag's error after a time: exp(-dt / T), and 0 when T = 0.

    Args:
        time_constant: [s] T >= 0.
        dt: [s] >= 0.

    Returns:
        A number in [0, 1].
    """
    lags = time_constant > 0.0
    return where(lags, exp(-dt / where(lags, time_constant, 1.0)), 0.0)


@compiled
def approach(value: float, target: float, time_constant: float, dt: float) -> float:
    """Exact step of T x' = target - x with a constant target; T = 0 is there at once.

    Args:
        value: [any] x now.
        target: [any] where x goes.
        time_constant: [s] T >= 0.
        dt: [s] step.

    Returns:
        x after the step.
    """
    return target + (value - target) * remaining(time_constant, dt)


@compiled
def runge_kutta_mean(start: float, middle_1: float, middle_2: float, end: float) -> float:
    """Mean slope over a step from the four slopes of the classical Runge-Kutta method.

    (k1 + 2 k2 + 2 k3 + k4) / 6

    Args:
        start: [any] k1, the slope at the start.
        middle_1: [any] k2, the slope half a step on along k1.
        middle_2: [any] k3, the slope half a step on along k2.
        end: [any] k4, the slope one step on along k3.

    Returns:
        The slope that one step of fourth order takes.
    """
    return (start + 2.0 * (middle_1 + middle_2) + end) * (1.0 / 6.0)


@compiled
def gauss_slopes(start: float, middle_1: float, middle_2: float, end: float) -> tuple[float, float]:
    """From a Runge-Kutta step, how far x has come at the two points t = 1/2 -+ sqrt(3)/6 of Gauss's rule.

    x(t dt) - x(0) = dt [(t - 3 t^2 / 2 + 2 t^3 / 3) k1 + (t^2 - 2 t^3 / 3) (k2 + k3) + (2 t^3 / 3 - t^2 / 2) k4]

    Of third order within the step. Hence a quantity that is only integrated, f(x(t)), needs two values
    for a step of fourth order: dt (f(x_1) + f(x_2)) / 2.

    Args:
        start: [any] k1.
        middle_1: [any] k2.
        middle_2: [any] k3.
        end: [any] k4.

    Returns:
        (x_1 - x(0)) / dt and (x_2 - x(0)) / dt.

    Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, section II.6, continuous
    extension of the classical method.
    """
    middle = middle_1 + middle_2
    return (
        FIRST[0] * start + FIRST[1] * middle + FIRST[2] * end,
        SECOND[0] * start + SECOND[1] * middle + SECOND[2] * end,
    )


@compiled
def simpson_mean(start: float, middle: float, end: float) -> float:
    """Mean of a smooth quantity over a step from its values at the start, halfway and the end.

    (f0 + 4 f1 + f2) / 6, exact for cubics.

    Args:
        start: [any] f0.
        middle: [any] f1.
        end: [any] f2.

    Returns:
        The mean.
    """
    return (start + 4.0 * middle + end) * (1.0 / 6.0)
