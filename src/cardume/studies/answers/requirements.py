"""How probable it is that what is required holds: all of it, each part, and what fails first."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cardume.studies.answers.distributions import Quantile, quantile
from cardume.studies.answers.results import Limit, Results
from cardume.studies.statistics import share_interval


class Chance(NamedTuple):
    """A probability with Wilson's 95 % interval."""

    successes: int
    tries: int
    low: float  # [-]
    high: float  # [-]

    @property
    def share(self) -> float:
        """[-] the share of the runs; NaN without any."""
        return self.successes / self.tries if self.tries else math.nan


@dataclass(frozen=True)
class Required:
    """One requirement over the runs of one case.

    Attributes:
        name: readable.
        limit: what the name says.
        chance: that it holds.
        missed: runs that miss it, failed missions left out.
        missed_alone: of these, runs that miss nothing else.
        violated: [s] median of when it was first violated, with its interval; NaN where no run knows.
        got: median of what was got, with its interval, in the metric's unit.
    """

    name: str
    limit: Limit
    chance: Chance
    missed: int
    missed_alone: int
    violated: Quantile
    got: Quantile


def chance(met: np.ndarray) -> Chance:
    """The probability of something.

    Args:
        met: (n,) whether it happened.
    """
    successes, count = int(np.sum(met)), int(np.size(met))
    return Chance(successes, count, *share_interval(successes, count))


def chance_of_all(results: Results, case: tuple[int, ...] = ()) -> Chance:
    """The probability that everything required holds; a mission that fails in flight meets nothing.

    Args:
        results: of the study.
        case: the place of the option of each swept key.
    """
    return chance(results.all_met[case][results.is_judged[case]])


def chances_of_all(results: Results) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The share of the runs in which everything required holds, and both ends of its interval, for every case.

    Args:
        results: of the study.

    Returns:
        Three (swept ...) arrays [-]; the share is NaN where no run was flown.
    """
    met, count = np.sum(results.all_met, axis=-1), np.sum(results.is_judged, axis=-1)
    ends = [share_interval(int(k), int(n)) for k, n in zip(met.ravel(), count.ravel(), strict=True)]
    low, high = (np.array([end[side] for end in ends]).reshape(met.shape) for side in (0, 1))
    return np.where(count > 0, met / np.maximum(count, 1), math.nan), low, high


def requirements(results: Results, case: tuple[int, ...] = ()) -> tuple[Required, ...]:
    """Each requirement over the runs of one case, the one that is missed most often first.

    Args:
        results: of the study.
        case: the place of the option of each swept key.
    """
    judged, flown = results.is_judged[case], results.is_judged[case] & ~np.isfinite(results.failed_at[case])
    met, got, when = results.met[case], results.array("got", "requirement")[case], results.violated_at[case]
    found = []
    for k, name in enumerate(results.requirements):
        misses = flown & ~met[..., k]
        others = np.delete(met, k, axis=-1).all(axis=-1)
        found.append(
            Required(
                name,
                results.limits[k],
                chance(met[judged][..., k]),
                int(np.sum(misses)),
                int(np.sum(misses & others)),
                _median(when[misses][..., k]),
                _median(got[flown][..., k].astype(float)),
            )
        )
    return tuple(sorted(found, key=lambda one: one.chance.successes))


def _median(values: np.ndarray) -> Quantile:
    return quantile(np.sort(values[np.isfinite(values)]), 0.5)
