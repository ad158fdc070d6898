"""Speed from the shafts, equation (37): the paper's numbers, its own inverse, and its limits."""

import math

import pytest
from hypothesis import given, strategies as st

from cardume.onboard.estimation.speed import proportional, thruster_calibration
from cardume.signals import ShaftReading
from cardume.vehicles.hull import steady_sway
from vehicles.rig import NEWTONS_PER_RPM2

RPM = 2.0 * math.pi / 60.0
PER_RPM2 = NEWTONS_PER_RPM2 / RPM**2  # [N s^2/rad^2]
MEDUSA_2013 = {"thrust_coefficient": PER_RPM2, "num_thrusters": 2.0, "linear_drag": 0.2, "quadratic_drag": 25.0}


def test_the_paper_s_example() -> None:
    assert 2.0 * NEWTONS_PER_RPM2 * 1390.0**2 == pytest.approx(6.86969748, abs=5e-9)
    reading = ShaftReading(1390.0 * RPM)
    assert thruster_calibration(reading) == pytest.approx(0.4998071438, abs=5e-11)  # farol's drag: 27.5 u^2
    # u = (0.2 - sqrt(0.04 + 100 tau)) / -50 with the drag of "Real MEDUSA Vehicle (2013)"
    other = (0.2 - math.sqrt(0.04 + 100.0 * 6.86969748)) / -50.0
    assert thruster_calibration(reading, **MEDUSA_2013) == pytest.approx(other, abs=1e-9)


@pytest.mark.parametrize("believed", [1.1, 0.8])
def test_a_thrust_that_is_believed_too_large_scales_the_speed_by_its_root(believed: float) -> None:
    reading = ShaftReading(1390.0 * RPM)
    wrong = thruster_calibration(reading, thrust_coefficient=believed * PER_RPM2)
    assert wrong / thruster_calibration(reading, thrust_coefficient=PER_RPM2) == pytest.approx(math.sqrt(believed))
    assert thruster_calibration(reading, scale=1.2) == pytest.approx(1.2 * thruster_calibration(reading))


@given(st.floats(-2.0, 2.0), st.floats(0.0, 30.0), st.floats(0.1, 60.0))
def test_it_inverts_the_drag(speed: float, linear: float, quadratic: float) -> None:
    thrust = (linear + quadratic * abs(speed)) * speed
    shaft = math.copysign(math.sqrt(0.5 * abs(thrust) / PER_RPM2), thrust)
    assert thruster_calibration(ShaftReading(shaft), PER_RPM2, 2.0, linear, quadratic) == pytest.approx(speed, abs=1e-9)


def test_edges() -> None:
    assert thruster_calibration(ShaftReading(0.0)) == 0.0  # the default has no linear drag: 0 / 0 unless guarded
    assert thruster_calibration(ShaftReading(90.0)) == -thruster_calibration(ShaftReading(-90.0)) > 0.0
    by_line = thruster_calibration(ShaftReading(100.0), linear_drag=10.0, quadratic_drag=0.0)
    assert by_line == pytest.approx(2.0 * PER_RPM2 * 1e4 / 10.0, rel=1e-5)
    assert math.isnan(thruster_calibration(ShaftReading(math.nan)))


def test_in_a_turn_it_reads_a_little_too_much() -> None:
    # a MEDUSA with the thrust of 0.5 m/s on a circle of 12 m: 27.5 u^2 = 6.875 + 60 v r
    surge = 0.5
    for _ in range(60):
        yaw_rate = surge / 12.0
        for _ in range(20):
            sway = steady_sway(surge, yaw_rate, 50.0, 55.1, 101.0)
            yaw_rate = math.hypot(surge, sway) / 12.0
        surge = math.sqrt((6.875 + 60.0 * sway * yaw_rate) / 27.5)
    assert surge == pytest.approx(0.4983483136, abs=2e-10)
    assert 0.5 / surge == pytest.approx(1.0033143212, abs=2e-10)


def test_the_kinematic_vehicle_s_speed_is_read_as_it_is() -> None:
    assert proportional(ShaftReading(0.4)) == 0.4
    assert proportional(ShaftReading(0.4), 1.2) == pytest.approx(0.48)
