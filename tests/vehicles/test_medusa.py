"""MEDUSA as a whole: the thrusters drive the hull as scipy says, and the surface, the start and the power are right."""

import math

import numpy as np
import pytest

from cardume.onboard.estimation.speed import thruster_calibration
from cardume.signals import Command, ShaftReading, VesselState, Water
from vehicles.rig import NEWTONS_PER_RPM2, equations, fly, solved

MOTOR_DELAY, MOTOR_POLE = 0.345, 7.2115  # farol's, typed again
COMMAND = Command(12.0, 0.8, 6.0)
POSE_AND_VELOCITY = ("north", "east", "depth", "heading", "surge", "sway", "heave", "yaw_rate")
HOLDS_HALF = Command(27.5 * 0.25, 0.0, 0.0)  # the thrust for 0.5 m/s


def numbers(vessel: VesselState) -> list[float]:
    return [getattr(vessel, name) for name in POSE_AND_VELOCITY]


def oracle(command: Command, duration: float, water: Water) -> np.ndarray:
    """A constant command from rest: nothing for the delay, then shafts that approach their speed."""
    rpm = [
        math.copysign(math.sqrt(abs(force) / NEWTONS_PER_RPM2), force)
        for force in (
            0.5 * command.thrust + command.yaw_moment / 0.3,
            0.5 * command.thrust - command.yaw_moment / 0.3,
            0.5 * command.heave_force,
        )
    ]

    def rates(t: float, y: np.ndarray) -> list[float]:
        turned = -math.expm1(-MOTOR_POLE * (t - MOTOR_DELAY))
        port, starboard, down = (NEWTONS_PER_RPM2 * (n * turned) * abs(n * turned) for n in rpm)
        return equations(y, port + starboard, 0.15 * (port - starboard), 2.0 * down, water)

    start = [MOTOR_DELAY * water.north, MOTOR_DELAY * water.east, *[0.0] * 6]
    return solved(rates, start, MOTOR_DELAY, duration)


def test_a_step_of_all_commands_moves_it_as_scipy_says() -> None:
    water = Water(0.1, -0.2)
    got = numbers(fly(COMMAND, 10.0, 0.05, water=water)[-1])
    assert np.allclose(got, oracle(COMMAND, 10.0, water), rtol=0.0, atol=2e-4)
    finer = numbers(fly(COMMAND, 10.0, 0.0125, water=water)[-1])
    assert np.allclose(finer, oracle(COMMAND, 10.0, water), rtol=0.0, atol=2e-5)


def test_with_a_delay_of_whole_steps_the_whole_plant_is_of_fourth_order() -> None:
    def at(dt: float) -> np.ndarray:
        return np.array(numbers(fly(COMMAND, 4.0, dt, motor_delay=0.4)[-1]))

    exact = at(0.0125)
    coarse, fine = np.abs(at(0.1) - exact), np.abs(at(0.05) - exact)
    assert (coarse / fine > 11.0).all()
    assert fine.max() < 1e-5


def test_it_settles_at_the_speed_of_its_thrust() -> None:
    end = fly(HOLDS_HALF, 60.0)[-1]
    assert end.surge == pytest.approx(0.5, abs=1e-6)
    assert end.thrust == pytest.approx(HOLDS_HALF.thrust, abs=1e-6)
    assert end.shaft_speed == pytest.approx(math.sqrt(0.5 * end.thrust / NEWTONS_PER_RPM2) * math.pi / 30.0, rel=1e-9)
    assert thruster_calibration(ShaftReading(end.shaft_speed)) == pytest.approx(0.5, abs=1e-6)
    assert end.power == pytest.approx(0.5 * HOLDS_HALF.thrust, abs=1e-5)


def test_shaft_speed_tells_the_thrust_also_while_the_thrusters_differ() -> None:
    end = fly(Command(8.0, 1.5, 0.0), 30.0)[-1]
    rpm = end.shaft_speed * 30.0 / math.pi
    assert 2.0 * NEWTONS_PER_RPM2 * rpm * abs(rpm) == pytest.approx(8.0, abs=1e-9)
    assert end.yaw_moment == pytest.approx(1.5, abs=1e-9)


def test_a_vehicle_that_starts_with_a_speed_keeps_it() -> None:
    states = fly(HOLDS_HALF, 5.0, start=VesselState(surge=0.5))
    assert [s.surge for s in states] == pytest.approx([0.5] * len(states), abs=1e-12)
    coasting = fly(Command(), 5.0, start=VesselState(surge=0.5))
    slower = np.diff([s.surge for s in coasting])
    assert slower[:5] == pytest.approx(0.0, abs=1e-12)
    assert (slower[8:] < 0.0).all()


