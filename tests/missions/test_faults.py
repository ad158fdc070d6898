"""Faults in a mission file: what is refused, where, and in which words; and what a plan makes of the others."""

from __future__ import annotations

import json

import numpy as np
import pytest

from cardume.cli.main import main
from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.faults import FAULTS
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.signals import Command
from cardume.simulation.plan import Plan
from cardume.vehicles.medusa import medusa
from cardume.vehicles.medusa_data import MAX_SHAFT_SPEED, THRUST_COEFFICIENT, THRUSTER_ARM
from cardume.vehicles.thrusters import allocate, thruster_force, thruster_plant
from cardume.world.faults import FORGED, LOST, REPLAYED, SILENT, STIRRED, Weakness, weakened

TEXT = """cardume: 1
name: planned
duration: 60 s
path: {type: line, length: 100 m}
formation: {speed: 0.5 m/s}
vehicles:
  - {name: surface, sensors: {gnss: {}, usbl: {}}}
  - {name: port, depth: 5 m, offset: {starboard: 3 m}}
  - {name: paper, model: kinematic, offset: {starboard: 6 m}}
guidance: {law: line_of_sight, lookahead: 5 m}
faults:
  - {FAULT}
"""


def plan_of(fault: str, *overrides: str) -> Plan:
    mission = parse_mission(TEXT.replace("FAULT", fault), catalog(), overrides, source="m.yaml")
    return make_plan(draw(mission, 1), catalog()).plan


@pytest.mark.parametrize(
    ("fault", "key", "told"),
    [
        ("kind: modem_silnt, vehicle: port, from: 1 s", "faults.0.kind", "Did you mean 'modem_silent'"),
        ("kind: modem_silent, vehicle: prot, from: 1 s", "faults.0.vehicle", "Did you mean 'port'"),
        ("kind: modem_silent, vehicle: port", "faults.0.from", "missing"),
        ("kind: modem_silent, vehicle: port, from: 1 m", "faults.0.from", "s"),
        ("kind: modem_silent, vehicle: port, from: 9 s, to: 9 s", "faults.0.to", "later than from"),
        ("kind: modem_silent, vehicle: port, from: 1 s, to: 9 s, lasts: 9 s", "faults.0.lasts", "one of them"),
        ("kind: modem_silent, vehicle: port, form: 1 s", "faults.0.form", "Did you mean 'from'"),
        ("kind: gnss_lost, vehicle: port, from: 1 s", "faults.0.vehicle", "carries no gnss; it carries ahrs, depth"),
        ("kind: usbl_outlier, vehicle: port, from: 1 s", "faults.0.vehicle", "carries no usbl"),
        ("kind: sensor_nan, vehicle: port, sensor: dvl, from: 1 s", "faults.0.sensor", "carries no dvl"),
        ("kind: sensor_biased, vehicle: port, sensor: ahrs, from: 1 s", "faults.0.sensor", "of ahrs give heading"),
        (
            "kind: sensor_biased, vehicle: port, sensor: ahrs, depth: 1 m, from: 1 s",
            "faults.0.depth",
            "is not measured by ahrs",
        ),
        ("kind: thruster_weak, vehicle: paper, from: 1 s", "faults.0.vehicle", "kinematic, has no thrusters"),
    ],
)
def test_what_cannot_be_is_refused_where_it_stands(fault: str, key: str, told: str) -> None:
    with pytest.raises(MissionError) as caught:
        plan_of(fault)
    (problem,) = (p for p in caught.value.problems if p.position.key == key)
    assert told in problem.message
    assert problem.position.source == "m.yaml"
    assert problem.position.line == 12


def test_times_are_whole_ticks_and_without_an_end_last_beyond_the_mission() -> None:
    (fault,) = plan_of("kind: current_step, from: 1.234 s, speed: 0.1, towards: 90 deg").faults
    assert (fault.kind, fault.vehicle) == (STIRRED, None)
    assert fault.numbers.begin == 12 * 0.1
    assert fault.numbers.end > 60.0
    assert np.allclose((fault.numbers.size, fault.numbers.more), (0.0, 0.1))


def test_a_lost_vehicle_is_silent_too_and_told_once() -> None:
    lost, silent = plan_of("kind: vehicle_lost, vehicle: port, from: 1 s").faults
    assert (lost.kind, silent.kind) == (LOST, SILENT)
    assert lost.says
    assert not silent.says


@pytest.mark.parametrize(("code", "forged", "replayed"), [(0, 1.0, 1.0), (2, 2.0**-16, 0.0), (4, 2.0**-32, 0.0)])
def test_which_packets_are_taken_depends_on_the_code(code: int, forged: float, replayed: float) -> None:
    channel = f"acoustics={{channel: modem, authentication: {code}}}"
    for kind, number, chance in (("forged", FORGED, forged), ("replayed", REPLAYED, replayed)):
        (fault,) = plan_of(f"kind: {kind}_packets, vehicle: surface, from: 1 s", channel).faults
        assert (fault.kind, fault.numbers.chance) == (number, chance)


def test_a_window_may_be_drawn() -> None:
    text = "kind: modem_silent, vehicle: port, from: {uniform: [5 s, 20 s]}, lasts: {uniform: [1 s, 9 s]}"
    mission = parse_mission(TEXT.replace("FAULT", text), catalog())
    windows = {make_plan(draw(mission, seed), catalog()).plan.faults[0].numbers[:2] for seed in range(20)}
    assert len(windows) == 20
    assert all(5.0 <= begin <= 20.1 and 0.8 < end - begin < 9.2 for begin, end in windows)


def test_a_weak_thruster_pushes_with_its_share_of_the_force_at_its_limit_too() -> None:
    """Against the allocation of the model: what the healthy thrusters make of the weakened command."""
    assert {"thruster_arm", "thrust_coefficient", "max_shaft_speed"} <= {p.name for p in medusa.parameters}
    plant = thruster_plant(0.05, THRUST_COEFFICIENT, MAX_SHAFT_SPEED, 0.0, 7.2, 0.0, THRUSTER_ARM)
    weak = Weakness(port=0.4, starboard=0.9, vertical=0.5, arm=THRUSTER_ARM, most=plant.most)

    def forces(command: Command) -> list[float]:
        return [thruster_force(n, THRUST_COEFFICIENT) for n in allocate(command, plant)]

    for thrust, moment in ((5.0, 0.0), (10.0, 1.0), (1e3, 0.5), (20.0, -1e3), (-30.0, 2.0)):
        command = Command(thrust, moment, 4.0)
        wanted = np.multiply(forces(command), (0.4, 0.9, 0.5))
        assert np.allclose(forces(weakened(command, weak)), wanted, atol=1e-9)


def test_every_kind_is_listed_with_its_keys_and_what_is_done_about_it(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["list", "faults", "--json"])
    assert ended.value.code == 0
    found = {entry["name"]: entry for entry in json.loads(capsys.readouterr().out)}
    assert set(found) == set(FAULTS)
    for entry in found.values():
        assert entry["summary"]
        assert entry["reaction"]
        assert {"from", "to", "lasts", "vehicle"} <= {key["name"] for key in entry["keys"]}
