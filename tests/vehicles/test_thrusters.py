"""Thrusters: delay and lag to the digit, sharing, dead zone, saturation."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.signals import Command
from cardume.vehicles.medusa_data import (
    DEAD_ZONE,
    MAX_SHAFT_SPEED,
    MOTOR_DELAY,
    MOTOR_POLE,
    THRUST_COEFFICIENT,
    THRUSTER_ARM,
)
from cardume.vehicles.thrusters import (
    SLOTS,
    ShaftSpeeds,
    ThrusterPlant,
    Thrusters,
    allocate,
    shaft_speed_for,
    smallest_plant_step,
    started_thrusters,
    thruster_force,
    thruster_plant,
    turned_shafts,
)
from vehicles.rig import NEWTONS_PER_RPM2, fresh

RPM = 2.0 * math.pi / 60.0
LARGEST = NEWTONS_PER_RPM2 * 4500.0**2


def share(thrust: float, moment: float, down: float = 0.0) -> tuple[float, float, float]:
    """Forces that the thrusters are told to make."""
    shafts = allocate(Command(thrust, moment, down), plant_with(0.05))
    port, starboard, vertical = (thruster_force(n, THRUST_COEFFICIENT) for n in shafts)
    return port, starboard, vertical


def plant_with(dt: float, delay: float = MOTOR_DELAY) -> ThrusterPlant:
    return thruster_plant(dt, THRUST_COEFFICIENT, MAX_SHAFT_SPEED, DEAD_ZONE, MOTOR_POLE, delay, THRUSTER_ARM)


def started(force: float = 0.0) -> Thrusters:
    return started_thrusters(fresh(), shaft_speed_for(force, 1.0 / THRUST_COEFFICIENT, 0.0))


def test_farols_thruster_curve() -> None:
    assert thruster_force(1500.0 * RPM, THRUST_COEFFICIENT) == pytest.approx(4.0, rel=1e-5)
    assert thruster_force(-4500.0 * RPM, THRUST_COEFFICIENT) == pytest.approx(-36.0, rel=1e-5)
    assert pytest.approx(4500.0) == MAX_SHAFT_SPEED / RPM


@given(st.floats(-20.0, 20.0), st.floats(-4.0, 4.0), st.floats(-70.0, 70.0))
def test_what_fits_is_shared_exactly(thrust: float, moment: float, down: float) -> None:
    port, starboard, vertical = share(thrust, moment, down)
    least = LARGEST * DEAD_ZONE**2
    wanted = 0.5 * thrust + moment / 0.3, 0.5 * thrust - moment / 0.3, 0.5 * down
    for got, force in zip((port, starboard, vertical), wanted, strict=True):
        assert got == pytest.approx(force if abs(force) > least else 0.0, abs=1e-12) or abs(abs(force) - least) < 1e-9


def test_a_positive_moment_pushes_harder_to_port() -> None:
    port, starboard, _ = share(10.0, 1.0)
    assert port > starboard
    assert THRUSTER_ARM * (port - starboard) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("thrust", "moment", "port", "starboard"),
    [
        (1e3, 0.0, LARGEST, LARGEST),
        (-1e3, 0.0, -LARGEST, -LARGEST),
        (1e3, 1e3, LARGEST, -LARGEST),  # all for the yaw
        (1e3, 4.5, LARGEST, LARGEST - 30.0),  # thrust gets what yaw leaves
        (-1e3, 4.5, 30.0 - LARGEST, -LARGEST),
        (0.0, -1e3, -LARGEST, LARGEST),
    ],
)
def test_saturation_keeps_the_yaw(thrust: float, moment: float, port: float, starboard: float) -> None:
    got_port, got_starboard, _ = share(thrust, moment)
    assert got_port == pytest.approx(port, abs=1e-9)
    assert got_starboard == pytest.approx(starboard, abs=1e-9)
    within = max(-0.3 * LARGEST, min(0.3 * LARGEST, moment))
    assert THRUSTER_ARM * (got_port - got_starboard) == pytest.approx(within, abs=1e-9)


def test_the_dead_zone_is_86_permille_of_the_shaft_speed() -> None:
    edge = 2.0 * NEWTONS_PER_RPM2 * (0.086 * 4500.0) ** 2  # of both thrusters: 0.53 N
    assert share(0.999 * edge, 0.0)[:2] == (0.0, 0.0)
    assert share(1.001 * edge, 0.0)[0] == pytest.approx(0.5 * 1.001 * edge)
    assert share(-0.999 * edge, 0.0, 0.999 * edge) == (0.0, 0.0, 0.0)
    assert share(-1.001 * edge, 0.0)[1] == pytest.approx(-0.5 * 1.001 * edge)


def respond(commands: list[float], dt: float, delay: float) -> list[tuple[float, float]]:
    """Speeds of the port shaft halfway through each step and at its end."""
    memory, plant, seen = started(), plant_with(dt, delay), []
    for command in commands:
        middle, memory = turned_shafts(memory, ShaftSpeeds(command, -command, 2.0 * command), plant)
        assert middle.starboard == -middle.port
        assert memory.vertical == pytest.approx(2.0 * memory.port, abs=1e-12)
        seen.append((middle.port, memory.port))
    return seen


def closed_form(commands: list[float], dt: float, delay: float, time: float) -> float:
    """Sum of the delayed step responses of all changes of the command."""
    before, speed = 0.0, 0.0
    for k, command in enumerate(commands):
        since = time - k * dt - delay
        if since > 0.0:
            speed += (command - before) * -math.expm1(-MOTOR_POLE * since)
        before = command
    return speed


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.3, MOTOR_DELAY, 1.0])
@pytest.mark.parametrize("dt", [0.02, 0.0345, 0.05, 0.1, 0.25, 0.5])
def test_delay_and_lag_are_exact_for_any_plant_step(dt: float, delay: float) -> None:
    rng = np.random.default_rng(1)
    commands = [100.0] * 8 + list(rng.uniform(-300.0, 300.0, 120))  # longer than the ring
    for k, (middle, end) in enumerate(respond(commands, dt, delay)):
        assert middle == pytest.approx(closed_form(commands, dt, delay, (k + 0.5) * dt), abs=1e-9)
        assert end == pytest.approx(closed_form(commands, dt, delay, (k + 1.0) * dt), abs=1e-9)


def test_nothing_turns_before_the_delay_is_over() -> None:
    times = [(k + 1) * 0.05 for k in range(8)]
    ends = [end for _, end in respond([200.0] * 8, 0.05, MOTOR_DELAY)]
    assert all((end == 0.0) == (time <= MOTOR_DELAY) for time, end in zip(times, ends, strict=True))


def test_a_vehicle_that_starts_moving_starts_with_the_thrusters_for_it() -> None:
    memory, plant = started(force=3.0), plant_with(0.05)
    for _ in range(6):
        _, memory = turned_shafts(memory, ShaftSpeeds(0.0, 0.0, 0.0), plant)
        assert thruster_force(memory.port, THRUST_COEFFICIENT) == pytest.approx(3.0)
    for _ in range(100):
        _, memory = turned_shafts(memory, ShaftSpeeds(0.0, 0.0, 0.0), plant)
    assert memory.port == pytest.approx(0.0, abs=1e-9)
    assert started_thrusters(memory, 9.0) == memory


def test_a_delay_longer_than_the_ring_is_not_silently_shortened() -> None:
    shortest = smallest_plant_step(MOTOR_DELAY)
    assert shortest == pytest.approx(MOTOR_DELAY / (SLOTS - 1))
    fine = respond([100.0] * 70, shortest * (1.0 + 1e-9), MOTOR_DELAY)
    assert np.isfinite(fine).all()
    _, memory = turned_shafts(started(), ShaftSpeeds(100.0, 100.0, 100.0), plant_with(0.9 * shortest))
    assert math.isnan(memory.port)
