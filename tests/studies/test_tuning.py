"""Tuning against optima that are known beforehand, and what it refuses."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cardume
from cardume.errors import DataError, InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.opening import open_mission
from cardume.missions.results import choose_destination
from cardume.report.tuning.figure import draw_tuning
from cardume.report.tuning.words import tuning_table, tuning_words
from cardume.studies.run_table import RunTable
from cardume.studies.tuning import trying
from cardume.studies.tuning.evidence import Evidence, weigh
from cardume.studies.tuning.keeping import keep_tuning
from cardume.studies.tuning.knobs import make_knobs, with_values
from cardume.studies.tuning.resuming import read_tuning
from cardume.studies.tuning.searching import Goal, Try, best_of, cost, front_of
from cardume.studies.tuning.tune import Tuning
from studies.missions import LINE, NOISY

BLIND = LINE.replace("sensors: ideal", "sensors: {ahrs: {}, depth: {}, thruster_speed: {scale: 1.25}}")
BLIND = BLIND.replace("sensors: {ahrs", "initial_estimate: {north: 4 m, east: -1 m}, sensors: {ahrs")
STILL = "current=none"


def read(text: str, *overrides: str) -> Mission:
    return parse_mission(text, catalog(), overrides)


def keep(found: Tuning, directory: Path, draw: Callable[[Path], None] | None = None) -> tuple[Path, dict[str, Any]]:
    destination = choose_destination("x", directory, read_tuning)
    return keep_tuning(destination, "x", found, words=["so"], version="1", draw=draw)


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
    where, told = keep(placed, tmp_path / "out", draw=drawn.append)
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


ONE_KNOB = ["guidance.lookahead=1..10"]
HOW: dict[str, Any] = {"evaluations": 10, "runs": 2}


def tune_noisy(**how: Any) -> Tuning:
    return cardume.tune(read(NOISY, "duration=15 s"), ONE_KNOB, ["cross_track_iae"], **HOW | how)


class After:
    """Asks to stop when a stage has come so far."""

    def __init__(self, stage: str, done: int) -> None:
        self.stage, self.done, self.is_reached = stage, done, False

    def progress(self, stage: str, done: int, total: int) -> None:
        self.is_reached |= stage == self.stage and done >= self.done

    def should_stop(self) -> bool:
        return self.is_reached

    @property
    def how(self) -> dict[str, Any]:
        return {"progress": self.progress, "should_stop": self.should_stop}


def test_a_stop_during_the_proof_keeps_the_best() -> None:
    found = tune_noisy(**After("compare", 1).how)
    assert found.is_interrupted
    assert len(found.tries) == len(tune_noisy().tries)
    assert found.recommended.vehicles[0].guidance.law.parameters["lookahead"] == found.best.values[0]
    assert tuning_words(found)[0].startswith(f"Interrupted after {len(found.tries)} tries")


def test_a_tuning_that_continues_ends_as_if_it_had_never_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = tune_noisy()
    cut = tune_noisy(**After("tune", 6).how)
    assert (len(cut.tries), cut.is_interrupted) == (6, True)
    directory, _ = keep(cut, tmp_path / "it")
    flown: list[Any] = []
    monkeypatch.setattr(trying, "with_values", lambda *given: flown.append(given[2]) or with_values(*given))
    again = tune_noisy(resume=directory)
    assert again.tries == whole.tries
    assert again.best == whole.best
    assert again.evidence is not None
    assert whole.evidence is not None
    assert again.evidence.differences == whole.evidence.differences
    assert again.recommended == whole.recommended
    assert (
        len(flown) == 1 + (len(whole.tries) - 6) + 2
    )  # the start, which says whether runs differ; what is left; the proof
    assert keep(again, directory)[1] == keep(whole, tmp_path / "whole")[1]


def test_nothing_that_is_known_is_forgotten_while_a_tuning_continues(tmp_path: Path) -> None:
    directory, _ = keep(tune_noisy(**After("tune", 6).how), tmp_path / "it")
    counts: list[int] = []
    tune_noisy(resume=directory, remember=lambda settings, tries: counts.append(len(tries)))
    assert counts[:7] == [6, 6, 6, 6, 6, 6, 7]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"runs": 3}, "has 2 for --runs, and 3 is given"),
        ({"seed": 5}, "for --seed, and 5 is given"),
        ({"evaluations": 11}, "has 10 for --evaluations"),
        ({"overrides": ["current.speed=0.2 m/s"]}, "is of another mission"),
    ],
)
def test_another_tuning_is_not_continued(tmp_path: Path, change: dict[str, Any], said: str) -> None:
    directory, _ = keep(tune_noisy(**After("tune", 2).how), tmp_path / "it")
    with pytest.raises(InputError, match=said):
        tune_noisy(resume=directory, **change)


def test_a_damaged_tuning_is_told(tmp_path: Path) -> None:
    directory, _ = keep(tune_noisy(**After("tune", 2).how), tmp_path / "it")
    table = (directory / "tries.csv").read_text()
    (directory / "tries.csv").write_text(table.replace("\n1,", "\n1,x", 1))
    with pytest.raises(DataError, match=r"tries.csv is damaged .*tune again"):
        tune_noisy(resume=directory)
    (directory / "tries.csv").unlink()
    with pytest.raises(DataError, match=r"tries.csv cannot be read"):
        tune_noisy(resume=directory)
    with pytest.raises(DataError, match="give the directory of a tuning"):
        tune_noisy(resume=tmp_path)


def test_one_run_of_a_try_does_not_hide_that_runs_differ() -> None:
    found = tune_noisy(runs=1)
    assert (found.is_random, found.runs) == (True, 1)
    assert found.evidence is not None
    assert len(found.evidence.start) == 100
    still = cardume.tune(read(LINE, "duration=15 s"), ONE_KNOB, ["cross_track_iae"], runs=1, evaluations=10)
    assert not still.is_random


def test_seeds_beyond_the_largest_are_refused() -> None:
    for seed in (2**63 - 1, 2**63 - 1_000_000, -1):
        with pytest.raises(InputError, match=f"--seed {seed}: the search and its proof"):
            tune_noisy(seed=seed)


def test_values_that_cannot_be_flown_are_tries_and_no_end() -> None:
    """Within a circle of 20 m a vehicle cannot be 20 m and more to starboard of it."""
    around = read(NOISY, "path={type: circle, radius: 20 m, centre: {north: 0 m, east: 0 m}}", "duration=10 s")
    found = cardume.tune(around, ["vehicles.a.offset.starboard=0..60"], ["energy"], runs=2, evaluations=10)
    lost = [one for one in found.tries if one.counted == 0.0]
    assert 0 < len(lost) < 10
    assert min(one.values[0] for one in lost) >= 19.0
    assert found.best.counted == 1.0


def table_of(numbers: np.ndarray, met: np.ndarray | None = None) -> RunTable:
    """Runs with these numbers of a metric or two."""
    columns, nothing = np.atleast_2d(numbers), np.full(np.shape(numbers)[-1], math.nan)
    names = ["fleet_cross_track_iae", "fleet_yaw_effort"][: len(columns)]
    is_met = np.ones((len(nothing), 0), bool) if met is None else met[:, None]
    return RunTable(
        seeds=np.arange(len(nothing)),
        drawn={},
        metrics=dict(zip(names, columns, strict=True)),
        requirements=("energy <= 9 J",)[: is_met.shape[1]],
        got=is_met.astype(float),
        met=is_met,
        failed_at=nothing,
        failure=("",) * len(nothing),
        violated_at=np.full(is_met.shape, math.nan),
    )


def weighed(start: RunTable, best: RunTable, metrics: int = 1, quantile: float | None = None) -> Evidence:
    names = ["cross_track_iae", "yaw_effort"][:metrics]
    return weigh(start, best, read(LINE), names, Goal((1.0,) * metrics, 0.95), quantile)


CHANCE = np.random.default_rng(11)
RUNS = CHANCE.normal(10.0, 1.0, 100)
BETTER = RUNS - 0.5 + CHANCE.normal(0.0, 0.1, 100)


def test_a_gain_is_real_where_no_metric_is_lost() -> None:
    assert weighed(table_of(RUNS), table_of(BETTER)).is_better
    assert not weighed(table_of(BETTER), table_of(RUNS)).is_better
    both = weighed(table_of(np.array([RUNS, BETTER])), table_of(np.array([BETTER, RUNS])), 2)
    assert (both.changes, both.is_better) == ((1, -1), False)
    one = weighed(table_of(np.array([RUNS, RUNS])), table_of(np.array([BETTER, RUNS])), 2)
    assert (one.changes, one.is_better) == ((1, 0), True)


def test_answers_share_the_risk() -> None:
    """One metric that is just clear by itself, with a chance of 4 %, is not among two."""
    noise = np.random.default_rng(3).normal(size=100)
    noise = (noise - noise.mean()) / noise.std(ddof=1)
    slightly = RUNS + 0.1 * noise - 0.0206  # 2.06 standard errors
    assert weighed(table_of(RUNS), table_of(slightly)).is_better
    assert weighed(table_of(np.array([RUNS, RUNS])), table_of(np.array([slightly, RUNS])), 2).changes == (0, 0)


def test_runs_without_numbers_are_not_left_out_of_the_proof() -> None:
    """Pairs of which one has no number say nothing of the difference: that they are so many does."""
    lost = np.where(np.arange(100) < 20, math.nan, BETTER)
    assert not weighed(table_of(RUNS), table_of(lost)).is_better
    assert weighed(table_of(lost), table_of(RUNS)).is_better


def test_what_is_required_comes_first_in_the_proof() -> None:
    share = lambda count: np.arange(100) < count  # noqa: E731
    start = table_of(RUNS, share(70))
    assert weighed(start, table_of(RUNS + 1.0, share(99))).is_better  # a worse metric, but as required
    assert not weighed(table_of(RUNS, share(96)), table_of(BETTER, share(94))).is_better  # no longer as required
    assert not weighed(table_of(RUNS, share(94)), table_of(RUNS, share(96))).is_better  # two runs more are chance
    assert weighed(table_of(RUNS, share(100)), table_of(BETTER, share(96))).is_better  # as required all the same


def test_a_quantile_is_proved_by_the_quantile() -> None:
    """Nine tenths gain a little, and the last tenth loses much: the mean is better, the 95 % quantile worse."""
    spread = np.sort(RUNS)
    mixed = np.where(np.arange(100) < 88, spread - 0.5, spread + 2.0)
    assert weighed(table_of(spread), table_of(mixed)).is_better
    by_quantile = weighed(table_of(spread), table_of(mixed), quantile=0.95)
    assert (by_quantile.changes, by_quantile.is_better) == ((-1,), False)
    (difference,) = by_quantile.differences
    assert difference.mean == pytest.approx(2.0)
    assert 0.0 < difference.low <= 2.0 <= difference.high


def test_of_a_front_one_that_loses_nothing_is_recommended() -> None:
    start = Try((0.0,), (2.0, 2.0), 1.0, 1.0)
    compromise, better = Try((1.0,), (1.0, 2.1), 1.0, 1.0), Try((2.0,), (1.9, 1.9), 1.0, 1.0)
    assert best_of([start, compromise, better], Goal((1.0, 1.0), 0.9)) == better
    assert best_of([start, compromise], Goal((1.0, 1.0), 0.9)) in (start, compromise)
