"""Complementary filter: the current is what position knows and velocity through the water does not."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import PerSecond, PerSecondSquared, Positive, Seconds
from cardume.onboard.estimation.current.base import current_observer_law
from cardume.signals import Motion, NavigationEstimate, Water


class Observed(NamedTuple):
    """Where the observer thinks the vehicle is, and the current that explains it."""

    started: float = 0.0  # [-] 1 after the first step
    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    current_north: float = 0.0  # [m/s]
    current_east: float = 0.0  # [m/s]


@current_observer_law
def complementary(
    position: NavigationEstimate,
    motion: Motion,
    memory: Observed,
    dt: Seconds,
    k1: Positive[PerSecond] = 0.2,
    k2: Positive[PerSecondSquared] = 0.01,
) -> tuple[Water, Observed]:
    """Second-order observer driven by position and velocity through the water.

    p_hat' = k1 (p_m - p_hat) + V_m + Vc_hat,   Vc_hat' = k2 (p_m - p_hat)

    Poles: s^2 + k1 s + k2, stable for all k1, k2 > 0.  Integrated by Euler's rule, stable while
    dt < k1 / k2 (complex poles).  Driven by dead reckoning between fixes it needs gaps well below
    2 k1 / k2.  Starts at the first position, with no current.

    Args:
        position: p_m, measured or believed position [m].
        motion: velocity through the water [m/s], V_m = R(psi) (u, v).
        memory: p_hat and Vc_hat.
        dt: [s] tick.
        k1: [1/s] > 0, of the position: how fast its error is forgotten.
        k2: [1/s^2] > 0, of the current: how fast it is learnt.

    Returns:
        The current Vc_hat before this step [m/s], NED, and the next memory.

    Source: paper eq. (33), the missing time derivatives restored.
    """
    first = memory.started < 0.5
    north = where(first, position.north, memory.north)
    east = where(first, position.east, memory.east)
    north_error, east_error = position.north - north, position.east - east
    after = Observed(
        1.0,
        north + dt * (k1 * north_error + motion.north + memory.current_north),
        east + dt * (k1 * east_error + motion.east + memory.current_east),
        memory.current_north + dt * k2 * north_error,
        memory.current_east + dt * k2 * east_error,
    )
    return Water(memory.current_north, memory.current_east), after
