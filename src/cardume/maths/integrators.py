"""Steps in time: the exact step of a first-order lag, and the weights of Runge-Kutta and Simpson."""

from cardume.compiler import compiled, where
from cardume.maths.elementary import exp
from cardume.maths.frames import to_ned

__all__ = ["approach", "remaining", "runge_kutta_mean", "simpson_mean", "way_made"]


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
def way_made(
    heading: float, turn: float, surge: float, sway: float, surge_gain: float, sway_gain: float
) -> tuple[float, float]:
    """Mean over a step of R(psi) (u, v), for a body that turns and changes its speed: fourth order with one sine.

    R(mean psi) [(1 - turn^2 / 24) (mean u, mean v) + turn / 12 (-gain_v, gain_u)]

    With delta the heading less its mean, R(delta) = 1 + J delta - delta^2 / 2 + ..., J (u, v) = (-v, u);
    over a step dt the mean of delta is 0, of delta^2 turn^2 / 12, of delta times V gain turn / 12, and what is
    left out is of order dt^4.

    Args:
        heading: [rad] mean of psi over the step.
        turn: [rad] change of psi.
        surge: [m/s] mean of u.
        sway: [m/s] mean of v.
        surge_gain: [m/s] change of u.
        sway_gain: [m/s] change of v.

    Returns:
        (north, east) [m/s].
    """
    shorter = 1.0 - (turn * turn) * (1.0 / 24.0)
    twelfth = turn * (1.0 / 12.0)
    return to_ned(heading, shorter * surge - twelfth * sway_gain, shorter * sway + twelfth * surge_gain)


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
