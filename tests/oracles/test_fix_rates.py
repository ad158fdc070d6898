"""Closed forms S and J5: what rare, lost and late fixes cost the paper's rules; and row X, what consistency is."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from cardume.simulation.fly import fly
from oracles.shaken import COMPENSATED, RESET, Scene, channel, errors_of, flights, kalman, nees_of, plan_for


def steady(scene, north, east):
    """The scene with a constant current and exact fixes."""
    plan = plan_for(scene._replace(sigma=0.0, qv=0.0, qc=0.0), COMPENSATED)
    return with_current(plan, north, east)


def with_current(plan, north, east):
    (vehicle,) = plan.vehicles
    water = replace(
        vehicle.laws["current"], parameters={**vehicle.laws["current"].parameters, "north": north, "east": east}
    )
    return replace(plan, vehicles=(replace(vehicle, laws={**vehicle.laws, "current": water}),))


def spread_of_age(scene):
    """Mean and mean square of the age of the newest fix: row S."""
    t, p, tau = scene.period, scene.loss, scene.delay
    mean = tau + t * (1 + p) / (2 * (1 - p))
    return mean, tau**2 + tau * t * (1 + p) / (1 - p) + t**2 * (1 + 4 * p + p**2) / (3 * (1 - p) ** 2)


def rms_after(plan, runs, axis):
    """RMS of one axis, after the first fixes."""
    return math.sqrt(np.mean([np.mean(errors_of(flown)[400:, axis] ** 2) for flown in flights(plan, range(runs), 10)]))


LONG = {"duration": 4000.0, "log_period": 0.1}


@pytest.mark.parametrize(
    ("period", "loss", "delay", "printed"),
    [
        (1.0, 0.0, 0.0, 0.0288675135),
        (1.0, 0.2, 0.0, 0.0489472505),
        (5.0, 0.2, 0.0, 0.2447362526),
        (5.0, 0.2, 1.0, 0.2848610773),
    ],
)
def test_unknown_current_between_fixes_at_the_printed_numbers(period, loss, delay, printed):
    """Row S: b = .05 m/s, dead reckoning in between; at ticks of .1 s a mean age is .05 s less than continuously."""
    scene = Scene(period, loss, delay, **LONG)
    assert 0.05 * math.sqrt(spread_of_age(scene)[1]) == pytest.approx(printed, abs=5e-11)
    check_ages(scene, 0.05, 6)


@pytest.mark.parametrize("seed", range(2))
def test_unknown_current_between_fixes_at_random(seed):
    """Row S at random T, p, tau and b."""
    draw = np.random.default_rng([62, seed])
    period, delay = 0.5 * int(draw.integers(2, 20)), 0.1 * int(draw.integers(0, 40))
    check_ages(Scene(period, draw.uniform(0.05, 0.5), delay, **LONG), draw.uniform(0.02, 0.2), 6)


def check_ages(scene, current, runs):
    """Ages at ticks are 0, h, 2 h, ...: the mean is h / 2 less, the mean square h times the mean, to first order."""
    mean, square = spread_of_age(scene)
    wanted = current * math.sqrt(square - scene.tick * mean)
    found = rms_after(steady(scene, 0.0, current), runs, 1)
    # A gap of n periods counts as its cube; so many gaps give their mean to four times its own error.
    n = np.arange(1, 400)
    share = (1.0 - scene.loss) * scene.loss ** (n - 1.0)
    gaps = runs * scene.duration * (1.0 - scene.loss) / scene.period
    scatter = math.sqrt((share @ n**6.0 / (share @ n**3.0) ** 2 - 1.0) / gaps)
    print(f"{found:.4f} m, wanted {wanted:.4f} +- {50.0 * scatter:.1f} %")
    assert found == pytest.approx(wanted, rel=0.01 + 2.0 * scatter)


def test_a_delay_not_compensated_adds_the_way_made():
    """Row S: the paper's rule is V tau astern on top: u tau + b age, which also shows the mean age."""
    scene = Scene(5.0, 0.2, 1.0, 0.0, 0.0, 0.0, **LONG)
    plan = with_current(plan_for(scene, RESET), 0.0, 0.05)
    mean, square = spread_of_age(scene)
    wanted = math.sqrt(0.25 + 2 * 0.5 * 0.05 * (mean - 0.05) + 0.05**2 * (square - 0.1 * mean))
    assert rms_after(plan, 6, 1) == pytest.approx(wanted, rel=0.02)


# ---- row J5 ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("k1", "k2", "printed"), [(1.0, 0.25, 10.0), (0.5, 0.5, 2.5), (10.0, 10.0, 2.2), (0.2, 0.01, 50.0)]
)
def test_an_observer_that_dead_reckoning_drives_is_unstable_near_a_gap(k1, k2, printed):
    """Row J5: the estimate's error dies out with fixes a tenth oftener than the limit, and grows with rarer ones."""
    tick = 0.02 if k1 > 5.0 else 0.1
    growth = []
    for share in (0.88, 1.12):
        period = tick * round(share * printed / tick)
        scene = Scene(period, 0.0, 0.0, 0.0, 0.0, 0.0, 40.0 * period, tick, period)
        observer = f"{{law: complementary, k1: {k1!r} 1/s, k2: {k2!r} 1/s^2}}"
        wrong = np.abs(channel(fly(plan_for(scene, RESET, observer)), "current_north_estimate") - 0.1)
        growth.append(wrong[-8:].max() / wrong[8:16].max())
    print(f"by {growth[0]:.3g} and {growth[1]:.3g}")
    assert growth[0] < 0.8
    assert growth[1] > 1.5


def test_a_filter_has_no_such_limit():
    """With `kalman_replay` and `from_position` the same vehicle finds the current with a fix a minute."""
    scene = Scene(60.0, 0.0, 0.0, 0.1, 1e-4, 0.0, 1800.0, 0.1, 60.0)
    flown = fly(plan_for(scene, kalman(scene), "{law: from_position}"))
    assert channel(flown, "current_north_estimate")[-1] == pytest.approx(0.1, abs=0.005)


# ---- row X -----------------------------------------------------------------------------------------------------------


def test_printed_bounds():
    """Row X: chi2.ppf(.025, .975; n M) / M and the gates."""
    for n, runs, wanted in ((2, 50, (1.48443855, 2.59122394)), (4, 100, (3.46481765, 4.57305482))):
        assert chi2.ppf([0.025, 0.975], n * runs) / runs == pytest.approx(wanted, abs=5e-9)
    assert chi2.ppf([0.99, 0.95], 2) == pytest.approx([9.21034037, 5.99146455], abs=5e-9)


def test_squared_errors_are_distributed_as_they_should():
    """Row X at one moment of 300 flights: mean, and the shares beyond the gates of 99 and 95 %."""
    scene = Scene(duration=200.0, log_period=40.0)
    found = np.array(
        [2.0 * nees_of(flown)[-1] for flown in flights(plan_for(scene, kalman(scene, gate=1e9)), range(300))]
    )
    low, high = chi2.ppf([5e-4, 1.0 - 5e-4], 2 * len(found)) / len(found)
    assert low < found.mean() < high
    assert abs(np.mean(found > 5.99146455) - 0.05) < 3.3 * math.sqrt(0.05 * 0.95 / len(found))
    assert abs(np.mean(found > 9.21034037) - 0.01) < 3.3 * math.sqrt(0.01 * 0.99 / len(found))
