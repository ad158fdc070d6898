"""The yaw-rate law of Micaelli & Samson and of Lapierre & Soetanto: its poles, its Lyapunov function, its equations."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from cardume.onboard.guidance import path_frame_backstepping
from cardume.signals import Motion, PathError
from cardume.simulation.flight import Flight
from flying import series, value_at
from oracles.closed_forms import integrate
from oracles.kinematic import Scene, assert_converges, at, curve, flown, line, water

COURSE = 0.5
FREE = "yaw_rate_max: 50"


def law(k1: float, k2: float, theta: float, k: float, reference: str = "projection") -> str:
    gains = f"course_gain: {k1!r}, error_gain: {k2!r}, approach: {theta!r}, steepness: {k!r}"
    return f"law: path_frame_backstepping, {gains}, {FREE}, reference_point: {reference}"


def at_rest(theta: float, k: float, e: float) -> float:
    """The course off the path's at which chi_e = delta."""
    return -theta * math.tanh(k * e)


@pytest.mark.parametrize("seed", range(4))
def test_without_k2_the_course_error_decays_by_itself(seed: int) -> None:
    """k2 = 0: chi_e - delta = x0 exp(-k1 t) exactly, on lines and on arcs of both senses, whatever e does."""
    random = np.random.default_rng([36, seed])
    u, k1, theta, k, e0, off = (float(x) for x in random.uniform([0.3, 0.3, 0.3, 0.1, -4, -1], [1, 1, 1, 0.5, 4, 1]))
    curvature = (0.0, 1 / 20.0, -1 / 20.0)[seed % 3]
    scene = Scene(curve(curvature), law(k1, 0.0, theta, k), f"cross_track: {e0!r}, heading_error: {off!r}", 5.0, u)

    def apart(flight: Flight) -> float:
        e, psi, chi = (value_at(flight, c, 5.0) for c in ("cross_track", "heading", "path_course"))
        return math.remainder(psi - chi, 2.0 * math.pi) - at_rest(theta, k, e)

    start = off - at_rest(theta, k, e0)
    assert_converges(scene, apart, start * math.exp(-5.0 * k1), (0.02, 0.01, 0.005), scale=abs(start))


@pytest.mark.parametrize(
    ("k1", "k2", "theta", "k"), [(1.0, 0.1, 0.8, 0.2), (0.5, 0.6, 0.3, 0.5), (1.0, 1.0, 0.0785, 2.0)]
)
def test_poles(k1: float, k2: float, theta: float, k: float) -> None:
    """Small errors on a line: (s + k1) (s + U theta k) + k2 U^2."""
    u, e0 = 0.5, 1e-4
    pull = u * theta * k
    # e' = U (x - theta k e), x' = -k1 x - k2 U e; the heading starts along the path, so x = theta k e
    e = integrate(lambda _, y: [u * y[1] - pull * y[0], -k1 * y[1] - k2 * u * y[0]], [e0, theta * k * e0], 6.0)[0]
    poles = np.roots([1.0, k1 + pull, k1 * pull + k2 * u * u])
    assert sorted(np.linalg.eigvals([[-pull, u], [-k2 * u, -k1]]), key=abs) == pytest.approx(sorted(poles, key=abs))
    scene = Scene(line(COURSE), law(k1, k2, theta, k), f"cross_track: {e0!r}", 6.0)
    assert_converges(scene, at("cross_track", 6.0), e, scale=e0)


