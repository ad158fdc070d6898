"""`check`: what it says of bad missions, that what it suggests passes, and that the engine flies as it predicts."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from cardume.missions import library
from cardume.missions.available import catalog
from cardume.missions.checks import Finding, check_mission
from cardume.missions.checks.abilities import speed_limits
from cardume.missions.checks.observer import longest_gap, mean_square_radius
from cardume.missions.loading import parse_mission
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.simulation.flight import Flight
from flying import fly_text

LINE = "{type: line, length: 200 m}"
LONG = "{type: line, length: 5 km}"
CIRCLE = "{type: circle, centre: {north: 0 m, east: 0 m}, radius: 5 m}"
MOWER = "{type: lawnmower, leg: 30 m, legs: 3, spacing: 24 m}"
EXACT = "heading_sigma: 0 deg, attitude_sigma: 0 deg, yaw_rate_sigma: 0 rad/s"
ABOARD = f"ahrs: {{{EXACT}}}, depth: {{sigma: 0 m}}, thruster_speed: {{sigma: 0}}"
USBL = "usbl: {range_sigma: 0 m, angle_sigma: 0 deg}"

POINT = "{name: a, model: kinematic, sensors: ideal, start: {speed: 0.5 m/s}}"
BESIDE = "{name: b, model: kinematic, sensors: ideal, start: {speed: 0.5 m/s}, offset: {starboard: 5 m}}"
HULL = "{name: a, model: medusa, sensors: ideal, start: {speed: 0.5 m/s}}"
HEAD = f"{{name: a, model: medusa, sensors: {{gnss: {{sigma: 0 m}}, {USBL}, {ABOARD}}}}}"
DIVER = f"{{name: b, model: medusa, depth: 5 m, offset: {{starboard: 5 m}}, sensors: {{{ABOARD}}}}}"

MEETS = """
compensation: {law: crab}
current_observer: {law: complementary, k1: 0.5 1/s, k2: 0.06 1/s^2}
current: {type: uniform, speed: 0.1 m/s, towards: 90 deg}
position: {law: direct}
"""
TOLD = """
compensation: {law: crab}
current_observer: {law: complementary, k1: 0.2 1/s, k2: 0.01 1/s^2}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
position: {law: reset}
messaging: {schedule: periodic, period: 1 s, offset: 0.1 s}
acoustics: {channel: bernoulli, delay: 0.3 s}
"""


def mission(vehicles: Sequence[str], more: str = "", path: str = LINE, duration: float = 420.0) -> str:
    """The text of a mission at 0.5 m/s."""
    listed = "".join(f"  - {vehicle}\n" for vehicle in vehicles)
    head = f"cardume: 1\nname: t\nduration: {duration} s\npath: {path}\nformation: {{speed: 0.5 m/s}}\n"
    return f"{head}vehicles:\n{listed}{more}"


def by_satellite(period: float = 1.0, latency: float = 0.0, scale: float = 1.0) -> str:
    """A kinematic vehicle, 1 m off its path, that is told now and then where it is, or was."""
    gnss = f"gnss: {{sigma: 0 m, period: {period} s, latency: {latency} s}}"
    sensors = f"{gnss}, ahrs: {{{EXACT}}}, thruster_speed: {{sigma: 0, scale: {scale}}}"
    return f"{{name: a, model: kinematic, sensors: {{{sensors}}}, start: {{cross_track: 1 m, speed: 0.5 m/s}}}}"


def quick_tick(tick: float) -> str:
    return f"tick: {tick} s\nplant_step: {tick} s\nlog_period: 1 s\n"


def observer(k1: float, k2: float) -> list[str]:
    return [f"current_observer.k1={k1} 1/s", f"current_observer.k2={k2} 1/s^2"]


def aims(lookahead: float) -> list[str]:
    return ["guidance.law=along_path", f"guidance.lookahead={lookahead} m"]


def arcsine(gain: float) -> list[str]:
    return ["guidance.law=arcsine", f"guidance.gain={gain} 1/s"]


def channel(**parameters: str) -> list[str]:
    return ["acoustics.channel=bernoulli", *(f"acoustics.{key}={value}" for key, value in parameters.items())]


def lagging(seconds: float) -> str:
    return f"vehicles.a.model={{law: kinematic, heading_time_constant: {seconds} s}}"


def findings(text: str, overrides: Sequence[str] = ()) -> list[Finding]:
    return check_mission(parse_mission(text, catalog(), overrides))


def told(text: str, key: str, *overrides: str) -> set[str]:
    """The levels of what is said about a key."""
    return {finding.level for finding in findings(text, overrides) if finding.key == key}


def find(text: str, level: str, key: str, *overrides: str) -> Finding:
    """The one finding of this level and key."""
    found = findings(text, overrides)
    (only,) = [finding for finding in found if (finding.level, finding.key) == (level, key)] or [found]
    assert isinstance(only, Finding), only
    return only


ALONE, HULLED, PAIR = mission([POINT], MEETS), mission([HULL], MEETS), mission([POINT, BESIDE])
MIXED, TEAM, RING = mission([HULL, BESIDE]), mission([HEAD, DIVER], TOLD), mission([POINT], path=CIRCLE)
RARE = mission([by_satellite(period=2)], TOLD)
SCALED = mission([by_satellite(period=0.01, scale=1.25)], MEETS + quick_tick(0.01))
LATE = mission([by_satellite(period=5, latency=5)], "position: {law: reset_compensated}\n")
OUTER = HULL.replace("name: a", "name: b").replace("0.5 m/s}}", "0.5 m/s}, offset: {starboard: -5 m}}")
DUO, TWO = mission([POINT, BESIDE], MEETS), mission([HULL, BESIDE], MEETS)
ABREAST, FOLLOWING = mission([HULL, OUTER], MEETS, MOWER), ["current.speed=0.25 m/s", "current.towards=0 deg"]
TO_AND_FRO = mission([HULL], MEETS, MOWER)
STILL = MEETS.replace("current: {type: uniform, speed: 0.1 m/s, towards: 90 deg}", "")
GUSTY = mission(
    [POINT], STILL + "current: {type: gauss_markov, speed: 0.1 m/s, towards: 90 deg, sigma_along: 0.01 m/s}"
)
POINTS = "{depth: 0 m, speed: 0.2 m/s, towards: 90 deg}, {depth: 5 m, speed: 0 m/s}"
LAYERED = mission([POINT], STILL + f"current: {{type: sheared, profile: [{POINTS}]}}")
HULL_LAYERED = mission([HULL], STILL + f"current: {{type: sheared, profile: [{POINTS}]}}")
BELOW = mission(
    [HULL.replace("{name: a", "{name: a, depth: 5 m")], STILL + f"current: {{type: sheared, profile: [{POINTS}]}}"
)
TURNING = mission([POINT], STILL + "current: {type: step, later_speed: 0.1 m/s, later_towards: 90 deg, at: 100 s}")
SILENT, UNDER = "vehicles.a.messaging=none", "vehicles.b.depth=5 m"

LATE_RATES = ["neighbors.law=reported_speed", "messaging.period=1 s"]

# What spoils a mission that is otherwise without this finding, its level and its key.
CASES = [
    (mission([POINT], path=MOWER), ["vehicles.a.offset.starboard=15 m"], "error", "vehicles.a.offset.starboard"),
    (MIXED, ["vehicles.b.model=medusa", "vehicles.b.offset.starboard=0.6 m"], "warning", "vehicles.b.offset"),
    (MIXED, ["vehicles.b.model=medusa", "vehicles.b.start.cross_track=-4.5 m"], "warning", "vehicles.b.start"),
    (RING, aims(8), "error", "guidance.lookahead"),
    (RING, aims(3), "note", "guidance.lookahead"),
    (HULLED, ["current.speed=1.7 m/s"], "error", "current.speed"),
    (HULLED, ["current.speed=1.8 m/s", "current.towards=180 deg"], "error", "current.speed"),
    (ALONE, ["current.speed=0.55 m/s", "speed_reference=water"], "error", "formation.speed"),
    (ALONE, ["current.speed=0.55 m/s", "compensation=none"], "error", "formation.speed"),
    (ALONE, ["current.speed=0.2 m/s", "compensation=none"], "warning", "compensation.law"),
    (ALONE, ["current.speed=0.02 m/s", "compensation=none"], "note", "compensation.law"),
    (ALONE, ["current.speed=0.2 m/s", "current_observer=none"], "warning", "current_observer.law"),
    (ALONE, ["current.variation_sigma=0.3 m/s", "speed_reference=water"], "warning", "current.variation_sigma"),
    (GUSTY, ["current.sigma_across=0.3 m/s", "speed_reference=water"], "warning", "current.sigma_across"),
    (LAYERED, ["current.scale=3", "speed_reference=water"], "error", "formation.speed"),
    (HULL_LAYERED, ["current.scale=8.5"], "error", "current.scale"),
    (TURNING, ["current.later_speed=0.6 m/s", "speed_reference=water"], "error", "formation.speed"),
    (TURNING, ["current.later_speed=0.7 m/s", "current.at=410 s", "speed_reference=water"], "warning", "end"),
    (DUO, ["current.speed=0.4 m/s", "speed_reference=water"], "warning", "coordination.gain"),
    (ALONE, ["current.speed=0.6 m/s", "current.towards=0 deg"], "warning", "formation.speed"),
    (ALONE, ["current.speed=0.6 m/s", "current.towards=0 deg", "speed_reference=water"], "warning", "end"),
    (TO_AND_FRO, ["current.speed=1.2 m/s", "current.towards=0 deg"], "warning", "current.speed"),
    (HULLED, ["formation.speed=1.8 m/s"], "warning", "formation.speed"),
    (HULLED, ["formation.speed=0.1 m/s", "current.speed=0 m/s", "duration=1 h"], "warning", "formation.speed"),
    (MIXED, ["coordination.gain=0.45 m/s"], "warning", "coordination.gain"),
    (MIXED, ["formation.speed=1.5 m/s"], "warning", "coordination.gain"),
    (ABREAST, ["formation.speed=1.8 m/s"], "warning", "formation.speed"),  # for both, worse for the outer one
    (TWO, ["coordination.gain=0.45 m/s", *FOLLOWING], "warning", "coordination.gain"),  # worse between than at ends
    (PAIR, ["coordination.gain=0.6 m/s"], "warning", "coordination.gain"),
    (ALONE, [*observer(10, 10), "tick=0.25 s", "log_period=1 s"], "error", "current_observer.k1"),
    (HULLED, [*observer(0.5, 0.5), "tick=0.9 s", "log_period=0.9 s"], "warning", "current_observer.k1"),
    (RARE, [*observer(0.5, 0.5), "vehicles.a.sensors.gnss.period=3 s"], "error", "current_observer.k2"),
    (RARE, observer(0.5, 0.5), "warning", "current_observer.k2"),
    (TEAM, [*observer(1, 0.25), "messaging.period=6 s", "acoustics.loss=0.3"], "warning", "current_observer.k2"),
    (SCALED, [*observer(0.05, 1), "guidance.lookahead=1 m"], "error", "current_observer.k1"),
    (ALONE, [lagging(4)], "warning", "guidance.lookahead"),
    (HULLED, ["guidance.lookahead=1 m"], "warning", "guidance.lookahead"),
    (HULLED, arcsine(1), "warning", "guidance.gain"),
    (RARE, ["vehicles.a.sensors.gnss.latency=20 s"], "error", "guidance.lookahead"),
    (RARE, ["vehicles.a.sensors.gnss.period=22 s", "position.law=direct"], "error", "guidance.lookahead"),
    (ALONE, ["tick=1 s", "guidance.lookahead=0.2 m"], "warning", "guidance.lookahead"),
    (PAIR, ["coordination.topology=[[0, 0], [0, 0]]"], "error", "coordination.topology"),
    (PAIR, ["messaging=none"], "error", "messaging"),
    (PAIR, channel(loss="1"), "error", "acoustics.loss"),
    (PAIR, channel(max_range="4 m"), "error", "acoustics.max_range"),
    (PAIR, ["coordination.length_scale=0.01 m"], "warning", "coordination.length_scale"),
    (PAIR, [*channel(delay="8 s"), *LATE_RATES], "warning", "coordination.gain"),
    (TEAM, ["vehicles.b.sensors.ahrs=none"], "error", "vehicles.b.sensors.ahrs"),
    (TEAM, ["vehicles.b.sensors.thruster_speed=none"], "error", "vehicles.b.sensors.thruster_speed"),
    (TEAM, ["vehicles.b.sensors.depth=none"], "warning", "vehicles.b.sensors.depth"),
    (TEAM, ["vehicles.a.sensors.usbl=none"], "warning", "vehicles.b.depth"),
    (TEAM, ["vehicles.b.depth=0 m", "vehicles.b.sensors.gnss=none", SILENT], "warning", "vehicles.b.sensors"),
    (mission(["{name: a}", "{name: b, offset: {starboard: 5 m}}"]), [UNDER], "warning", "vehicles.b.depth"),
    (mission([POINT, "{name: b, offset: {starboard: 5 m}}"]), [UNDER], "warning", "vehicles.b.depth"),
    (RARE, ["vehicles.a.sensors.gnss.latency=1 s"], "note", "position.law"),
    (RARE, ["position.law=direct"], "note", "position.law"),
    (LATE, ["tick=0.01 s"], "warning", "tick"),
    (TEAM, ["messaging.offset=0 s"], "warning", "messaging.offset"),
    (TEAM, ["messaging.period=0.5 s"], "warning", "messaging.period"),
    (PAIR, ["messaging.period=0.1 s", *channel(delay="6.4 s")], "error", "messaging.period"),
    (ALONE, ["duration=60 s"], "warning", "duration"),
    (HULLED, ["tick=0.01 s", "plant_step=0.005 s"], "error", "plant_step"),
    (HULLED, ["autopilot.turn_bandwidth=45 1/s"], "error", "autopilot.turn_bandwidth"),
    (HULLED, ["autopilot.speed_bandwidth=45 1/s"], "warning", "autopilot.speed_bandwidth"),
]


@pytest.mark.parametrize(("text", "spoils", "level", "key"), CASES, ids=lambda value: str(value)[:40])
def test_it_finds_what_is_wrong_and_what_it_suggests_passes(text: str, spoils: list[str], level: str, key: str) -> None:
    assert level not in told(text, key)
    found = find(text, level, key, *spoils)
    assert found.message
    assert found.suggestion, found
    cured = [*spoils, *found.suggestion.split(" and ")]
    left = findings(text, cured)
    assert not [f for f in left if (f.level, f.key) == (level, key)], f"{found.suggestion} leaves {left}"
    errors = {f.key for f in findings(text, spoils) if f.level == "error"}
    assert {f.key for f in left if f.level == "error"} <= errors, f"{found.suggestion} brings {left}"


def test_a_sheared_current_counts_at_the_depth_of_the_vehicle() -> None:
    """1.7 m/s at the surface beats a MEDUSA there, and not the one at 5 m, where the water stands still."""
    strong = ["current.scale=8.5"]
    assert told(HULL_LAYERED, "current.scale", *strong) == {"error"}
    assert not told(BELOW, "current.scale", *strong)


@pytest.mark.parametrize("name", library.names())
def test_built_in_missions_have_no_errors_and_only_these_warnings(name: str) -> None:
    found = [finding for finding in check_mission(open_mission(name)) if finding.level != "note"]
    true_of = {
        "paper/figure-3": {"vehicles.without.compensation.law"},  # what the figure shows
        "kinematic/line": {"duration"},  # it shows the approach, not the whole line
        "study/row-s": {"duration", "messaging.period"},  # a line long enough, a channel without collisions
        "study/row-k2": {"duration"},
        "study/how-often-to-talk": {"coordination.gain", "formation.speed"},  # in the strongest of its currents
        "acoustics/figure-5-s2c": {"coordination.gain"},  # who waits comes near to the dead zone of its thrusters
        "acoustics/figure-5-s2c-paper": {"coordination.gain"},
        "cadiz": {"coordination.gain", "path"},  # slow: in the inner arc, 0.23 m/s in a current of 0.1 m/s
        **{survey: {"duration"} for survey in library.names() if survey.startswith("survey/")},  # its 400 s are theirs
    }
    swept_too_far = {"study/row-k2": {"current_observer.k1"}}.get(name, set())  # until it fails: that is the question
    assert {finding.key for finding in found if finding.level == "error"} <= swept_too_far, found
    assert {finding.key for finding in found} - swept_too_far <= true_of.get(name, set()), found


def test_findings_are_frozen_and_errors_come_first() -> None:
    found = findings(TEAM, ["vehicles.b.sensors.ahrs=none", "messaging.offset=0 s", "duration=1 s"])
    order = [("error", "warning", "note").index(finding.level) for finding in found]
    assert order == sorted(order)
    assert set(order) == {0, 1, 2}
    with pytest.raises(dataclasses.FrozenInstanceError):
        found[0].level = "note"  # type: ignore[misc]


def test_what_planning_refuses_is_told_with_its_place_for_every_vehicle() -> None:
    text = mission([POINT, BESIDE], path=MOWER)
    found = findings(text, ["vehicles.b.offset.starboard=-13 m", "vehicles.a.offset.starboard=12 m"])
    assert [(f.level, f.key) for f in found] == [("error", f"vehicles.{name}.offset.starboard") for name in ("a", "b")]
    assert "--set vehicles.b.offset.starboard=-13 m" in found[1].message
    assert found[1].suggestion == "vehicles.b.offset.starboard=-11.999 m"
    nowhere = find(text, "error", "origin", "current={type: gridded, file: " + __file__ + "}")
    assert "<text>" in nowhere.message


def test_values_that_vary_are_looked_at_in_their_extremes() -> None:
    found = find(HULLED, "error", "current.speed", "current.speed={uniform: [0.1 m/s, 1.7 m/s]}")
    assert found.message.endswith("(with current.speed = 1.7)")
    assert not told(HULLED, "current.speed", "current.speed={uniform: [0.1 m/s, 1.5 m/s]}")
    sweep = "guidance={sweep: [{law: line_of_sight}, {law: arcsine, gain: 1 1/s}]}"
    assert find(HULLED, "warning", "guidance.gain", sweep).message.endswith("(with guidance = arcsine)")


EXTREMES = (
    "tick=0.01 s;formation.speed=1e-6;formation.speed=1e6;current.speed=1e3;guidance.lookahead=1e-6;duration=0.01"
)
EXTREMES += ";current_observer.k1=1e-6;acoustics.loss=0.999;acoustics.delay=1000;position=direct;vehicles.b.depth=5 km"
EXTREMES += ";vehicles.a.sensors.gnss.latency=60 s;vehicles.a.offset.ahead=1 km;messaging.offset=1e6"


@pytest.mark.parametrize("spoil", EXTREMES.split(";"))
def test_extreme_values_are_looked_at_too(spoil: str) -> None:
    assert all("nan" not in finding.message + finding.suggestion for finding in findings(TEAM, [spoil, "end=hold"]))


def test_a_users_law_is_looked_at_only_where_that_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "law_for_check.py").write_text(
        "from cardume.onboard.guidance import guidance_law\nfrom cardume.signals import PathError\n\n"
        "@guidance_law\ndef straight(error: PathError) -> float:\n    return error.path_course\n"
    )
    text = mission([POINT], "guidance: {law: law_for_check:straight}\n")
    read = parse_mission(text, catalog([tmp_path]))
    assert check_mission(read, [tmp_path]) == []
    (refused,) = check_mission(read)
    assert refused.level == "error"
    assert "--allow-code" in refused.message


def test_a_fleet_follows_one_vehicle_that_corrects_nothing_but_not_two() -> None:
    third = BESIDE.replace("name: b", "name: c").replace("5 m}", "-5 m}")
    text = mission([POINT, BESIDE, third])
    assert findings(text, ["vehicles.b.coordination=none"]) == []
    two = ["vehicles.b.coordination=none", "vehicles.c.coordination=none"]
    found = find(text, "warning", "vehicles.c.coordination.law", *two)
    assert findings(text, [*two, found.suggestion]) == []


# ---- the engine flies as predicted -----------------------------------------------------------------------------------


def fly(text: str, *overrides: str) -> Flight:
    return fly_text(text, overrides)


def late_error(flight: Flight, vehicle: int = 0) -> float:
    """Largest cross-track error [m] in the last quarter."""
    return float(np.abs(flight.channels["cross_track"][-len(flight.times) // 4 :, vehicle]).max())


def speeds(flight: Flight) -> np.ndarray:
    return flight.channels["surge"][-len(flight.times) // 4 :, 0]


def lag_astern(flight: Flight, vehicle: int) -> float:
    """How far astern of the truth a vehicle on a line to the north believes itself, on average, in the second half."""
    behind = flight.channels["north"] - flight.channels["north_estimate"]
    return float(behind[len(behind) // 2 :, vehicle].mean())


def test_the_speeds_of_medusa_are_what_its_thrusters_can_keep() -> None:
    planned = make_plan(parse_mission(HULLED, catalog()), catalog())
    limits = speed_limits(planned.plan.vehicles[0])
    assert limits is not None
    fast = speeds(fly(HULLED, "formation.speed=2 m/s", "current=none", "path.length=900 m"))
    assert fast == pytest.approx(limits.most, abs=1e-3)
    for speed, swings in ((0.95 * limits.least, True), (1.02 * limits.least, False)):
        still = ["current=none", f"formation.speed={speed} m/s", "duration=900 s"]
        assert bool("warning" in told(HULLED, "formation.speed", *still)) is swings
        assert bool(float(np.ptp(speeds(fly(HULLED, *still)))) > 0.01) is swings


@pytest.mark.parametrize(
    ("text", "spoil", "beaten", "met"),
    [
        (HULLED, "end=continue", 1.65, 1.55),
        (ALONE, "speed_reference=water", 0.52, 0.47),
        (ALONE, "compensation=none", 0.52, 0.42),
    ],
)
def test_a_current_that_is_told_to_be_too_strong_carries_the_vehicle_off(
    text: str, spoil: str, beaten: float, met: float
) -> None:
    for speed, is_beaten in ((beaten, True), (met, False)):
        overrides = [spoil, f"current.speed={speed} m/s"]
        levels = told(text, "current.speed", *overrides) | told(text, "formation.speed", *overrides)
        assert bool("error" in levels) is is_beaten
        error = np.abs(fly(text, "path.length=5 km", *overrides).channels["cross_track"][:, 0])
        assert bool(error[-1] > error[len(error) // 2] + 1.0) is is_beaten


@pytest.mark.parametrize("course", [0.0, 30.0])
def test_the_offset_that_a_current_leaves_is_the_predicted_one(course: float) -> None:
    spoils = [f"path.start.course={course} deg", f"current.towards={course + 90.0} deg", "current.speed=0.2 m/s"]
    spoils += ["compensation=none", "path.length=5 km"]
    assert "2.18 m off its path" in find(ALONE, "warning", "compensation.law", *spoils).message
    flight = fly(ALONE, *spoils)
    assert late_error(flight) == pytest.approx(2.1821789, abs=1e-4)
    assert np.isnan(flight.metrics.vehicles["a"]["settling_time"])  # "never counts as settled"


def test_a_following_current_overtakes_as_predicted() -> None:
    spoils = ["current.speed=0.8 m/s", "current.towards=0 deg", "path.length=5 km"]
    assert "it makes 1.1 m/s" in find(ALONE, "warning", "formation.speed", *spoils).message
    state = fly(ALONE, *spoils).channels["coordination_state"][:, 0]
    assert state[-1] - state[-101] == pytest.approx(1.1 * 100.0, rel=1e-3)


def test_the_gap_at_which_an_observer_turns_unstable_is_that_of_the_theory() -> None:
    for k1, k2, simulated in ((1.0, 0.25, 10.0), (0.5, 0.5, 2.5), (10.0, 10.0, 2.2), (0.2, 0.01, 50.0)):
        assert longest_gap(k1, k2) == pytest.approx(simulated, abs=0.02)
    assert mean_square_radius(1.0, 0.25, 9.0, 0.0) < 1.0 < mean_square_radius(1.0, 0.25, 9.0, 0.2)


@pytest.mark.parametrize(("period", "diverges"), [(9.0, False), (11.0, True)])
def test_gaps_between_fixes_make_the_observer_diverge_where_predicted(period: float, diverges: bool) -> None:
    text, gains = mission([by_satellite(period)], TOLD, LONG, 1500.0), observer(1, 0.25)
    assert bool("error" in told(text, "current_observer.k2", *gains)) is diverges
    assert "warning" in told(text, "current_observer.k2", *gains) or diverges
    assert bool(late_error(fly(text, *gains)) > 10.0) is diverges


@pytest.mark.parametrize(("tick", "unstable"), [(0.18, False), (0.2, True)])
def test_ticks_too_long_for_the_gains_are_unstable_where_predicted(tick: float, unstable: bool) -> None:
    overrides = [*observer(10, 10), f"tick={tick} s", f"log_period={5 * tick} s", "current.speed=0.05 m/s"]
    assert bool("error" in told(ALONE, "current_observer.k1", *overrides)) is unstable
    assert bool(late_error(fly(ALONE, *overrides)) > 1.0) is unstable


@pytest.mark.parametrize(("scale", "unstable"), [(1.1, False), (1.2, True)])
def test_a_wrong_scale_of_speed_is_stood_up_to_the_predicted_limit(scale: float, unstable: bool) -> None:
    text = mission([by_satellite(0.01, scale=scale)], MEETS + quick_tick(0.01), LONG, 600.0)
    overrides = [*observer(0.05, 1), "guidance.lookahead=1 m"]
    overrides += ["vehicles.a.sensors.ahrs.period=0.01 s", "vehicles.a.sensors.thruster_speed.period=0.01 s"]
    overrides += ["speed_reference=water", "formation.speed=0.5 m/s"]
    assert bool("error" in told(text, "current_observer.k1", *overrides)) is unstable
    assert bool(late_error(fly(text, *overrides)) > 0.2) is unstable


def test_the_aim_beyond_the_center_draws_the_vehicle_in_and_the_static_error_is_the_predicted_one() -> None:
    drawn = aims(8.5)
    assert "error" in told(RING, "guidance.lookahead", *drawn)
    assert late_error(fly(RING, *drawn)) > 0.95 * 5.0
    mild = [*aims(5), "path.radius=12 m"]
    assert "1.03 m inside" in find(RING, "note", "guidance.lookahead", *mild).message
    assert late_error(fly(RING, *mild)) == pytest.approx(1.0267, abs=0.02)


@pytest.mark.parametrize(
    ("overrides", "overshoots"),
    [
        ([lagging(2), "guidance.lookahead=2 m"], True),
        ([lagging(2), "guidance.lookahead=4.2 m"], False),
        ([lagging(2), *arcsine(0.25)], True),
        ([lagging(2), *arcsine(0.12)], False),
        (["vehicles.a.model=medusa", "guidance.lookahead=1 m"], True),
        (["vehicles.a.model=medusa", "guidance.lookahead=3 m"], False),
    ],
)
def test_steering_too_hard_for_the_lag_of_the_heading_overshoots(overrides: list[str], overshoots: bool) -> None:
    text = mission([POINT.replace("start: {", "start: {cross_track: 0.5 m, ")], "log_period: 0.1 s\n", duration=100.0)
    said = told(text, "guidance.lookahead", *overrides) | told(text, "guidance.gain", *overrides)
    assert bool("warning" in said) is overshoots
    assert bool(fly(text, *overrides).channels["cross_track"].min() < -0.01) is overshoots


@pytest.mark.parametrize(
    ("period", "latency", "law", "weaves"),
    [
        (1, 14, "reset", False),
        (1, 17, "reset", True),
        (18, 0, "direct", False),
        (22, 0, "direct", True),
        (8, 9, "direct", False),
        (8, 14, "direct", True),
    ],
)
def test_fixes_too_late_or_held_too_long_make_it_weave(period: float, latency: float, law: str, weaves: bool) -> None:
    text = mission([by_satellite(period, latency)], f"position: {{law: {law}}}\n", LONG, 1500.0)
    assert bool("error" in told(text, "guidance.lookahead")) is weaves
    assert bool(late_error(fly(text)) > 1.0) is weaves


@pytest.mark.parametrize(
    ("overrides", "agree"),
    [
        ([], True),
        (["coordination.topology=[[0, 0], [1, 0]]"], True),
        (["coordination.topology=[[0, 0], [0, 0]]"], False),
        ([SILENT], True),
        (["messaging=none"], False),
        (channel(loss="1"), False),
        (channel(max_range="6 m"), False),
        (["messaging.period=0.1 s", *channel(delay="6.4 s")], False),
    ],
)
def test_fleets_that_are_told_not_to_agree_do_not(overrides: list[str], agree: bool) -> None:
    ahead = ["vehicles.a.start.along_track=4 m", *overrides]
    assert any(finding.level == "error" for finding in findings(PAIR, ahead)) is not agree
    states = fly(PAIR, "path.length=1 km", *ahead).channels["coordination_state"][-1]
    assert bool(abs(states[0] - states[1]) < 0.1) is agree


@pytest.mark.parametrize("law", ["coordinated", "reported_speed"])
@pytest.mark.parametrize(("gain", "settles"), [(0.12, True), (0.3, False)])
def test_late_reports_that_are_carried_on_make_a_fast_fleet_swing(law: str, gain: float, settles: bool) -> None:
    late = [*channel(delay="6 s"), f"neighbors.law={law}", "messaging.period=1 s", f"coordination.gain={gain} m/s"]
    late += ["vehicles.a.start.along_track=0.5 m", "path.length=1 km", "duration=1500 s"]
    assert ("warning" in told(PAIR, "coordination.gain", *late)) is not settles
    correction = np.abs(fly(PAIR, *late).channels["speed_correction"][-100:]).max()
    assert bool(correction < 0.01) is settles


@pytest.mark.parametrize(("usbl", "agree"), [("{}", True), ("none", False)])
def test_a_silent_vehicle_is_followed_where_a_third_one_sees_it_and_tells(usbl: str, agree: bool) -> None:
    ahead = DIVER.replace("5 m}", "-5 m}, start: {along_track: 4 m}").replace("name: b", "name: c")
    text = mission([HEAD, DIVER, ahead], TOLD, LONG)
    overrides = ["coordination.topology=[[0, 1, 0], [0, 0, 1], [0, 0, 0]]", "vehicles.c.messaging=none"]
    overrides += [f"vehicles.a.sensors.usbl={usbl}"]
    assert bool(told(text, "vehicles.c.messaging", *overrides) == {"error"}) is not agree
    states = fly(text, *overrides).channels["coordination_state"][-1]
    assert bool(abs(states[1] - states[2]) < 1.0) is agree


def test_predictions_in_steps_that_are_too_long_chatter() -> None:
    for scale, chatters in ((0.01, True), (0.05, False)):
        overrides = [f"coordination.length_scale={scale} m", "path.length=1 km", "vehicles.a.start.along_track=1 m"]
        assert bool("warning" in told(PAIR, "coordination.length_scale", *overrides)) is chatters
        # every tick: a chatter of two ticks looks like rest once a second
        states = fly(PAIR, *overrides, "log_period=0.1 s").channels["coordination_state"]
        assert bool(float(np.ptp(states[-100:, 0] - states[-100:, 1])) > 0.01) is chatters


@pytest.mark.parametrize("offset", [0.0, 0.1, 0.5])
def test_late_fixes_put_the_vehicle_astern_by_the_predicted_way(offset: float) -> None:
    overrides = [f"messaging.offset={offset} s", "path.length=5 km"]
    said = find(TEAM, "note", "position.law", *overrides).message
    assert ("warning" in told(TEAM, "messaging.offset", *overrides)) is (offset == 0.0)
    predicted = float(said.split("up to ")[1].split(" m ")[0])
    late = fly(TEAM, *overrides)
    # The head sees how far ahead the other is, the other believes itself astern: both go faster than v_L.
    state = late.channels["coordination_state"][len(late.times) // 2 :, 1]
    pace = float(np.polyfit(np.arange(len(state)), state, 1)[0]) / (late.times[1] - late.times[0])
    assert 0.5 < pace < 0.57
    assert lag_astern(late, 1) == pytest.approx(predicted * pace / 0.5, rel=0.02)
    assert abs(lag_astern(fly(TEAM, *overrides, "position.law=reset_compensated"), 1)) < 0.01


def test_fixes_older_than_what_is_remembered_leave_the_predicted_bias() -> None:
    assert lag_astern(fly(LATE, "duration=100 s"), 0) == pytest.approx(0.0, abs=0.01)
    lag = lag_astern(fly(LATE, "duration=100 s", "tick=0.01 s"), 0)
    assert lag == pytest.approx(0.5 * (5.0 - 2.55), abs=0.01)


def test_a_filter_leaves_out_fixes_older_than_what_it_remembers() -> None:
    said = find(LATE, "warning", "tick", "position={law: kalman_replay}", "tick=0.01 s")
    assert "kalman_replay remembers 255 ticks, 2.55 s: what is older is left out" in said.message
    assert not told(LATE, "tick", "position={law: kalman_replay}")


def test_a_current_is_taken_only_from_a_law_that_estimates_one() -> None:
    said = find(ALONE, "warning", "current_observer.law", "current_observer={law: from_position}")
    assert "takes the current from its position law, and direct estimates none" in said.message
    assert said.suggestion == "position.law=kalman_replay"
    assert not told(ALONE, "current_observer.law", "current_observer={law: from_position}", said.suggestion)


def test_a_vehicle_without_fixes_drifts_as_far_as_predicted() -> None:
    overrides = ["vehicles.a.sensors.usbl=none", "path.length=5 km"]
    assert "0.1 m/s, 42 m by the end" in find(TEAM, "warning", "vehicles.b.depth", *overrides).message
    flight = fly(TEAM, *overrides)
    apart = [flight.channels[f"{axis}_estimate"][-1, 1] - flight.channels[axis][-1, 1] for axis in ("north", "east")]
    assert float(np.hypot(*apart)) == pytest.approx(42.0, rel=0.1)


def test_missions_without_a_heading_stop_and_without_a_speed_go_at_the_wrong_one() -> None:
    assert fly(TEAM, "vehicles.b.sensors.ahrs=none").reason == "failed"
    assert speeds(fly(TEAM, "vehicles.a.sensors.thruster_speed=none", "current=none"))[-1] > 0.6  # 0.5 is asked for
    assert fly(HULLED, "tick=0.01 s", "plant_step=0.005 s", "duration=5 s").reason == "failed"
    stuck = fly(HULLED, "autopilot.turn_bandwidth=45 1/s", "vehicles.a.start.cross_track=1 m")
    assert stuck.channels["coordination_state"][-1, 0] < 100.0  # of 200 m


def test_the_least_distance_in_the_formation_and_the_way_made_are_as_predicted() -> None:
    text = mission([POINT, BESIDE], "require: {separation_min: 6 m}\n", MOWER)
    said = find(text, "warning", "vehicles.b.offset").message
    assert "come within 5 m; at least 6 m (required by separation_min)" in said
    assert fly(text).metrics.fleet["separation_min"] == pytest.approx(5.0, abs=0.01)
    short = find(ALONE, "warning", "duration", "duration=60 s", "current=none").message
    assert "the formation is 30 m along a path of 200 m, which takes 400 s" in short
    flight = fly(ALONE, "duration=60 s", "current=none")
    assert flight.channels["coordination_state"][-1, 0] == pytest.approx(30.0, abs=0.6)


@pytest.mark.parametrize(("speed", "is_carried_off"), [(0.45, False), (0.6, True)])
def test_a_vehicle_holds_the_end_of_its_path_unless_told_otherwise(speed: float, is_carried_off: bool) -> None:
    overrides = ["path.length=30 m", "speed_reference=water", f"current.speed={speed} m/s", "current.towards=0 deg"]
    assert bool("warning" in told(ALONE, "end", *overrides)) is is_carried_off
    beyond = fly(ALONE, *overrides).channels["coordination_state"][-1, 0] - 30.0
    assert bool(beyond > 10.0) is is_carried_off


def test_a_path_file_that_cannot_be_read_is_laid_to_the_key_path(tmp_path: Path) -> None:
    Path(tmp_path, "log.gpx").write_bytes(b"\x89HDF\0\0\0")
    Path(tmp_path, "m.yaml").write_text(mission([POINT], path="{type: file, file: log.gpx}"))
    (found,) = check_mission(open_mission(str(Path(tmp_path, "m.yaml"))))
    assert (found.level, found.key) == ("error", "path")
    assert "is a binary file" in found.message
