"""A wrong speed scale a, (38)-(43): what the observer converges to, and that crab and observer forgive it together."""

import math

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from cardume.onboard.estimation.current.complementary import Observed
from flying import fly_text, value_at
from oracles.aboard import check_limit, fly_plan, memory_of, relative, uniform, vessel_of

MISSION = """
cardume: 1
name: scale
duration: {duration!r} s
tick: {tick!r} s
log_period: {until!r} s
path: {{type: line, start: {{course: {course!r} rad}}, length: 100 m}}
formation: {{speed: {speed!r} m/s}}
current: {current}
vehicles:
  - name: alone
    model: kinematic
    start: {{cross_track: {cross_track!r}, heading_error: {heading_error!r} rad, speed: {speed!r}}}
    sensors:
      gnss: {{sigma: 0 m, period: {tick!r} s}}
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg, period: {tick!r} s}}
      thruster_speed: {{sigma: 0, scale: {scale!r}, period: {tick!r} s}}
guidance: {{law: line_of_sight, lookahead: {lookahead!r} m}}
end: continue
speed_reference: water
position: {{law: direct}}
current_observer: {{law: complementary, k1: {k1!r}, k2: {k2!r}}}
compensation: {{law: {compensation}}}
"""
TRUE_SPEED = "'printed_compensation:crab_by_true_speed'"


def fly_scale(scale, current, compensation, until=600.0, tick=0.1, **numbers):
    """The state at `until`: (current estimate, total velocity, heading, cross-track error)."""
    chosen = {"course": 0.0, "speed": 0.5, "lookahead": 5.0, "cross_track": 2.0, "heading_error": 0.0}
    chosen |= {"k1": 1.0, "k2": 0.25, **numbers}
    text = MISSION.format(
        duration=until + tick,
        until=until,
        tick=tick,
        scale=scale,
        current=uniform(*current),
        compensation=compensation,
        **chosen,
    )
    flight = fly_text(text)
    estimate = np.array([value_at(flight, f"current_{axis}_estimate", until) for axis in ("north", "east")])
    course, speed = value_at(flight, "course", until), value_at(flight, "speed", until)
    total = speed * np.array([math.cos(course), math.sin(course)])
    return estimate, total, value_at(flight, "heading", until), value_at(flight, "cross_track", until)


def along(heading):
    return np.array([math.cos(heading), math.sin(heading)])


def biased(scale, current, speed, heading):
    """Row K: Vc + (1 - a) R v."""
    return np.asarray(current) + (1.0 - scale) * speed * along(heading)


def test_observer_and_crab_at_the_printed_numbers():
    """Row K: Vc = (.05, .15), a = 1.2: Vhat = (-.04539392, .18), e = 1e-12, V_m + Vhat = V_T."""
    estimate, total, heading, error = fly_scale(1.2, (0.05, 0.15), "crab")
    assert estimate == pytest.approx([-0.04539392, 0.18], abs=5e-9)
    assert abs(error) < 1e-10
    assert 1.2 * 0.5 * along(heading) + estimate == pytest.approx(total, abs=1e-11)  # "the correct total velocity"


@pytest.mark.parametrize("seed", range(6))
def test_observer_and_crab_at_random_scales_courses_and_currents(seed):
    """Row K: psi = chi - asin(Vperp / u), the true one, whatever a; Vhat = Vc + (1 - a) R v; e -> 0."""
    draw = np.random.default_rng(seed)
    scale, course, speed = draw.uniform(0.7, 1.4), draw.uniform(0.0, 6.2), draw.uniform(0.4, 1.0)
    current = 0.5 * speed * draw.uniform(0.2, 1.0) * along(draw.uniform(0.0, 6.2))
    lookahead, k1 = draw.uniform(4.0, 8.0), draw.uniform(0.8, 1.5)
    numbers = {"course": course, "speed": speed, "lookahead": lookahead, "k1": k1, "k2": 0.25 * k1 * k1}
    estimate, total, heading, error = fly_scale(scale, current, "crab", **numbers)
    across = -math.sin(course) * current[0] + math.cos(course) * current[1]
    wanted = course - math.asin(across / speed)
    assert math.remainder(heading - wanted, math.tau) == pytest.approx(0.0, abs=1e-9)
    assert relative(estimate, biased(scale, current, speed, wanted)) < 1e-8
    assert abs(error) < 1e-8
    assert scale * speed * along(heading) + estimate == pytest.approx(total, abs=1e-9)


