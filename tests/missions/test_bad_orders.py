"""What is wrong with profiles, altitude, phases, limits and abort is told with its key and what to do."""

from __future__ import annotations

import json
from typing import Any

import pytest

from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.missions.schema import Profile
from missions.helpers import tree


def read(**sections: Any) -> Mission:
    return parse_mission(json.dumps({**tree(), **sections}), catalog(), source="m.yaml")


def vehicles(**keys: Any) -> list[dict[str, Any]]:
    return [{"name": "port", **keys}, {"name": "starboard"}]


def profile(*points: Any, over: str = "time", **more: Any) -> dict[str, Any]:
    return {"profile": over, "points": list(points), **more}


@pytest.mark.parametrize(
    ("speed", "key", "words"),
    [
        ({"points": [[0, 1]]}, "formation.speed", "lacks 'profile'"),
        ({"profile": "time"}, "formation.speed", "lacks 'points'"),
        (profile([0, 1], over="depth"), "formation.speed.profile", "time, path"),
        (profile([0, 1], over=3), "formation.speed.profile", "time, path"),
        (profile(), "formation.speed.points", "list of 1 to 1000"),
        (profile([0, 1], step=2), "formation.speed.step", "no such key in a profile"),
        (profile([0, 1], [0, 1]), "formation.speed.points.1", "beyond the one before"),
        (profile([5, 1], [3, 1]), "formation.speed.points.1", "given 3 s after 5 s"),
        (profile([0, 1, 2]), "formation.speed.points.0", "a point is a pair"),
        (profile(7), "formation.speed.points.0", "a point is a pair"),
        (profile(["0 m", "1 m/s"]), "formation.speed.points.0.0", "m"),
        (profile(["0 s", "1 m"]), "formation.speed.points.0.1", "m/s"),
        (profile(["0 s", "0 m/s"]), "formation.speed.points.0.1", "above 0 m/s"),
        (profile(["0 m", "nan"], over="path"), "formation.speed.points.0.1", "m/s"),
        ({"uniform": [profile([0, 1]), 2]}, "formation.speed.uniform.0", "must be a number"),
        ("fast", "formation.speed", "m/s"),
    ],
)
def test_a_bad_profile(speed: Any, key: str, words: str) -> None:
    with pytest.raises(MissionError) as caught:
        read(formation={"speed": speed})
    (problem,) = caught.value.problems
    assert problem.position.key == key
    assert words in problem.message


@pytest.mark.parametrize(
    ("sections", "key", "words"),
    [
        ({"vehicles": vehicles(altitude=0)}, "altitude", "above 0 m"),
        ({"vehicles": vehicles(depth=profile([0, -1]))}, "depth.points.0.1", "at least 0 m"),
        ({"vehicles": vehicles(start={"depth": -2})}, "start.depth", "at least 0 m"),
        ({"phases": {"dive": {"deeper": 3}}}, "phases.dive.deeper", "no key"),
        ({"phases": {"dives": {}}}, "phases.dives", "dive"),
        ({"phases": {"dive": {"timeout": 0}}}, "phases.dive.timeout", "above 0 s"),
        ({"phases": {"gather": {"radius": "3 s"}}}, "phases.gather.radius", "m"),
        ({"phases": {"hold": -1}}, "phases.hold", "at least 0 s"),
        ({"phases": {"circle": 0}}, "phases.circle", "above 0 m"),
        ({"phases": "yes"}, "phases", "none"),
        ({"limits": {"depth": -1}}, "limits.depth", "at least 0 m"),
        ({"limits": {"geofence": {}}}, "limits.geofence.radius", "missing"),
        ({"limits": {"geofence": {"radius": 0}}}, "limits.geofence.radius", "above 0 m"),
        ({"limits": {"geofence": {"radius": 3, "polygon": []}}}, "limits.geofence.polygon", "does not go with"),
        ({"limits": {"geofence": {"polygon": []}}}, "limits.geofence.polygon", "at least one item"),
        ({"abort": {"to": "sink"}}, "abort.to", "surface, hold"),
        ({"abort": {"silence": 0}}, "abort.silence", "above 0 s"),
        ({"abort": {"battery": 0}}, "abort.battery", "no key"),
        ({"bathymetry": {"type": "flat", "depth": 0}}, "bathymetry.depth", "above 0 m"),
        ({"bathymetry": {"type": "hill"}}, "bathymetry.type", "flat, gridded, slope"),
        ({"bathymetry": {"type": "gridded"}}, "bathymetry.file", "missing"),
        ({"bathymetry": {"type": "gridded", "file": "no.nc"}}, "bathymetry.file", "no such file"),
        ({"bathymetry": {"type": "slope", "steepness": 1}}, "bathymetry.steepness", "no key"),
    ],
)
def test_a_bad_value(sections: dict[str, Any], key: str, words: str) -> None:
    with pytest.raises(MissionError) as caught:
        read(**sections)
    problem = caught.value.problems[0]
    assert problem.position.key.endswith(key)
    assert words in problem.message
    assert problem.position.line > 0


