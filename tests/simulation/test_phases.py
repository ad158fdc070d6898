"""Phases of a mission: each vehicle goes on by what it measured and was told; limits are judged by the truth."""

from __future__ import annotations

import json

import numpy as np
import pytest

from cardume.missions.available import catalog
from cardume.missions.flying import fly_mission
from cardume.missions.loading import parse_mission
from cardume.missions.summary import judge, summarize, to_json
from cardume.onboard.phases import ABORT, ASSEMBLED, DIVE, GO, HOLD, READY, SURFACE
from cardume.report.words import meaning, verdict_lines
from cardume.simulation.flight import Flight

HEAD = """
cardume: 1
name: phases
duration: 60 s
log_period: 0.5 s
path: {type: line, length: 12 m}
formation: {speed: 0.5 m/s}
model: kinematic
messaging: {schedule: periodic, period: 1 s}
"""
FLEET = """
vehicles:
  - {name: hub}
  - {name: near, offset: {starboard: 3 m}, start: {along_track: -2 m}, depth: 5 m}
  - {name: late, offset: {starboard: -3 m}, start: {along_track: -9 m}, depth: 5 m}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, topology: star}
"""


def flown(text: str, *overrides: str) -> Flight:
    return fly_mission(parse_mission(HEAD + text, catalog(), overrides))


def phases(flight: Flight, name: str) -> list[float]:
    """The phases of a vehicle, each once, in their order."""
    column = flight.channels["phase"][:, flight.vehicle_names.index(name)]
    return [float(column[0]), *(float(b) for a, b in zip(column, column[1:], strict=False) if b != a)]


def happened(flight: Flight, name: str, what: str) -> float:
    (time,) = [event.time for event in flight.events if event.vehicle == name and what in event.what]
    return time


def test_without_phases_a_vehicle_is_on_its_path_and_then_holds() -> None:
    flight = flown("vehicles: [{name: alone}]\n")
    assert phases(flight, "alone") == [GO, HOLD]
    assert flight.events == ()


def test_a_fleet_gathers_and_goes_together_by_what_it_is_told() -> None:
    delayed = "acoustics: {channel: bernoulli, loss: 0, delay: 0.4 s}\n"
    flight = flown(FLEET + "phases: {dive: {}, gather: {radius: 1 m}}\nend: surface\n" + delayed)
    starts = [happened(flight, name, "sets out") for name in flight.vehicle_names]
    last = happened(flight, "late", "is at its start")
    assert last > 5.0
    assert last < min(starts)
    assert max(starts) - min(starts) < 3.0  # a message or two apart
    assert phases(flight, "hub")[-1] == SURFACE
    assert flight.metrics.fleet["coordination_error_max"] < 1.5


def test_the_hub_waits_for_a_leaf_that_is_not_there_until_its_patience_ends() -> None:
    text = FLEET.replace("along_track: -9 m", "along_track: -200 m")
    flight = flown(text + "phases: {gather: {radius: 1 m, timeout: 20 s}}\n")
    assert happened(flight, "hub", "without having heard") == pytest.approx(20.1, abs=0.11)
    assert happened(flight, "near", "sets out") < 23.0  # it was told that the hub is gone


def test_who_hears_nobody_ready_stays() -> None:
    flight = flown(FLEET + "phases: {gather: {}}\nacoustics: {channel: bernoulli, loss: 1}\n")
    assert phases(flight, "hub") == [READY]
    assert np.ptp(flight.channels["north"][20:, 0]) < 1.0


def test_a_lone_vehicle_needs_nobody() -> None:
    flight = flown("vehicles: [{name: alone, depth: 5 m, start: {depth: 0 m}}]\nphases: {dive: {}, gather: {}}\n")
    assert phases(flight, "alone")[-2:] == [GO, HOLD]


def test_a_dive_that_does_not_end_is_given_up_after_its_timeout() -> None:
    ahrs_only = (
        "vehicles: [{name: alone, depth: 5 m, sensors: {ahrs: {}, gnss: {deepest: 50 m}, thruster_speed: {}}}]\n"
    )
    flight = flown(ahrs_only + "phases: {dive: {timeout: 7 s}}\n")  # no depth is measured
    assert phases(flight, "alone")[:2] == [DIVE, GO]
    assert happened(flight, "alone", "not down within") == pytest.approx(7.1, abs=0.11)


def test_it_holds_the_end_and_then_comes_up() -> None:
    flight = flown("vehicles: [{name: alone, depth: 5 m}]\nphases: {hold: 10 s}\nend: surface\n")
    assert happened(flight, "alone", "comes up") - happened(flight, "alone", "holds") == pytest.approx(10.1, abs=0.11)
    depth = flight.channels["depth"][:, 0]
    assert depth[-1] == 0.0
    assert depth[int(2 * happened(flight, "alone", "comes up")) - 1] == 5.0


def test_a_circle_is_kept_while_it_waits() -> None:
    flight = flown("vehicles: [{name: alone}]\nphases: {circle: 4 m}\n")
    held = flight.channels["phase"][:, 0] == HOLD
    radius = np.hypot(flight.channels["north"][held, 0] - 12.0, flight.channels["east"][held, 0])[-30:]
    assert abs(radius - 4.0).max() < 0.3


# ---- giving up -------------------------------------------------------------------------------------------------------


ROUND = "limits: {geofence: {centre: {north: 0 m, east: 0 m}, radius: 6 m}}\n"
SQUARE = """
limits:
  geofence:
    polygon: [{north: -5, east: -9}, {north: -5, east: 9}, {north: 8, east: 9}, {north: 8, east: -9}]
"""
RISING = "bathymetry: {type: slope, depth: 12 m, gradient: -0.5}\n"


