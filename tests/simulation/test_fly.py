"""Flying in slices: watched, stopped, and ended by the first number that is not one."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from cardume.compiler import where
from cardume.laws import Law, Meters, Number, Radians, Seconds
from cardume.missions.flying import flight_of
from cardume.missions.planning import Planned
from cardume.onboard.compensation.base import Steering, compensation_law
from cardume.onboard.estimation.position import position_law
from cardume.onboard.guidance import guidance_law
from cardume.signals import (
    NOTHING,
    Course,
    Fix,
    GnssReading,
    Motion,
    NavigationEstimate,
    PathError,
    Reference,
    VesselState,
    Water,
    Where,
)
from cardume.simulation import warming
from cardume.simulation.fly import SLICE, fly, fly_batch
from cardume.simulation.plan import Choice, Plan
from cardume.simulation.recording import LOG, RECORDS, Truth
from cardume.simulation.warming import warm_up
from cardume.vehicles.base import vehicle_model
from cardume.world.currents.base import current_law
from cardume.world.sensors import gnss_sensor
from properties.flown import different_tables, plan_of

TEXT = """
cardume: 1
name: flown
duration: 250 s
path: {type: line, start: {north: 0 m, east: 0 m, course: 0 deg}, length: 300 m}
formation: {speed: 0.5 m/s}
vehicles:
  - {name: zeta, model: kinematic, sensors: ideal, start: {cross_track: 1 m, speed: 0.5 m/s}}
  - {name: alpha, model: kinematic, sensors: ideal, offset: {starboard: 2 m}, start: {speed: 0.5 m/s}}
