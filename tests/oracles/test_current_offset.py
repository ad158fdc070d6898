"""Closed form D: what a current that nothing compensates does, and what (36) as printed makes of it."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from flying import value_at
from oracles.closed_forms import integrate
from oracles.kinematic import Scene, assert_converges, at, flown, line, water

COURSE = 0.5
SIGHT, MAURYA = "law: line_of_sight, lookahead: 5", "law: arcsine, gain: 0.1"
TICKS = (0.1, 0.05)


def drifting(guidance: str, v: float, compensation: str = "none", *, observer: str = "", **other: float) -> Scene:
    """A line flown at 0.5 m/s in a current v [m/s] square to it, towards starboard."""
    extra = water(abs(v), COURSE + math.copysign(math.pi / 2.0, v), compensation, observer)
    return Scene(line(COURSE), guidance, "cross_track: 0", 600.0, extra=extra, **other)


def settled(scene: Scene) -> list[float]:
    """Error at the end at two ticks: at rest nothing changes within a tick, so no limit is needed."""
    return [value_at(flown(scene, tick), "cross_track", scene.duration) for tick in TICKS]


@pytest.mark.parametrize(
    ("guidance", "v", "printed"),
    [(SIGHT, 0.1, 1.0206207262), (SIGHT, 0.2, 2.1821789024), (MAURYA, 0.1, 1.0), (MAURYA, 0.2, 2.0)],
)
def test_d_static_error_at_the_printed_parameters(guidance: str, v: float, printed: float) -> None:
    """Row D: d V / sqrt(u^2 - V^2) for line of sight, V / k1 for Maurya's law."""
    assert settled(drifting(guidance, v)) == pytest.approx([printed] * 2, abs=1e-9)
    assert settled(drifting(guidance, -v)) == pytest.approx([-printed] * 2, abs=1e-9)


def drawn(seed: int) -> tuple[float, float, float, float, float]:
    """u, d, k1, and a current of any direction: its speed and where it flows to."""
    random = np.random.default_rng([5, seed])
    u, d, k1, share = (float(v) for v in random.uniform([0.3, 3.0, 0.05, 0.1], [1.2, 12.0, 0.2, 0.6]))
    return u, d, k1, share * u, float(random.uniform(0.0, 2.0 * math.pi))


@pytest.mark.parametrize("seed", range(8))
def test_d_static_error_at_random(seed: int) -> None:
    """Row D with u, d, k1 and the current drawn; only its part across the line counts."""
    u, d, k1, speed, towards = drawn(seed)
    v, extra = speed * math.sin(towards - COURSE), water(speed, towards)
    sight, maurya = (
        Scene(line(COURSE), law, "cross_track: 1", 600.0, u, extra=extra)
        for law in (f"law: line_of_sight, lookahead: {d!r}", f"law: arcsine, gain: {k1!r}")
    )
    assert settled(sight) == pytest.approx([d * v / math.sqrt(u * u - v * v)] * 2, rel=1e-9)
    assert settled(maurya) == pytest.approx([v / k1] * 2, rel=1e-9)


@pytest.mark.parametrize("seed", range(8, 14))
def test_d_way_to_the_static_error(seed: int) -> None:
    """Row D: e' = u sin(chi_d - chi_p) + V, and gamma' = u cos(chi_d - chi_p) + Vpar, on the way."""
    u, d, _, speed, towards = drawn(seed)
    v, along = speed * math.sin(towards - COURSE), speed * math.cos(towards - COURSE)

    def rates(_: float, y: np.ndarray) -> list[float]:
        slant = math.hypot(d, y[0])
        return [v - u * y[0] / slant, along + u * d / slant]

    e, gamma = integrate(rates, [8.0, 0.0], 20.0)
    law = f"law: line_of_sight, lookahead: {d!r}"
    scene = Scene(line(COURSE), law, "cross_track: 8", 20.0, u, extra=water(speed, towards))
    assert_converges(scene, at("cross_track", 20.0), e)
    assert_converges(scene, at("coordination_state", 20.0), gamma, scale=10.0)