@pytest.mark.parametrize(
    ("lines", "reason", "at"),
    [
        ("limits: {depth: 4 m}\nabort: {to: surface}\n", "depth limit", (0.0, 0.2)),
        (ROUND + "abort: {to: hold}\n", "geofence", (12.0, 13.0)),
        (SQUARE + "abort: {}\n", "geofence", (16.0, 17.0)),
        ("abort: {time: 11 s}\n", "time", (11.0, 11.2)),
        (RISING + "limits: {altitude: 4 m}\nabort: {}\n", "altitude", (12.0, 13.0)),
    ],
)
def test_it_gives_up(lines: str, reason: str, at: tuple[float, float]) -> None:
    flight = flown("vehicles: [{name: alone, start: {depth: 5 m, speed: 0.5 m/s}, depth: 5 m}]\n" + lines)
    assert phases(flight, "alone") in ([GO, ABORT], [ABORT])
    assert at[0] <= happened(flight, "alone", f"gives up: {reason}") <= at[1]
    assert (flight.channels["depth"][-1, 0] == 0.0) == ("to: hold" not in lines)


def test_silence_ends_a_mission_and_the_others_go_on_without_it() -> None:
    deaf = "  - {name: near, acoustics: {loss: 1}, depth: 5 m, start: {speed: 0.5 m/s}}\n"
    text = "vehicles:\n  - {name: hub, start: {speed: 0.5 m/s}}\n" + deaf + "acoustics: {channel: bernoulli}\n"
    flight = flown(text + "abort: {silence: 8 s}\n")
    assert happened(flight, "near", "gives up: silence") == pytest.approx(8.1, abs=0.11)
    assert phases(flight, "hub")[0] == GO
    assert phases(flight, "hub")[-1] == HOLD
    assert np.isnan(flight.neighbor_state_estimate[-1, 0, 1])  # who gave up does not count


def test_limits_are_judged_by_the_truth_with_time_name_and_margin() -> None:
    fence = "limits: {depth: 6 m, geofence: {centre: {north: 0 m, east: 0 m}, radius: 8 m}}\n"
    flight = flown(FLEET + fence + "require: {separation_min: 6 m}\n")
    depth, geofence, separation = sorted(judge((), flight.metrics), key=lambda v: v.metric)
    assert (depth.met, depth.margin, depth.first_violated) == (True, 1.0, None)
    assert not geofence.met
    assert geofence.margin == pytest.approx(-4.37, abs=0.1)  # hypot(12, 3) - 8
    assert (geofence.by, geofence.first_violated) == ("late", 0.0)  # it starts outside, at (-9, -3)
    assert not separation.met
    assert separation.by == "hub and near" or separation.by == "hub and late"
    assert any("geofence" in event.what for event in flight.events)


def test_nobody_knows_that_another_is_ready_before_a_message_says_so() -> None:
    fast = flown(FLEET + "phases: {gather: {radius: 20 m}}\nacoustics: {channel: bernoulli, loss: 0, delay: 5 s}\n")
    assert happened(fast, "hub", "knows") >= 5.0
    assert happened(fast, "near", "sets out") >= 10.0
    assert phases(fast, "near")[:3] == [READY, ASSEMBLED, GO]


@pytest.mark.parametrize("delay", [0.4, 3.0])
def test_to_be_seen_by_a_usbl_is_not_to_have_said_that_one_is_there(delay: float) -> None:
    """The head sees both divers each second, from before their first word on, and its sightings overtake late words."""
    seen = FLEET.replace(
        "{name: hub}", "{name: hub, sensors: {gnss: {sigma: 0}, usbl: {}, ahrs: {}, depth: {}, thruster_speed: {}}}"
    )
    slow = "messaging: {schedule: periodic, period: 3 s, offset: 2 s}\n"
    late = f"phases: {{gather: {{radius: 1 m}}}}\nacoustics: {{channel: bernoulli, loss: 0, delay: {delay} s}}\n"
    mission = HEAD.replace("messaging: {schedule: periodic, period: 1 s}\n", slow).replace("60 s", "45 s")
    flight = fly_mission(parse_mission(mission + seen + late, catalog()))
    there = happened(flight, "late", "is at its start")
    assert there > 5.0
    starts = [happened(flight, name, "sets out") for name in flight.vehicle_names]
    assert there + delay < min(starts)
    assert max(starts) < there + 4.0 * (3.0 + delay)  # four messages later at most


def test_the_summary_and_the_sentences_tell_it() -> None:
    lines = SQUARE + "abort: {to: hold}\n"
    mission = parse_mission(
        HEAD + "vehicles: [{name: alone, start: {speed: 0.5 m/s}}]\n" + lines + "require: {depth_max: 3 m}\n", catalog()
    )
    flight = fly_mission(mission)
    verdicts = judge(mission.require, flight.metrics)
    summary = summarize(flight, verdicts, duration=60.0, version="1")
    (event,) = [e for e in summary["events"] if "gives up" in e["what"]]
    assert event == {
        "time": pytest.approx(16.1, abs=0.21),
        "vehicle": "alone",
        "what": "gives up: geofence",
        "until": None,
    }
    assert summary["requirements_met"] is False
    of_fence = next(r for r in summary["requirements"] if r["metric"] == "geofence_margin_min")
    assert of_fence["first_violated"] == pytest.approx(16.1, abs=0.21)
    assert of_fence["margin"] < 0.0
    assert json.loads(to_json(summary)) == summary
    text = meaning(flight, mission, verdicts)
    assert "alone gave up at 16" in text
    assert "geofence" in text
    assert any("first at 16" in line and not good for line, good in verdict_lines(verdicts))
