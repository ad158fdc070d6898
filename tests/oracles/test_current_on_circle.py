"""Closed form E: a current that nothing compensates makes the error swing once a lap of a circle."""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from cardume.simulation.flight import Flight
from flying import series
from oracles.closed_forms import integrate, solve
from oracles.kinematic import FINE, Quantity, Scene, assert_converges, circle, converged, water

TURNS = pytest.mark.parametrize(("turn", "sigma"), [("starboard", 1.0), ("port", -1.0)])


def swing(settling: float, lap: float) -> Quantity:
    """Half of what the error swings over a lap [m]."""

    def value(flight: Flight) -> float:
        times, e = series(flight, "cross_track")
        curve = CubicSpline(times, e)(np.linspace(settling, settling + lap, 200_001))
        return float(curve.max() - curve.min()) / 2.0

    return value


def mean(settling: float, lap: float) -> Quantity:
    """Mean of the error over the time of a lap [m]."""

    def value(flight: Flight) -> float:
        times, e = series(flight, "cross_track")
        return float(CubicSpline(times, e).integrate(settling, settling + lap)) / lap

    return value


def circling(u: float, d: float, radius: float, turn: str, speed: float, towards: float = 0.3) -> tuple[Scene, float]:
    """A circle in a current, flown until it repeats, then for a lap; and the time until then."""
    settling, lap = math.ceil(20.0 * d / u), 2.0 * math.pi * radius / (u * math.sqrt(1.0 - (speed / u) ** 2))
    law = f"law: line_of_sight, lookahead: {d!r}"
    duration = float(math.ceil(settling + 1.1 * lap + 2.0))
    scene = Scene(circle(radius, turn), law, "cross_track: 0", duration, u, extra=water(speed, towards))
    return scene, float(settling)


def lap_of(u: float, d: float, radius: float, sigma: float, speed: float) -> tuple[float, float, float]:
    """Swing [m], mean over time [m] and duration [s] of a lap, from e' = -u e / sqrt(d^2 + e^2) + Vperp over chi_p."""

    def onward(angle: float, e: float) -> float:
        return (u * d / math.hypot(d, e) + speed * math.cos(sigma * angle)) / (radius - sigma * e)

    def rates(angle: float, y: np.ndarray) -> list[float]:
        e = y[0]
        sideways = -u * e / math.hypot(d, e) - speed * math.sin(sigma * angle)
        return [sideways / onward(angle, e), e / onward(angle, e), 1.0 / onward(angle, e)]

    start = integrate(rates, [0.0] * 3, 2.0 * math.pi * math.ceil(5.0 * d / radius))[0]
    lap = solve(rates, [start, 0.0, 0.0], 2.0 * math.pi)
    e, (_, area, duration) = lap(np.linspace(0.0, 2.0 * math.pi, 200_001))[0], lap(2.0 * math.pi)
    return float(e.max() - e.min()) / 2.0, area / duration, duration


@TURNS
def test_e_swing_at_the_printed_parameters(turn: str, sigma: float) -> None:
    """Row E: R = 30 m, Vc = 0.05 m/s: amplitude 0.49549875 m; linearized 0.4931969619."""
    assert lap_of(0.5, 5.0, 30.0, sigma, 0.05)[0] == pytest.approx(0.49549875, abs=1e-8)
    assert 0.05 / math.hypot(0.5 / 5.0, 0.5 / 30.0) == pytest.approx(0.4931969619, abs=1e-10)
    scene, settling = circling(0.5, 5.0, 30.0, turn, 0.05)
    assert_converges(scene, swing(settling, 380.0), 0.49549875, FINE)


@TURNS
def test_e_mean_at_the_printed_parameters(turn: str, sigma: float) -> None:
    """Row E: over a lap the mean is -0.00408834 sigma m, not the table's -0.01047242."""
    _, expected, lap = lap_of(0.5, 5.0, 30.0, sigma, 0.05)
    assert expected == pytest.approx(-0.00408834 * sigma, abs=1e-8)
    scene, settling = circling(0.5, 5.0, 30.0, turn, 0.05)
    assert_converges(scene, mean(settling, lap), expected)


@pytest.mark.parametrize("seed", range(6))
def test_e_swing_is_linear_in_a_weak_current(seed: int) -> None:
    """Row E: |Vc| / sqrt((u / d)^2 + (u / R)^2) as the current vanishes, with u, d, R and its direction drawn."""
    random = np.random.default_rng([6, seed])
    u, d, radius, towards = (float(v) for v in random.uniform([0.3, 3.0, 12.0, 0.0], [0.8, 8.0, 35.0, 6.0]))
    scene, settling = circling(u, d, radius, ("starboard", "port")[seed % 2], 1e-3 * u, towards)
    expected = 1e-3 * u / math.hypot(u / d, u / radius)
    value, _ = converged(scene, swing(settling, 2.0 * math.pi * radius / u))
    assert value == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("seed", range(6, 12))
def test_e_swing_in_a_strong_current(seed: int) -> None:
    """Row E beyond its linearization: swing and mean, with u, d, R, Vc and its direction drawn."""
    random = np.random.default_rng([6, seed])
    low, high = [0.3, 3.0, 12.0, 0.0, 0.1], [0.8, 8.0, 35.0, 6.0, 0.4]
    u, d, radius, towards, share = (float(v) for v in random.uniform(low, high))
    turn, sigma = (("starboard", 1.0), ("port", -1.0))[seed % 2]
    scene, settling = circling(u, d, radius, turn, share * u, towards)
    most, middle, lap = lap_of(u, d, radius, sigma, share * u)
    assert_converges(scene, swing(settling, lap), most)
    assert_converges(scene, mean(settling, lap), middle, scale=most)
