"""Whether the best of a search really is better: start and best in pairs, on seeds that the search never saw."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cardume.missions.mission import Mission
from cardume.studies.comparing import values_of
from cardume.studies.run_table import RunTable
from cardume.studies.statistics import (
    CONFIDENCE,
    Estimate,
    is_clear,
    paired_difference,
    paired_quantile_difference,
    shared_confidence,
)
from cardume.studies.tuning.searching import Goal


@dataclass(frozen=True)
class Evidence:
    """The start and the best on seeds that the search never saw.

    Attributes:
        start: runs with the values that the mission had.
        best: runs with the values that were found, of the same seeds.
        differences: for each metric, how much more the best has than the start, in pairs of equal seed; of the quantile
            where that was tuned.
        changes: for each metric 1 where the best is really better, -1 where it is really worse, at odds that all
            answers share, else 0.
        is_better: whether the best is to be flown.
    """

    start: RunTable
    best: RunTable
    differences: tuple[Estimate, ...]
    changes: tuple[int, ...]
    is_better: bool


def weigh(
    start: RunTable,
    best: RunTable,
    mission: Mission,
    metrics: Sequence[str],
    goal: Goal,
    quantile: float | None = None,
) -> Evidence:
    """What fresh seeds say: first of runs that have numbers, then of what is required, then of the metrics.

    Args:
        start: runs with the values that the mission had.
        best: runs of the same seeds with those that were found.
        mission: that is tuned.
        metrics: for which.
        goal: what is better.
        quantile: [-] of each metric over the runs; None: its mean.
    """
    columns = [[values_of(table, metric, mission) for metric in metrics] for table in (start, best)]
    numbers = [np.isfinite(np.array(of)).all(axis=0) for of in columns]
    met = [table.all_met for table in (start, best)]
    shares = [pair for pair in (numbers, met) if (pair[0] != pair[1]).any()]
    confidence = shared_confidence(len(metrics) + len(shares))

    def compare(one: np.ndarray, other: np.ndarray, sure: float) -> Estimate:
        if quantile is None:
            return paired_difference(one, other, sure)
        return paired_quantile_difference(one, other, quantile, sure)

    def change(one: np.ndarray, other: np.ndarray, of: Callable[[np.ndarray, np.ndarray, float], Estimate]) -> int:
        difference = of(one, other, confidence)
        is_alone = len(start) == 1  # nothing is random: a difference is one
        return int(np.sign(difference.mean)) if is_alone or is_clear(difference) else 0

    changes = tuple(
        -int(sign) * change(of_best, of_start, compare)
        for sign, of_start, of_best in zip(goal.signs, *columns, strict=True)
    )
    more_numbers = change(numbers[1], numbers[0], paired_difference)
    more_met = change(met[1], met[0], paired_difference)
    before, after = (float(of.mean()) for of in met)
    if more_numbers:
        is_better = more_numbers > 0
    elif after < goal.met <= before:
        is_better = False
    elif more_met and before < goal.met:
        is_better = more_met > 0
    else:
        is_better = max(changes) > 0 and min(changes) >= 0
    return Evidence(
        start,
        best,
        tuple(compare(of_best, of_start, CONFIDENCE) for of_start, of_best in zip(*columns, strict=True)),
        changes,
        is_better,
    )