def resting_error(law: str, u: float, gain: float, v: float, along: float) -> float:
    """Where e rests under (36) as printed: psi = chi_d + asin(Vperp / u), with u sin(psi - chi_p) = -V."""

    def sideways(e: float) -> float:
        off = math.atan(-e / gain) if law == "line_of_sight" else math.asin(-gain * e / u)
        across = math.cos(off) * v - math.sin(off) * along
        return u * math.sin(off + math.asin(across / u)) + v

    widest = 60.0 if law == "line_of_sight" else 0.99 * u / gain
    return float(brentq(sideways, -widest, widest, xtol=1e-13))


@pytest.mark.parametrize(("v", "expected"), [(0.1, 2.0412414523), (0.2, 4.3643578047), (0.3, 7.5)])
def test_36_as_printed_doubles_the_error(v: float, expected: float) -> None:
    """Erratum (36): 2 d V / sqrt(u^2 - V^2), twice the error without compensation, at every V < u; corrected, none."""
    assert 10.0 * v / math.sqrt(0.25 - v * v) == pytest.approx(expected, abs=1e-10)
    assert resting_error("line_of_sight", 0.5, 5.0, v, 0.0) == pytest.approx(expected, abs=1e-10)
    assert settled(drifting(SIGHT, v, "'printed_guidance:crab_of_36'")) == pytest.approx([expected] * 2, abs=1e-9)
    assert settled(drifting(SIGHT, v, "crab")) == pytest.approx([0.0] * 2, abs=1e-9)


def test_36_as_printed_under_maurya() -> None:
    """Erratum (36): 2 (V / k1) / sqrt(1 + 3 V^2 / u^2) with Maurya's law."""
    expected = 2.0 / math.sqrt(1.12)
    assert resting_error("arcsine", 0.5, 0.1, 0.1, 0.0) == pytest.approx(expected, abs=1e-10)
    assert settled(drifting(MAURYA, 0.1, "'printed_guidance:crab_of_36'")) == pytest.approx([expected] * 2, abs=1e-9)
    assert settled(drifting(MAURYA, 0.1, "crab")) == pytest.approx([0.0] * 2, abs=1e-9)


@pytest.mark.parametrize("compensation", ["crab", "'printed_guidance:crab_of_36'"])
def test_36_with_the_observer_that_the_paper_has(compensation: str) -> None:
    """Erratum (36): the same rest, once (33) has found the current."""
    observer = "{law: complementary, k1: 1, k2: 0.25}"
    expected = 0.0 if compensation == "crab" else 2.0412414523
    scene = drifting(SIGHT, 0.1, compensation, observer=observer)
    assert settled(scene) == pytest.approx([expected] * 2, abs=1e-8)


def test_36_row_d_takes_the_doubled_drift_for_a_doubled_current() -> None:
    """Row D, "V -> 2V": 2.1821789024 m is where a vehicle rests that does not compensate a current of 2 V = 0.2 m/s."""
    assert settled(drifting(SIGHT, 2 * 0.1)) == pytest.approx([2.1821789024] * 2, abs=1e-9)


@pytest.mark.parametrize("seed", range(14, 20))
def test_36_as_printed_at_random(seed: int) -> None:
    """Erratum (36) with u, d, k1 and a current of any direction drawn."""
    u, d, k1, speed, towards = drawn(seed)
    v, along = speed * math.sin(towards - COURSE), speed * math.cos(towards - COURSE)
    extra = water(speed, towards, "'printed_guidance:crab_of_36'")
    for law, parameter, gain in (("line_of_sight", "lookahead", d), ("arcsine", "gain", k1)):
        guidance = f"law: {law}, {parameter}: {gain!r}"
        scene = Scene(line(COURSE), guidance, "cross_track: 1", 2000.0, u, log_period=10.0, extra=extra)
        assert settled(scene) == pytest.approx([resting_error(law, u, gain, v, along)] * 2, rel=1e-8)


@pytest.mark.parametrize(
    ("compensation", "share"), [("'printed_guidance:crab_of_36'", 2.0), ("crab", 0.0), ("none", 1.0)]
)
@pytest.mark.parametrize("v", [0.13, -0.27])
def test_36_residual_across_the_course(compensation: str, share: float, v: float) -> None:
    """Erratum (36): across the course 2.000000 Vperp are left as printed, 0 corrected, 1 without compensation."""
    flight = flown(drifting("law: 'aids:parallel'", v, compensation), 0.1)
    drift = value_at(flight, "cross_track", 110.0) - value_at(flight, "cross_track", 10.0)
    assert drift / (100.0 * v) == pytest.approx(share, abs=1e-9)