@pytest.mark.parametrize(
    ("sections", "key", "words"),
    [
        ({"vehicles": vehicles(altitude=4)}, "vehicles.port.altitude", "needs a seabed"),
        ({"limits": {"altitude": 1}}, "limits.altitude", "needs a seabed"),
        (
            {"vehicles": vehicles(altitude=4, sensors={"altimeter": "none"}), "bathymetry": "flat"},
            "vehicles.port.altitude",
            "needs sensors.altimeter",
        ),
        (
            {"vehicles": vehicles(altitude=4, sensors={"depth": "none"}), "bathymetry": "flat"},
            "vehicles.port.altitude",
            "needs sensors.depth",
        ),
        (
            {"limits": {"geofence": {"polygon": [{"north": 0, "east": 0}, {"north": 9, "east": 0}]}}},
            "limits.geofence.polygon",
            "given 2 corners",
        ),
        ({"vehicles": [{"name": "alone"}], "abort": {"silence": 9}}, "abort.silence", "hears nobody"),
    ],
)
def test_what_does_not_go_together(sections: dict[str, Any], key: str, words: str) -> None:
    with pytest.raises(MissionError) as caught:
        make_plan(read(**sections), catalog())
    (problem,) = caught.value.problems
    assert problem.position.key.endswith(key)
    assert words in problem.message


def test_everything_is_read_saved_and_read_back() -> None:
    sections = {
        "formation": {"speed": profile(["0 s", "0.3 m/s"], ["1 min", "1 kn"])},
        "bathymetry": {"type": "slope", "depth": "20 m", "gradient": 0.1, "towards": "90 deg"},
        "vehicles": [
            {"name": "port", "depth": profile([0, 5], ["0.1 km", 12], over="path"), "phases": "none", "limits": "none"},
            {"name": "starboard", "altitude": "4 m", "start": {"cross_track": 1, "depth": 2}},
        ],
        "phases": {"dive": {}, "gather": {"timeout": "2 min"}, "hold": 20, "circle": 5},
        "limits": {"depth": 15, "altitude": 1, "geofence": {"polygon": [{"north": 0, "east": x} for x in (0, 1, 5)]}},
        "abort": {"to": "hold", "silence": 30, "time": "10 min"},
    }
    mission = read(**sections)
    port, starboard = mission.vehicles
    assert port.depth == Profile(over="path", points=((0.0, 5.0), (100.0, 12.0)))
    assert (port.phases, port.limits) == (None, None)
    assert starboard.sensors.altimeter is not None
    assert port.sensors.altimeter is None
    assert starboard.phases is not None
    assert starboard.phases.gather is not None
    assert starboard.phases.gather.timeout == 120.0
    text = mission.to_yaml()
    again = parse_mission(text, catalog())
    assert again == mission
    assert again.to_yaml() == text
    make_plan(again, catalog())


def test_a_mission_without_any_of_it_says_so_when_saved() -> None:
    text = read().to_yaml()
    assert "phases: none" in text
    assert "bathymetry: none" in text


def test_a_profile_may_be_swept_and_its_value_drawn() -> None:
    swept = read(formation={"speed": {"sweep": [0.5, profile([0, 0.3], [9, 0.5])]}})
    assert not swept.is_fixed
    read(vehicles=vehicles(depth={"uniform": ["1 m", "2 m"]}))


def test_the_mean_of_a_profile_is_its_integral_over_the_time() -> None:
    p = Profile(over="time", points=((10.0, 1.0), (20.0, 3.0), (40.0, 3.0)))
    assert p.mean(0.0, 10.0) == 1.0
    assert p.mean(0.0, 30.0) == pytest.approx((10.0 + 20.0 + 30.0) / 30.0)
    assert p.mean(15.0, 15.0) == 2.0
    assert (p.at(-1.0), p.at(15.0), p.at(99.0)) == (1.0, 2.0, 3.0)
