"""The table and the sentences: what a person reads after a flight."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cardume.missions.mission import Requirement
from cardume.missions.summary import judge
from cardume.report.table import number, results_table, share_heard
from cardume.report.words import meaning, verdict_lines
from cardume.simulation.flight import Flight, Metrics
from report.synthetic import make_flight, without_settling

MISSION: Any = SimpleNamespace(duration=700.0, transient=SimpleNamespace(threshold=0.5, hold=10.0))


@pytest.fixture(scope="module")
def flight() -> Flight:
    return make_flight()


def row_of(table: str, label: str) -> list[str]:
    return next(line.split() for line in table.splitlines() if line.startswith(label))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.28349, "0.283"),
        (2.4149, "2.41"),
        (31.44, "31.4"),
        (4312.4, "4312"),
        (np.nan, "-"),
        (np.inf, "-"),
        (0.0, "0.000"),
    ],
)
def test_numbers_have_three_digits(value: float, text: str) -> None:
    assert number(value) == text


def test_80_columns_hold_all_that_matters(flight: Flight) -> None:
    table = results_table(flight, 80)
    assert max(map(len, table.splitlines())) <= 80
    assert row_of(table, "port") == ["port", "0.284", "0.540", "0.837", "42.4", "0.743", "0.016", "0.608", "81", "%"]
    fleet = "fleet 0.284 0.540 0.837 42.4 0.743 0.016 0.410 0.608 81 %"
    assert row_of(table, "fleet") == fleet.split()
    heading = ["cross-track", "[m]", "settled", "position", "current", "coord.", "formation", "messages"]
    assert table.split()[: len(heading)] == heading


@pytest.mark.parametrize("width", range(30, 180, 7))
def test_columns_stand_below_their_headings(flight: Flight, width: int) -> None:
    lines = results_table(flight, width).splitlines()
    assert max(map(len, lines)) <= width
    assert len(lines[2]) == len(lines[1]) == len(lines[6])  # the fleet's row is full
    assert len(lines[0]) <= len(lines[1])


def test_more_room_shows_more(flight: Flight) -> None:
    assert "energy" not in results_table(flight, 80)
    assert "energy" in results_table(flight, 160)
    assert "lines" in results_table(flight, 140)


def test_share_heard(flight: Flight) -> None:
    assert share_heard(flight) == pytest.approx(0.8, abs=0.02)
    silent = replace(flight, messages={name: values[:0] for name, values in flight.messages.items()})
    assert np.isnan(share_heard(silent))
    assert "messages" not in results_table(silent, 160)


def words(flight: Flight, *requirements: Requirement) -> str:
    return meaning(flight, MISSION, judge(requirements, flight.metrics))


def test_sentences_of_a_good_flight(flight: Flight) -> None:
    text = words(flight, Requirement(metric="cross_track_rms", limit=0.5, unit="m"))
    assert text.startswith(
        "Flew 700 s, in 6.1 ms of computing. Every vehicle reached its path, the last (port) after 42 s"
    )
    assert "within 0.540 m of it 95 % of the time" in text
    assert "kept together to 0.410 m rms, 1.32 m at worst" in text
    assert "No two came closer than 2.41 m" in text
    assert text.endswith("What was required is met.")


@pytest.mark.parametrize(
    ("error", "cause"),
    [(0.0, "knew its error exactly: steering limits it"), (3.0, "knowing where it is limits it, not steering")],
)
def test_the_cause_of_an_error_is_told_apart(flight: Flight, error: float, cause: str) -> None:
    believed = flight.channels["cross_track"] * (1.0 + error)
    text = words(replace(flight, channels={**flight.channels, "cross_track_estimate": believed}))
    assert cause in text
    assert "port, the worst," in text


def test_an_unsettled_vehicle_is_named(flight: Flight) -> None:
    text = words(without_settling(flight, "port"))
    assert "port never stayed within 0.5 m of the path for 10 s" in text
    assert "kept together" not in text
    assert "nan" not in text


@pytest.mark.parametrize(
    ("reason", "beginning"), [("failed", "The mission failed at 312 s of 700 s"), ("interrupted", "Interrupted")]
)
def test_an_early_end_comes_first(flight: Flight, reason: Any, beginning: str) -> None:
    ended = replace(flight, reason=reason, failure="vehicle port", flown=312.0)
    text = words(ended, Requirement(metric="cross_track_rms", limit=0.5, unit="m"))
    assert text.startswith(beginning)
    assert text.endswith("What was required cannot be judged, for the mission did not come to its end.")


def test_nothing_known_says_nothing_wrong(flight: Flight) -> None:
    bare = replace(flight, metrics=Metrics(), wall_seconds=np.nan)
    assert words(bare).startswith("Flew 700 s.")
    assert results_table(bare, 80)


def test_verdict_lines_are_aligned(flight: Flight) -> None:
    requirements = [
        Requirement(metric="cross_track_rms", limit=0.5, unit="m"),
        Requirement(metric="separation_min", limit=3.0, unit="m"),
        Requirement(metric="settling_time", limit=50.0, unit="s", vehicle="port"),
        Requirement(metric="messages_sent", limit=500, unit="", vehicle="port"),
    ]
    lines = verdict_lines(judge(requirements, flight.metrics))
    assert [is_good for _, is_good in lines] == [True, False, True, False]
    assert lines[1][0].split() == ["separation_min", "wanted", "at", "least", "3", "m", "got", "2.41", "m", "MISSED"]
    assert lines[2][0].startswith("port.settling_time")
    assert len({line.index("wanted") for line, _ in lines}) == 1
    assert verdict_lines([]) == []
