"""`check` of a fleet on a modem: its cycle, its slots, who speaks at once, and what noise drowns."""

from __future__ import annotations

import re

import pytest

from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.checks import Finding, check_mission
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.world.acoustics.ainslie_mccolm import ainslie_mccolm
from cardume.world.acoustics.francois_garrison import francois_garrison

TEXT = """
cardume: 1
name: shared
duration: 100 s
path: {type: line, length: 40 m}
formation: {speed: 0.5 m/s}
model: kinematic
vehicles:
  - {name: a, sensors: {gnss: {}, usbl: {}, ahrs: {}, thruster_speed: {}}, start: {speed: 0.5 m/s}}
  - {name: b, depth: 5 m, offset: {starboard: 20 m}, start: {speed: 0.5 m/s}}
  - {name: c, depth: 5 m, offset: {starboard: -20 m}, start: {speed: 0.5 m/s}}
coordination: {law: laplacian_tanh, gain: 0.1 m/s, topology: star}
messaging: {schedule: tdma, range: 200 m}
acoustics: {channel: modem}
"""
KEYS = ("messaging.schedule", "messaging.slot", "messaging.period", "acoustics.source_level_db")


def findings(*overrides: str) -> list[Finding]:
    found = check_mission(parse_mission(TEXT, catalog(), overrides))
    return [f for f in found if f.key.endswith(KEYS)]


def number(words: str, pattern: str) -> float:
    match = re.search(pattern, words)
    assert match, words
    return float(match[1])


def test_a_cycle_is_told_with_the_age_that_follows_from_it():
    """Three slots of 0.7 s: 0.37 s on the air, 0.13 s of way, 0.09 s in the modem, 0.1 s of guard; ages by row S."""
    (note,) = findings()
    assert (note.level, note.key) == ("note", "messaging.schedule")
    assert number(note.message, r"a slot of ([\d.]+) s") == 0.7
    assert number(note.message, r"cycle takes ([\d.]+) s") == 2.1
    way = number(note.message, r"was true ([\d.]+) s before")
    assert number(note.message, r"on average, ([\d.]+) s") == way + 1.05
    (lossy,) = findings("acoustics.bursts=coastal")
    assert number(lossy.message, r"on average, ([\d.]+) s") == pytest.approx(way + 2.1 * 1.2 / 1.6, abs=0.005)
    assert "20 % being lost" in lossy.message


def test_questions_and_answers_take_longer_and_a_fix_is_a_slot_old():
    (note,) = findings("messaging.schedule=polling")
    slot = number(note.message, r"take a slot of ([\d.]+) s")
    assert slot == 1.7  # 500 m, unless a range is given
    assert number(note.message, r"cycle takes ([\d.]+) s") == 3.4
    assert f"a fix is {slot} s old" in note.message


def test_a_slot_too_short_is_told_and_what_is_told_passes():
    warning, _ = findings("messaging.slot=0.5 s")
    assert (warning.level, warning.key) == ("warning", "messaging.slot")
    assert [f.level for f in findings(warning.suggestion)] == ["note"]


def test_more_than_fits_is_told_and_so_are_those_that_speak_at_once():
    warning = findings("messaging={schedule: periodic, period: 1 s}")[0]
    assert (warning.level, warning.key) == ("warning", "messaging.period")
    error = findings("messaging={schedule: periodic, period: 2 s}")[0]
    assert (error.level, error.key) == ("error", "messaging.schedule")
    assert "a and b" in error.message
    assert error.suggestion == "messaging.schedule=tdma"
    apart = [f"vehicles.{name}.messaging.offset={k} s" for k, name in enumerate("abc")]
    assert not findings("messaging={schedule: periodic, period: 3 s}", *apart)


def test_noise_that_drowns_is_told_and_what_is_told_passes():
    warning = findings("acoustics.source_level_db=95 dB")[0]
    assert (warning.level, warning.key) == ("warning", "acoustics.source_level_db")
    assert [f.level for f in findings(warning.suggestion.replace("'", ""))] == ["note"]


