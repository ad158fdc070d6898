"""Closed form Y and errata (24)-(31): the virtual target, with Frenet's equations integrated beside it."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cardume.simulation.flight import Flight
from flying import fly_text, series, value_at
from oracles.kinematic import Quantity, Scene, assert_converges, converged, flown, line, water

U, D, COURSE, BEARING = 0.5, 5.0, 0.5, 0.7
WORST = math.sqrt(2.0) - 1.0  # cos(beta) at which the literal (27) does most harm


def frenet(
    s1: float, e: float, time: float, *, c: float = 0.0, k2: float = 0.5, u: float = U, d: float = D
) -> tuple[float, float, float]:
    """s1, e and the target's way s [m], by (25), (26) and (27) corrected, with line of sight."""

    def rates(_: float, x: np.ndarray) -> list[float]:
        beta = math.atan2(-x[1], d)
        target = u * math.cos(beta) + k2 * x[0]
        return [u * math.cos(beta) - target * (1.0 - c * x[1]), u * math.sin(beta) - c * x[0] * target, target]

    way = solve_ivp(rates, (0.0, time), [s1, e, 0.0], rtol=1e-11, atol=1e-12)
    return tuple(way.y[:, -1])


def place(s: float, c: float) -> tuple[float, float, float]:
    """North, east and course of the path at s: the line of `kinematic.line`, or a circle about the origin."""
    if c == 0.0:
        return 3.0 + s * math.cos(COURSE), -2.0 + s * math.sin(COURSE), COURSE
    bearing = BEARING + c * s
    return math.cos(bearing) / abs(c), math.sin(bearing) / abs(c), bearing + math.copysign(0.5 * math.pi, c)


def scene(
    s1: float,
    e: float,
    duration: float,
    *,
    c: float = 0.0,
    law: str = "",
    k2: float = 0.5,
    extra: str = "",
    tick_log=0.0,
) -> Scene:
    """A vehicle seen at (s1, e) by a target at the start of the path, heading as line of sight wants."""
    north, east, course = place(0.0, c)
    north, east = (
        north + s1 * math.cos(course) - e * math.sin(course),
        east + s1 * math.sin(course) + e * math.cos(course),
    )
    turn = "starboard" if c > 0.0 else "port"
    path = (
        f"type: circle, centre: {{north: 0, east: 0}}, radius: {1.0 / abs(c)!r}, turn: {turn}, start_bearing: {BEARING}"
        if c
        else line(COURSE)
    )
    guidance = f"law: line_of_sight, lookahead: {D!r}, reference_point: {law or 'virtual_target'}, target_gain: {k2!r}"
    heading = course + math.atan2(-e, D)
    start = f"north: {north!r}, east: {east!r}, heading: {heading!r}"
    return Scene(path, guidance, start, duration, U, log_period=tick_log or 1.0, extra=extra)


def seen(time: float, c: float, which: int) -> Quantity:
    """s1 (0) or e (1) from where the vehicle truly is and where its target is."""

    def value(flight: Flight) -> float:
        north, east, course = place(value_at(flight, "coordination_state_estimate", time), c)
        there = value_at(flight, "north", time) - north, value_at(flight, "east", time) - east
        axes = ((math.cos(course), math.sin(course)), (-math.sin(course), math.cos(course)))
        return there[0] * axes[which][0] + there[1] * axes[which][1]

    return value


@pytest.mark.parametrize(("s1", "e", "k2"), [(3.0, -4.0, 0.5), (-10.0, 2.0, 0.5), (6.0, 8.0, 0.07)])
def test_y_on_a_line_s1_decays_whatever_e(s1: float, e: float, k2: float) -> None:
    """Row Y: s1 exp(-k2 t); from far behind the target runs back first."""
    for time in (4.0, 15.0):
        assert_converges(scene(s1, e, 20.0, k2=k2), seen(time, 0.0, 0), s1 * math.exp(-k2 * time), scale=abs(s1))


