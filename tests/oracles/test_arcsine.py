"""Closed forms B, B2: Maurya's law (4), saturated at 0.99 as we fly it and at 1 as it is printed."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from flying import value_at
from oracles.closed_forms import arcsine
from oracles.kinematic import FINE, Scene, assert_converges, at, at_time, circle, converged, curve, flown, line, when

STEEPEST = 0.99  # the documented saturation of our law
OURS = Scene(line(), "law: arcsine, gain: 0.1", "cross_track: 20", 80.0)
PRINTED = Scene(line(), "law: 'printed_guidance:arcsine_to_one', gain: 0.1", "cross_track: 20", 80.0, log_period=0.1)


@pytest.mark.parametrize(("time", "printed"), [(20, 10.0), (30, 5.0), (50, 0.6766764162), (80, 0.0336897350)])
def test_b_as_printed(time: float, printed: float) -> None:
    """Row B with (4) saturated at 1: straight for 30 s at u, then 5 exp(-k1 (t - 30)); e0 = 20 m, k1 = 0.1 1/s."""
    assert arcsine(20.0, 0.5, 0.1, time) == pytest.approx(printed, abs=1e-10)
    value, order = converged(PRINTED, at("cross_track", time))
    assert value == pytest.approx(printed, rel=1e-5)
    if time > 30:  # until then the heading is constant, and no tick matters
        assert order == pytest.approx(1.0, abs=0.1)


def test_b_time_as_printed() -> None:
    """Row B: 0.1 m is reached at 69.1202300543 s; by line of sight with d = 5 m at 74.8070935506 s."""
    assert 30.0 + math.log(50.0) / 0.1 == pytest.approx(69.1202300543, abs=1e-10)
    assert_converges(PRINTED, when("cross_track", 0.1), 69.1202300543)
    sight = Scene(line(), "law: line_of_sight, lookahead: 5", "cross_track: 20", 80.0, log_period=0.1)
    assert_converges(sight, when("cross_track", 0.1), 74.8070935506)


@pytest.mark.parametrize("time", [20.0, 50.0, 80.0])
def test_b_as_we_fly_it(time: float) -> None:
    """Row B with our saturation: straight at 0.99 u for (e0 - 0.99 u / k1) / (0.99 u) = 30.404 s, then exponential."""
    expected = arcsine(20.0, 0.5, 0.1, time, STEEPEST)
    value, order = converged(OURS, at("cross_track", time), FINE)
    assert value == pytest.approx(expected, rel=1e-5)
    if time > 30.5:
        assert order == pytest.approx(1.0, abs=0.1)


def test_4_saturated_at_one_makes_no_way() -> None:
    """Erratum (4): at saturation 1 the vehicle stands square to the path; at 0.99 it keeps 14 % of its speed."""
    printed = converged(PRINTED, at("coordination_state", 30.0))[0]
    ours = converged(OURS, at("coordination_state", 30.0))[0]
    assert printed == pytest.approx(0.0, abs=1e-6)
    assert ours == pytest.approx(30.0 * 0.5 * math.sqrt(1.0 - STEEPEST**2), rel=1e-9)


def drawn(seed: int) -> tuple[float, float, float, float]:
    """u, k1, e0 and curvature at random; starts on both sides, some saturated and some not."""
    random = np.random.default_rng([2, seed])
    u, k1, start, radius = (float(v) for v in random.uniform([0.2, 0.05, 0.2, 10.0], [1.2, 0.2, 2.5, 40.0]))
    c = (0.0, 1.0 / radius, -1.0 / radius)[seed % 3]
    e0 = min(start * u / k1, 0.8 * radius) * (1.0, -1.0)[seed // 3 % 2]
    return u, k1, e0, c


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize(("law", "saturation"), [("arcsine", STEEPEST), ("'printed_guidance:arcsine_to_one'", 1.0)])
def test_b_at_random(law: str, saturation: float, seed: int) -> None:
    """Row B, lines and arcs of both senses, with u, k1, e0 and curvature drawn."""
    u, k1, e0, c = drawn(seed)
    scene = Scene(curve(c), f"law: {law}, gain: {k1!r}", f"cross_track: {e0!r}, along_track: 1", 40.0, u)
    expected = arcsine(e0, u, k1, 40.0, saturation)
    assert abs(expected) < saturation * u / k1  # it has come off the saturation
    assert_converges(scene, at("cross_track", 40.0), expected, FINE)


@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_12_is_exponential_only_unsaturated(turn: str) -> None:
    """Errata (12), (13): e0 exp(-k1 t) from 4 m; from -20 m it is still -10 m after 20 s, not -2.7 m."""
    sign, law = 1.0 if turn == "starboard" else -1.0, "law: 'printed_guidance:arcsine_to_one', gain: 0.1"
    near, far = (Scene(circle(12.0, turn), law, f"cross_track: {sign * e0}", 20.0) for e0 in (4.0, -20.0))
    assert_converges(near, at("cross_track", 20.0), sign * 4.0 * math.exp(-2.0))
    assert at("cross_track", 20.0)(flown(far, 0.1)) == pytest.approx(
        -10.0 * sign, abs=1e-9
    )  # straight: no tick matters


def tractrix(e0: float, e: float, u: float, k1: float) -> float:
    """Row B2 by quadrature of ds = -de sqrt(u^2 - (k1 e)^2) / (k1 e)."""
    return quad(lambda x: math.sqrt(u * u - (k1 * x) ** 2) / (k1 * x), e, e0, epsabs=1e-13, epsrel=1e-13)[0]


def test_b2_tractrix_at_the_printed_parameters() -> None:
    """Row B2: from e = 4 m to 1 m the vehicle makes 6.0974429594 m along the line."""
    w = [math.sqrt(1.0 - (0.1 * e / 0.5) ** 2) for e in (4.0, 1.0)]
    assert 5.0 * (math.atanh(w[1]) - w[1] - math.atanh(w[0]) + w[0]) == pytest.approx(6.0974429594, abs=1e-10)
    assert tractrix(4.0, 1.0, 0.5, 0.1) == pytest.approx(6.0974429594, abs=1e-10)
    scene = Scene(line(), "law: arcsine, gain: 0.1", "cross_track: 4", 16.0, log_period=0.1)
    assert_converges(scene, at_time("coordination_state", when("cross_track", 1.0)), 6.0974429594)


@pytest.mark.parametrize("seed", range(8))
def test_b2_at_random(seed: int) -> None:
    """Row B2 with u, k1, the start and the end drawn, from both sides."""
    random = np.random.default_rng([3, seed])
    u, k1, high, low = (float(v) for v in random.uniform([0.2, 0.05, 0.5, 0.1], [1.2, 0.2, 0.95, 0.4]))
    e0, e, side = high * u / k1, low * u / k1, (1.0, -1.0)[seed % 2]
    duration = math.ceil(math.log(e0 / e) / k1) + 2.0
    scene = Scene(line(), f"law: arcsine, gain: {k1!r}", f"cross_track: {side * e0!r}", duration, u, log_period=0.1)
    quantity = at_time("coordination_state", when("cross_track", side * e))
    assert_converges(scene, quantity, tractrix(e0, e, u, k1))


def test_b_needs_the_speed_through_the_water() -> None:
    """Row B: k1 alone sets the rate; at twice the speed the decay is the same, once unsaturated."""
    slow, fast = (
        Scene(line(), "law: arcsine, gain: 0.1", "cross_track: 4", 30.0, speed, log_period=0.1) for speed in (0.5, 1.0)
    )
    values = [converged(scene, lambda f: value_at(f, "cross_track", 30.0))[0] for scene in (slow, fast)]
    assert values == pytest.approx([4.0 * math.exp(-3.0)] * 2, rel=1e-5)