def static_offset(scale, current, speed, lookahead):
    """The offset from a line north at which chi_d - asin(Vhat_perp / u) with the true u holds the vehicle."""
    heading = -math.asin(current[1] / speed)  # e' = 0
    estimate = biased(scale, current, speed, heading)

    def turn(error):
        course = -math.atan(error / lookahead)
        across = -math.sin(course) * estimate[0] + math.cos(course) * estimate[1]
        return course - math.asin(across / speed) - heading

    return brentq(turn, -3.0 * lookahead, 3.0 * lookahead, xtol=1e-14)


@pytest.mark.parametrize(("scale", "printed"), [(0.8, 0.24101670), (1.2, -0.34756361), (1.5, -1.29989517)])
def test_true_speed_in_the_arcsine_at_the_printed_numbers(scale, printed):
    """Row K, the variant that fails: asin over the true u leaves .24101670, -.34756361, -1.29989517 m."""
    current = (0.05, 0.15)
    assert static_offset(scale, current, 0.5, 5.0) == pytest.approx(printed, abs=5e-9)
    assert fly_scale(scale, current, TRUE_SPEED)[3] == pytest.approx(printed, abs=5e-9)
    assert abs(fly_scale(scale, current, "crab")[3]) < 1e-9


@pytest.mark.parametrize("scale", [0.8, 1.2, 1.5])
def test_residual_cross_flow_of_the_true_speed(scale):
    """Row K, the variant that fails: on the path's course a cross flow V (1 - a) / (2 - a) is left over."""
    _, total, _, _ = fly_scale(scale, (0.05, 0.15), TRUE_SPEED, lookahead=1e9)
    assert total[1] == pytest.approx(0.15 * (1.0 - scale) / (2.0 - scale), rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_true_speed_in_the_arcsine_at_random(seed):
    """Row K, the variant that fails, at random a, Vc, u and lookahead."""
    draw = np.random.default_rng(seed)
    speed, lookahead = draw.uniform(0.4, 0.8), draw.uniform(4.0, 7.0)
    scale = float(draw.choice([draw.uniform(0.7, 0.9), draw.uniform(1.1, 1.4)]))
    current = speed * draw.uniform(-0.3, 0.3, 2)
    wanted = static_offset(scale, current, speed, lookahead)
    found = fly_scale(scale, current, TRUE_SPEED, speed=speed, lookahead=lookahead)[3]
    assert found == pytest.approx(wanted, rel=1e-7)


def steady_heading(current, heading, speed, lookahead):
    """Line of sight without compensation, started where it settles: then the heading is `heading` all the time."""
    total = speed * along(heading) + current
    course = math.atan2(total[1], total[0])
    return {
        "course": course % math.tau,
        "heading_error": heading - course,
        "cross_track": -lookahead * math.tan(heading - course),
        "speed": speed,
        "lookahead": lookahead,
    }


def test_the_factor_is_on_the_speed():
    """Errata of (38), (39) and of "only in the norm": Vhat = (.00789, -.23894), not a Vc = (.12, -.24); along psi."""
    current, scale = np.array([0.1, -0.2]), 1.2
    estimate = fly_scale(scale, current, "none", **steady_heading(current, 0.4, 0.5, 5.0))[0]
    assert estimate == pytest.approx([0.00789, -0.23894], abs=5e-6)
    assert relative(estimate, scale * current) > 0.4  # what (38) says literally
    assert estimate / current == pytest.approx([0.0789, 1.1947], abs=5e-5)  # a wrong norm alone would have equal ratios
    assert math.atan2(*(current - estimate)[::-1]) == pytest.approx(0.4, abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_transient_with_a_wrong_scale(seed):
    """Row K, (40)-(43): at constant heading Vhat(t) is the observer's response to Vc + (1 - a) R v, at first order."""
    draw = np.random.default_rng(seed)
    scale, heading, speed, k1 = (
        draw.uniform(0.7, 1.4),
        draw.uniform(0.0, 6.2),
        draw.uniform(0.4, 1.0),
        draw.uniform(0.1, 1),
    )
    current, k2, until = draw.uniform(-0.15, 0.15, 2), k1 * k1 * draw.uniform(0.1, 1.0), 2.0 / k1
    numbers = {**steady_heading(current, heading, speed, 5.0), "k1": k1, "k2": k2, "until": until}
    gap = (expm(until * np.array([[-k1, 1.0], [-k2, 0.0]])) @ [0.0, 1.0])[1]
    check_limit(
        lambda tick: fly_scale(scale, current, "none", tick=tick, **numbers)[0],
        (1.0 - gap) * biased(scale, current, speed, heading),
        tuple(until / count for count in (200, 400, 800)),
    )


TURN = """
cardume: 1
name: scale-in-a-turn
duration: {duration!r} s
tick: {tick!r} s
plant_step: {tick!r} s
path: {{type: line, length: 10 m}}
formation: {{speed: 0.5 m/s}}
current: {current}
vehicles:
  - name: alone
    model: {{law: 'turning:turning', speed: {speed!r}, yaw_rate: {yaw_rate!r}, sway: {sway!r}}}
    start: {{north: 0 m, east: 0 m, heading: 0.3 rad, speed: {speed!r}}}
    sensors:
      gnss: {{sigma: 0 m, period: {tick!r} s}}
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg, period: {tick!r} s}}
      thruster_speed: {{sigma: 0, reader: proportional, scale: {scale!r}, period: {tick!r} s}}
      depth: none
guidance: {{law: line_of_sight}}
position: {{law: direct}}
current_observer: {{law: complementary, k1: {k1!r}, k2: {k2!r}}}
"""


def turning_errors(speed, sway, yaw_rate, scale, k1, k2, tick):
    """(|p - p_hat|, |Vc - Vc_hat|) in the steady turn."""
    current = (0.06, -0.03)
    text = TURN.format(
        duration=tick * math.ceil(30.0 / abs(np.roots([1.0, k1, k2]).real).min() / tick),
        tick=tick,
        current=uniform(*current),
        speed=speed,
        sway=sway,
        yaw_rate=yaw_rate,
        scale=scale,
        k1=k1,
        k2=k2,
    )
    flown = fly_plan(text)
    memory, vessel = Observed(*memory_of(flown, "current_observer")), vessel_of(flown)
    position = math.hypot(vessel.north - memory.north, vessel.east - memory.east)
    return np.array([position, math.hypot(memory.current_north - current[0], memory.current_east - current[1])])


def forced(error, yaw_rate, k1, k2):
    """A velocity that is wrong by `error` [m/s] and turns: (|e_p|, |dV|) = error (r, k2) / D."""
    return error * np.array([abs(yaw_rate), k2]) / math.hypot(k2 - yaw_rate**2, k1 * yaw_rate)


def test_printed_numbers_of_a_turn():
    """Errata of (39), row L: a = 1.2, R = 12, (.2, .01): .3550295858 m, .0852071006; sway: .0649831250, .0155959500."""
    rate = 0.5 / 12.0
    assert forced(0.1, rate, 0.2, 0.01) == pytest.approx([0.3550295858, 0.0852071006], abs=5e-11)
    assert forced(0.0183035802, rate, 0.2, 0.01) == pytest.approx([0.0649831250, 0.0155959500], abs=5e-11)


@pytest.mark.parametrize("seed", [None, 0, 1])
@pytest.mark.parametrize("is_scale", [True, False])
def test_forced_response_in_a_turn(seed, is_scale):
    """Errata of (39), row L: there is no equilibrium in a turn; |e_p| = |1 - a| u r / D, |dV| = k2 |1 - a| u / D."""
    draw = np.random.default_rng(seed or 0)
    speed, rate, scale, k1, k2 = 0.5, 0.5 / 12.0, 1.2, 0.2, 0.01
    if seed is not None:
        speed, rate, scale = draw.uniform(0.3, 1.0), -draw.uniform(0.02, 0.1), draw.uniform(0.7, 0.9)
        k1 = draw.uniform(0.1, 0.5)
        k2 = k1 * k1 * draw.uniform(0.1, 1.0)
    scale, sway = (scale, 0.0) if is_scale else (1.0, 0.0183035802)
    wanted = forced(abs(1.0 - scale) * speed + sway, rate, k1, k2)
    check_limit(lambda tick: turning_errors(speed, sway, rate, scale, k1, k2, tick), wanted, (0.1, 0.05, 0.025))