def test_y_the_target_runs_back_and_gamma_with_it() -> None:
    """s' < 0 where s1 < -u cos(beta) / k2; gamma is along - s1."""
    scene_ = scene(-10.0, 0.0, 10.0)
    times, gamma = series(flown(scene_, 0.1), "coordination_state_estimate")
    assert gamma[1] < gamma[0] == 0.0
    assert gamma.min() < -5.0
    for time in (1.0, 5.0, 10.0):
        expected = -10.0 + U * time + 10.0 * math.exp(-0.5 * time)  # at e = 0 any tick gives it
        assert value_at(flown(scene_, 0.1), "coordination_state_estimate", time) == pytest.approx(expected, abs=1e-9)
    assert times[-1] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("s1", "e", "time", "printed"),
    [
        (3.0, -4.0, 5.0, (-0.0548290164, -2.9268185834)),
        (3.0, -4.0, 20.0, (-0.0638505595, -0.6770304622)),
        (-6.0, 12.0, 20.0, (0.1934718213, 1.7056863879)),
    ],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_y_on_a_circle_at_the_printed_parameters(
    s1: float, e: float, time: float, printed: tuple[float, float], side: float
) -> None:
    """Row Y: c = 1/12, k2 = 0.5; mirrored, c = -1/12."""
    assert frenet(s1, e, time, c=1.0 / 12.0)[:2] == pytest.approx(printed, abs=2e-10)
    scene_ = scene(s1, side * e, 20.0, c=side / 12.0)
    assert_converges(scene_, seen(time, side / 12.0, 0), printed[0], scale=1.0)
    assert converged(scene_, seen(time, side / 12.0, 1))[0] == pytest.approx(side * printed[1], rel=1e-5)


@pytest.mark.parametrize("seed", range(4))
def test_25_26_27_at_random(seed: int) -> None:
    """s1, e and s by Frenet's equations, on lines and circles of both senses."""
    random = np.random.default_rng([27, seed])
    c = (0.0, 1.0, -1.0, 1.0)[seed] / float(random.uniform(8.0, 30.0))
    s1, e, k2 = (float(x) for x in random.uniform([-5.0, -6.0, 0.1], [5.0, 6.0, 1.2]))
    expected = frenet(s1, e, 12.0, c=c, k2=k2)
    scene_ = scene(s1, e, 12.0, c=c, k2=k2)
    assert_converges(scene_, seen(12.0, c, 0), expected[0], scale=1.0)
    assert_converges(scene_, seen(12.0, c, 1), expected[1], scale=1.0)
    assert_converges(scene_, lambda f: value_at(f, "coordination_state_estimate", 12.0), expected[2], scale=1.0)


def slope_of_v(law: str, k2: float) -> float:
    """V' at the start, V = (s1^2 + e^2) / 2 of a flight by a law from where the literal (27) is at its worst."""
    e, s1 = D * math.sqrt(1.0 / WORST**2 - 1.0), U * (WORST - 1.0) / (2.0 * k2)

    def slope(flight: Flight) -> float:
        tick = flight.times[1] - flight.times[0]
        v = [0.5 * sum(seen(t, 0.0, k)(flight) ** 2 for k in (0, 1)) for t in (0.0, tick)]
        return float((v[1] - v[0]) / tick)

    def at(tick: float) -> Flight:
        return flown(scene(s1, e, 0.1, law=law, k2=k2, tick_log=tick), tick)

    coarse, fine = slope(at(0.01)), slope(at(0.005))
    return 2.0 * fine - coarse


