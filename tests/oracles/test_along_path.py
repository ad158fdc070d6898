"""Closed form C: line of sight along the path (18) settles inside its arc, and needs d / R < pi / 2."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from oracles.closed_forms import integrate, line_of_sight
from oracles.kinematic import (
    FINE,
    Scene,
    assert_converges,
    at,
    circle,
    converged,
    distance_from_origin,
    flown,
    rho,
    time_within,
)

TURNS = pytest.mark.parametrize("turn", ["starboard", "port"])


def scene(radius: float, d: float, rho0: float, turn: str, duration: float, **other: float) -> Scene:
    """A start at a distance from the center of a circle."""
    e0 = (radius - rho0) * (1.0 if turn == "starboard" else -1.0)
    return Scene(circle(radius, turn), f"law: along_path, lookahead: {d!r}", f"cross_track: {e0!r}", duration, **other)


def inner_circle(radius: float, d: float, rho0: float, u: float, t: float) -> float:
    """rho(t): (22) is line of sight about the circle of radius R cos(d / R), with the lookahead R sin(d / R)."""
    inner = radius * math.cos(d / radius)
    return inner + line_of_sight(rho0 - inner, u, radius * math.sin(d / radius), t)


def pursuit(radius: float, d: float, rho0: float, u: float, t: float) -> float:
    """rho(t) from first principles: a point that heads for another one, d further along the circle than itself."""

    def velocity(_: float, p: np.ndarray) -> np.ndarray:
        bearing = math.atan2(p[1], p[0]) + d / radius
        to_aim = radius * np.array([math.cos(bearing), math.sin(bearing)]) - p
        return u * to_aim / math.hypot(*to_aim)

    return math.hypot(*integrate(velocity, [rho0, 0.0], t))


@TURNS
@pytest.mark.parametrize(
    ("radius", "d", "printed"),
    [(12, 5, -1.0266832009), (20, 5, -0.6217515658), (12, 10, -3.9310530710), (30, 5, -0.4157030531)],
)
def test_c_static_error(radius: float, d: float, printed: float, turn: str) -> None:
    """Row C: rho - R -> -R (1 - cos(d / R)), in steady state."""
    assert -radius * (1.0 - math.cos(d / radius)) == pytest.approx(printed, abs=1e-10)
    steady = scene(radius, d, radius + 1.0, turn, 400.0)
    assert_converges(steady, lambda f: rho(radius, turn)(400.0)(f) - radius, printed)


@TURNS
@pytest.mark.parametrize(("time", "printed"), [(10, 3.944764912), (20, 1.116856884), (60, -0.990097503)])
def test_c_approach(time: float, printed: float, turn: str) -> None:
    """Row C: rho - R on the way from rho0 = 20 m, R = 12 m, d = 5 m."""
    assert inner_circle(12.0, 5.0, 20.0, 0.5, time) - 12.0 == pytest.approx(printed, abs=1e-9)
    assert pursuit(12.0, 5.0, 20.0, 0.5, time) - 12.0 == pytest.approx(printed, abs=1e-9)
    assert_converges(scene(12.0, 5.0, 20.0, turn, 60.0), lambda f: rho(12.0, turn)(time)(f) - 12.0, printed)


def test_c_rate() -> None:
    """Row C: the inner circle is approached at u / (R sin(d / R)) = 0.1029532179 1/s."""
    rate = 0.5 / (12.0 * math.sin(5.0 / 12.0))
    assert rate == pytest.approx(0.1029532179, abs=1e-10)
    approach, inner = scene(12.0, 5.0, 20.0, "starboard", 120.0), 12.0 * math.cos(5.0 / 12.0)
    left = [converged(approach, rho(12.0, "starboard")(t), FINE)[0] - inner for t in (90.0, 110.0)]
    assert math.log(left[0] / left[1]) / 20.0 == pytest.approx(rate, rel=1e-5)


@pytest.mark.parametrize("seed", range(12))
def test_c_at_random(seed: int) -> None:
    """Row C with R, d, u and the start drawn, inside and outside, both senses of turn."""
    random = np.random.default_rng([4, seed])
    radius, angle, u, start = (float(v) for v in random.uniform([8.0, 0.3, 0.2, 0.3], [40.0, 1.3, 1.0, 2.0]))
    turn, d, rho0 = ("starboard", "port")[seed % 2], angle * radius, start * radius
    expected = pursuit(radius, d, rho0, u, 40.0)
    assert inner_circle(radius, d, rho0, u, 40.0) == pytest.approx(expected, rel=1e-10)
    assert_converges(scene(radius, d, rho0, turn, 40.0, speed=u), rho(radius, turn)(40.0), expected)


def test_18_is_periodic_in_the_lookahead() -> None:
    """Erratum (18): d and d + 2 pi R steer the same way, so that a longer lookahead is no safer."""
    near, far = (scene(3.0, d, 4.0, "starboard", 60.0) for d in (1.0, 1.0 + 6.0 * math.pi))
    for time in (10.0, 60.0):
        values = [at("cross_track", time)(flown(s, 0.1)) for s in (near, far)]
        assert values[0] == pytest.approx(values[1], abs=1e-9)


@TURNS
def test_18_beyond_a_right_angle_drives_into_the_center(turn: str) -> None:
    """Erratum (18): R = 5, d = 9 (d / R > pi / 2) from rho = 8 m reaches the center at 26.7872392452 s."""
    cosine = math.cos(9.0 / 5.0)

    def seconds_per_meter(r: float) -> float:
        return math.sqrt(25.0 + r * r - 10.0 * r * cosine) / (0.5 * (r - 5.0 * cosine))

    arrival = quad(seconds_per_meter, 0.0, 8.0, epsabs=1e-13, epsrel=1e-13)[0]
    assert arrival == pytest.approx(26.7872392452, abs=1e-9)
    swallowed = scene(5.0, 9.0, 8.0, turn, 26.7, log_period=0.1)
    ticks, radii = (0.01, 0.005, 0.0025), np.geomspace(0.3, 2.0, 7)  # nearer the center a step turns too far
    times = [converged(swallowed, time_within(r), ticks)[0] for r in radii]
    assert times == pytest.approx([quad(seconds_per_meter, r, 8.0, epsabs=1e-13)[0] for r in radii], rel=1e-5)
    smooth = np.polynomial.Polynomial.fit(np.log(radii - 5.0 * cosine), times, 6)  # t(rho) is singular at R cos(d / R)
    assert smooth(math.log(-5.0 * cosine)) == pytest.approx(26.7872392452, rel=1e-5)


def test_18_at_the_same_place_the_tangent_leads_to_the_path() -> None:
    """Erratum (18): line of sight (3), R = 5, d = 9, from 8 m, has no such limit."""
    law = Scene(circle(5.0, "starboard"), "law: line_of_sight, lookahead: 9", "cross_track: -3", 60.0)
    assert_converges(law, at("cross_track", 60.0), line_of_sight(-3.0, 0.5, 9.0, 60.0))


def rate_at_start(law: Scene) -> float:
    """d rho / dt [m/s] at the start, without a tick."""

    def rate(tick: float) -> float:
        flight = flown(law, tick)
        return (distance_from_origin(tick)(flight) - distance_from_origin(0.0)(flight)) / tick

    coarse, middle, fine = (rate(tick) for tick in (0.04, 0.02, 0.01))
    return (8.0 * fine - 6.0 * middle + coarse) / 3.0


@pytest.mark.parametrize(
    ("start", "corrected", "printed"),
    [(25.5148, -0.4742493705, -0.1163698630), (10.8645, 0.0112012697, 1.1406560171)],
)
def test_21_as_printed_moves_at_another_rate(start: float, corrected: float, printed: float) -> None:
    """Erratum (21): rho' at R = 12, d = 5, u = 0.5; the table gives rho to four decimals only, hence 2e-6 m/s."""
    flights = [scene(12.0, 5.0, start, "starboard", 1.0, log_period=0.0)]
    flights += [moved_by_21(start, 1.0, share) for share in (0, 1)]
    rates = [rate_at_start(flight) for flight in flights]
    assert rates[0] == pytest.approx(corrected, abs=2e-6)
    assert rates[1] == pytest.approx(rates[0], abs=1e-8)  # (21) corrected is what the vehicle does
    assert rates[2] == pytest.approx(printed, abs=2e-6)


def moved_by_21(start: float, duration: float, printed: int) -> Scene:
    """A point that moves by (21)."""
    model = f"{{law: 'printed_hulls:radial_of_21', printed: {printed}}}"
    return Scene(
        circle(12.0, "starboard"),
        "law: line_of_sight",
        f"cross_track: {12.0 - start!r}",
        duration,
        model=model,
        log_period=0.0 if duration <= 1.0 else 1.0,
    )


def test_21_as_printed_settles_on_another_circle() -> None:
    """Erratum (21): printed, rho -> R cos(d / R) / u = 21.9466 m; corrected and flown, R cos(d / R) = 10.9733 m."""
    inner = 12.0 * math.cos(5.0 / 12.0)
    printed, corrected = (distance_from_origin(600.0)(flown(moved_by_21(14.0, 600.0, p), 0.1)) for p in (1, 0))
    assert printed == pytest.approx(inner / 0.5, rel=1e-9)
    assert corrected == pytest.approx(inner, rel=1e-9)
