"""What is known of depths, seabed and limits before the flight, and that what is suggested passes."""

from __future__ import annotations

import pytest

from cardume.missions.available import catalog
from cardume.missions.checks import check_mission
from cardume.missions.checks.finding import Finding
from cardume.missions.loading import parse_mission

TEXT = """
cardume: 1
name: checked
duration: 200 s
path: {type: line, length: 80 m}
formation: {speed: 0.5 m/s}
bathymetry: {type: slope, depth: 20 m, gradient: -0.05}
vehicles:
  - {name: alone, depth: 8 m, sensors: {gnss: {deepest: 100 m}}}
compensation: {law: crab}
"""


def found(*overrides: str, key: str) -> list[Finding]:
    return [f for f in check_mission(parse_mission(TEXT, catalog(), overrides)) if f.key.endswith(key)]


@pytest.mark.parametrize(
    ("overrides", "level", "key", "words"),
    [
        (["bathymetry.gradient=-0.2"], "error", "alone.depth", "runs aground"),
        (
            ["vehicles.alone.depth={profile: time, points: [[0, 1], [10, 8]]}"],
            "warning",
            "alone.depth",
            "it dives and rises at most",
        ),
        (["vehicles.alone.altitude=4 m", "bathymetry.gradient=-1"], "warning", "alone.altitude", "cannot follow"),
        (["vehicles.alone.altitude=0.5 m", "bathymetry.gradient=-0.22"], "warning", "alone.altitude", "late"),
        (["vehicles.alone.altitude=40 m"], "error", "alone.altitude", "its altimeter measures from"),
        (["vehicles.alone.altitude=4 m", "bathymetry.depth=70 m"], "warning", "alone.depth", "out of the reach"),
        (["limits={depth: 7 m}"], "warning", "limits.depth", "its limit is 7 m"),
        (["limits={geofence: {radius: 30 m}}"], "error", "limits.geofence", "outside its geofence"),
        (
            ["limits={geofence: {polygon: [{north: -5, east: -5}, {north: 50, east: -5}, {north: 0, east: 9}]}}"],
            "error",
            "limits.geofence",
            "outside its geofence",
        ),
        (
            ["phases={dive: {}}", "vehicles.alone.sensors.depth=none"],
            "error",
            "phases.dive",
            "never knows that it is down",
        ),
    ],
)
def test_it_is_told(overrides: list[str], level: str, key: str, words: str) -> None:
    findings = [f for f in found(*overrides, key=key) if words in f.message]
    assert [f.level for f in findings] == [level]
    suggestion = findings[0].suggestion
    if suggestion:
        again = [f for f in found(*overrides, suggestion, key=key) if words in f.message]
        assert again == [], suggestion


def test_a_good_mission_is_not_blamed() -> None:
    good = ["vehicles.alone.altitude=4 m", "limits={depth: 18 m, altitude: 1 m, geofence: {radius: 90 m}}"]
    for key in ("depth", "altitude", "geofence", "bathymetry", "phases.dive"):
        assert found(*good, "phases={dive: {}, gather: {}}", key=key) == []


def test_a_profile_of_speed_is_looked_at_where_it_is_fastest_and_slowest() -> None:
    fast = found("formation.speed={profile: time, points: [[0, 0.4], [50, 3], [100, 0.05]]}", key="")
    assert any("too little" in f.message and "fastest" in f.message for f in fast)
    assert any("dead zone" in f.message and "slowest" in f.message for f in fast)
