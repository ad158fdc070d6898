"""The last fixes in the order in which they were valid, each with what was believed after it.

A fix that comes late is put where it belongs, and what was believed from there on is worked out again
with all later ones.  So the order in which fixes arrive makes no difference.
"""

from cardume.compiler import Layout, Rows, compiled, negate, some, where
from cardume.onboard.estimation.position.belief import (
    Belief,
    Covariance,
    Doubts,
    Mean,
    Moment,
    aged,
    corrected,
    first_belief,
)
from cardume.signals import Fix

KEPT = 8  # fixes that a late one can be put among or before
HALF = 0.5  # [-] of a tick

SLOT = Layout(Moment, Mean, Covariance, Fix)
get_moment, put_moment = SLOT.reader(Moment), SLOT.writer(Moment)
get_mean, put_mean = SLOT.reader(Mean), SLOT.writer(Mean)
get_covariance, put_covariance = SLOT.reader(Covariance), SLOT.writer(Covariance)
get_fix, put_fix = SLOT.reader(Fix), SLOT.writer(Fix)
FIXES_WIDTH = (KEPT + 1) * SLOT.width  # slot 0 is the newest fix; the last one is what the others start from


@compiled
def get_belief(fixes: Rows, slot: int) -> Belief:
    """What was believed after a fix."""
    return Belief(get_moment(fixes, slot), get_mean(fixes, slot), get_covariance(fixes, slot))


@compiled
def put_belief(fixes: Rows, slot: int, belief: Belief) -> None:
    """Note what is believed after a fix."""
    put_moment(fixes, slot, belief.moment)
    put_mean(fixes, slot, belief.mean)
    put_covariance(fixes, slot, belief.covariance)


@compiled
def begin(fixes: Rows, north: float, east: float, is_first: bool, doubts: Doubts) -> None:
    """Fill all slots with what is believed before the first fix.

    Args:
        fixes: (FIXES_WIDTH,) rows.
        north: [m]
        east: [m]
        is_first: [-] in each lane.
        doubts: variances at first.
    """
    first = first_belief(north, east, doubts)
    for slot in range(KEPT + 1):
        _put_where(fixes, slot, is_first, first)


@compiled
def _put_where(fixes: Rows, slot: int, condition: bool, belief: Belief) -> None:
    before = get_belief(fixes, slot)
    put_moment(fixes, slot, where(condition, belief.moment, before.moment))
    put_mean(fixes, slot, where(condition, belief.mean, before.mean))
    put_covariance(fixes, slot, where(condition, belief.covariance, before.covariance))


@compiled
def take(fixes: Rows, fix: Fix, valid: Moment, is_known: bool, doubts: Doubts, dt: float) -> None:
    """Put a fix among the others and work out again what follows.

    One that is older than all that are kept is left out, and one that is among them already: somebody said it again.

    Args:
        fixes: (FIXES_WIDTH,) rows, newest first.
        fix: its position and covariance.
        valid: when it was, and the way through the water until then.
        is_known: [-] whether there is a fix, in each lane.
        doubts: of the filter.
        dt: [s] one tick.
    """
    is_taken = is_known & (valid.tick >= get_moment(fixes, KEPT - 1).tick) & negate(_is_kept(fixes, fix, valid))
    for slot in range(KEPT, 0, -1):
        moves = is_taken & (get_moment(fixes, slot - 1).tick <= valid.tick)
        if some(moves):
            _put_where(fixes, slot, moves, get_belief(fixes, slot - 1))
            put_fix(fixes, slot, where(moves, get_fix(fixes, slot - 1), get_fix(fixes, slot)))
    newer = 0.0 * valid.tick
    for slot in range(KEPT):
        newer = newer + where(get_moment(fixes, slot).tick > valid.tick, 1.0, 0.0)
    for slot in range(KEPT - 1, -1, -1):
        follows = is_taken & (newer >= slot)
        if some(follows):
            _work_out(fixes, slot, follows, newer == slot, valid, fix, doubts, dt)


@compiled
def _is_kept(fixes: Rows, fix: Fix, valid: Moment) -> bool:
    """Whether a fix is among those that are kept; what stands there at first is of tick 0, and no fix."""
    found = valid.tick < 0.0
    for slot in range(KEPT):
        kept, tick = get_fix(fixes, slot), get_moment(fixes, slot).tick
        same_range = (kept.level_range == fix.level_range) | negate(
            (kept.level_range == kept.level_range) | (fix.level_range == fix.level_range)
        )
        same = (kept.north == fix.north) & (kept.east == fix.east) & same_range
        found = found | (same & (abs(tick - valid.tick) < HALF) & (tick > HALF))
    return found


@compiled
def _work_out(
    fixes: Rows, slot: int, follows: bool, is_new: bool, valid: Moment, fix: Fix, doubts: Doubts, dt: float
) -> None:
    """Work one slot out from the one before it; where it is the new fix's, put that there first."""
    moment = where(is_new, valid, get_moment(fixes, slot))
    seen = where(is_new, fix, get_fix(fixes, slot))
    put_fix(fixes, slot, where(follows, seen, get_fix(fixes, slot)))
    then = aged(get_belief(fixes, slot + 1), moment, doubts, dt)
    _put_where(fixes, slot, follows, corrected(then, seen, doubts))
