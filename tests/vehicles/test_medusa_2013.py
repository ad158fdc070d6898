"""The MEDUSA of the Simulink model: its numbers, its steps with the autopilot that follows it, and missions."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from numba import config

from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.onboard.control import feedforward_pid
from cardume.onboard.control.feedforward_pid import Helm
from cardume.onboard.estimation.speed import thruster_calibration
from cardume.signals import Command, Feedback, ShaftReading, VesselState, Water
from cardume.vehicles import announce, kinematic, medusa, medusa_2013, variant_of
from cardume.vehicles.thrusters import SLOTS, Thrusters
from flying import fly_text, series
from vehicles.rig import solved

PILOT, READER = medusa_2013.announced["autopilot"], medusa_2013.announced["speed"]
DT = 0.05
Wanted = tuple[float, float, float]  # heading [rad], speed [m/s], depth [m]


def drift(command: Command, duration: float, start: VesselState = VesselState(), water: Water = Water()) -> VesselState:
    """The state after a constant command."""
    vessel, memory = start, Thrusters(commands=np.zeros(3 * SLOTS))
    for _ in range(round(duration / DT)):
        vessel, memory = medusa_2013(vessel, command, water, memory, DT)
    return vessel


def fly(wanted: Callable[[float], Wanted] | Wanted, duration: float, start: VesselState) -> np.ndarray:
    """Rows of time, heading, surge, depth, yaw rate, moment; measured each 0.1 s, steered each 0.05 s."""
    vessel, helm, memory, rows = start, Helm(), Thrusters(commands=np.zeros(3 * SLOTS)), []
    begun = medusa_2013(vessel, Command(), Water(), memory._replace(commands=np.zeros(3 * SLOTS)), DT)[0]
    vessel = vessel._replace(shaft_speed=begun.shaft_speed)
    for tick in range(round(duration / 0.1)):
        now, seen = wanted(0.1 * tick) if callable(wanted) else wanted, vessel
        surge = thruster_calibration(ShaftReading(seen.shaft_speed), **READER)
        for step in range(2):
            heading = seen.heading + step * DT * seen.yaw_rate
            feedback = Feedback(heading, seen.yaw_rate, surge, seen.depth, *now)
            command, helm = feedforward_pid(feedback, helm, DT, **PILOT)
            vessel, memory = medusa_2013(vessel, command, Water(0.1, -0.1), memory, DT)
            time = 0.1 * tick + (step + 1) * DT
            rows.append((time, vessel.heading, vessel.surge, vessel.depth, vessel.yaw_rate, command.yaw_moment))
    return np.array(rows).T


def settled(time: np.ndarray, error: np.ndarray, band: float) -> float:
    outside = np.nonzero(np.abs(error) > band)[0]
    return float(time[outside[-1] + 1]) if len(outside) and outside[-1] + 1 < len(time) else math.inf


# ---- the plant -------------------------------------------------------------------------------------------------------


def equations(command: Command) -> Callable[[float, np.ndarray], list[float]]:
    """The Simulink set, typed again: rates of [north, east, heading, u, v, r] once the shafts turn as commanded."""
    rpm = [
        math.copysign(math.sqrt(abs(force) / (4.0 / 1500.0**2)), force)
        for force in (0.5 * command.thrust + 2.0 * command.yaw_moment, 0.5 * command.thrust - 2.0 * command.yaw_moment)
    ]

    def rates(t: float, y: np.ndarray) -> list[float]:
        turned = -math.expm1(-7.2115 * (t - 0.346))
        port, starboard = (4.0 * (n * turned / 1500.0) * abs(n * turned / 1500.0) for n in rpm)
        _, _, psi, u, v, r = y
        return [
            u * math.cos(psi) - v * math.sin(psi),
            u * math.sin(psi) + v * math.cos(psi),
            r,
            (port + starboard + 47.0 * v * r - 0.2 * u - 25.0 * u * abs(u)) / 37.0,
            (-37.0 * u * r - 50.0 * v - 0.01 * v * abs(v)) / 47.0,
            (0.25 * (port - starboard) - 10.0 * u * v - 4.14 * r - 6.23 * r * abs(r)) / 9.69,
        ]

    return rates


@pytest.mark.parametrize("command", [Command(12.0, 0.8, 0.0), Command(3.0, -2.0, 0.0), Command(50.0, 0.1, 0.0)])
def test_commands_move_it_as_scipy_says(command: Command) -> None:
    end = drift(command, 10.0)
    got = [end.north, end.east, end.heading, end.surge, end.sway, end.yaw_rate]
    # the delay is no whole number of plant steps: the thrusters are exact, the hull is of second order there
    assert got == pytest.approx(solved(equations(command), [0.0] * 6, 0.346, 10.0), abs=6e-4)


def test_its_full_thrust_and_speed() -> None:
    """Two times 36 N at 4500 rpm: 0.2 u + 25 u^2 = 72 N."""
    end = drift(Command(500.0, 0.0, 0.0), 60.0)
    assert end.thrust == pytest.approx(72.0, rel=1e-6)
    assert end.surge == pytest.approx((-0.2 + math.sqrt(0.04 + 100.0 * 72.0)) / 50.0, rel=1e-6)
    assert end.shaft_speed == pytest.approx(4500.0 * math.pi / 30.0, rel=1e-9)


def test_it_has_no_dead_zone() -> None:
    assert drift(Command(0.02, 0.0, 0.0), 200.0).surge > 0.015
    assert (
        medusa(VesselState(), Command(0.02, 0.0, 0.0), Water(), Thrusters(commands=np.zeros(192)), DT)[0].thrust == 0.0
    )


def test_its_calibration_reads_its_speed() -> None:
    end = drift(Command(10.0, 0.0, 0.0), 60.0)
    assert thruster_calibration(ShaftReading(end.shaft_speed), **READER) == pytest.approx(end.surge, rel=1e-6)
    assert thruster_calibration(ShaftReading(end.shaft_speed)) != pytest.approx(end.surge, rel=0.03)


# ---- with its autopilot ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "seconds"), [(0.15, 4.0), (0.5, 5.5), (0.7, 7.2), (1.2, 14.0)])
def test_a_right_angle_without_overshoot(speed: float, seconds: float) -> None:
    time, heading, surge, *_ = fly((0.5 * math.pi, speed, 0.0), 35.0, VesselState(surge=speed))
    turn = heading / (0.5 * math.pi)
    assert turn.max() < 1.02
    assert settled(time, turn - 1.0, 0.05) < seconds
    assert turn[-1] == pytest.approx(1.0, abs=0.02)
    assert surge[-1] == pytest.approx(speed, abs=0.01)


@pytest.mark.parametrize("speed", [0.15, 0.5, 0.9])
def test_a_small_nudge_dies_out(speed: float) -> None:
    _, heading, _, _, rate, _ = fly((0.0, speed, 0.0), 40.0, VesselState(surge=speed, yaw_rate=0.1, heading=0.05))
    assert np.abs(heading[-100:]).max() < math.radians(0.2)
    assert np.abs(rate[-100:]).max() < math.radians(0.1)


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_on_an_arc_the_heading_hardly_lags(turn: float) -> None:
    rate = turn * 0.5 / 12.0
    time, heading, *_ = fly(lambda t: (rate * max(0.0, t - 5.0), 0.5, 0.0), 60.0, VesselState(surge=0.5))
    lag = (rate * (time - 5.0) - heading)[-200:].mean() / rate
    assert abs(lag) < 0.06  # [s]; half a tick of it is the reference's being held


def test_farols_beliefs_do_not_suit_it() -> None:
    """Why the defaults follow the model: with farol's numbers a step overshoots, and the arc has a lag."""
    vessel = VesselState(surge=0.15)
    heading, helm, memory = [], Helm(), Thrusters(commands=np.zeros(3 * SLOTS))
    for _ in range(400):
        feedback = Feedback(vessel.heading, vessel.yaw_rate, vessel.surge, 0.0, 0.5 * math.pi, 0.15, 0.0)
        command, helm = feedforward_pid(feedback, helm, DT)
        vessel, memory = medusa_2013(vessel, command, Water(), memory, DT)
        heading.append(vessel.heading)
    assert max(heading) > 1.06 * 0.5 * math.pi


