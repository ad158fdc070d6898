"""The hull in four degrees of freedom: against scipy, closed forms, and what physics does not allow."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.maths.integrators import approach, way_made
from cardume.signals import Water
from cardume.vehicles.hull import Pose, Velocity, steady_sway, sway_step
from vehicles.rig import HULL, I_R, M_U, M_V, M_W, equations, glide, push, solved

ORIGIN = Pose(0.0, 0.0, 50.0, 0.4)
speeds = st.floats(-1.0, 1.0)


def oracle(
    pose: Pose, velocity: Velocity, force: tuple[float, float, float], duration: float, water: Water
) -> np.ndarray:
    return solved(lambda t, y: equations(y, *force, water), [*pose, *velocity], 0.0, duration)


@given(u=speeds, v=speeds, w=speeds, r=speeds, thrust=st.floats(-70, 70), moment=st.floats(-10, 10))
def test_a_second_of_motion_is_that_of_an_independent_solver(u, v, w, r, thrust, moment) -> None:
    velocity, water = Velocity(u, v, w, r), Water(0.2, -0.3)
    pose, after = glide(ORIGIN, velocity, push(thrust, moment, 20.0), 1.0, 0.01, water)
    wanted = oracle(ORIGIN, velocity, (thrust, moment, 20.0), 1.0, water)
    assert np.allclose([*pose, *after], wanted, rtol=0.0, atol=2e-6)  # |v| v has a kink at rest: second order there


@pytest.mark.parametrize("heading", [0.0, 0.4, 2.5])
def test_halving_the_step_makes_the_error_sixteen_times_smaller(heading: float) -> None:
    start, velocity, water = Pose(0.0, 0.0, 50.0, heading), Velocity(0.3, -0.1, 0.1, 0.5), Water(0.1, 0.2)
    force = (10.0, 3.0, 8.0)
    wanted = oracle(start, velocity, force, 1.6, water)

    def errors(dt: float) -> np.ndarray:
        pose, after = glide(start, velocity, push(*force), 1.6, dt, water)
        return np.array([*pose, *after]) - wanted

    for part in (slice(0, 2), slice(2, 4), slice(4, 8)):
        coarse, fine = np.linalg.norm(errors(0.05)[part]), np.linalg.norm(errors(0.025)[part])
        assert coarse > 12.0 * fine
    assert np.abs(errors(0.05)).max() < 1e-7


def test_a_hull_left_alone_slows_down_as_the_closed_form_says() -> None:
    # m_u u' = -D u^2  =>  u = u0 / (1 + D u0 t / m_u)
    _, after = glide(ORIGIN, Velocity(1.2, 0.0, 0.0, 0.0), push(0.0, 0.0, 0.0), 10.0, 0.05)
    assert after.surge == pytest.approx(1.2 / (1.0 + 27.5 / 50.0 * 1.2 * 10.0), abs=1e-8)


def kinetic_energy(velocity: Velocity) -> float:
    u, v, w, r = velocity
    return 0.5 * (M_U * u * u + M_V * v * v + M_W * w * w + I_R * r * r)


@given(u=speeds, v=speeds, w=speeds, r=st.floats(-1.5, 1.5))
def test_without_thrust_kinetic_energy_never_grows(u: float, v: float, w: float, r: float) -> None:
    pose, velocity = ORIGIN, Velocity(u, v, w, r)
    for _ in range(40):
        before = kinetic_energy(velocity)
        pose, velocity = glide(pose, velocity, push(0.0, 0.0, 0.0), 0.05, 0.05)
        assert kinetic_energy(velocity) <= before * (1.0 + 1e-12)


@pytest.mark.parametrize("thrust", [0.6, 6.875, 40.0, -20.0])
def test_terminal_speeds(thrust: float) -> None:
    _, after = glide(ORIGIN, Velocity(0.0, 0.0, 0.0, 0.0), push(thrust, 0.0, thrust), 200.0, 0.1)
    assert after.surge == pytest.approx(math.copysign(math.sqrt(abs(thrust) / 27.5), thrust), abs=1e-6)
    heave = (-4.1879 + math.sqrt(4.1879**2 + 4.0 * 40.9649 * abs(thrust))) / (2.0 * 40.9649)
    assert after.heave == pytest.approx(math.copysign(heave, thrust), abs=1e-6)


def test_above_068_meters_a_second_the_hull_does_not_keep_its_course() -> None:
    # (m_v - m_u) m_u u^2 / Y_v > N_r: the Munk moment of the sway that a turn makes beats the yaw drag
    def growth(u: float) -> float:
        nudge = Velocity(u, 0.0, 0.0, 1e-6)
        return glide(ORIGIN, nudge, push(27.5 * u * u, 0.0, 0.0), 40.0, 0.1)[1].yaw_rate / 1e-6

    assert growth(0.66) < 1.0 < growth(0.70)


@pytest.mark.parametrize("mirrored", ["still", "moving"])
def test_mirroring_the_scene_mirrors_the_motion(mirrored: str) -> None:
    water = {"still": Water(0.0, 0.0), "moving": Water(0.1, 0.3)}[mirrored]
    pose, after = glide(ORIGIN, Velocity(0.5, 0.1, 0.2, 0.3), push(5.0, 1.0, 2.0), 5.0, 0.05, water)
    other_pose, other = glide(
        Pose(0.0, 0.0, 50.0, -0.4),
        Velocity(0.5, -0.1, 0.2, -0.3),
        push(5.0, -1.0, 2.0),
        5.0,
        0.05,
        Water(water.north, -water.east),
    )
    assert other_pose == pytest.approx((pose.north, -pose.east, pose.depth, -pose.heading), abs=1e-14)
    assert other == pytest.approx((after.surge, -after.sway, after.heave, -after.yaw_rate), abs=1e-14)


def test_a_current_carries_the_hull_and_changes_nothing_else() -> None:
    start, force = Velocity(0.5, 0.1, 0.2, 0.3), push(5.0, 1.0, 2.0)
    still, slow = glide(ORIGIN, start, force, 20.0, 0.05)
    carried, same = glide(ORIGIN, start, force, 20.0, 0.05, Water(0.3, -0.7))
    assert same == slow
    assert carried.north - still.north == pytest.approx(20.0 * 0.3, abs=1e-12)
    assert carried.east - still.east == pytest.approx(20.0 * -0.7, abs=1e-12)


ROW_G = [  # speed, radius, cross-track error of line of sight with d = 5 m, sway
    (0.5, 12.0, -0.1804055481, -0.0180405548),
    (1.0, 12.0, -0.3290985454, -0.0658197091),
    (0.5, 12.0, 0.0, -0.0183035802),  # with the sway compensated
]


@pytest.mark.parametrize(("surge", "radius", "error", "sway"), ROW_G)
def test_the_sway_of_a_steady_turn(surge: float, radius: float, error: float, sway: float) -> None:
    yaw_rate = math.hypot(surge, sway) / (radius - error)
    assert steady_sway(surge, yaw_rate, 50.0, 55.1, 101.0) == pytest.approx(sway, abs=1e-9)
    assert steady_sway(surge, -yaw_rate, 50.0, 55.1, 101.0) == pytest.approx(-sway, abs=1e-9)
    if error == pytest.approx(-0.1804055481):
        assert yaw_rate == pytest.approx(0.0410762477, abs=1e-10)


def test_the_turn_that_the_moment_holds_has_that_sway() -> None:
    surge, yaw_rate = 0.5, 0.0410762477
    sway = steady_sway(surge, yaw_rate, 50.0, 55.1, 101.0)
    thrust = 27.5 * surge**2 - 60.0 * sway * yaw_rate
    moment = 4.14 * yaw_rate + 6.23 * yaw_rate**2 + 10.0 * surge * sway
    _, after = glide(ORIGIN, Velocity(0.5, 0.0, 0.0, 0.0), push(thrust, moment, 0.0), 200.0, 0.1)
    assert after == pytest.approx((surge, sway, 0.0, yaw_rate), abs=1e-9)


def test_without_quadratic_drag_the_sway_is_linear() -> None:
    assert steady_sway(0.5, 0.1, 50.0, 55.1, 0.0) == pytest.approx(-50.0 * 0.05 / 55.1, rel=1e-14)


@pytest.mark.parametrize("dt", [0.05, 0.5, 20.0])
def test_the_estimate_of_sway_settles_there_with_any_step(dt: float) -> None:
    sway = 0.0
    for _ in range(1200):
        sway = sway_step(sway, 0.5, 0.2, 50.0, 60.0, 55.1, 101.0, dt)
    assert sway == pytest.approx(steady_sway(0.5, 0.2, 50.0, 55.1, 101.0), rel=1e-12)


def test_the_estimate_of_sway_follows_the_hull() -> None:
    pose, velocity, sway, worst = ORIGIN, Velocity(0.5, 0.0, 0.0, 0.0), 0.0, 0.0
    for k in range(400):
        sway = sway_step(sway, velocity.surge, velocity.yaw_rate, 50.0, 60.0, 55.1, 101.0, 0.05)
        moment = 2.0 if k < 100 else -2.0
        pose, velocity = glide(pose, velocity, push(8.0, moment, 0.0), 0.05, 0.05)
        worst = max(worst, abs(velocity.sway - sway))
    assert worst < 0.01
    assert abs(velocity.sway) > 0.1


def test_way_made_is_exact_for_a_body_that_does_not_turn() -> None:
    north, east = way_made(0.7, 0.0, 0.4, -0.2, 0.3, 0.1)
    assert north == pytest.approx(0.4 * math.cos(0.7) + 0.2 * math.sin(0.7), abs=1e-15)
    assert east == pytest.approx(0.4 * math.sin(0.7) - 0.2 * math.cos(0.7), abs=1e-15)


def test_a_lag_is_exact_whatever_the_step() -> None:
    once = approach(3.0, -1.0, 2.0, 5.0)
    twice = approach(approach(3.0, -1.0, 2.0, 1.3), -1.0, 2.0, 3.7)
    assert once == pytest.approx(-1.0 + 4.0 * math.exp(-2.5), abs=1e-14)
    assert twice == pytest.approx(once, abs=1e-14)
    assert approach(3.0, -1.0, 0.0, 1e-9) == -1.0


def test_the_rig_knows_the_same_hull_as_the_model() -> None:
    assert HULL.surge_coupling == pytest.approx(1.2)
    assert HULL.yaw_coupling == pytest.approx(-10.0 / 4.64)
