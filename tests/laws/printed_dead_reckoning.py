"""Equation (49) as printed: Euler's rule with the heading at the start of the step."""

from typing import NamedTuple

from cardume.laws import Seconds
from cardume.maths import to_ned
from cardume.onboard.estimation.position import position_law
from cardume.signals import Fix, Motion, NavigationEstimate


class Reckoned(NamedTuple):
    """Where the vehicle will be at the next tick; no fix changes it."""

    north: float = 0.0
    east: float = 0.0


@position_law
def euler(fix: Fix, motion: Motion, memory: Reckoned, dt: Seconds) -> tuple[NavigationEstimate, Reckoned]:
    """p_hat(k+1) = p_hat(k) + [R(psi) (u, v) + Vc_hat] dt.   Source: paper eq. (49), printed."""
    north, east = to_ned(motion.heading, motion.surge, motion.sway)
    after = Reckoned(
        memory.north + dt * (north + motion.current_north), memory.east + dt * (east + motion.current_east)
    )
    return NavigationEstimate(memory.north, memory.east), after