def test_from_rest_to_half_a_meter_a_second() -> None:
    time, _, surge, *_ = fly((0.0, 0.5, 0.0), 40.0, VesselState())
    assert surge.max() < 0.5 * 1.05
    assert settled(time, surge - 0.5, 0.025) < 5.0
    assert surge[-1] == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize("depth", [2.0, 10.0])
def test_a_dive(depth: float) -> None:
    time, _, _, z, *_ = fly((0.0, 0.5, depth), 20.0 + 2.6 * depth, VesselState(surge=0.5))
    assert z.max() < depth + 0.12
    assert settled(time, z - depth, 0.12) < 8.0 + 2.0 * depth
    assert np.abs(z[-100:] - depth).max() < 0.1


# ---- in missions -----------------------------------------------------------------------------------------------------

MOWER = """
cardume: 1
name: simulink
duration: 340 s
path: {type: lawnmower, leg: 40 m, legs: 3, spacing: 24 m}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
model: medusa_2013
vehicles: [{name: sirene, start: {cross_track: 3 m}, sensors: {gnss: {sigma: 0 m, period: 0.1 s}, ahrs: {}, depth: {}}}]
guidance: {law: line_of_sight, lookahead: 5 m}
current_observer: {law: complementary, k1: 0.5 1/s, k2: 0.06 1/s^2}
compensation: {law: crab}
"""


