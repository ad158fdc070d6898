"""The paper's rule: dead reckoning, overwritten by every fix."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import Seconds
from cardume.onboard.estimation.position.base import position_law
from cardume.onboard.estimation.position.dead_reckoning import displacement
from cardume.signals import Fix, Motion, NavigationEstimate


class Reckoned(NamedTuple):
    """Where the vehicle will be at the next tick, unless a fix says otherwise."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]


@position_law
def reset(fix: Fix, motion: Motion, memory: Reckoned, dt: Seconds) -> tuple[NavigationEstimate, Reckoned]:
    """Believe each fix when it comes, dead reckoning in between.

    p_hat(t_k) = fix;   p_hat(k+1) = p_hat(k) + [R(psi + r dt / 2) (u, v) + Vc_hat] dt

    A fix describes where the vehicle was: this rule neglects the way made since, and the noise.

    Args:
        fix: position [m], NaN when there is none in this tick.
        motion: believed motion, for the step to the next tick.
        memory: dead-reckoned position [m].
        dt: [s] tick.

    Returns:
        The position [m] and the next memory.

    Source: paper section 4.2 and eq. (49), midpoint.
    """
    has_fix = (fix.north == fix.north) & (fix.east == fix.east)
    north = where(has_fix, fix.north, memory.north)
    east = where(has_fix, fix.east, memory.east)
    ahead, aside = displacement(motion, dt)
    return NavigationEstimate(north, east), Reckoned(north + ahead, east + aside)