@pytest.mark.parametrize("profile", ["evologics_s2c", "nanomodem_v3", "micromodem_fsk", "tritech_micron"])
def test_a_profile_sets_what_is_left_out_and_a_saved_mission_has_it_all(profile):
    mission = parse_mission(TEXT, catalog(), [f"acoustics.profile={profile}", "acoustics.overhead=0.5 s"])
    again = parse_mission(mission.to_yaml(), catalog())
    assert again.vehicles == mission.vehicles
    values = mission.vehicles[0].acoustics.parameters
    assert values["overhead"] == 0.5
    assert values["profile"] == profile
    assert (
        values["byte_time"]
        == {
            "evologics_s2c": 0.01085,
            "nanomodem_v3": 0.0125,
            "micromodem_fsk": 0.1,
            "tritech_micron": 0.2,
        }[profile]
    )


@pytest.mark.parametrize("curve", ["logistic", "fsk"])
def test_noise_is_judged_by_the_curve_that_is_chosen(curve):
    """At the level that is suggested 2 % are lost, whichever the curve."""
    chosen = ["acoustics.profile=micromodem_fsk", f"acoustics.packet_errors={curve}", "messaging.slot=5 s"]
    (warning,) = [f for f in findings("acoustics.source_level_db=80 dB", *chosen) if f.key.endswith("level_db")]
    assert "loses 100 % of the packets" in warning.message
    level = warning.suggestion
    assert not [f for f in findings(level, *chosen) if f.key.endswith("level_db")]
    lower = f"acoustics.source_level_db={number(level, r'=.?([0-9.]+)') - 0.5} dB"
    assert [f for f in findings(lower, *chosen) if f.key.endswith("level_db")]


def test_words_of_a_law_are_numbers_in_flight_and_words_in_a_saved_mission():
    mission = parse_mission(TEXT, catalog(), ["acoustics.absorption=ainslie_mccolm", "acoustics.packet_errors=fsk"])
    assert mission.vehicles[0].acoustics.parameters["absorption"] == "ainslie_mccolm"
    assert parse_mission(mission.to_yaml(), catalog()).vehicles == mission.vehicles
    assert "absorption: ainslie_mccolm" in mission.to_yaml()
    plain = parse_mission(TEXT, catalog())
    assert plain.vehicles[0].acoustics.parameters["packet_errors"] == "logistic"
    media = [make_plan(m, catalog()).plan.vehicles[0].medium for m in (mission, plain)]
    values = {"frequency": 26000.0, "temperature": 12.0, "salinity": 35.0, "depth": 20.0, "acidity": 8.1}
    assert media[0].absorption == ainslie_mccolm(*values.values())
    assert media[1].absorption == francois_garrison(*values.values())
    assert [m.by_theory for m in media] == [1.0, 0.0]


@pytest.mark.parametrize("value", ["thorp", "1", "0.5"])
def test_a_word_that_is_none_is_refused(value):
    with pytest.raises(MissionError, match="francois_garrison"):
        parse_mission(TEXT, catalog(), [f"acoustics.absorption={value}"])


def test_paths_beyond_the_numbers_of_a_packet_are_told():
    far = ["acoustics.codec=compact", "path.start.north=3250 m"]
    (warning,) = [f for f in check_mission(parse_mission(TEXT, catalog(), far)) if f.key == "acoustics.codec"]
    assert warning.level == "warning"
    assert "beyond the numbers for north" in warning.message
    assert "13.4 m" in warning.message  # 3250 + 40 - 3276.6
    assert warning.suggestion == "acoustics.codec=exact"
    near = parse_mission(TEXT, catalog(), ["acoustics.codec=compact"])
    assert not [f for f in check_mission(near) if f.key == "acoustics.codec"]