@pytest.mark.parametrize(("share", "sign"), [(0.9, 1.0), (0.99, 1.0), (1.01, -1.0), (1.1, -1.0)])
def test_27_to_the_letter_makes_v_grow_below_a_gain(share: float, sign: float) -> None:
    """Erratum (27): V' > 0 somewhere iff k2 d / u < (3 - 2 sqrt2) / 4 = 0.0428932188; corrected it never is."""
    limit = (3.0 - 2.0 * math.sqrt(2.0)) / 4.0
    assert limit == pytest.approx(0.0428932188, abs=1e-10)
    k2 = share * limit * U / D
    e, s1 = D * math.sqrt(1.0 / WORST**2 - 1.0), U * (WORST - 1.0) / (2.0 * k2)
    expected = -k2 * s1 * s1 + s1 * U * (WORST - 1.0) - U * e * e / math.hypot(D, e)
    assert math.copysign(1.0, expected) == sign
    assert slope_of_v("'printed_paths:virtual_target_of_27'", k2) == pytest.approx(expected, rel=2e-3, abs=1e-4)
    right = -k2 * s1 * s1 - U * e * e / math.hypot(D, e)  # (29)
    assert slope_of_v("virtual_target", k2) == pytest.approx(right, rel=1e-5)


def test_27_to_the_letter_runs_ahead_on_a_line() -> None:
    """Erratum (27): s' = u + k2 s1 gives s1' = u (cos(beta) - 1) - k2 s1 on a line."""

    def rates(_: float, x: np.ndarray) -> list[float]:
        beta = math.atan2(-x[1], D)
        return [U * (math.cos(beta) - 1.0) - 0.5 * x[0], U * math.sin(beta)]

    way = solve_ivp(rates, (0.0, 15.0), [0.0, 10.0], rtol=1e-11, atol=1e-12)
    law = "'printed_paths:virtual_target_of_27'"
    assert_converges(scene(0.0, 10.0, 15.0, law=law), seen(15.0, 0.0, 0), float(way.y[0, -1]))


@pytest.mark.parametrize(("form", "left"), [(0.0, 0.0), (1.0, 0.1 / 0.5)])
def test_in_a_current_course_and_ground_speed_leave_nothing(form: float, left: float) -> None:
    """On a line in a current V_par along it: s1 -> 0 over ground, V_par / k2 by heading and speed through the water."""
    sea = water(0.1, COURSE)
    scene_ = scene(3.0, 2.0, 60.0, law=f"virtual_target, through_water: {form!r}", extra=sea)
    expected = left + (3.0 - left) * math.exp(-0.5 * 10.0)
    assert_converges(scene_, seen(10.0, 0.0, 0), expected, scale=1.0)
    value, _ = converged(scene_, seen(60.0, 0.0, 0))
    assert value == pytest.approx(left, abs=1e-5)


def test_a_vehicle_with_a_target_rests_at_the_end() -> None:
    scene_ = scene(2.0, 3.0, 200.0).text(0.1).replace("end: continue", "end: hold")
    flight = fly_text(scene_)
    end = place(50.0, 0.0)
    away = np.hypot(flight.channels["north"][:, 0] - end[0], flight.channels["east"][:, 0] - end[1])
    assert away[-60:].max() < 1.0
    assert flight.channels["speed_desired"][-1, 0] == 0.0


def test_others_are_seen_by_projection_whatever_law_they_fly() -> None:
    """What a head says of a silent diver is the point abeam of it, though the diver's own target lags by meters."""
    flight = fly_text("""
cardume: 1
name: seen
duration: 20 s
path: {type: line, start: {course: 0.3}, length: 200 m}
formation: {speed: 0.5 m/s}
model: kinematic
guidance: {law: line_of_sight, reference_point: virtual_target, target_gain: 0.03}
coordination: {law: laplacian_tanh, gain: 0 m/s}
sensors: ideal
vehicles:
  - name: diver
    messaging: none
    start: {north: 6 m, east: 5 m, speed: 0.5 m/s, heading: 0.3}
  - name: head
    sensors: {gnss: {sigma: 0}, usbl: {range_sigma: 0, angle_sigma: 0}, ahrs: {heading_sigma: 0}, dvl: {}}
  - name: listener
    offset: {starboard: 20 m}
""")
    assert flight.reason == "completed"
    late = flight.times > 3.0
    abeam, believed = (flight.channels[f"coordination_state{of}"][late, 0] for of in ("", "_estimate"))
    assert (abeam - believed).min() > 3.0
    assert abs(flight.neighbor_state_estimate[late, 2, 0] - abeam).max() < 0.6