def test_it_flies_a_lawnmower_in_a_current() -> None:
    """On lines on the path; on arcs outside it by the sway, d v / u = 0.3 m for v = -m_u u r / Y."""
    flight = fly_text(MOWER)
    assert flight.reason == "completed"
    vehicle = flight.metrics.vehicles["sirene"]
    assert vehicle["cross_track_rms_lines"] < 0.12
    assert 0.05 < vehicle["cross_track_rms_arcs"] < 0.3
    assert vehicle["path_speed_mean"] == pytest.approx(0.5, abs=0.01)


def test_its_sway_on_a_circle() -> None:
    """(50 + 0.01 |v|) v = -37 u r, in the mean over the last 100 s on a circle; the compass is noisy."""
    path = "{type: circle, centre: {north: 0 m, east: 0 m}, radius: 12 m, turn: starboard}"
    flight = fly_text(MOWER, [f"path={path}", "current=none", "compensation=none", "current_observer=none"])
    u, v, r = (series(flight, name)[1][-100:] for name in ("surge", "sway", "yaw_rate"))
    assert v.mean() == pytest.approx(-37.0 * np.mean(u * r) / 50.0, rel=5e-3)
    assert -0.017 < v.mean() < -0.014


def test_autopilot_and_calibration_follow_the_model() -> None:
    mission = open_mission("paper/figure-5", overrides=["vehicles.port.model=medusa_2013"])
    surface, port, _ = mission.vehicles
    assert port.autopilot.parameters["surge_mass"] == 37.0
    assert port.autopilot.parameters["heading_gain"] == 10.0
    assert port.autopilot.parameters["speed_bandwidth"] == 0.3  # as the mission says
    assert port.sensors.thruster_speed.reader.parameters["quadratic_drag"] == 25.0
    assert surface.autopilot.parameters["surge_mass"] == 50.0
    assert surface.sensors.thruster_speed.reader.parameters["quadratic_drag"] == 27.5
    assert parse_mission(mission.to_yaml(), catalog()) == mission


def test_what_a_mission_says_of_the_belief_counts() -> None:
    mission = open_mission("paper/figure-5", overrides=["model=medusa_2013", "autopilot.surge_mass=44 kg"])
    assert [v.autopilot.parameters["surge_mass"] for v in mission.vehicles] == [44.0] * 3


def test_with_ideal_sensors_the_reader_follows_too() -> None:
    text = MOWER.replace("sensors: {gnss: {sigma: 0 m, period: 0.1 s}, ahrs: {}, depth: {}}", "sensors: ideal")
    plan = make_plan(parse_mission(text, catalog()), catalog()).plan
    assert plan.vehicles[0].laws["speed"].value("quadratic_drag") == 25.0


def test_a_model_that_varies_must_announce_the_same() -> None:
    with pytest.raises(MissionError, match="medusa and medusa_2013 want different autopilots"):
        open_mission("paper/figure-5", overrides=["model={sweep: [medusa, medusa_2013]}"])
    open_mission("paper/figure-5", overrides=["model={sweep: [medusa, kinematic]}"])


def test_a_variant_of_ones_own() -> None:
    """As docs/extending/vehicle.md has it: another set of numbers, and what others believe of it."""

    @variant_of(medusa, mass=40.0)
    def heavy() -> None:
        """A heavier MEDUSA.

        Source: this test.
        """

    announce(heavy, autopilot={"surge_mass": 60.0})
    assert heavy.name == "heavy"
    assert [p.default for p in heavy.parameters if p.name in ("mass", "surge_drag_quadratic")] == [40.0, 27.5]
    assert "thruster_arm: [m]" in heavy.doc
    with pytest.raises(TypeError, match="no parameter"):
        variant_of(kinematic, mass=1.0)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the law")
def test_it_compiles_for_one_mission_and_for_lanes() -> None:
    assert medusa_2013.handle() > 0
    assert medusa_2013.handle(lanes=True) > 0