def rates(u: float, gains: Sequence[float], c: float, gain: float | None, current: tuple[float, float]):
    """e, s1, chi_e of Samson (gain None: s1 stays 0) or Lapierre, in a current (along, across) of a line.

    The state holds the heading, psi - chi_p, from which course and speed over ground follow.
    """
    k1, k2, theta, k = gains

    def of(_: float, y: np.ndarray) -> list[float]:
        e, s1, psi = y
        along, across = u * math.cos(psi) + current[0], u * math.sin(psi) + current[1]
        speed, chi = math.hypot(along, across), math.atan2(across, along)
        target = along / (1.0 - c * e) if gain is None else along + gain * s1
        delta = -theta * math.tanh(k * e)
        e_rate = across - c * target * s1
        delta_rate = -theta * k * (1.0 - math.tanh(k * e) ** 2) * e_rate
        quotient = (math.sin(chi) - math.sin(delta)) / (chi - delta) if chi != delta else math.cos(chi)
        r = c * target + delta_rate - k1 * (chi - delta) - k2 * e * speed * quotient
        return [e_rate, 0.0 if gain is None else along - (1.0 - c * e) * target, r - c * target]

    return of


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("reference", ["projection", "virtual_target"])
def test_against_an_independent_integration(reference: str, seed: int) -> None:
    """Gains, speed and start drawn, lines in a known current and arcs of both senses without."""
    random = np.random.default_rng([37, seed])
    u, k1, k2, theta, k, gain = (
        float(x) for x in random.uniform([0.3, 0.3, 0.02, 0.1, 0.1, 0.1], [1.0, 1.2, 0.8, 1.0, 1.0, 0.8])
    )
    e0, off, speed, towards = (float(x) for x in random.uniform([-5, -1, 0.05, -3], [5, 1, 0.2, 3]))
    c = (0.0, 1 / 20.0, -1 / 20.0)[seed % 3]
    flow = (0.0, 0.0) if c else (speed * math.cos(towards - COURSE), speed * math.sin(towards - COURSE))
    path = curve(c) if c else line(COURSE)
    where = reference if reference == "projection" else f"{reference}, target_gain: {gain!r}"
    scene = Scene(
        path,
        law(k1, k2, theta, k, where),
        f"cross_track: {e0!r}, heading_error: {off!r}",
        8.0,
        u,
        extra=water(0.0 if c else speed, towards),
    )
    target = None if reference == "projection" else gain
    e, s1, psi = integrate(rates(u, (k1, k2, theta, k), c, target, flow), [e0, 0.0, off], 8.0)
    assert_converges(scene, at("cross_track_estimate", 8.0), e, (0.02, 0.01, 0.005), scale=abs(e0))
    heading = value_at(flown(scene, 0.005), "heading", 8.0) - value_at(flown(scene, 0.005), "path_course", 8.0)
    if target is None:
        assert math.remainder(heading - psi, 2.0 * math.pi) == pytest.approx(0.0, abs=0.01)
    assert s1 == 0.0 or target is not None


def test_the_lyapunov_function_never_grows() -> None:
    """(k2 e^2 + (chi_e - delta)^2) / 2 under method 1, from far off and heading away."""
    _, k2, theta, k = gains = (1.0, 0.1, 0.8, 0.2)
    flight = flown(Scene(line(COURSE), law(*gains), "cross_track: 15, heading_error: 2.5", 120.0, log_period=0.1), 0.05)
    e, psi = series(flight, "cross_track")[1], series(flight, "heading")[1]
    apart = np.remainder(psi - COURSE + math.pi, 2.0 * math.pi) - math.pi + theta * np.tanh(k * e)
    value = k2 * e**2 + apart**2
    assert np.diff(value).max() < 1e-9
    assert value[-1] < 1e-8 * value[0]


@pytest.mark.parametrize("reference", ["projection", "virtual_target"])
@pytest.mark.parametrize("c", [1 / 12.0, -1 / 12.0])
def test_on_an_arc_no_error_is_left(c: float, reference: str) -> None:
    """The paper's path, R = 12 m; MEDUSA's sway is known by no one, so the vehicle is kinematic."""
    scene = Scene(curve(c), law(1.0, 0.1, 0.8, 0.2, reference), "cross_track: 3", 200.0)
    found = [value_at(flown(scene, tick), "cross_track", 200.0) for tick in (0.1, 0.05)]
    assert abs(found[0]) < 0.02
    assert abs(found[1]) < 0.6 * abs(found[0]) + 1e-6  # what there is comes of the tick


def test_where_its_quotient_is_0_over_0_it_is_smooth() -> None:
    """chi_e = delta, where the source divides by zero: the value there is that beside it, cos(delta)."""
    e = 2.0
    delta = -0.8 * math.tanh(0.2 * e)

    def asked(off: float) -> float:
        error = PathError(path_course=0.3, cross_track=e, path_speed=0.5)
        motion = Motion(0.3 + off, 0.0, 0.5, 0.0, 0.5 * math.cos(0.3 + off), 0.5 * math.sin(0.3 + off), 0.0, 0.0)
        return float(path_frame_backstepping(error, motion, 1.0, 0.1, 0.8, 0.2, 50.0).yaw_rate)

    exact = -0.8 * 0.2 * (1.0 - math.tanh(0.2 * e) ** 2) * 0.5 * math.sin(delta) - 0.1 * e * 0.5 * math.cos(delta)
    assert asked(delta) == pytest.approx(exact, abs=1e-12)
    for step in (1e-3, 1e-5, 1e-7):
        assert asked(delta + step) == pytest.approx(exact, abs=2.0 * step)
