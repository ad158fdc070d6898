"""The tries of a search: flown, remembered, or known from a search that was interrupted."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from cardume.errors import InputError, MissionError
from cardume.missions.mission import Mission
from cardume.studies.comparing import values_of
from cardume.studies.constants import LARGEST_SEED
from cardume.studies.flying import Progress, RunTable, fly_seeds
from cardume.studies.tuning.evidence import Evidence, weigh
from cardume.studies.tuning.knobs import Knob, with_values
from cardume.studies.tuning.searching import Enough, Goal, Shares, Try
from cardume.studies.work import expected_ticks, wants_lanes

FRESH_FROM = 1_000_000  # seeds after the first of the search
FRESH_RUNS = 100
HOPELESS = 8  # tries in which no run has a number, after which it is given up
MOST_REPEATED = 20  # times as many as tries: all that can be told apart was tried

Known = Mapping[tuple[float, ...], Try]


@dataclass(frozen=True)
class Settings:
    """What is searched; the same settings lead to the same tries.

    Attributes:
        mission: that is tuned.
        knobs: that are varied.
        metrics: for which.
        quantile: [-] of each metric over the runs; None: its mean.
        first: seed of the first run, and of the search.
        runs: of a try, where they differ at all.
        evaluations: tries in all.
        goal: what is better.
        folders: from which laws may be imported.
    """

    mission: Mission
    knobs: tuple[Knob, ...]
    metrics: tuple[str, ...]
    quantile: float | None
    first: int
    runs: int
    evaluations: int
    goal: Goal
    folders: tuple[str | Path, ...]

    @property
    def fresh_runs(self) -> int:
        """Runs of the proof, where they differ at all."""
        return max(FRESH_RUNS, 2 * self.runs)

    @property
    def start(self) -> tuple[float, ...]:
        """The values that the mission has."""
        return tuple(knob.start for knob in self.knobs)

    def check_seeds(self) -> None:
        """Refuse seeds beyond the largest.

        Raises:
            InputError: of the search or of the proof.
        """
        last = self.first + FRESH_FROM + self.fresh_runs
        if self.first < 0 or last > LARGEST_SEED:
            most = LARGEST_SEED - FRESH_FROM - self.fresh_runs
            raise InputError(
                f"--seed {self.first}: the search and its proof on fresh seeds count from it; give one from 0 to {most}"
            )


Remember = Callable[[Settings, Sequence[Try]], None]


@dataclass
class Tries:
    """Flies tries and remembers them.

    Attributes:
        settings: what is searched.
        progress: called with "compile", "tune" or "compare", how much is done, and how much there is.
        should_stop: asked every few milliseconds.
        known: of an earlier search with the same settings, by their values; these are not flown again.
        remember: called after each try with the settings and all tries that are known by now, for whoever keeps them.
        is_random: whether a run differs from the next.
        made: all, in order; the first is the mission as it is.
    """

    settings: Settings
    progress: Progress
    should_stop: Callable[[], bool]
    known: Known = field(default_factory=dict)
    remember: Remember = lambda settings, tries: None
    is_random: bool = True
    made: list[Try] = field(default_factory=list)
    _seen: dict[tuple[float, ...], Try] = field(default_factory=dict)
    _repeated: int = 0

    @property
    def runs(self) -> int:
        """Of a try."""
        return self.settings.runs if self.is_random else 1

    def begin(self) -> None:
        """Try the mission as it is, and see whether its runs differ at all, which takes two.

        Raises:
            Enough: the user said stop.
            MissionError: it cannot be flown.
        """
        values = self.settings.start
        table = self._fly(values, self.settings.first, max(2, self.settings.runs), is_lenient=False)
        self.is_random = table.is_varied
        self._keep(self._made_of(values, table.first(self.runs)))

    def attempt(self, shares: Shares) -> Try:
        """What some shares of the ranges lead to.

        Raises:
            Enough: there are no tries left, or the user said stop.
            InputError: no try has a number.
        """
        values = tuple(knob.at(share) for knob, share in zip(self.settings.knobs, shares, strict=True))
        if values in self._seen:
            self._repeated += 1
            if self._repeated > MOST_REPEATED * self.settings.evaluations:
                raise Enough
            return self._seen[values]
        if len(self.made) >= self.settings.evaluations or self.should_stop():
            raise Enough
        found = self.known.get(values)
        if found is None:
            try:
                found = self._made_of(values, self._fly(values, self.settings.first, self.runs))
            except MissionError:  # values of the keys that do not fit one another: as bad as any
                found = Try(values, (math.nan,) * len(self.settings.metrics), 0.0, 0.0)
        self._keep(found)
        self.complain_if_hopeless(HOPELESS)
        return found

    def complain_if_hopeless(self, count: int) -> None:
        """Give up where no run of so many tries has a number.

        Args:
            count: how many.

        Raises:
            InputError: for which metric.
        """
        if len(self.made) >= count and all(found.counted == 0.0 for found in self.made):
            what = " and ".join(self.settings.metrics)
            raise InputError(
                f"--for {what}: none of {len(self.made) * self.runs} runs has a number for it; look at one with"
                " cardume run: a mission that never settles, or has one vehicle, lacks some (cardume list metrics)"
            )

    def prove(self, best: Try) -> Evidence | None:
        """Fly start and best with seeds that the search never saw; None where the user said stop.

        Args:
            best: of the tries.
        """
        asked = self.settings
        first, count = asked.first + FRESH_FROM, asked.fresh_runs if self.is_random else 1
        tables = []
        try:
            for done, values in enumerate((self.made[0].values, best.values)):
                self.progress("compare", done * count, 2 * count)
                tables.append(self._fly(values, first, count))
        except Enough:
            return None
        self.progress("compare", 2 * count, 2 * count)
        return weigh(tables[0], tables[1], asked.mission, asked.metrics, asked.goal, asked.quantile)

    def _fly(self, values: Sequence[float], first: int, count: int, is_lenient: bool = True) -> RunTable:
        def note(stage: str, done: int, total: int) -> None:
            if stage == "compile":
                self.progress(stage, done, total)

        asked = self.settings
        if self.should_stop():
            raise Enough
        table = fly_seeds(
            with_values(asked.mission, asked.knobs, values),
            [first + k for k in range(count)],
            allow_code=asked.folders,
            lanes=wants_lanes(expected_ticks(asked.mission) * asked.runs * asked.evaluations) or None,
            is_lenient=is_lenient,
            progress=note,
            should_stop=self.should_stop,
        )
        if len(table) < count:
            raise Enough
        return table

    def _made_of(self, values: tuple[float, ...], table: RunTable) -> Try:
        columns = [values_of(table, metric, self.settings.mission) for metric in self.settings.metrics]
        counted = np.isfinite(np.array(columns)).all(axis=0)
        return Try(
            values,
            tuple(summarized(column, self.settings.quantile) for column in columns),
            float(table.all_met.mean()),
            float(counted.mean()),
        )

    def _keep(self, found: Try) -> None:
        self._seen[found.values] = found
        self.made.append(found)
        left = [one for values, one in self.known.items() if values not in self._seen]
        self.remember(self.settings, [*self.made, *left])
        self.progress("tune", len(self.made), self.settings.evaluations)


def summarized(values: np.ndarray, quantile: float | None) -> float:
    """The mean or a quantile of a metric over its runs [any]; NaN where one of them has no number.

    Args:
        values: [any] (run,)
        quantile: [-] None: the mean.
    """
    if not np.isfinite(values).all():
        return math.nan
    return float(values.mean() if quantile is None else np.quantile(values, quantile))
