"""`check` on the laws that stand beside the paper's: what it says of them is what they then do."""

import re

import numpy as np
import pytest

from cardume.missions.available import catalog
from cardume.missions.checks import Finding, check_mission
from cardume.missions.loading import parse_mission
from flying import LAWS, fly_text

TEXT = """
cardume: 1
name: t
duration: 400 s
path: {type: line, length: 5 km}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.2 m/s, towards: 90 deg}
vehicles:
  - {name: a, model: MODEL, sensors: ideal, start: {cross_track: 0.5 m, speed: 0.5 m/s}}
"""
KINEMATIC = TEXT.replace("MODEL", "kinematic")
LAGGING = TEXT.replace("MODEL", "{law: kinematic, heading_time_constant: 2 s}").replace("0.2 m/s", "0 m/s")
KNOWN = ["current_observer={law: complementary, k1: 0.5 1/s, k2: 0.06 1/s^2}", "position.law=direct"]


def findings(text: str, *overrides: str) -> list[Finding]:
    return check_mission(parse_mission(text, catalog([LAWS]), overrides), [LAWS])


def about(text: str, key: str, *overrides: str) -> list[Finding]:
    return [finding for finding in findings(text, *overrides) if finding.key == key]


@pytest.mark.parametrize(
    "guidance",
    [
        "{law: line_of_sight, lookahead: 5 m}",
        "{law: vector_field, approach: 60 deg, width: 3 m}",
        "{law: arcsine_with_current, decay_length: 6 m}",
    ],
)
def test_the_offset_that_a_current_leaves_is_the_one_flown(guidance: str) -> None:
    (said,) = about(KINEMATIC, "compensation.law", f"guidance={guidance}")
    offset = float(re.search(r"up to ([0-9.]+) m off its path", said.message)[1])
    error = fly_text(KINEMATIC, [f"guidance={guidance}"]).channels["cross_track"][-1, 0]
    assert error == pytest.approx(offset, abs=0.006)
    assert not about(KINEMATIC, "compensation.law", f"guidance={guidance}", "compensation.law=crab", *KNOWN)[1:]


def test_a_field_too_shallow_for_the_current_never_arrives() -> None:
    shallow = ["guidance={law: vector_field, approach: 15 deg}", "current.speed=0.2 m/s"]
    assert "up to inf m" in about(KINEMATIC, "compensation.law", *shallow)[0].message
    error = fly_text(KINEMATIC, shallow).channels["cross_track"][:, 0]
    assert error[-1] > error[200] + 10.0


@pytest.mark.parametrize(
    "guidance",
    [
        "{law: integral_line_of_sight}",
        "{law: adaptive_line_of_sight}",
        "{law: arcsine_integral}",
    ],
)
def test_a_law_with_an_integral_is_not_said_to_drift(guidance: str) -> None:
    assert about(KINEMATIC, "compensation.law", f"guidance={guidance}") == []
    flight = fly_text(KINEMATIC, [f"guidance={guidance}", "duration=900 s"])
    assert abs(flight.channels["cross_track"][-1, 0]) < 0.01


@pytest.mark.parametrize(
    ("guidance", "key"),
    [
        ("law=integral_line_of_sight integral_gain=0", "lookahead"),
        ("law=adaptive_line_of_sight adaptation_gain=0", "lookahead"),
        ("law=vector_field approach=90deg", "width"),
        ("law=arcsine_with_current", "decay_length"),
    ],
)
def test_steering_too_hard_for_the_lag_of_the_heading_overshoots(guidance: str, key: str) -> None:
    """Critical at d = 4 u T = 4 m."""
    for length, overshoots in ((2.0, True), (4.3, False)):
        given = [f"guidance.{setting}" for setting in (*guidance.split(), f"{key}={length} m")]
        said = about(LAGGING, f"guidance.{key}", *given)
        assert bool(said) is overshoots
        assert bool(np.min(fly_text(LAGGING, given).channels["cross_track"]) < -0.01) is overshoots
        if overshoots:
            assert not about(LAGGING, f"guidance.{key}", *given, said[0].suggestion)


@pytest.mark.parametrize(
    ("law", "asked", "left"),
    [
        ("arcsine_with_current", "headings", "only the speed"),
        ("body_frame_target", "yaw rates and speeds", "nothing"),
        ("trajectory_tracking", "yaw rates and speeds", "nothing"),
    ],
)
def test_a_compensation_that_is_not_used_is_told(law: str, asked: str, left: str) -> None:
    crab = [f"guidance.law={law}", "compensation.law=crab", *KNOWN]
    (said,) = about(KINEMATIC, "compensation.law", *crab)
    assert said.level == "note"
    assert f"{law} asks for {asked} itself, past compensation; of crab {left} is used" in said.message
    if said.suggestion:
        assert about(KINEMATIC, "compensation.law", *crab, said.suggestion) == []
        flights = [fly_text(KINEMATIC, given) for given in (crab, [*crab, said.suggestion])]
        assert np.array_equal(flights[0].channels["north"], flights[1].channels["north"])


def test_beside_a_law_that_asks_for_a_course_it_is_used() -> None:
    for law in ("line_of_sight", "integral_line_of_sight", "'aids:parallel'"):
        given = [f"guidance={{law: {law}}}", "compensation.law=crab", *KNOWN]
        assert about(KINEMATIC, "compensation.law", *given) == []
