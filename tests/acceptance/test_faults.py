"""Must show 7 of the faults: each is survived as stated, in the table of docs/faults.md; and 1,000 random schedules."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from acceptance.fault_table import (
    AFTER,
    BEGIN,
    CASES,
    DOC,
    DURATION,
    END,
    FLEET,
    GO_ON,
    HOLD,
    SLOW_DOWN,
    TEXT,
    Case,
    Limits,
    flown,
    found_after,
    measured,
    table,
)
from acceptance.random_faults import random_faults
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.faults import FAULTS, REACTIONS
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.missions.results import choose_destination, write_results
from cardume.missions.runs import Run, read_run
from cardume.report.page.page import make_page
from cardume.report.words import meaning
from cardume.signals import VesselState
from cardume.simulation.fleet import VEHICLE
from cardume.simulation.flight import Flight
from cardume.simulation.fly import fly_batch
from cardume.simulation.plan import Plan
from flying import fly_text


def exceeded(got: Limits, limits: Limits) -> dict[str, tuple[float, float]]:
    pairs = zip(dataclasses.asdict(got).items(), dataclasses.astuple(limits), strict=True)
    return {name: (value, limit) for (name, value), limit in pairs if not value <= limit}


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.fault} {case.note}")
def test_a_fault_is_survived_as_stated(case: Case) -> None:
    flight = flown(case)
    assert flight.reason == "completed"
    assert exceeded(measured(case, BEGIN, END if case.lasts else DURATION), case.during) == {}
    assert exceeded(measured(case, AFTER, DURATION), case.after) == {}
    if case.doubted is not None:
        vehicle, soon = case.doubted
        assert 0.0 <= found_after(case) <= soon
        assert {e.vehicle for e in flight.events if e.what.startswith("does not believe")} == {vehicle}
    began = [event for event in flight.events if event.what.startswith("fault: ") and event.time == BEGIN]
    assert len(began) == 1


def test_every_kind_has_a_case_and_a_stated_reaction() -> None:
    assert {case.kind for case in CASES} == set(FAULTS) == set(REACTIONS)


def test_without_faults_the_fleet_is_healthy() -> None:
    """What is asked for after a fault is what there is without one."""
    flight = fly_text(TEXT)
    late = flight.times >= BEGIN
    spread = np.ptp(flight.channels["coordination_state"][late], axis=1)
    assert spread.max() < 1.2
    assert not flight.events


def test_the_table_of_the_docs_is_what_is_measured() -> None:
    page = DOC.read_text(encoding="utf-8")
    _, _, rest = page.partition("<!-- table -->\n")
    shown, _, _ = rest.partition("\n<!-- end of table -->")
    assert shown.splitlines() == table(), "run tests/acceptance/fault_table.py"
    for kind, reaction in REACTIONS.items():
        assert f"| `{kind}` | {reaction} |" in page


# ---- silence ---------------------------------------------------------------------------------------------------------


def speeds(flight: Flight, start: float, end: float) -> dict[str, float]:
    """Mean rate of the coordination state of each vehicle [m/s] between two times [s]."""
    states, times = flight.channels["coordination_state"], list(flight.times)
    first, last = times.index(start), times.index(end)
    rates = (states[last] - states[first]) / (end - start)
    return dict(zip(flight.vehicle_names, rates.tolist(), strict=True))


@pytest.mark.parametrize(("policy", "low", "high"), [(GO_ON, 0.47, 0.53), (SLOW_DOWN, 0.17, 0.33), (HOLD, -0.05, 0.05)])
def test_neighbors_of_a_silent_vehicle_do_as_they_are_told(policy: Sequence[str], low: float, high: float) -> None:
    """The hub hears that port is silent, and port hears nobody.  Slower is half of v_L -+ k, k the gain."""
    case = next(c for c in CASES if c.kind == "modem_silent" and c.overrides == policy)
    found = speeds(flown(case), BEGIN + 20.0, END)  # ten seconds of patience, ten to slow down
    assert low < found["surface"] < high
    assert low < found["port"] < high


@pytest.mark.parametrize("policy", [GO_ON, SLOW_DOWN, HOLD])
def test_the_formation_closes_up_after_a_blackout(policy: Sequence[str]) -> None:
    """A gap of d closes in about d / (2 k), k = 0.15 m/s what coordination adds to one and takes of another at most."""
    everybody = [f"{{kind: modem_silent, vehicle: {name}, from: 100 s, to: 130 s}}" for name in FLEET]
    weak = "{kind: thruster_weak, vehicle: port, efficiency: 0.2, from: 100 s, to: 130 s}"
    flight = fly_text(TEXT + "faults:\n" + "".join(f"  - {fault}\n" for fault in [*everybody, weak]), policy)
    spread = np.ptp(flight.channels["coordination_state"], axis=1)
    assert spread[130] > (2.0 if policy != HOLD else 0.0)
    assert spread[190:].max() < 1.0


# ---- what a vehicle makes of nothing at all --------------------------------------------------------------------------


def test_readings_of_every_sensor_of_every_vehicle_may_be_nan() -> None:
    carried = {
        "surface": ("gnss", "ahrs", "depth", "usbl", "thruster_speed"),
        "port": ("ahrs", "depth", "dvl", "thruster_speed", "altimeter"),
        "starboard": ("ahrs", "depth", "thruster_speed"),
    }
    faults = [
        f"{{kind: sensor_nan, vehicle: {vehicle}, sensor: {sensor}, from: 40 s, to: 60 s}}"
        for vehicle, sensors in carried.items()
        for sensor in sensors
    ]
    flight = fly_text(TEXT + "faults:\n" + "".join(f"  - {fault}\n" for fault in faults), ["duration=200 s"])
    assert flight.reason == "completed"
    away = np.hypot(*(flight.channels[f"{x}_estimate"] - flight.channels[x] for x in ("north", "east")))
    assert away[150:].max() < 0.6
    still = flight.channels["speed_desired"][45:60]
    assert (still == 0.0).all()  # nobody knows its heading


# ---- a thousand schedules --------------------------------------------------------------------------------------------

CARRIED = {
    "surface": ("gnss", "ahrs", "depth", "thruster_speed", "usbl"),
    "port": ("ahrs", "depth", "thruster_speed", "dvl", "altimeter"),
    "starboard": ("ahrs", "depth", "thruster_speed"),
}
SHORT = 120.0  # [s]
CHANNELS = ((), ("acoustics={channel: modem}",), ("acoustics={channel: modem, authentication: 4}",))
SILENCES = ("none", "{after: 10 s, do: go_on}", "{after: 10 s, do: slow_down}", "{after: 10 s, do: hold}")


def random_plan(number: int) -> Plan:
    """A fleet with a random schedule of faults, one of two filters, three channels and four ways to take silence."""
    overrides = [f"duration={SHORT:g} s", f"coordination.silence={SILENCES[number % 4]}", *CHANNELS[number % 3]]
    if number % 3:
        overrides.append(f"messaging={{schedule: {'tdma' if number % 4 else 'polling'}}}")
    if number % 2:
        overrides += ["position.law=reset", "current_observer={law: complementary, k1: 0.2, k2: 0.01}"]
    text = TEXT + "faults:\n" + "".join(f"  - {fault}\n" for fault in random_faults(number, CARRIED, SHORT))
    return make_plan(draw(parse_mission(text, catalog(), overrides), number), catalog()).plan


def fly_random(numbers: Sequence[int]) -> None:
    plans = [dataclasses.replace(random_plan(number), log_period=0.0) for number in numbers]
    ill = {}
    for number, one in zip(numbers, fly_batch(plans), strict=True):
        state = one.tables.vehicles.reshape(len(FLEET), VEHICLE.width)[:, : len(VesselState._fields)]
        if one.trouble or one.ticks != one.plan.num_ticks or not np.isfinite(state).all():
            ill[number] = one.trouble
        assert np.abs(state[:, :2]).max() < 200.0, number  # nobody leaves for the ocean
    assert ill == {}


def test_fifty_random_schedules() -> None:
    fly_random(range(50))


@pytest.mark.slow
def test_a_thousand_random_schedules() -> None:
    fly_random(range(1000))


# ---- words -----------------------------------------------------------------------------------------------------------


def test_the_report_says_what_went_wrong_and_what_was_found_of_it() -> None:
    case = next(c for c in CASES if c.kind == "sensor_frozen" and "ahrs" in c.fault)
    mission = parse_mission(case.text, catalog())
    told = meaning(flown(case), mission, ())
    assert "As scheduled, port: its AHRS freezes (100 to 160 s)." in told
    assert "port did not believe its AHRS." in told


def test_a_run_with_faults_has_the_same_page_when_it_is_read_back(tmp_path: Path) -> None:
    case = next(c for c in CASES if c.kind == "sensor_frozen" and "ahrs" in c.fault)
    mission = parse_mission(case.text, catalog())
    directory, _ = write_results(choose_destination(mission.name, tmp_path / "run"), mission, flown(case), version="0")
    found = read_run(directory)
    assert [event for event in found.flight.events if event.what.startswith("fault: ")]
    again = Run(
        flight=flown(case),
        mission=mission,
        text=found.text,
        version="0",
        verdicts=found.verdicts,
        duration=mission.duration,
        transient=mission.transient,
    )
    assert make_page(found) == make_page(again)
