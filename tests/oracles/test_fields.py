"""Laws without a memory: the vector field, and the current inside the law; closed forms and quadrature."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from flying import series
from oracles.closed_forms import integrate
from oracles.kinematic import Scene, assert_converges, at, curve, flown, line, water, when

COURSE = 0.5


@pytest.mark.parametrize("curvature", [0.0, 1 / 15.0, -1 / 15.0])
def test_a_right_angle_and_k_equal_to_1_over_d_make_the_field_line_of_sight(curvature: float) -> None:
    """chi_inf = pi / 2, w = d: the same course, so the same flight."""
    extra = water(0.08, 1.0)
    field = f"law: vector_field, approach: {math.pi / 2.0!r}, width: 4.2"
    flights = [
        flown(Scene(curve(curvature), law, "cross_track: 7", 60.0, extra=extra), 0.1)
        for law in (field, "law: line_of_sight, lookahead: 4.2")
    ]
    for channel in ("north", "east", "heading"):
        one, other = (series(flight, channel)[1] for flight in flights)
        assert one == pytest.approx(other, abs=1e-11)
    assert np.abs(series(flights[0], "cross_track")[1][0]) == pytest.approx(7.0)


@pytest.mark.parametrize("seed", range(6))
def test_vector_field_by_quadrature(seed: int) -> None:
    """t = int de / (u sin((2 / pi) chi_inf atan(e / w))), on lines and arcs of both senses."""
    random = np.random.default_rng([33, seed])
    u, w, chi = (float(x) for x in random.uniform([0.3, 2.0, 0.4], [1.2, 9.0, 1.57]))
    curvature = (0.0, 1 / 30.0, -1 / 30.0)[seed % 3]
    side = (1.0, -1.0)[seed // 3]
    e0, e1 = 9.0, 2.0
    time = quad(lambda e: 1.0 / (u * math.sin(2.0 / math.pi * chi * math.atan(e / w))), e1, e0, epsabs=1e-12)[0]
    law = f"law: vector_field, approach: {chi!r}, width: {w!r}"
    scene = Scene(curve(curvature), law, f"cross_track: {side * e0!r}", math.ceil(time) + 2.0, u, log_period=0.1)
    assert_converges(scene, when("cross_track", side * e1), time)


@pytest.mark.parametrize("seed", range(8))
def test_with_the_current_inside_the_error_decays_with_the_way_through_the_water(seed: int) -> None:
    """e = e0 exp(-u t / l) in a current of any direction, on lines and on arcs of both senses alike."""
    random = np.random.default_rng([34, seed])
    u, length, share, towards = (float(x) for x in random.uniform([0.3, 3, 0.05, -3], [1.2, 12, 0.4, 3]))
    curvature = (0.0, 1 / 25.0, -1 / 25.0)[seed % 3]
    e0 = 0.5 * length * (1.0, -1.0)[seed % 2]
    law = f"law: arcsine_with_current, decay_length: {length!r}"
    scene = Scene(curve(curvature), law, f"cross_track: {e0!r}", 20.0, u, extra=water(share * u, towards))
    assert_converges(scene, at("cross_track", 20.0), e0 * math.exp(-20.0 * u / length), scale=abs(e0))


def test_a_heading_that_the_law_asks_for_is_not_turned_again() -> None:
    """`crab` beside a law that has the current inside changes nothing of its heading."""
    law = "law: arcsine_with_current, decay_length: 6"
    none, crab = (
        flown(Scene(line(COURSE), law, "cross_track: 4", 60.0, extra=water(0.2, 2.0, compensation)), 0.1)
        for compensation in ("none", "crab")
    )
    for channel in ("north", "east", "heading"):
        assert np.array_equal(series(none, channel)[1], series(crab, channel)[1])


def test_without_an_estimate_it_is_maurya_s_law_of_the_way() -> None:
    """Unknown, a current V across leaves e = V l / u, as gain k1 = u / l would: row D."""
    extra = water(0.1, COURSE + math.pi / 2.0, observer="none")
    scene = Scene(line(COURSE), "law: arcsine_with_current, decay_length: 6", "cross_track: 0", 400.0, extra=extra)
    assert series(flown(scene, 0.1), "cross_track")[1][-1] == pytest.approx(0.1 * 6.0 / 0.5, abs=1e-9)


def test_saturated_it_approaches_at_99_percent() -> None:
    """sat(e / l + Vperp / u): from 40 m in a current across; integrated independently."""

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [0.1 - 0.5 * min(max(y[0] / 6.0 + 0.1 / 0.5, -0.99), 0.99)]

    extra = water(0.1, COURSE + math.pi / 2.0)
    scene = Scene(line(COURSE), "law: arcsine_with_current, decay_length: 6", "cross_track: 40", 60.0, extra=extra)
    e = integrate(rates, [40.0], 60.0)[0]
    assert e == pytest.approx(40.0 - 60.0 * 0.395, abs=1e-9)  # saturated all the way
    assert series(flown(scene, 0.1), "cross_track")[1][60] == pytest.approx(e, abs=1e-9)
