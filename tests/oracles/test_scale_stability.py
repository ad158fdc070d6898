"""Closed form K2: observer and crab forgive a wrong speed scale a together, but not every one."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from cardume.simulation.flight import Flight
from flying import limit
from oracles.aboard import uniform
from oracles.kinematic import Quantity, Scene, flown, line

COURSE = 0.5
SMALL = 1e-6  # of the lookahead: squared, it is below every tolerance here
TICKS = (0.01, 0.005, 0.0025)  # Euler's rule moves the observer's poles to the right by k2 dt / 2


def scene(a: float, u: float, d: float, k: tuple[float, float], e0: float, until: float, along: float = 0.0) -> Scene:
    """A line flown by a vehicle that believes in a times its speed, in a current along the line [m/s]."""
    current = uniform(along * math.cos(COURSE), along * math.sin(COURSE))
    sensors = (
        "{gnss: {sigma: 0, period: TICK}, ahrs: {heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0, period: TICK},"
        f" thruster_speed: {{sigma: 0, scale: {a!r}, period: TICK}}}}"
    )
    extra = (
        f"current: {current}\nposition: {{law: direct}}\ncompensation: {{law: crab}}\nspeed_reference: water\n"
        f"current_observer: {{law: complementary, k1: {k[0]!r}, k2: {k[1]!r}}}"
    )
    guidance = f"law: line_of_sight, lookahead: {d!r}"
    return Scene(line(COURSE), guidance, f"cross_track: {e0!r}", until, u, sensors=sensors, log_period=0.4, extra=extra)


def polynomial(a: float, rate: float, k: tuple[float, float]) -> list[float]:
    """Row K2: s^3 + (k1 + L / a) s^2 + (k2 + k1 L) / a s + L k2 / a, L = V_T / d."""
    k1, k2 = k
    return [1.0, k1 + rate / a, (k2 + k1 * rate) / a, rate * k2 / a]


def growth_by_theory(a: float, rate: float, k: tuple[float, float]) -> float:
    """[1/s] of the slowest mode."""
    return float(np.roots(polynomial(a, rate, k)).real.max())


def largest_scale(rate: float, k: tuple[float, float]) -> float:
    """Row K2: a* = L (k2 + k1 L) / (L k2 - k1 (k2 + k1 L)); infinite where every a is stable."""
    k1, k2 = k
    room = rate * k2 - k1 * (k2 + k1 * rate)
    return rate * (k2 + k1 * rate) / room if room > 0.0 else math.inf


def growth(begin: float) -> Quantity:
    """[1/s] of the pair of modes that a small error shows from `begin` [s] on: half the sum of their poles."""

    def rate(flight: Flight) -> float:
        e = flight.channels["cross_track"][:, 0][flight.times >= begin]
        e = e / np.abs(e).max()
        (_, q), *_ = np.linalg.lstsq(np.column_stack([e[1:-1], -e[:-2]]), e[2:], rcond=None)
        return 0.5 * float(np.log(q)) / float(flight.times[1] - flight.times[0])

    return rate


def flown_growth(a: float, u: float, d: float, k: tuple[float, float], along: float = 0.0) -> float:
    """[1/s] the limit for no tick, once the observer knows the current along the path: its modes decay at k1 / 2."""
    begin = 0.4 * round(20.0 / k[0] / 0.4)
    flight = scene(a, u, d, k, SMALL * d, begin + 20.0, along)
    return limit(lambda tick: growth(begin)(flown(flight, tick)), TICKS)[0]


def flown_limit(u: float, d: float, k: tuple[float, float], along: float = 0.0) -> float:
    """The scale at which the engine's error neither grows nor decays, by bisection."""
    expected = largest_scale((u + along) / d, k)
    return float(brentq(lambda a: flown_growth(a, u, d, k, along), 0.95 * expected, 1.05 * expected, xtol=1e-4))


PRINTED = 0.5, 1.0, (0.05, 1.0)  # u, d and gains with L = .5


def test_limit_at_the_printed_numbers() -> None:
    """Row K2: k1 = .05, k2 = 1, L = .5: a* = 1.1420612813."""
    u, d, k = PRINTED
    assert largest_scale(u / d, k) == pytest.approx(1.1420612813, abs=5e-11)
    assert growth_by_theory(1.1420612813, u / d, k) == pytest.approx(0.0, abs=1e-10)
    assert flown_limit(u, d, k) == pytest.approx(1.1420612813, rel=1e-3)


@pytest.mark.parametrize("seed", range(3))
def test_limit_at_random(seed: int) -> None:
    """Row K2 with u, d, the gains and a current along the path drawn: L = V_T / d counts the speed over ground."""
    draw = np.random.default_rng([22, seed])
    u, d = draw.uniform(0.4, 0.8), draw.uniform(0.8, 1.5)
    along = u * draw.uniform(-0.3, 0.3)
    rate = (u + along) / d
    k2 = draw.uniform(0.8, 2.0)
    k1 = rate * draw.uniform(0.05, 0.25)
    assert flown_limit(u, d, (k1, k2), along) == pytest.approx(largest_scale(rate, (k1, k2)), rel=2e-3)


@pytest.mark.parametrize("k", [(0.5, 1.0), (0.6, 2.0), (0.45, 0.2)])
def test_gains_that_forgive_every_scale(k: tuple[float, float]) -> None:
    """Row K2: stable for all a where k1 >= L or k1^2 >= k2 (here L = .5)."""
    u, d, _ = PRINTED
    assert k[0] >= u / d or k[0] ** 2 >= k[1]
    for a in (0.5, 1.5, 3.0):
        assert growth_by_theory(a, u / d, k) < 0.0
        e = abs(flown(scene(a, u, d, k, 1.0, 200.0), 0.01).channels["cross_track"][:, 0])
        assert e[-100:].max() < 1e-3 * e[:100].max()


def test_decay_below_the_limit_at_the_printed_numbers() -> None:
    """Row K2: at a = 1.12 what is left after 100 s is .7106 of a small error; of one that is not so small .7116."""
    u, d, k = PRINTED
    assert math.exp(100.0 * growth_by_theory(1.12, u / d, k)) == pytest.approx(0.7106, abs=5e-5)
    small = scene(1.12, u, d, k, 1e-4, 620.0)
    rate = limit(lambda tick: growth(600.0)(flown(small, tick)), TICKS)[0]
    assert math.exp(100.0 * rate) == pytest.approx(0.7106, abs=1e-4)
    large = flown(scene(1.12, u, d, k, 0.5, 800.0), TICKS[-1])
    left = largest_between(large, 700.0, 720.0) / largest_between(large, 600.0, 620.0)
    assert left == pytest.approx(0.7116, abs=2e-3)


def test_limit_cycle_above_the_limit() -> None:
    """Row K2: at a = 1.16 the error grows to the same cycle, of half a meter, from wherever it starts."""
    u, d, k = PRINTED
    flights = [flown(scene(1.16, u, d, k, e0, 2600.0), TICKS[-1]) for e0 in (0.1, 3.0)]
    for flight in flights:
        assert largest_between(flight, 1000.0, 1020.0) > 1.5 * largest_between(flight, 400.0, 420.0)
        assert largest_between(flight, 2500.0, 2600.0) == pytest.approx(0.5285, abs=1e-3)


def largest_between(flight: Flight, begin: float, end: float) -> float:
    """[m] largest error between two times."""
    e, times = flight.channels["cross_track"][:, 0], flight.times
    return float(np.abs(e[(times >= begin) & (times < end)]).max())
