"""Dead reckoning, moved by the error it had when the fix was valid."""

from typing import Annotated, NamedTuple

import numpy as np

from cardume.compiler import Rows, some, where
from cardume.laws import Length, Seconds
from cardume.maths import clip
from cardume.maths.history import push, recall
from cardume.onboard.estimation.position.base import position_law
from cardume.onboard.estimation.position.dead_reckoning import displacement
from cardume.signals import Fix, Motion, NavigationEstimate

REMEMBERED = 256  # ticks; an older fix is taken for as old as this


class Track(NamedTuple):
    """Dead reckoning that no fix touches, its recent past, and what the last fix adds to it."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    tick: float = 0.0  # [-]
    north_correction: float = 0.0  # [m]
    east_correction: float = 0.0  # [m]
    norths: Annotated[Rows, Length(REMEMBERED)] = np.zeros(REMEMBERED)
    easts: Annotated[Rows, Length(REMEMBERED)] = np.zeros(REMEMBERED)


@position_law
def reset_compensated(fix: Fix, motion: Motion, memory: Track, dt: Seconds) -> tuple[NavigationEstimate, Track]:
    """Reset the position that was believed when the fix was valid, and keep the way made since.

    p_hat(t) = fix + p_dr(t) - p_dr(t - age)

    p_dr is dead reckoning by (49) that no fix touches; its last 256 ticks are remembered, and
    interpolated between them.

    Args:
        fix: position [m] and age [s], NaN when there is none in this tick.
        motion: believed motion, for the step to the next tick.
        memory: dead reckoning, its recent past, and its correction.
        dt: [s] tick.

    Returns:
        The position [m] and the next memory.

    Source: paper section 4.2, with the delay that it neglects (p + V_T tau, by replay).
    """
    has_fix = (fix.north == fix.north) & (fix.east == fix.east)
    push(memory.norths, REMEMBERED, memory.tick, memory.north)
    push(memory.easts, REMEMBERED, memory.tick, memory.east)
    north_correction, east_correction = memory.north_correction, memory.east_correction
    if some(has_fix):
        oldest = where(memory.tick < REMEMBERED - 1.0, memory.tick, REMEMBERED - 1.0)
        then = memory.tick - clip(where(has_fix, fix.age, 0.0) / dt, 0.0, oldest)
        north_correction = where(has_fix, fix.north - recall(memory.norths, REMEMBERED, then), north_correction)
        east_correction = where(has_fix, fix.east - recall(memory.easts, REMEMBERED, then), east_correction)
    ahead, aside = displacement(motion, dt)
    after = Track(
        memory.north + ahead,
        memory.east + aside,
        memory.tick + 1.0,
        north_correction,
        east_correction,
        memory.norths,
        memory.easts,
    )
    return NavigationEstimate(memory.north + north_correction, memory.east + east_correction), after
