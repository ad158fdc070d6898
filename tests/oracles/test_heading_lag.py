"""Closed forms F, F2: a heading that lags, and a position that comes late."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import lambertw

from cardume.simulation.flight import Flight
from flying import series
from oracles.kinematic import FINE, Quantity, Scene, assert_converges, at, circle, converged, line

TURNS = pytest.mark.parametrize("turn", ["starboard", "port"])
SMALL = 1e-4  # of the scale on which the laws bend: squared, it is below every tolerance here


def lagging(time_constant: float) -> str:
    """A vehicle whose heading follows with a time constant [s]."""
    return f"{{law: kinematic, heading_time_constant: {time_constant!r}}}"


def oscillator(begin: float, end: float, spacing: int = 1) -> tuple[Quantity, Quantity]:
    """Sum and product of the two poles that a small error's log, from begin to end [s], shows.

    A linear motion with two poles obeys e[k + 2] = p e[k + 1] - q e[k] exactly, at any spacing.
    """

    def logarithms(flight: Flight) -> np.ndarray:
        times, e = series(flight, "cross_track")
        e = e[(times >= begin) & (times <= end)][::spacing]
        (p, q), *_ = np.linalg.lstsq(np.column_stack([e[1:-1], -e[:-2]]), e[2:], rcond=None)
        return np.log(np.roots([1.0, -p, q]).astype(complex)) / (spacing * (times[1] - times[0]))

    return lambda f: float(logarithms(f).sum().real), lambda f: float(logarithms(f).prod().real)


def swaying(law: str, gain: float, u: float, model: str = "kinematic", **other: str) -> Scene:
    """A line flown from a small error, logged often."""
    e0 = SMALL * (gain if law == "line_of_sight" else u / gain)
    parameter = "lookahead" if law == "line_of_sight" else "gain"
    guidance = f"law: {law}, {parameter}: {gain!r}"
    return Scene(line(), guidance, f"cross_track: {e0!r}", 40.0, u, model, log_period=0.5, **other)


@TURNS
@pytest.mark.parametrize(
    ("law", "lag", "printed"),
    [("line_of_sight", 1.0, -0.2049495983), ("line_of_sight", 2.0, -0.4039722593), ("arcsine", 1.0, -0.2047804756)],
)
def test_f_static_error_at_the_printed_parameters(law: str, lag: float, printed: float, turn: str) -> None:
    """Row F: on an arc of 12 m a lag T leaves e = -sigma d tan(T u |c| / (1 - c e)), outside; Maurya (u / k1) sin."""
    sigma = 1.0 if turn == "starboard" else -1.0
    guidance = "law: line_of_sight, lookahead: 5" if law == "line_of_sight" else "law: arcsine, gain: 0.1"
    scene = Scene(circle(12.0, turn), guidance, "cross_track: 0", 200.0, model=lagging(lag))
    assert_converges(scene, at("cross_track", 200.0), sigma * printed)


@pytest.mark.parametrize("seed", range(8))
def test_f_at_random(seed: int) -> None:
    """Row F with T, u, d or k1 and R drawn, both senses of turn."""
    random = np.random.default_rng([7, seed])
    lag, u, d, radius = (float(v) for v in random.uniform([0.3, 0.3, 5.0, 10.0], [2.0, 0.6, 9.0, 40.0]))
    turn, sigma = (("starboard", 1.0), ("port", -1.0))[seed % 2]
    bend, reach = ((math.tan, d), (math.sin, d))[seed // 2 % 2]
    law = f"law: line_of_sight, lookahead: {d!r}" if bend is math.tan else f"law: arcsine, gain: {u / d!r}"
    outside = brentq(lambda e: e - reach * bend(lag * u / (radius + e)), 0.0, 0.9 * d, xtol=1e-14)
    scene = Scene(circle(radius, turn), law, "cross_track: 0", 600.0, u, lagging(lag), log_period=10.0)
    assert_converges(scene, at("cross_track", 600.0), -sigma * outside)


@pytest.mark.parametrize("seed", range(8))
def test_f2_poles_at_random(seed: int) -> None:
    """Row F2: a small error on a line has the poles of T s^2 + s + u / d; with Maurya's law, of T s^2 + s + k1."""
    random = np.random.default_rng([8, seed])
    lag, u, d = (float(v) for v in random.uniform([0.5, 0.2, 1.0], [3.0, 1.0, 8.0]))
    law, gain = (("line_of_sight", d), ("arcsine", u / d))[seed % 2]
    total, product = oscillator(0.0, 20.0)
    scene = swaying(law, gain, u, lagging(lag))
    assert_converges(scene, total, -1.0 / lag)
    assert_converges(scene, product, u / (d * lag), order=2.0)


@pytest.mark.parametrize(("lag", "u"), [(2.0, 0.5), (1.3, 0.8)])
@pytest.mark.parametrize("law", ["line_of_sight", "arcsine"])
def test_f2_where_oscillation_begins(law: str, lag: float, u: float) -> None:
    """Row F2: oscillation below d = 4 u T (4 m for T = 2 s, u = 0.5 m/s); with Maurya's law above k1 = 1 / (4 T)."""

    def discriminant(share: float) -> float:
        d = share * 4.0 * u * lag
        scene = swaying(law, d if law == "line_of_sight" else u / d, u, lagging(lag))
        total, product = (converged(scene, quantity)[0] for quantity in oscillator(0.0, 20.0))
        return lag * lag * (total * total - 4.0 * product)  # 1 - 4 u T / d

    assert discriminant(1.0) == pytest.approx(0.0, abs=2e-5)
    assert discriminant(0.999) == pytest.approx(1.0 - 1.0 / 0.999, abs=2e-5)
    assert discriminant(1.001) == pytest.approx(1.0 - 1.0 / 1.001, abs=2e-5)


def late(delay: float) -> str:
    """Exact sensors whose position is `delay` [s] old."""
    return (
        f"{{gnss: {{sigma: 0, latency: {delay!r}, period: TICK}},"
        " ahrs: {heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0, period: TICK}}"
    )


@pytest.mark.parametrize(("u", "d", "delay"), [(0.5, 2.0, 2.0), (0.8, 1.5, 2.0), (0.5, 0.9, 3.0), (0.4, 0.5, 2.0)])
def test_f2_poles_with_a_late_position(u: float, d: float, delay: float) -> None:
    """Row F2, delay: e' = -(u / d) e(t - tau) has the leading poles s tau = W(-u tau / d), Lambert's W."""
    pole = lambertw(-u * delay / d) / delay
    scene = swaying("line_of_sight", d, u, sensors=late(delay), extra="position: {law: direct}")
    total, product = oscillator(10.0 * delay, 13.0 * delay)  # the other poles' motion has died out by then
    assert_converges(scene, total, 2.0 * pole.real, FINE, scale=abs(pole))
    assert_converges(scene, product, abs(pole) ** 2, FINE)


@pytest.mark.parametrize("share", [0.99, 1.0, 1.01])
def test_f2_delay_that_makes_guidance_unstable(share: float) -> None:
    """Row F2, delay: stable while u tau / d < pi / 2."""
    u, delay = 0.5, 2.0
    d = u * delay / (share * math.pi / 2.0)
    scene = swaying("line_of_sight", d, u, sensors=late(delay), extra="position: {law: direct}")
    growth = converged(scene, oscillator(20.0, 30.0)[0], FINE)[0] / 2.0
    expected = (lambertw(-share * math.pi / 2.0) / delay).real
    assert growth == pytest.approx(expected, abs=1e-5)
    assert (growth > 1e-4, growth < -1e-4) == (share > 1.0, share < 1.0)
