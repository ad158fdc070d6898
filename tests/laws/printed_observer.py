"""Equation (33) as printed: the dots over p_hat and Vc_hat are missing, so it is two algebraic equations."""

from cardume.laws import PerSecond, PerSecondSquared, Positive
from cardume.maths import to_ned
from cardume.onboard.estimation.current import current_observer_law
from cardume.signals import Motion, NavigationEstimate, Water


@current_observer_law
def without_dots(
    position: NavigationEstimate,
    motion: Motion,
    k1: Positive[PerSecond] = 1.0,
    k2: Positive[PerSecondSquared] = 0.25,
) -> Water:
    """p_hat = k1 (p_m - p_hat) + V_m + Vc_hat,   Vc_hat = k2 (p_m - p_hat).   Source: paper eq. (33), printed."""
    north, east = to_ned(motion.heading, motion.surge, motion.sway)
    north_estimate = ((k1 + k2) * position.north + north) / (1.0 + k1 + k2)
    east_estimate = ((k1 + k2) * position.east + east) / (1.0 + k1 + k2)
    return Water(k2 * (position.north - north_estimate), k2 * (position.east - east_estimate))
