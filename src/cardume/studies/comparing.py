"""Laws, values or missions side by side under common random numbers, and which differences are real."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import index
from pathlib import Path

import numpy as np

from cardume.errors import InputError
from cardume.missions.mission import Mission
from cardume.simulation.flight import METRICS
from cardume.studies.arms import Arm, Given, as_text, check_metrics, make_arms
from cardume.studies.constants import DEFAULT_COMPARED, FLEET, LARGEST_SEED, MOST_COMPARED, TRIFLE, USUAL
from cardume.studies.flying import Progress, RunTable, able_places, fly_all
from cardume.studies.statistics import CONFIDENCE, Estimate, estimate, is_clear, paired_difference, shared_confidence


@dataclass(frozen=True)
class Comparison:
    """What the arms did, seed by seed; the first arm is what the others are compared with.

    Attributes:
        arms: what was flown.
        varied: keys of the mission file in which the arms differ, as given.
        seeds: that all arms were flown with.
        asked: how many seeds were asked for; more than `seeds` where the comparison was interrupted.
        metrics: that were asked for, or the usual ones that have numbers.
        runs: for each arm a table with a row for each seed.
    """

    arms: tuple[Arm, ...]
    varied: tuple[str, ...]
    seeds: tuple[int, ...]
    asked: int
    metrics: tuple[str, ...]
    runs: tuple[RunTable, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        """The names of the arms."""
        return tuple(arm.label for arm in self.arms)

    @property
    def is_interrupted(self) -> bool:
        """Whether some seeds were not flown."""
        return len(self.seeds) < self.asked

    def values(self, metric: str) -> np.ndarray:
        """One metric of the fleet, or of a vehicle as `vehicle.metric`, for every arm and seed.

        Args:
            metric: its name.

        Returns:
            (arm, seed) array in the metric's unit; NaN where a run has no such number.
        """
        return np.array([values_of(runs, metric, arm.mission) for arm, runs in zip(self.arms, self.runs, strict=True)])

    @cached_property
    def estimates(self) -> dict[str, tuple[Estimate, ...]]:
        """For each metric the mean of each arm."""
        return {metric: tuple(estimate(row) for row in self.values(metric)) for metric in self.metrics}

    @cached_property
    def differences(self) -> dict[str, tuple[Estimate, ...]]:
        """For each metric how much more each arm but the first has than the first, in pairs of equal seed."""
        return {metric: self._differences(metric, CONFIDENCE) for metric in self.metrics}

    @cached_property
    def is_real(self) -> dict[str, tuple[bool, ...]]:
        """For each metric whether each arm but the first differs from it, at odds that all these answers share."""
        confidence = self.shared_confidence
        return {metric: tuple(map(is_clear, self._differences(metric, confidence))) for metric in self.metrics}

    @property
    def shared_confidence(self) -> float:
        """The confidence [-] of each interval with which all of them hold together with 95 %."""
        return shared_confidence(len(self.metrics) * (len(self.arms) - 1))

    def met(self, arm: int) -> tuple[int, int] | None:
        """How many runs of an arm are what its mission requires, and of how many; None where nothing is required.

        Args:
            arm: its place.
        """
        runs = self.runs[arm]
        return (int(runs.all_met.sum()), len(runs)) if runs.requirements else None

    def failures(self, arm: int) -> list[tuple[int, str]]:
        """Seed and reason of each run of an arm that failed while flying, or whose drawn values do not fit one another.

        Args:
            arm: its place.
        """
        return [(seed, why) for seed, why in zip(self.seeds, self.runs[arm].failure, strict=True) if why]

    def _differences(self, metric: str, confidence: float) -> tuple[Estimate, ...]:
        baseline, *others = self.values(metric)
        return tuple(paired_difference(row, baseline, confidence) for row in others)


def compare(
    missions: Given | Sequence[Given],
    vary: Mapping[str, Sequence[object]] | None = None,
    *,
    runs: int = DEFAULT_COMPARED,
    seeds: Sequence[int] | None = None,
    metrics: Sequence[str] = (),
    overrides: Sequence[str] = (),
    allow_code: Iterable[str | Path] = (),
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Comparison:
    """Fly missions that differ in something with the same seeds, so that the difference is not chance.

    Noise, losses and distributions depend on the seed alone, so the arms meet the same of them.

        cardume.compare("paper/figure-5", {"guidance.law": ["line_of_sight", "arcsine"]}, runs=50)

    Args:
        missions: one or several: file, name of a built-in mission, or what `load` gave.
        vary: keys of a mission file to the values they take; every combination is an arm.
        runs: how many seeds, from 1 on.
        seeds: which ones instead.
        metrics: to report, of the fleet or as `vehicle.metric`; the usual ones without.
        overrides: what holds for all, as `current.speed=0.2 m/s`.
        allow_code: folders from which laws may be imported.
        progress: called with "compile" or "compare", how much is done, and how much there is.
        should_stop: asked every few milliseconds; what was flown by then is compared.

    Returns:
        Every number of every run, and the means and differences made of them.

    Raises:
        InputError: a mission, key, value, metric or seed that cannot be.
        TypeError: a seed that is no whole number.
    """
    several = [missions] if isinstance(missions, (str, Path, Mission)) else list(missions)
    chosen = check_seeds(range(1, runs + 1) if seeds is None else [index(seed) for seed in seeds])
    texts = {key: [as_text(value) for value in values] for key, values in (vary or {}).items()}
    arms = make_arms(several, texts, overrides, tuple(allow_code))
    asked = check_metrics(metrics, arms, METRICS)
    for arm in arms:  # one that no seed lets fly is an error, told before any flies
        able_places(arm.mission, chosen, {}, 1, tuple(allow_code))
    found = fly_all(
        [arm.mission for arm in arms],
        chosen,
        is_lenient=True,
        progress=progress,
        should_stop=should_stop,
        allow_code=tuple(allow_code),
    )
    return Comparison(
        arms, tuple(texts), chosen[: len(found[0])], len(chosen), asked or _usual(arms, found), tuple(found)
    )


def values_of(runs: RunTable, metric: str, mission: Mission) -> np.ndarray:
    """(run,) a metric of the fleet, which is its worst vehicle's, or of a vehicle; NaN where there is none.

    Args:
        runs: of one mission.
        metric: `name`, or `vehicle.name`.
        mission: that was flown.
    """
    vehicle, dot, name = metric.rpartition(".")
    names = [v.name for v in mission.vehicles]
    none = np.full(len(runs), np.nan)
    if dot:
        return runs.metrics[name][:, names.index(vehicle)] if vehicle in names and name in runs.metrics else none
    return runs.metrics.get(FLEET + name, none)


def check_seeds(seeds: Sequence[int]) -> tuple[int, ...]:
    """Seeds, if they can be flown.

    Args:
        seeds: whole numbers.

    Raises:
        InputError: none, too many, one twice, or one that is no seed.
    """
    if not seeds:
        raise InputError("no seeds are given; fly at least one, as runs=20 or seeds=range(1, 21)")
    if len(seeds) > MOST_COMPARED:
        raise InputError(f"{len(seeds)} seeds are given; compare at most {MOST_COMPARED} at a time")
    if wrong := [seed for seed in seeds if not 0 <= seed <= LARGEST_SEED]:
        raise InputError(f"{wrong[0]} is no seed; a seed is a whole number from 0 to {LARGEST_SEED}")
    if len(set(seeds)) < len(seeds):
        twice = next(seed for seed in seeds if seeds.count(seed) > 1)
        raise InputError(f"the seed {twice} is given twice; the same seed flies the same mission again")
    return tuple(seeds)


def _usual(arms: Sequence[Arm], found: Sequence[RunTable]) -> tuple[str, ...]:
    """Of the usual metrics those with a number that is more than rounding."""
    values = {
        name: [values_of(runs, name, arm.mission) for arm, runs in zip(arms, found, strict=True)] for name in USUAL
    }
    has = [name for name, of_arms in values.items() if (np.nan_to_num(np.concatenate(of_arms)) > TRIFLE).any()]
    return tuple(has) or USUAL[:1]
