"""`check` tells of faults that nobody would notice."""

from __future__ import annotations

import pytest

from cardume.missions.available import catalog
from cardume.missions.checks import Finding, check_mission
from cardume.missions.loading import parse_mission
from missions.test_checks import BESIDE, POINT, mission


def findings(*faults: str, overrides: tuple[str, ...] = ()) -> list[Finding]:
    listed = "".join(f"  - {fault}\n" for fault in faults)
    text = mission([POINT, BESIDE], f"faults:\n{listed}")
    return [f for f in check_mission(parse_mission(text, catalog(), overrides)) if f.key.startswith("faults")]


def test_one_after_the_end_and_what_would_pass() -> None:
    (found,) = findings("{kind: modem_silent, vehicle: a, from: 10 s}", "{kind: modem_silent, vehicle: b, from: 420 s}")
    assert (found.level, found.key) == ("warning", "faults.1.from")
    assert found.message == "420 s is past the end of the mission, 420 s: nothing happens"
    assert found.suggestion == "faults.1.from=210 s"
    assert not findings("{kind: modem_silent, vehicle: b, from: 420 s}", overrides=("faults.0.from=210 s",))


@pytest.mark.parametrize(
    ("fault", "is_told"),
    [
        ("{kind: modem_silent, vehicle: a, from: 150 s}", True),
        ("{kind: sensor_nan, vehicle: a, sensor: ahrs, from: 100 s, lasts: 5 s}", True),
        ("{kind: vehicle_lost, vehicle: a, from: 100 s}", True),
        ("{kind: modem_silent, vehicle: a, from: 50 s}", False),  # began before
        ("{kind: modem_silent, vehicle: b, from: 150 s}", False),  # another vehicle
        ("{kind: forged_packets, vehicle: a, from: 150 s}", False),  # somebody else sends them
        ("{kind: current_step, speed: 0.1 m/s, from: 150 s}", False),
    ],
)
def test_one_aboard_a_lost_vehicle(fault: str, is_told: bool) -> None:
    found = findings(fault, "{kind: vehicle_lost, vehicle: a, from: 100 s}")
    assert bool(found) == is_told
    if is_told:
        assert "a is lost from 100 s: what else fails aboard moves nothing and reaches nobody" in found[0].message


def test_one_that_goes_on_after_the_vehicle_is_back() -> None:
    assert not findings(
        "{kind: vehicle_lost, vehicle: a, from: 100 s, to: 200 s}", "{kind: modem_silent, vehicle: a, from: 150 s}"
    )
    (found,) = findings(
        "{kind: vehicle_lost, vehicle: a, from: 100 s, to: 200 s}",
        "{kind: modem_silent, vehicle: a, from: 150 s, to: 200 s}",
    )
    assert "from 100 s to 200 s" in found.message