"""


@pytest.fixture(scope="module")
def plan() -> Plan:
    return plan_of(TEXT)


def test_progress_is_told_to_the_end(plan: Plan) -> None:
    told: list[tuple[int, int]] = []
    flown = fly(plan, lambda done, total: told.append((done, total)))
    assert told == [(k, 2500) for k in (SLICE, 2 * SLICE, 2500)]
    assert (flown.ticks, flown.stopped, flown.trouble) == (2500, False, None)


def test_a_flight_that_is_asked_to_stop_keeps_what_was_flown(plan: Plan) -> None:
    answers = iter([False, False, True])
    flown = fly(plan, should_stop=lambda: next(answers))
    assert (flown.ticks, flown.stopped, flown.trouble) == (2 * SLICE, True, None)
    assert flown.tables.counts[RECORDS] == 200
    log = flown.tables.log.reshape(-1, 2, LOG.width)
    assert np.isfinite(log[:200, :, LOG.column(Truth, "north")]).all()
    assert np.isnan(log[200:]).all()


def test_a_flight_that_is_stopped_at_once_has_flown_nothing(plan: Plan) -> None:
    flown = fly(plan, should_stop=lambda: True)
    assert (flown.ticks, flown.stopped) == (0, True)


def test_an_exception_of_the_watcher_comes_out(plan: Plan) -> None:
    def interrupt(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fly(plan, interrupt)


def test_a_batch_of_none_and_of_one(plan: Plan) -> None:
    for lanes in (False, True):
        assert fly_batch([], lanes=lanes) == []
        (flown,) = fly_batch([plan], lanes=lanes)
        assert flown.ticks == 2500


def test_flying_twice_gives_the_same(plan: Plan) -> None:
    assert different_tables(fly(plan).tables, fly(plan).tables) == []


def test_warming_up_tells_how_far_it_is(plan: Plan) -> None:
    told: list[tuple[int, int]] = []
    warm_up(plan, lambda done, total: told.append((done, total)))
    assert told[0][0] == 0
    assert told[-1][0] == told[-1][1]
    assert [t[0] for t in told] == sorted(t[0] for t in told)


def test_whatever_stops_warming_up_leaves_no_process_behind(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """The one that compiles beside is ended and waited for, or it would stay in the table of processes as a zombie."""
    beside = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])

    def interrupted(*_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(warming, "is_kept", lambda _: False)
    monkeypatch.setattr(warming, "compile_beside", lambda _: beside)
    monkeypatch.setattr(warming, "advance", interrupted)
    with pytest.raises(KeyboardInterrupt):
        warm_up(plan)
    assert beside.returncode is not None


# ---- trouble ---------------------------------------------------------------------------------------------------------

LATE = 30.0  # [m] or [s] after which a law fails


@guidance_law
def lost_course(error: PathError, after: Meters = LATE) -> Radians:
    """No course. Source: this test."""
    return where(error.path_parameter > after, NOTHING, error.path_course)


@compensation_law
def lost_speed(course: Course, motion: Motion, after: Meters = 0.0) -> Steering:
    """Infinite speed when it goes east. Source: this test."""
    return Steering(course.course, where(motion.east > after, math.inf, course.speed))


@position_law
def lost_position(fix: Fix, motion: Motion, after: Meters = LATE) -> NavigationEstimate:
    """No position. Source: this test."""
    return NavigationEstimate(where(fix.north > after, NOTHING, fix.north), fix.east)


@vehicle_model
def lost_vehicle(
    vessel: VesselState, reference: Reference, water: Water, dt: Seconds, after: Meters = LATE
) -> VesselState:
    """Diverges. Source: this test."""
    north = where(vessel.north > after, math.inf, vessel.north + 0.5 * dt)
    return VesselState(north, vessel.east, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0)


@current_law
def lost_current(place: Where, after: Seconds = LATE) -> Water:
    """A hole in the current. Source: this test."""
    return Water(where(place.time > after, NOTHING, 0.0), 0.0)


TROUBLES: list[tuple[str, Law, dict[str, float], str, float]] = [
    ("guidance", lost_course, {}, "reference", 60.1),
    ("compensation", lost_speed, {"after": -1.0}, "reference", 0.0),
    ("position", lost_position, {}, "position estimate", 60.1),
    ("model", lost_vehicle, {}, "state", 60.1),
    ("current", lost_current, {}, "current", 30.1),
]


@pytest.mark.parametrize(("family", "law", "values", "signal", "time"), TROUBLES, ids=lambda v: getattr(v, "name", ""))
@pytest.mark.parametrize("name", ["zeta", "alpha"])
def test_the_first_number_that_is_not_one_ends_the_mission(
    plan: Plan, name: str, family: str, law: Law, values: dict[str, float], signal: str, time: float
) -> None:
    ill = with_law(plan, name, family, Choice(law, values))
    flown = fly(ill)
    assert flown.trouble is not None
    assert (flown.trouble.vehicle, flown.trouble.signal) == (name, signal)
    assert flown.trouble.time == pytest.approx(time, abs=0.21)
    assert flown.ticks == round(flown.trouble.time / plan.tick) + 1
    before = flown.tables.counts[RECORDS] - 1
    log = flown.tables.log.reshape(-1, 2, LOG.width)[:before]
    told = [k for k, channel in enumerate(Truth._fields) if channel != "altitude"]  # there is no seabed
    assert np.isfinite(log[:, :, told]).all()  # what was logged before it is kept


def with_law(plan: Plan, name: str, family: str, choice: Choice) -> Plan:
    vehicles = [replace(v, laws=v.laws | {family: choice}) if v.name == name else v for v in plan.vehicles]
    return replace(plan, vehicles=tuple(vehicles))


def test_a_sensor_may_say_nothing(plan: Plan) -> None:
    """NaN from a sensor is a fault that whoever reads it rejects: the mission goes on."""

    @gnss_sensor(period=0.1)
    def faulty(truth: VesselState, after: Number = 20.0) -> GnssReading:
        return GnssReading(where(truth.north > after, NOTHING, truth.north), truth.east)

    flown = fly(with_law(plan, "zeta", "gnss", Choice(faulty)))
    assert flown.trouble is None
    assert flown.ticks == 2500


def test_a_mission_that_fails_says_what_failed_where_and_when(plan: Plan) -> None:
    ill = fly(with_law(plan, "alpha", "guidance", Choice(lost_course)))
    flight = flight_of("ill", Planned(plan, plan.vehicles[0].path), ill)
    assert (flight.reason, flight.flown) == ("failed", pytest.approx(60.3, abs=0.5))
    assert flight.failure is not None
    assert re.match(r"the reference of vehicle alpha was no number at 60(\.\d+)? s; .+", flight.failure)
