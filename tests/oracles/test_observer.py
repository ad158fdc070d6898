"""The complementary observer (33) flown: its response, its poles, and the tick at which it fails."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

from cardume.onboard.estimation.current.complementary import Observed, complementary
from cardume.signals import Motion, NavigationEstimate
from flying import fly_text, limit, series, value_at
from oracles.aboard import check_limit, fly_plan, halved, memory_of, uniform, vessel_of

MISSION = """
cardume: 1
name: observer
duration: {duration!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {{type: line, start: {{course: 30 deg}}, length: 100 m}}
formation: {{speed: 0.5 m/s}}
current: {current}
vehicles:
  - {{name: alone, model: kinematic, sensors: ideal, start: {{cross_track: {cross_track!r}, speed: 0.5 m/s}}}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
position: {{law: direct}}
current_observer: {observer}
"""


def text(k1, k2, current, tick, until, log_period=None, cross_track=3.0):
    """A vehicle that comes to a line while its observer learns the current; `until` is the last record."""
    return MISSION.format(
        duration=until + tick if log_period else until,
        tick=tick,
        log_period=log_period or until,
        current=uniform(*current),
        cross_track=cross_track,
        observer=f"{{law: complementary, k1: {k1!r}, k2: {k2!r}}}",
    )


def response(k1, k2, time):
    """(p - p_hat, Vc - Vc_hat) per unit of current: e_p' = -k1 e_p + e_v, e_v' = -k2 e_p, from (0, 1)."""
    return expm(time * np.array([[-k1, 1.0], [-k2, 0.0]])) @ [0.0, 1.0]


def current_estimate(k1, k2, current, tick, time):
    """Vc_hat (north, east) at a time that is in the log."""
    flight = fly_text(text(k1, k2, current, tick, time, log_period=time))
    return np.array([value_at(flight, f"current_{axis}_estimate", time) for axis in ("north", "east")])


def position_error(k1, k2, current, tick, time):
    """p - p_hat (north, east) after the flight, from what the observer remembers."""
    flown = fly_plan(text(k1, k2, current, tick, time))
    memory, vessel = Observed(*memory_of(flown, "current_observer")), vessel_of(flown)
    return np.array([vessel.north - memory.north, vessel.east - memory.east])


def test_critically_damped_response_at_the_printed_numbers():
    """Row J: w = .1, Vc = .2: Vhat(20) = .1187988301, p - p_hat = Vc t exp(-w t)."""
    w, speed, time = 0.1, 0.2, 20.0
    assert speed * (1.0 - (1.0 + w * time) * math.exp(-w * time)) == pytest.approx(0.1187988301, abs=5e-11)
    found, order = limit(lambda tick: current_estimate(2 * w, w * w, (speed, 0.0), tick, time)[0])
    assert found == pytest.approx(0.1187988301, rel=1e-7)
    assert order == pytest.approx(1.0, abs=0.05)
    found, order = limit(lambda tick: position_error(2 * w, w * w, (speed, 0.0), tick, time)[0])
    assert found == pytest.approx(speed * time * math.exp(-w * time), rel=1e-7)
    assert order == pytest.approx(1.0, abs=0.05)


def test_peak_of_the_position_error_at_the_printed_numbers():
    """Row J: w = .1, Vc = .2: the peak of p - p_hat is .7357588823 m at 10 s."""
    w, speed = 0.1, 0.2

    def peak(tick):
        # (Vc_hat(k+1) - Vc_hat(k)) / (k2 dt) is p - p_hat at k; a parabola through its three largest gives the peak.
        flight = fly_text(text(2 * w, w * w, (speed, 0.0), tick, 20.0, log_period=tick))
        times, estimate = series(flight, "current_north_estimate")
        errors = np.diff(estimate) / (w * w * tick)
        k = int(np.argmax(errors))
        before, top, after = errors[k - 1 : k + 2]
        ahead = 0.5 * (before - after) / (before - 2.0 * top + after)
        return times[k] + ahead * tick, top - 0.25 * (before - after) * ahead

    time, _ = limit(lambda tick: peak(tick)[0])
    height, order = limit(lambda tick: peak(tick)[1])
    assert height == pytest.approx(0.7357588823, rel=1e-6)
    assert time == pytest.approx(10.0, rel=1e-4)
    assert order == pytest.approx(1.0, abs=0.05)
    error, _ = limit(lambda tick: position_error(2 * w, w * w, (speed, 0.0), tick, 10.0)[0])
    assert error == pytest.approx(0.7357588823, rel=1e-7)


@pytest.mark.parametrize(
    ("k1", "k2", "poles"),
    [(10.0, 10.0, (-8.87298335, -1.12701665)), (0.5, 0.5, (-0.25 + 0.66143783j, -0.25 - 0.66143783j))],
)
def test_poles_at_the_printed_numbers(k1, k2, poles):
    """Row J: the poles of s^2 + k1 s + k2; the flown response has them, and so has the law, (A - 1) / dt exactly."""
    check_limit(
        lambda tick: current_estimate(k1, k2, (0.15, -0.1), tick, 1.0),
        (1.0 - response(k1, k2, 1.0)[1]) * np.array([0.15, -0.1]),
        halved(0.0125),
    )
    rates = np.linalg.eigvals(transition(k1, k2, 0.01) - np.eye(2)) / 0.01
    assert sorted(rates, key=abs) == pytest.approx(sorted(np.array(poles), key=abs), abs=1e-8)
    assert rates.real.max() < 0.0


def transition(k1, k2, tick):
    """The law's own matrix from (p_hat, Vc_hat) of one tick to the next, column by column."""
    columns = []
    for north, current in ((1.0, 0.0), (0.0, 1.0)):
        memory = Observed(1.0, north, 0.0, current, 0.0)
        _, after = complementary(
            NavigationEstimate(0.0, 0.0), Motion(*[0.0] * len(Motion._fields)), memory, tick, k1, k2
        )
        columns.append([after.north, after.current_north])
    return np.array(columns).T


@pytest.mark.parametrize("seed", range(6))
def test_response_at_random_gains_and_currents(seed):
    """Row J: Vc_hat(t) and p - p_hat for any k1, k2 > 0 and Vc, over- and underdamped."""
    draw = np.random.default_rng(seed)
    k1, k2 = draw.uniform(0.1, 2.0), draw.uniform(0.01, 1.0)
    current = draw.uniform(-0.2, 0.2, 2)
    fastest = abs(np.roots([1.0, k1, k2])).max()
    time = draw.uniform(1.0, 4.0) / math.sqrt(k2)
    ticks = halved(time / math.ceil(time * fastest / 0.01))
    error, gap = response(k1, k2, time)
    check_limit(lambda tick: current_estimate(k1, k2, current, tick, time), (1.0 - gap) * current, ticks)
    check_limit(lambda tick: position_error(k1, k2, current, tick, time), error * current, ticks)


def stability_limit(k1, k2, low, high):
    """The tick at which the flown observer's error stops dying out, by bisection."""

    def grows(tick):
        ticks = 4000
        flight = fly_text(text(k1, k2, (0.1, 0.0), tick, ticks * tick, log_period=tick, cross_track=0.0))
        errors = np.abs(series(flight, "current_north_estimate")[1] - 0.1)
        with np.errstate(invalid="ignore", over="ignore"):
            early, late = np.nanmax(errors[1000:2000]), np.nanmax(errors[3000:4000])
        return late > 1e-9 and not late < early

    assert grows(high)
    assert not grows(low)
    while high - low > 1e-6 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return 0.5 * (low + high)


def euler_limit(k1, k2):
    """k1 / k2 where the poles are complex, else 2 / |s_max|."""
    return k1 / k2 if k1 * k1 < 4.0 * k2 else 2.0 / float(abs(np.roots([1.0, k1, k2])).max())


def test_euler_limit_at_the_printed_gains():
    """Row J4: (.5, .5) needs ticks below 1 s, so 1 s USBL fixes drive (33) unstable in Euler form."""
    assert stability_limit(0.5, 0.5, 0.9, 1.1) == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(("seed", "is_complex"), [(0, True), (1, True), (2, False), (3, False)])
def test_euler_limit_at_random_gains(seed, is_complex):
    """Row J4: Ts < k1 / k2 for complex poles, Ts < 2 / |s_max| for real ones."""
    draw = np.random.default_rng(seed)
    k1 = draw.uniform(0.3, 2.0)
    k2 = k1 * k1 * (draw.uniform(0.4, 2.0) if is_complex else draw.uniform(0.05, 0.2))
    wanted = euler_limit(k1, k2)
    assert stability_limit(k1, k2, 0.9 * wanted, 1.1 * wanted) == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize(("k1", "k2", "north"), [(1.0, 0.25, 100.0), (0.7, 0.4, -40.0)])
def test_without_the_printed_missing_dots(k1, k2, north):
    """Row J, errata of (33): printed without dots it is algebraic, and p_hat = 55.78 where p = 100; with dots 100."""
    scene = MISSION.replace("start: {{course: 30 deg}}", f"start: {{{{north: {north!r}}}}}")
    numbers = {"duration": 1.0, "tick": 0.1, "log_period": 0.1, "current": "none", "cross_track": 0.0}
    gains = f"k1: {k1!r}, k2: {k2!r}"
    printed = fly_text(scene.format(observer=f"{{law: 'printed_observer:without_dots', {gains}}}", **numbers))
    estimate = north - value_at(printed, "current_north_estimate", 0.0) / k2  # from its second line
    assert estimate == pytest.approx(((k1 + k2) * north + 0.5) / (1.0 + k1 + k2), rel=1e-12)
    if north == 100.0:
        assert estimate == pytest.approx(55.78, abs=5e-3)
    right = fly_plan(scene.format(observer=f"{{law: complementary, {gains}}}", **numbers))
    assert Observed(*memory_of(right, "current_observer")).north == pytest.approx(vessel_of(right).north, rel=1e-12)
