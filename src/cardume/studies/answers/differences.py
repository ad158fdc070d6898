"""Which of the options of a swept law is better: differences in pairs of equal seed, and which of them are real."""

from dataclasses import dataclass

import numpy as np

from cardume.studies.answers.distributions import mean_of
from cardume.studies.answers.regions import numeric_keys
from cardume.studies.answers.results import Results
from cardume.studies.statistics import CONFIDENCE, ROUNDING, Estimate, is_clear, shared_confidence


@dataclass(frozen=True)
class Differences:
    """The options of one swept key against the first of them.

    Attributes:
        key: of the mission file.
        labels: of the options.
        metrics: that are compared.
        means: by metric, for each option.
        differences: by metric, for each option but the first, how much more it has than the first.
        is_real: by metric, for each option but the first, whether chance is ruled out at odds that all answers share.
        num_seeds: pairs.
        is_pooled: whether the numbers are means over the options of other swept keys.
    """

    key: str
    labels: tuple[str, ...]
    metrics: tuple[str, ...]
    means: dict[str, tuple[Estimate, ...]]
    differences: dict[str, tuple[Estimate, ...]]
    is_real: dict[str, tuple[bool, ...]]
    num_seeds: int
    is_pooled: bool


def swept_laws(results: Results) -> tuple[str, ...]:
    """The swept keys whose options are laws or words.

    Args:
        results: of the study.
    """
    return tuple(key for key in results.swept if key not in numeric_keys(results) and len(results.labels(key)) > 1)


def differences(results: Results, key: str) -> Differences:
    """The options of a swept key against the first, seed by seed.

    Where other keys are swept too, a seed's number is its mean over their options that both have flown, so that the
    pairs stay independent of one another.

    Args:
        results: of the study.
        key: one of the swept keys.
    """
    axis, metrics = results.swept.index(key), results.shown
    count = results.shape[axis]
    confidence = shared_confidence(len(metrics) * (count - 1))
    means, told, real = {}, {}, {}
    for metric in metrics:
        values = np.moveaxis(results.values(metric), axis, 0).reshape(count, -1, len(results.seeds))
        means[metric] = tuple(mean_of(_pooled(option)) for option in values)
        pairs = [_pooled(_without_rounding(option - values[0], values[0])) for option in values[1:]]
        told[metric] = tuple(mean_of(pair, CONFIDENCE) for pair in pairs)
        real[metric] = tuple(is_clear(mean_of(pair, confidence)) for pair in pairs)
    flown = int(np.sum(results.is_judged.any(axis=tuple(range(len(results.swept))))))
    return Differences(key, results.labels(key), metrics, means, told, real, flown, len(results.swept) > 1)


def _without_rounding(difference: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.where(np.abs(difference) <= ROUNDING * np.maximum(1.0, np.abs(baseline)), 0.0, difference)
    return found


def _pooled(values: np.ndarray) -> np.ndarray:
    """(case, run) numbers as one per run: the mean of those that are there."""
    count = np.sum(np.isfinite(values), axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)
