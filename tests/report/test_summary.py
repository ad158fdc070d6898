"""The summary and the verdict: the worst vehicle counts, no value meets nothing, JSON is strict."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.errors import DataError
from cardume.missions.mission import Requirement
from cardume.missions.summary import is_met, judge, read_summary, summarize, to_json
from cardume.simulation.flight import CHANNELS, METRICS, Metrics
from report.synthetic import make_flight, without_settling


def verdict_of(
    metric: str, limit: float, metrics: Metrics, vehicle: str | None = None
) -> tuple[bool, float, str | None]:
    requirement = Requirement(metric=metric, limit=limit, unit=METRICS[metric].unit, vehicle=vehicle)
    (found,) = judge([requirement], metrics)
    return found.met, found.got, found.worst


METRICS_OF_TWO = Metrics(
    fleet={"separation_min": 2.0, "coordination_error_max": 1.5, "cross_track_rms": 99.0},
    vehicles={
        "one": {"cross_track_rms": 0.2, "path_speed_mean": 0.5, "settling_time": 20.0},
        "two": {"cross_track_rms": 0.4, "path_speed_mean": 0.3, "settling_time": math.nan},
    },
)


@pytest.mark.parametrize(
    ("metric", "limit", "vehicle", "expected"),
    [
        ("cross_track_rms", 0.4, None, (True, 0.4, "two")),  # the worst vehicle, whatever the fleet's table says
        ("cross_track_rms", 0.399, None, (False, 0.4, "two")),
        ("cross_track_rms", 0.3, "one", (True, 0.2, "one")),
        ("path_speed_mean", 0.4, None, (False, 0.3, "two")),  # at least
        ("path_speed_mean", 0.3, None, (True, 0.3, "two")),
        ("separation_min", 2.0, None, (True, 2.0, None)),
        ("separation_min", 2.1, None, (False, 2.0, None)),
        ("coordination_error_max", 1.4, None, (False, 1.5, None)),
    ],
)
def test_the_worst_counts(metric: str, limit: float, vehicle: str | None, expected: tuple[bool, float, str]) -> None:
    assert verdict_of(metric, limit, METRICS_OF_TWO, vehicle) == expected


@pytest.mark.parametrize(("metric", "vehicle"), [("settling_time", None), ("settling_time", "two"), ("energy", "one")])
def test_no_value_meets_nothing(metric: str, vehicle: str | None) -> None:
    is_good, got, _ = verdict_of(metric, 1e9, METRICS_OF_TWO, vehicle)
    assert not is_good
    assert math.isnan(got)


def test_a_flight_that_did_not_end_is_not_judged() -> None:
    flight = make_flight(num_rows=11)
    verdicts = judge([Requirement(metric="cross_track_rms", limit=1.0, unit="m")], flight.metrics)
    assert is_met(flight, verdicts) is True
    assert is_met(flight, []) is None
    assert is_met(replace(flight, reason="interrupted"), verdicts) is None
    assert is_met(replace(flight, reason="failed"), verdicts) is None


def test_the_summary_holds_what_a_person_would_look_for() -> None:
    flight = without_settling(make_flight(num_rows=11), "port")
    verdicts = judge([Requirement(metric="cross_track_rms", limit=0.5, unit="m")], flight.metrics)
    text = to_json(summarize(flight, verdicts, duration=700.0, version="0.1.0", files=["log.nc"]))
    found = json.loads(text, parse_constant=lambda constant: pytest.fail(constant))
    assert text.isascii()
    assert found["requirements_met"] is False
    assert found["requirements"] == [
        {
            "metric": "cross_track_rms",
            "unit": "m",
            "bound": "at most",
            "wanted": 0.5,
            "got": None,
            "vehicle": None,
            "worst": "port",
            "met": False,
            "margin": None,
            "first_violated": None,
            "by": None,
        }
    ]
    assert found["fleet"]["cross_track_rms"] is None
    assert found["vehicles"]["surface"]["cross_track_rms"] == 0.21
    assert found["fleet"]["separation_min"] == 2.41
    assert "700," in text.split('"messages_sent":')[1][:6]  # a count is a whole number
    assert set(found["units"]) == set(found["fleet"])
    said = ("mission", "seed", "reason", "failure", "duration", "flown", "version", "files")
    assert [found[name] for name in said] == ["figure-5", 7, "completed", None, 700.0, 700.0, "0.1.0", ["log.nc"]]


numbers = st.floats(width=64) | st.sampled_from([np.float64("nan"), np.float32(0.5), np.int64(3), 7])


@given(st.dictionaries(st.sampled_from(sorted(METRICS)), numbers), numbers)
def test_any_numbers_make_strict_json(values: dict[str, float], wall: float) -> None:
    flight = replace(make_flight(num_rows=3), metrics=Metrics(vehicles={"surface": values}), wall_seconds=wall)
    text = to_json(summarize(flight, [], duration=700.0, version="0.1.0"))
    found = json.loads(text, parse_constant=lambda constant: pytest.fail(constant))
    for name, value in found["vehicles"]["surface"].items():
        assert value == values[name] if math.isfinite(values[name]) else value is None


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (None, "cannot be read: No such file"),
        (b"", "is damaged: it is not JSON"),
        (b"\xff\xfe", "is damaged"),
        (b'{"mission": 1', "is damaged"),
        (b"[1, 2]", "was not written by cardume"),
        (b'{"name": 1}', "was not written by cardume"),
        (b'{"cardume_summary": 1, "files": 5}', "'files' is no list of names"),
        (b'{"cardume_summary": 1, "files": ["a", {}]}', "'files' is no list of names"),
        (b'{"cardume_summary": 2}', "has format 2; this cardume reads format 1"),
    ],
)
def test_what_is_no_summary_is_named(tmp_path: Path, content: bytes | None, complaint: str) -> None:
    if content is not None:
        (tmp_path / "summary.json").write_bytes(content)
    with pytest.raises(DataError, match=complaint):
        read_summary(tmp_path)


CHANNEL_NAMES = """
north east depth heading surge sway yaw_rate course speed current_north current_east
cross_track along_track path_course curvature coordination_state
north_estimate east_estimate current_north_estimate current_east_estimate
cross_track_estimate coordination_state_estimate
course_desired heading_desired speed_desired speed_correction thrust yaw_moment shaft_speed_rpm
altitude depth_desired phase
north_variance north_east_covariance east_variance
"""
METRIC_NAMES = """
cross_track_rms cross_track_p95 cross_track_max cross_track_iae cross_track_rms_lines cross_track_rms_arcs settling_time
position_error_rms current_error_rms coordination_error_rms coordination_error_max
formation_error_rms formation_error_p95 formation_error_rms_relative path_speed_mean separation_min
messages_sent messages_delivered information_age_mean information_age_max energy yaw_effort swath_coverage
depth_max altitude_min geofence_margin_min
"""


def test_the_names_are_those_of_the_contract() -> None:
    """Names that are fixed, so that missions and scripts written today work tomorrow."""
    assert list(CHANNELS) == CHANNEL_NAMES.split()
    assert sorted(METRICS) == sorted(METRIC_NAMES.split())
