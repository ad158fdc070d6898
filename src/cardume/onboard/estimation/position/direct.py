"""Believe each fix, and nothing between them."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.onboard.estimation.position.base import position_law
from cardume.signals import Fix, NavigationEstimate


class LastFix(NamedTuple):
    """The last fix."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]


@position_law
def direct(fix: Fix, memory: LastFix) -> tuple[NavigationEstimate, LastFix]:
    """Take the last fix for the position until the next one.

    p_hat(t) = p_m(t_k),  t_k <= t < t_{k+1}

    Args:
        fix: position [m], NaN when there is none in this tick.
        memory: the last fix.

    Returns:
        The position [m] and the next memory.

    Source: paper section 3, where position is measured continuously.
    """
    has_fix = (fix.north == fix.north) & (fix.east == fix.east)
    last = LastFix(where(has_fix, fix.north, memory.north), where(has_fix, fix.east, memory.east))
    return NavigationEstimate(last.north, last.east), last
