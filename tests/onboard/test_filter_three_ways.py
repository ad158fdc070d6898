"""The position filter in plain Python, compiled for one mission and for eight: the same bits, whatever fixes come."""

import numpy as np

from cardume.compiler import at, load, rows_of, store
from cardume.onboard.estimation.position.belief import Doubts, Moment, aged
from cardume.onboard.estimation.position.past_fixes import FIXES_WIDTH, begin, get_belief, take
from cardume.signals import Fix
from compiler.three_ways import three_ways

FIXES, NUMBERS = 5, 10


def replay(given, out):
    """Work fixes in, one after the other, and write what is believed in the end."""
    fixes, told = rows_of(given), rows_of(out)
    numbers = at(fixes, FIXES_WIDTH)
    north = load(numbers, 0)
    doubts = Doubts(4.0, 0.09, 0.04, 0.01, 2e-3, 3e-5, 0.01, 1.0, 9.0, 2.0)
    begin(fixes, north, load(numbers, 1), north == north, doubts)
    for k in range(FIXES):
        one = at(numbers, 2 + k * NUMBERS)
        fix = Fix(load(one, 0), load(one, 1), 0.0 * north, load(one, 2), load(one, 3), load(one, 4), load(one, 5))
        valid = Moment(load(one, 6), load(one, 7), load(one, 8), 0.0 * north)
        take(fixes, fix, valid, fix.north == fix.north, doubts, 0.1)
    found = aged(get_belief(fixes, 0), Moment(load(one, 9), load(one, 7), load(one, 8), 0.0 * north), doubts, 0.1)
    store(told, 0, found.mean.north)
    store(told, 1, found.mean.east)
    store(told, 2, found.mean.current_north)
    store(told, 3, found.mean.scale)
    store(told, 4, found.covariance.pp_nn)
    store(told, 5, found.covariance.pp_ne)
    store(told, 6, found.covariance.ca_en)
    store(told, 7, found.covariance.aa_ee)
    store(told, 8, found.moment.rejected)


def test_filter_three_ways() -> None:
    """Fixes late, early and missing, ranges, and fixes that are not believed, each lane its own."""
    draw = np.random.default_rng(5)
    given = np.zeros((FIXES_WIDTH + 2 + FIXES * NUMBERS, 8))
    given[FIXES_WIDTH : FIXES_WIDTH + 2] = draw.normal(size=(2, 8))
    for k in range(FIXES):
        rows = given[FIXES_WIDTH + 2 + k * NUMBERS :][:NUMBERS]
        rows[:2] = 2.0 * draw.normal(size=(2, 8)) + np.where(draw.random(8) < 0.2, 60.0, 0.0)
        rows[:2, draw.random(8) < 0.2] = np.nan
        rows[2], rows[3], rows[4] = draw.uniform(0.5, 2.0, 8), draw.uniform(-0.3, 0.3, 8), draw.uniform(0.5, 2.0, 8)
        rows[2:5, draw.random(8) < 0.2] = np.nan
        rows[5] = np.where(draw.random(8) < 0.3, draw.uniform(5.0, 9.0, 8), np.nan)
        rows[6:9] = draw.integers(1, 60, 8), *draw.normal(size=(2, 8))
        rows[9] = 80.0
    out = three_ways(replay, given, 9)
    assert np.isfinite(out).all()
    assert len(np.unique(out[0])) == 8
    assert out[8].max() >= 0.0
