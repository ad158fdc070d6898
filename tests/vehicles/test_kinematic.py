"""The kinematic vehicle: exact on held headings, of fourth order in a lag, and never lost at half a turn."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.maths import wrap_angle
from cardume.signals import Reference, VesselState, Water
from cardume.vehicles import kinematic
from vehicles.rig import STILL, solved

headings = st.floats(-20.0, 20.0)


def reference(heading: float, speed: float, depth: float = 0.0) -> Reference:
    return Reference(heading=heading, speed=speed, depth=depth)


@given(headings, headings, st.floats(0.0, 2.0), st.floats(0.01, 5.0))
def test_without_a_lag_it_goes_straight_where_it_is_told(
    before: float, heading: float, speed: float, dt: float
) -> None:
    vessel = kinematic(VesselState(heading=before, surge=0.3), reference(heading, speed, 4.0), Water(0.1, -0.2), dt)
    assert vessel.north == pytest.approx(dt * (speed * math.cos(heading) + 0.1), abs=1e-12)
    assert vessel.east == pytest.approx(dt * (speed * math.sin(heading) - 0.2), abs=1e-12)
    assert (vessel.surge, vessel.shaft_speed, vessel.depth) == (speed, speed, 4.0)
    assert (vessel.sway, vessel.thrust, vessel.yaw_moment, vessel.power) == (0.0, 0.0, 0.0, 0.0)


@given(headings, headings)
def test_it_turns_the_shorter_way_and_never_wraps(before: float, heading: float) -> None:
    vessel = kinematic(VesselState(heading=before), reference(heading, 1.0), STILL, 0.1)
    assert abs(vessel.heading - before) <= math.pi + 1e-12
    assert math.cos(vessel.heading - heading) == pytest.approx(1.0, abs=1e-12)
    assert vessel.yaw_rate == pytest.approx((vessel.heading - before) / 0.1)


def test_its_heading_counts_whole_turns() -> None:
    vessel = VesselState()
    for k in range(1000):
        vessel = kinematic(vessel, reference(wrap_angle(0.05 * (k + 1)), 0.5), STILL, 0.1)
    assert vessel.heading == pytest.approx(50.0, abs=1e-9)


def test_it_dives_and_surfaces_at_once_but_does_not_fly() -> None:
    diving = kinematic(VesselState(), reference(0.0, 0.0, 3.0), STILL, 0.5)
    assert (diving.depth, diving.heave) == (3.0, 6.0)
    assert kinematic(diving, reference(0.0, 0.0, -2.0), STILL, 0.5).depth == 0.0


@pytest.mark.parametrize("dt", [0.02, 0.5, 3.0])
def test_a_lag_is_exact_whatever_the_step(dt: float) -> None:
    vessel = VesselState(heading=1.0, surge=0.2)
    for _ in range(round(6.0 / dt)):
        vessel = kinematic(vessel, reference(-1.0, 0.8), STILL, dt, 2.0, 4.0)
    assert vessel.heading == pytest.approx(-1.0 + 2.0 * math.exp(-3.0), abs=1e-12)
    assert vessel.surge == pytest.approx(0.8 - 0.6 * math.exp(-1.5), abs=1e-12)


@given(headings, st.floats(-0.5, 0.5), st.floats(0.05, 2.0))
def test_a_yaw_rate_is_had_at_once_and_flown_as_an_arc(before: float, rate: float, dt: float) -> None:
    asked = reference(99.0, 0.8)._replace(yaw_rate=rate)
    vessel = kinematic(VesselState(heading=before), asked, STILL, dt, 3.0)  # no lag of heading is in it
    assert vessel.heading == pytest.approx(before + rate * dt, abs=1e-12)
    assert vessel.yaw_rate == pytest.approx(rate, abs=1e-9)
    half = 0.5 * rate * dt
    chord = 0.8 * dt * (math.sin(half) / half if half else 1.0)
    simpson = 0.8 * dt * half**4 / 175.0 + 1e-12  # its error is that over 180
    assert vessel.north == pytest.approx(chord * math.cos(before + half), abs=simpson)
    assert vessel.east == pytest.approx(chord * math.sin(before + half), abs=simpson)


@given(headings, headings, st.floats(0.01, 3.0), st.booleans())
def test_it_turns_no_faster_than_it_can(before: float, wanted: float, limit: float, by_rate: bool) -> None:
    asked = reference(wanted, 1.0)._replace(yaw_rate=wanted if by_rate else math.nan)
    vessel = kinematic(VesselState(heading=before), asked, STILL, 0.1, yaw_rate_max=limit)
    free = kinematic(VesselState(heading=before), asked, STILL, 0.1)
    turned = min(max(free.heading - before, -0.1 * limit), 0.1 * limit)
    assert vessel.heading == pytest.approx(before + turned, abs=1e-12)
    if vessel.heading == free.heading:
        assert vessel == free


def lagging(dt: float) -> np.ndarray:
    vessel = VesselState(heading=2.9, surge=0.2)
    for _ in range(round(4.0 / dt)):
        vessel = kinematic(vessel, reference(-2.5, 0.8), Water(0.1, 0.05), dt, 1.5, 0.7)
    return np.array([vessel.north, vessel.east])


def test_the_way_in_a_lag_is_of_fourth_order() -> None:
    target = 2.0 * math.pi - 2.5  # the shorter way round

    def rates(t: float, y: np.ndarray) -> list[float]:
        psi, u = target - (target - 2.9) * math.exp(-t / 1.5), 0.8 - 0.6 * math.exp(-t / 0.7)
        return [u * math.cos(psi) + 0.1, u * math.sin(psi) + 0.05]

    wanted = solved(rates, [0.0, 0.0], 0.0, 4.0)
    coarse, fine = np.linalg.norm(lagging(0.2) - wanted), np.linalg.norm(lagging(0.1) - wanted)
    assert coarse > 13.0 * fine
    assert fine < 1e-6


def cross_track_on_a_circle(lag: float, dt: float) -> float:
    """Line of sight (3), d = 5 m, on a circle of R = 12 m to starboard, u = 0.5 m/s, once it has settled."""
    vessel = VesselState(north=0.0, east=-12.0, heading=0.0, surge=0.5)  # the centre is the origin
    for _ in range(round(150.0 / dt)):
        error = 12.0 - math.hypot(vessel.north, vessel.east)
        course = math.atan2(vessel.east, vessel.north) + 0.5 * math.pi + math.atan(-error / 5.0)
        vessel = kinematic(vessel, reference(course, 0.5), STILL, dt, lag)
    return 12.0 - math.hypot(vessel.north, vessel.east)


@pytest.mark.parametrize(("lag", "error"), [(1.0, -0.2049495983), (2.0, -0.4039722593)])
def test_a_lag_shifts_an_arc_outwards(lag: float, error: float) -> None:
    # e = -sigma d tan(T u |c| / (1 - c e)); held references add half a step to T
    coarse, fine = cross_track_on_a_circle(lag, 0.2), cross_track_on_a_circle(lag, 0.1)
    assert fine == pytest.approx(error, abs=0.02)
    assert 2.0 * fine - coarse == pytest.approx(error, abs=2e-5)
