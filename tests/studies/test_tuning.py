"""Tuning against optima that are known beforehand, and what it refuses."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import cardume
from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.opening import open_mission
from cardume.report.tuning.figure import draw_tuning
from cardume.report.tuning.words import tuning_table, tuning_words
from cardume.studies.tuning.keeping import keep_tuning, read_tuning, tuning_destination
from cardume.studies.tuning.knobs import make_knobs
from cardume.studies.tuning.searching import Goal, Try, best_of, cost, front_of
from cardume.studies.tuning.tune import Tuning
from studies.missions import LINE, NOISY

BLIND = LINE.replace("sensors: ideal", "sensors: {ahrs: {}, depth: {}, thruster_speed: {scale: 1.25}}")
BLIND = BLIND.replace("sensors: {ahrs", "initial_estimate: {north: 4 m, east: -1 m}, sensors: {ahrs")
STILL = "current=none"


def read(text: str, *overrides: str) -> Mission:
    return parse_mission(text, catalog(), overrides)


@pytest.fixture(scope="module")
def placed() -> Tuning:
    """A vehicle without fixes believes that it begins elsewhere; where it does is the optimum."""
    ranges = ["vehicles.a.initial_estimate.north=-8..8", "vehicles.a.initial_estimate.east=-8..8"]
    exact = ["vehicles.a.sensors.thruster_speed.scale=1", STILL]
    return cardume.tune(read(BLIND), ranges, ["position_error_rms"], evaluations=90, runs=2, overrides=exact)


def test_a_belief_is_best_where_the_vehicle_is(placed: Tuning) -> None:
    """Dead reckoning keeps its first error: the optimum is the true start, (0, 3) m, with an error of 0."""
    assert placed.best.values == pytest.approx((0.0, 3.0), abs=0.05)
    assert placed.start.metrics[0] == pytest.approx(math.hypot(4.0, -4.0), rel=0.02)
    assert placed.best.metrics[0] < 0.06
    assert placed.is_better
    (difference,) = placed.evidence.differences if placed.evidence else ()
    assert difference.mean == pytest.approx(placed.best.metrics[0] - placed.start.metrics[0], abs=0.05)


def test_the_best_of_a_dense_sweep_is_found() -> None:
    """A wrong scale of the speed, one knob: |1 - a c| u t / sqrt(3), least where the reader undoes the sensor."""
    mission = read(BLIND, STILL, "vehicles.a.initial_estimate={north: 0 m, east: 3 m}")
    key = "vehicles.a.sensors.thruster_speed.scale"
    sweep = np.linspace(0.7, 1.5, 33)
    swept = cardume.compare(mission, {key: list(sweep)}, seeds=[0, 1], metrics=["position_error_rms"])
    errors = swept.values("position_error_rms").mean(axis=1)
    found = cardume.tune(mission, [f"{key}=0.7..1.5"], ["position_error_rms"], evaluations=30, runs=2)
    assert abs(found.best.values[0] - sweep[errors.argmin()]) < 0.0126  # half of a step of the sweep
    slope = (errors[0] - errors.min()) / (sweep[errors.argmin()] - sweep[0])
    assert found.best.metrics[0] <= errors.min() + slope * 0.8e-3  # to a thousandth of the range it is refined


def test_it_flies_with_what_was_found_in_the_file(placed: Tuning, tmp_path: Path) -> None:
    drawn: list[Path] = []
    where, told = keep_tuning(
        tuning_destination("x", tmp_path / "out"), "x", placed, words=["so"], version="1", draw=drawn.append
    )
    again = open_mission(where / "mission.yaml")
    belief = again.vehicles[0].initial_estimate
    assert belief is not None
    assert (belief.north, belief.east) == placed.best.values
    alone = cardume.fly(again).metrics.worst("position_error_rms")[0]
    assert alone < 0.1
    assert read_tuning(where) == told
    assert told["files"] == ["mission.yaml", "summary.json", "tries.csv"]
    rows = list(csv.DictReader((where / "tries.csv").open(encoding="utf-8")))
    assert len(rows) == len(placed.tries)
    assert min(float(row["position_error_rms [m]"]) for row in rows) == placed.best.metrics[0]


def test_it_is_told_in_words_and_drawn(placed: Tuning) -> None:
    table = tuning_table(placed)
    assert "vehicles.a.initial_estimate.north [m]" in table
    assert table.isascii()
    assert tuning_words(placed)[0].startswith("Better in position_error_rms, by the mean, after")
    assert len(draw_tuning(placed).axes) == 3


def test_what_is_required_comes_first() -> None:
    """A short lookahead is best on the path; the requirement holds it back to where the yaw is gentle enough."""
    free = read(NOISY)
    found = cardume.tune(free, ["guidance.lookahead=1..10"], ["yaw_effort"], evaluations=10, runs=2)
    limit = found.start.metrics[0]
    bound = cardume.tune(
        read(NOISY, f"require={{yaw_effort: {limit}}}"),
        ["guidance.lookahead=1..10"],
        ["cross_track_iae"],
        evaluations=16,
        runs=2,
    )
    assert all(one.met == 1.0 or cost(one, bound.goal) > cost(bound.best, bound.goal) for one in bound.tries)
    assert bound.best.met >= bound.goal.met


def test_two_metrics_give_a_front() -> None:
    found = cardume.tune(
        read(NOISY), ["guidance.lookahead=1..10"], ["yaw_effort", "cross_track_iae"], evaluations=20, runs=2
    )
    assert len(found.front) >= 3
    first, second = np.array([one.metrics for one in found.front]).T
    assert (np.diff(first) > 0.0).all()
    assert (np.diff(second) < 0.0).all()  # less of one costs more of the other
    assert found.best in found.front


def test_tries_are_ordered_by_what_is_required_then_by_the_metric() -> None:
    goal = Goal((1.0,), 0.9)
    some = [Try((0.0,), (v,), met, counted) for v, met, counted in ((5.0, 1.0, 1.0), (1.0, 0.5, 1.0), (2.0, 0.8, 1.0))]
    assert best_of([*some, Try((0.0,), (math.nan,), 1.0, 0.5)], goal) == some[0]
    assert sorted(some, key=lambda one: cost(one, goal)) == [some[0], some[2], some[1]]
    two = [Try((float(k),), pair, 1.0, 1.0) for k, pair in enumerate([(1.0, 3.0), (3.0, 1.0), (2.0, 2.0), (3.0, 3.0)])]
    assert front_of(two, Goal((1.0, 1.0), 0.9)) == [two[0], two[2], two[1]]
    assert front_of(two, Goal((-1.0, -1.0), 0.9)) == [two[3]]


@pytest.mark.parametrize(
    ("vary", "complaint"),
    [
        ("guidance.lookahed=1..2", "no number of that name. Did you mean 'guidance.lookahead'"),
        ("guidance.law", "is no number with a range"),
        ("guidance.lookahead=5..2", "the first end must be less than the second; write guidance.lookahead=2..5"),
        ("guidance.lookahead=-1..5", "-1 m is not allowed there; valid: above 0 m"),
        ("guidance.lookahead=1..5 s", "one of length is needed"),
        ("guidance.lookahead=5", "write the least and the most to try"),
        ("tick=0.1..0.2", "is a whole number of ticks"),
        ("current.speed=0..1", "the mission draws or sweeps this value"),
        ("vehicles.a.offset.ahead", "begins at 0 and has no bounds of its own"),
    ],
)
def test_keys_and_ranges_that_cannot_be(vary: str, complaint: str) -> None:
    drawn = read(LINE, "current.speed={uniform: [0 m/s, 0.2 m/s]}")
    with pytest.raises(InputError) as told:
        make_knobs(drawn, [vary], catalog())
    assert complaint in str(told.value)


def test_ranges_that_are_not_given_are_those_of_the_law_or_around_the_start() -> None:
    (wide,) = make_knobs(read(LINE), ["guidance.lookahead"], catalog())
    assert (wide.low, wide.high, wide.is_logarithmic) == (pytest.approx(0.4), pytest.approx(10.0), True)
    assert [wide.at(wide.share(value)) for value in (0.4, 2.0, 10.0)] == pytest.approx([0.4, 2.0, 10.0], rel=1e-3)


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ({"metrics": ["cross_trak_rms"]}, "there is no metric of that name"),
        ({"metrics": ["coordination_error_rms"]}, "has a number for it"),
        ({"runs": 0}, "--runs 0"),
        ({"evaluations": 3}, "--evaluations 3"),
        ({"quantile": 1.5}, "--quantile 1.5"),
        ({"metrics": []}, "0 metrics are given"),
    ],
)
def test_what_cannot_be_tuned(given: dict[str, object], complaint: str) -> None:
    asked: dict[str, object] = {"metrics": ["energy"], "runs": 2, "evaluations": 10} | given
    with pytest.raises(InputError, match=complaint):
        cardume.tune(read(LINE), ["guidance.lookahead"], **asked)  # type: ignore[arg-type]
