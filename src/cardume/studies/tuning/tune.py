"""Find values of a few keys with which a mission does best over all that it draws, and prove it on fresh seeds."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.drawing import refuse_sweeps
from cardume.missions.mission import Mission
from cardume.simulation.flight import METRICS
from cardume.studies.arms import Arm, Given, check_metrics, open_given
from cardume.studies.comparing import values_of
from cardume.studies.flying import Progress, RunTable, fly_seeds
from cardume.studies.statistics import Estimate, is_clear, paired_difference
from cardume.studies.tuning.knobs import Knob, make_knobs, with_values
from cardume.studies.tuning.searching import (
    Enough,
    Goal,
    Shares,
    Try,
    best_of,
    front_of,
    search_one,
    search_several,
)
from cardume.studies.work import expected_ticks, wants_lanes

DEFAULT_RUNS, DEFAULT_TRIES = 24, 60
FEWEST_TRIES, MOST_TRIES, MOST_RUNS, MOST_METRICS = 10, 10_000, 10_000, 3
FRESH_FROM = 1_000_000  # seeds after the first of the search
FRESH_RUNS = 100
HOPELESS = 8  # tries in which no run has a number, after which it is given up
DEFAULT_MET = 0.95


@dataclass(frozen=True)
class Evidence:
    """The start and the best on seeds that the search never saw.

    Attributes:
        start: runs with the values that the mission had.
        best: runs with the values that were found, of the same seeds.
        differences: for each metric, how much more the best has than the start, in pairs of equal seed.
    """

    start: RunTable
    best: RunTable
    differences: tuple[Estimate, ...]


@dataclass(frozen=True)
class Tuning:
    """What a search found.

    Attributes:
        mission: that was tuned.
        recommended: the same with the values to fly with: those found, if they are better, else its own.
        knobs: what was varied.
        metrics: for which.
        quantile: of each metric over the runs [-]; None: its mean.
        runs: of a try.
        tries: all, in order; the first is the mission as it was.
        best: the one that was found.
        front: for several metrics, all tries of which no other is better in each.
        evidence: on fresh seeds; None where the search was interrupted.
        goal: what is better.
        is_better: whether the evidence says so.
        is_random: whether a mission differs from seed to seed.
        is_interrupted: whether it ended before its time.
    """

    mission: Mission
    recommended: Mission
    knobs: tuple[Knob, ...]
    metrics: tuple[str, ...]
    quantile: float | None
    runs: int
    tries: tuple[Try, ...]
    best: Try
    front: tuple[Try, ...]
    evidence: Evidence | None
    goal: Goal
    is_better: bool
    is_random: bool
    is_interrupted: bool

    @property
    def start(self) -> Try:
        """The mission as it was."""
        return self.tries[0]


def tune(
    mission: Given,
    vary: Sequence[str],
    metrics: Sequence[str],
    *,
    runs: int = DEFAULT_RUNS,
    evaluations: int = DEFAULT_TRIES,
    quantile: float | None = None,
    met: float = DEFAULT_MET,
    seed: int | None = None,
    overrides: Sequence[str] = (),
    allow_code: Iterable[str | Path] = (),
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Tuning:
    """Tune numbers of a mission for a metric, or for several at once.

        found = cardume.tune("paper/figure-5", ["guidance.lookahead=2..15"], ["cross_track_rms"])
        found.best.values, found.evidence.differences

    Every try flies with the same seeds.  What the mission requires comes first: a try in which all is met in fewer
    runs than `met` is worse than any in which it is.

    Args:
        mission: file, name of a built-in mission, or what `load` gave.
        vary: each a key, or `key=low..high`; without ends those of the law, or five times less and more.
        metrics: one to three, of the fleet or as `vehicle.metric`.
        runs: of a try.
        evaluations: how many tries.
        quantile: of a metric over the runs that counts, as 0.95; None for its mean.
        met: share of the runs in which all is to be met that the mission requires.
        seed: of the first run and of the search, instead of the mission's.
        overrides: values to change before, as `--set` takes them.
        allow_code: folders from which laws may be imported.
        progress: called with "compile", "tune" or "compare", how much is done, and how much there is.
        should_stop: asked every few milliseconds; what was found by then is given.

    Returns:
        What was found, tried and proved.

    Raises:
        InputError: a mission, key, range or metric that cannot be, or a metric without any number.
    """
    folders = tuple(allow_code)
    opened = open_given(mission, overrides, (), folders)
    refuse_sweeps(opened)
    _check(runs, evaluations, quantile, met, metrics)
    asked = check_metrics(metrics, [Arm("", opened, opened.name)], METRICS)
    knobs = make_knobs(opened, vary, catalog(folders))
    first = opened.seed if seed is None else seed
    wanted = [METRICS[metric.rpartition(".")[2]].wanted for metric in asked]
    goal = Goal(tuple(-1.0 if of == "at least" else 1.0 for of in wanted), met)
    search = _Search(opened, knobs, asked, quantile, first, runs, evaluations, folders, progress, should_stop)
    start = tuple(min(max(knob.share(knob.start), 0.0), 1.0) for knob in knobs)
    try:
        search.begin()
        looking = search_one if len(asked) == 1 else search_several
        looking(search.attempt, start, evaluations - 1, goal, first)
    except Enough:
        pass
    if not search.tries:
        raise InputError("interrupted before anything was flown")
    search.complain_if_hopeless(1)
    best = best_of(search.tries, goal)
    evidence = None if should_stop() else search.prove(best)
    better = evidence is not None and _is_better(evidence, goal, search.is_random)
    return Tuning(
        mission=opened,
        recommended=with_values(opened, knobs, best.values) if better or evidence is None else opened,
        knobs=knobs,
        metrics=asked,
        quantile=quantile,
        runs=search.runs,
        tries=tuple(search.tries),
        best=best,
        front=tuple(front_of(search.tries, goal)) if len(asked) > 1 else (),
        evidence=evidence,
        goal=goal,
        is_better=better,
        is_random=search.is_random,
        is_interrupted=evidence is None,
    )


class _Search:
    """Flies tries and remembers them."""

    def __init__(
        self,
        mission: Mission,
        knobs: tuple[Knob, ...],
        metrics: tuple[str, ...],
        quantile: float | None,
        first: int,
        runs: int,
        most: int,
        folders: tuple[str | Path, ...],
        progress: Progress,
        should_stop: Callable[[], bool],
    ) -> None:
        self._mission, self._knobs, self._metrics, self._quantile = mission, knobs, metrics, quantile
        self._first, self.runs, self._most, self._folders = first, runs, most, folders
        self._progress, self._should_stop = progress, should_stop
        self._known: dict[tuple[float, ...], Try] = {}
        self.tries: list[Try] = []
        self.is_random = True
        self._lanes = wants_lanes(expected_ticks(mission) * runs * most) or None

    def begin(self) -> None:
        """Try the mission as it is, and see whether its runs differ at all."""
        table = self._fly(tuple(knob.start for knob in self._knobs), self._first, self.runs)
        self.is_random = any(_differs(column) for column in (*table.metrics.values(), *table.drawn.values()))
        if not self.is_random:
            self.runs = 1
        self._keep(tuple(knob.start for knob in self._knobs), table.first(self.runs))

    def attempt(self, shares: Shares) -> Try:
        """What some shares of the ranges lead to."""
        values = tuple(knob.at(share) for knob, share in zip(self._knobs, shares, strict=True))
        if values in self._known:
            self._repeated += 1
            if self._repeated > 20 * self._most:
                raise Enough  # all that can be told apart was tried
            return self._known[values]
        if len(self.tries) >= self._most or self._should_stop():
            raise Enough
        found = self._keep(values, self._fly(values, self._first, self.runs))
        self.complain_if_hopeless(HOPELESS)
        return found

    _repeated = 0

    def complain_if_hopeless(self, count: int) -> None:
        """Give up where no run of so many tries has a number.

        Raises:
            InputError: for which metric.
        """
        if len(self.tries) >= count and all(found.counted == 0.0 for found in self.tries):
            what = " and ".join(self._metrics)
            raise InputError(
                f"--for {what}: none of {len(self.tries) * self.runs} runs has a number for it; look at one with"
                " cardume run: a mission that never settles, or has one vehicle, lacks some (cardume list metrics)"
            )

    def prove(self, best: Try) -> Evidence:
        """Fly start and best with seeds that the search never saw."""
        first, count = self._first + FRESH_FROM, max(FRESH_RUNS, 2 * self.runs) if self.is_random else 1
        tables = []
        for done, values in enumerate((self.tries[0].values, best.values)):
            self._progress("compare", done * count, 2 * count)
            tables.append(self._fly(values, first, count))
        self._progress("compare", 2 * count, 2 * count)
        start, end = ([values_of(table, m, self._mission) for m in self._metrics] for table in tables)
        return Evidence(tables[0], tables[1], tuple(map(paired_difference, end, start)))

    def _fly(self, values: Sequence[float], first: int, count: int) -> RunTable:
        def note(stage: str, done: int, total: int) -> None:
            if stage == "compile":
                self._progress(stage, done, total)

        table = fly_seeds(
            with_values(self._mission, self._knobs, values),
            [first + k for k in range(count)],
            allow_code=self._folders,
            lanes=self._lanes,
            progress=note,
            should_stop=self._should_stop,
        )
        if len(table) < count:
            raise Enough
        return table

    def _keep(self, values: tuple[float, ...], table: RunTable) -> Try:
        columns = [values_of(table, metric, self._mission) for metric in self._metrics]
        counted = np.isfinite(np.array(columns)).all(axis=0)
        found = Try(
            values,
            tuple(summarized(column, self._quantile) for column in columns),
            float(table.met.all(axis=1).mean()) if table.requirements else 1.0,
            float(counted.mean()),
        )
        self._known[values] = found
        self.tries.append(found)
        self._progress("tune", len(self.tries), self._most)
        return found


def summarized(values: np.ndarray, quantile: float | None) -> float:
    """The mean or a quantile of a metric over its runs [any]; NaN where one of them has no number.

    Args:
        values: [any] (run,)
        quantile: [-] None: the mean.
    """
    if not np.isfinite(values).all():
        return math.nan
    return float(values.mean() if quantile is None else np.quantile(values, quantile))


def _check(runs: int, evaluations: int, quantile: float | None, met: float, metrics: Sequence[str]) -> None:
    if not 1 <= runs <= MOST_RUNS:
        raise InputError(f"--runs {runs}: give a whole number from 1 to {MOST_RUNS}")
    if not FEWEST_TRIES <= evaluations <= MOST_TRIES:
        raise InputError(f"--evaluations {evaluations}: give a whole number from {FEWEST_TRIES} to {MOST_TRIES}")
    if quantile is not None and not 0.0 < quantile < 1.0:
        raise InputError(f"--quantile {quantile:g}: give a share between 0 and 1, as 0.95")
    if not 0.0 <= met <= 1.0:
        raise InputError(f"--met {met:g}: give a share from 0 to 1, as 0.95")
    if not 1 <= len(set(metrics)) <= MOST_METRICS:
        raise InputError(
            f"{len(set(metrics))} metrics are given; tune for one to {MOST_METRICS}, as --for cross_track_rms"
        )


def _is_better(evidence: Evidence, goal: Goal, is_random: bool) -> bool:
    """Whether the best really is: it meets what the start does not, or no metric is worse and one is clearly better."""
    start, best = (float(t.met.all(axis=1).mean()) if t.requirements else 1.0 for t in (evidence.start, evidence.best))
    if (start >= goal.met) != (best >= goal.met):
        return best > start
    gains = [-sign * difference.mean for sign, difference in zip(goal.signs, evidence.differences, strict=True)]
    clear = [is_clear(d) if is_random else d.mean != 0.0 for d in evidence.differences]
    is_worse = any(sure and gain < 0.0 for sure, gain in zip(clear, gains, strict=True))
    is_gained = any(sure and gain > 0.0 for sure, gain in zip(clear, gains, strict=True))
    return is_gained and (len(goal.signs) > 1 or not is_worse)


def _differs(column: np.ndarray) -> bool:
    """Whether a run has another value than the first."""
    others = np.broadcast_to(column[:1], column.shape)
    return not np.array_equal(column, others, equal_nan=column.dtype.kind == "f")
