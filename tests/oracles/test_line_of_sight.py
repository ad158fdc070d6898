"""Closed forms A, A2, A3: line of sight (3) keeps to its closed forms, on lines and arcs of both senses."""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from cardume.simulation.flight import Flight
from flying import series, value_at
from oracles.closed_forms import line_of_sight, line_of_sight_arc_length, line_of_sight_time
from oracles.kinematic import (
    Quantity,
    Scene,
    assert_converges,
    at,
    circle,
    converged,
    curve,
    line,
    rho,
    when,
)

PRINTED = Scene(line(), "law: line_of_sight, lookahead: 5", "cross_track: 10", 100.0, log_period=0.1)


def drawn(seed: int) -> tuple[Scene, float, float, float, float]:
    """A scene at random, with its u, d, e0 and curvature; every third on a line, starts on both sides."""
    random = np.random.default_rng([1, seed])
    u, d, radius, share = (float(v) for v in random.uniform([0.2, 5.0, 8.0, 0.1], [1.2, 12.0, 40.0, 0.8]))
    c, e0 = (0.0, 1.0 / radius, -1.0 / radius)[seed % 3], (1.0, -1.0)[seed // 3 % 2] * share * radius
    guidance = f"law: line_of_sight, lookahead: {d!r}"
    return Scene(curve(c), guidance, f"cross_track: {e0!r}, along_track: 2", 30.0, u), u, d, e0, c


def turn_rate(time: float) -> Quantity:
    """Rate of the desired course [rad/s] at a time [s]."""

    def rate(flight: Flight) -> float:
        times, course = series(flight, "course_desired")
        return float(CubicSpline(times, np.unwrap(course))(time, 1))

    return rate


@pytest.mark.parametrize(
    ("time", "printed"), [(10, 5.814121186282), (20, 2.685109431109), (40, 0.389040768046), (100, 0.000965795191)]
)
def test_a_error_at_the_printed_parameters(time: float, printed: float) -> None:
    """Row A: e(t) from F(e(t)) = F(e0) - u t, e0 = 10 m, u = 0.5 m/s, d = 5 m."""
    assert line_of_sight(10.0, 0.5, 5.0, time) == pytest.approx(printed, abs=1e-12)
    assert_converges(PRINTED, at("cross_track", time), printed)


@pytest.mark.parametrize(("level", "printed"), [(1.0, 30.4749059099), (0.1, 53.5992634343)])
def test_a_times_at_the_printed_parameters(level: float, printed: float) -> None:
    """Row A: the times at which 1 m and 0.1 m are reached."""
    assert line_of_sight_time(10.0, level, 0.5, 5.0) == pytest.approx(printed, abs=1e-10)
    assert_converges(PRINTED, when("cross_track", level), printed)


def test_a_tail_is_exponential() -> None:
    """Row A: e -> 2 d exp((F(e0) - u t) / d - 1) = 21.2730549364 exp(-u t / d)."""
    potential = math.hypot(5.0, 10.0) - 5.0 * math.asinh(0.5)
    assert 10.0 * math.exp(potential / 5.0 - 1.0) == pytest.approx(21.2730549364, abs=1e-10)
    scene = Scene(line(), "law: line_of_sight, lookahead: 5", "cross_track: 10", 120.0)
    assert_converges(scene, lambda f: value_at(f, "cross_track", 120.0) * math.exp(12.0), 21.2730549364)


@pytest.mark.parametrize("e0", [10.0, -10.0])
@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_a_holds_on_arcs(turn: str, e0: float) -> None:
    """Row A, any curvature: the numbers of the line, on a circle of 12 m, from inside and outside."""
    scene = Scene(circle(12.0, turn), "law: line_of_sight, lookahead: 5", f"cross_track: {e0}", 20.0)
    assert_converges(scene, at("cross_track", 20.0), math.copysign(2.685109431109, e0))


@pytest.mark.parametrize("seed", range(12))
def test_a_at_random(seed: int) -> None:
    """Row A with u, d, e0, curvature and side drawn."""
    scene, u, d, e0, _ = drawn(seed)
    for time in (5.0, 15.0, 30.0):
        assert_converges(scene, at("cross_track", time), line_of_sight(e0, u, d, time))


@pytest.mark.parametrize(
    ("e0", "arc_length", "e"), [(-10.0, 23.2171015925, -0.052729165165), (6.0, 31.8853162096, 0.020366675719)]
)
@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_a2_path_shape_at_the_printed_parameters(turn: str, e0: float, arc_length: float, e: float) -> None:
    """Row A2: s and e after 60 s at c = 1/12; mirrored at c = -1/12."""
    assert line_of_sight(e0, 0.5, 5.0, 60.0) == pytest.approx(e, abs=1e-12)
    assert line_of_sight_arc_length(e0, e, 1.0 / 12.0, 5.0) == pytest.approx(arc_length, abs=1e-8)
    sign = 1.0 if turn == "starboard" else -1.0
    scene = Scene(circle(12.0, turn), "law: line_of_sight, lookahead: 5", f"cross_track: {sign * e0}", 60.0)
    assert_converges(scene, at("coordination_state", 60.0), arc_length)
    assert_converges(scene, at("cross_track", 60.0), sign * e)


@pytest.mark.parametrize("seed", range(12, 24))
def test_a2_at_random(seed: int) -> None:
    """Row A2: e(s) = e0 E / (1 - c e0 + c e0 E), E = exp(-s / d)."""
    scene, u, d, e0, c = drawn(seed)
    for time in (10.0, 30.0):
        arc_length = line_of_sight_arc_length(e0, line_of_sight(e0, u, d, time), c, d)
        assert_converges(scene, lambda f, t=time: value_at(f, "coordination_state", t) - 2.0, arc_length)


def test_a3_fastest_turn_on_a_line() -> None:
    """Row A3: at most 2 u / (3 sqrt3 d) = 0.0384900179 rad/s, at e = d / sqrt2."""
    expected = 2.0 * 0.5 / (3.0 * math.sqrt(3.0) * 5.0)
    assert expected == pytest.approx(0.0384900179, abs=1e-10)
    there = line_of_sight_time(10.0, 5.0 / math.sqrt(2.0), 0.5, 5.0)

    def fastest(flight: Flight) -> float:
        times, course = series(flight, "course_desired")
        rates = CubicSpline(times, np.unwrap(course)).derivative()
        around = np.linspace(there - 3.0, there + 3.0, 6001)
        return float(rates(around).max())

    value, _ = converged(PRINTED, fastest)
    assert value == pytest.approx(expected, rel=1e-5)
    ahead_and_behind = [converged(PRINTED, turn_rate(t))[0] for t in (there - 3.0, there + 3.0)]
    assert max(ahead_and_behind) < 0.99 * expected


@pytest.mark.parametrize("seed", range(24, 36))
def test_a3_at_random(seed: int) -> None:
    """Row A3: c u cos(beta) / (1 - c e) + u d e / (d^2 + e^2)^1.5, beta = atan(-e / d)."""
    scene, u, d, e0, c = drawn(seed)
    scene = Scene(scene.path, scene.guidance, scene.start, 20.0, scene.speed, log_period=0.0)
    e = line_of_sight(e0, u, d, 10.0)
    expected = c * u * d / math.hypot(d, e) / (1.0 - c * e) + u * d * e / math.hypot(d, e) ** 3
    value, _ = converged(scene, turn_rate(10.0))
    assert value == pytest.approx(expected, rel=1e-5, abs=1e-7)


def test_3_with_the_error_of_19_runs_away_on_clockwise_arcs() -> None:
    """Erratum (3): with e = rho - R on a clockwise arc, rho goes from 12.5 m to 32.63662983 m in 60 s."""
    law = "law: 'printed_guidance:error_of_19', lookahead: 5"
    scene = Scene(circle(12.0, "starboard"), law, "cross_track: -0.5", 60.0)
    assert 12.0 + line_of_sight(0.5, 0.5, 5.0, -60.0) == pytest.approx(32.63662983, abs=1e-8)
    assert_converges(scene, rho(12.0, "starboard")(60.0), 32.63662983)
    right = Scene(circle(12.0, "starboard"), "law: line_of_sight, lookahead: 5", "cross_track: -0.5", 60.0)
    assert_converges(right, at("cross_track", 60.0), line_of_sight(-0.5, 0.5, 5.0, 60.0))


def test_3_with_the_error_of_19_is_right_on_anticlockwise_arcs() -> None:
    """Erratum (3), (19): there rho - R is the distance to starboard."""
    law = "law: 'printed_guidance:error_of_19', lookahead: 5"
    scene = Scene(circle(12.0, "port"), law, "cross_track: 0.5", 60.0)
    assert_converges(scene, at("cross_track", 60.0), line_of_sight(0.5, 0.5, 5.0, 60.0))