def test_mirrored_commands_make_a_mirrored_way() -> None:
    one = fly(Command(12.0, 0.8, 6.0), 20.0)[-1]
    other = fly(Command(12.0, -0.8, 6.0), 20.0)[-1]
    for name in POSE_AND_VELOCITY:
        sign = -1.0 if name in ("east", "heading", "sway", "yaw_rate") else 1.0
        assert getattr(other, name) == sign * getattr(one, name)
    assert (other.power, other.shaft_speed, other.yaw_moment) == (one.power, one.shaft_speed, -one.yaw_moment)


def test_water_that_moves_carries_the_vehicle_and_changes_nothing_else() -> None:
    still, carried = fly(COMMAND, 20.0)[-1], fly(COMMAND, 20.0, water=Water(0.3, -0.1))[-1]
    assert numbers(carried)[2:] == numbers(still)[2:]
    assert carried.north - still.north == pytest.approx(6.0, abs=1e-12)
    assert carried.east - still.east == pytest.approx(-2.0, abs=1e-12)


def test_a_turned_scene_turns_the_way() -> None:
    still, turned = fly(COMMAND, 20.0)[-1], fly(COMMAND, 20.0, start=VesselState(heading=2.0))[-1]
    c, s = math.cos(2.0), math.sin(2.0)
    assert turned.north == pytest.approx(c * still.north - s * still.east, abs=1e-12)
    assert turned.east == pytest.approx(s * still.north + c * still.east, abs=1e-12)


def test_the_surface_holds() -> None:
    assert all(s.depth == 0.0 and s.heave == 0.0 for s in fly(Command(0.0, 0.0, -20.0), 10.0))
    rising = fly(Command(0.0, 0.0, -5.0), 60.0, start=VesselState(depth=2.0))
    assert min(s.depth for s in rising) == 0.0
    assert rising[-1].depth == 0.0
    assert rising[-1].heave == 0.0
    assert fly(Command(0.0, 0.0, 5.0), 10.0)[-1].depth > 0.5


def test_it_is_neutrally_buoyant_and_can_dive() -> None:
    assert fly(Command(), 20.0, start=VesselState(depth=7.0))[-1].depth == 7.0
    assert fly(Command(0.0, 0.0, 72.0), 30.0)[-1].heave == pytest.approx(1.276, abs=0.01)


def test_heading_is_never_wrapped() -> None:
    states = fly(Command(0.0, 5.0, 0.0), 60.0)
    assert states[-1].heading > 8.0 * math.pi
    assert max(np.abs(np.diff([s.heading for s in states]))) < 0.1


def test_power_counts_every_thruster_as_positive() -> None:
    assert fly(Command(20.0, 0.0, 0.0), 0.05)[-1].power == 0.0
    spinning = fly(Command(0.0, 3.0, 0.0), 20.0)[-1]
    assert spinning.thrust == pytest.approx(0.0, abs=1e-9)
    assert spinning.power == pytest.approx(10.0 * 2.0 * 0.15 * abs(spinning.yaw_rate), rel=1e-6)
    diving = fly(Command(0.0, 0.0, 30.0), 20.0)[-1]
    assert diving.power == pytest.approx(30.0 * diving.heave, rel=1e-6)
    assert min(s.power for s in fly(Command(-20.0, 3.0, -9.0), 20.0, start=VesselState(depth=30.0, surge=0.5))) >= 0.0


def test_a_stronger_thruster_is_faster_by_its_root() -> None:
    coefficient = 1.1 * NEWTONS_PER_RPM2 * (30.0 / math.pi) ** 2
    # the allocation knows the thruster, so the shafts turn slower and the calibration reads too little
    end = fly(HOLDS_HALF, 60.0, thrust_coefficient=coefficient)[-1]
    assert end.surge == pytest.approx(0.5, abs=1e-6)
    assert end.surge / thruster_calibration(ShaftReading(end.shaft_speed)) == pytest.approx(math.sqrt(1.1), rel=1e-6)


@pytest.mark.parametrize("field", ["thrust", "yaw_moment", "heave_force"])
def test_what_is_not_a_number_shows(field: str) -> None:
    end = fly(COMMAND._replace(**{field: math.nan}), 1.0)[-1]
    assert any(math.isnan(x) for x in numbers(end))
