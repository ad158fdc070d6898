"""How a metric is distributed over the runs: its mean and quantiles, each with an interval."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cardume.studies.answers.results import Results
from cardume.studies.statistics import (
    CONFIDENCE,
    ROUNDING,
    Estimate,
    estimate,
    expanded_tail,
    resampled_counts,
    student_quantile,
)

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
TOGETHER = 200  # samples at once
TOGETHER_FROM = 400  # runs of a sample, up to which the resampling of many fits into memory
MOST_RESAMPLED = 1000  # runs; of more, the bootstrap says what Student's interval says


class Quantile(NamedTuple):
    """The value below which a share of the runs lies, with its interval; an end that no run bounds is NaN."""

    share: float  # [-]
    value: float  # [any]
    low: float  # [any]
    high: float  # [any]


@dataclass(frozen=True)
class Distribution:
    """One metric over the runs of one case.

    Attributes:
        metric: its name.
        mean: with its 95 % interval.
        quantiles: those of SHARES, each with its 95 % interval.
        least: [any] of all runs.
        most: [any] of all runs.
        missing: runs that were flown and have no such number, as one that never settled.
    """

    metric: str
    mean: Estimate
    quantiles: tuple[Quantile, ...]
    least: float
    most: float
    missing: int

    @property
    def median(self) -> Quantile:
        """The middle one."""
        return self.quantiles[SHARES.index(0.5)]


def distribution(results: Results, metric: str, case: tuple[int, ...] = ()) -> Distribution:
    """One metric over the runs of one case.

    Args:
        results: of the study.
        metric: its name.
        case: the place of the option of each swept key.
    """
    values = results.values(metric)[case]
    known = np.sort(values[np.isfinite(values)])
    return Distribution(
        metric,
        mean_of(known),
        tuple(quantile(known, share) for share in SHARES),
        float(known[0]) if known.size else math.nan,
        float(known[-1]) if known.size else math.nan,
        int(np.sum(results.is_judged[case])) - known.size,
    )


def mean_of(values: np.ndarray, confidence: float = CONFIDENCE) -> Estimate:
    """The mean and its interval: as `estimate` has them, and of more than a thousand values by Student's t alone.

    The bootstrap moves an interval by skewness / sqrt(n) of its half width and less: with a thousand values and the
    skewness of an exponential, 2, by a fiftieth; and it would take seconds.

    Args:
        values: (n,) [any] those that are no number are left out.
        confidence: [-] of the interval.
    """
    known = values[np.isfinite(values)]
    if known.size <= MOST_RESAMPLED:
        return estimate(known, confidence)
    mean, count = float(known.mean()), known.size
    half = student_quantile(0.5 + 0.5 * confidence, count - 1) * float(known.std(ddof=1)) / math.sqrt(count)
    return Estimate(mean, mean - half, mean + half, count)


def means_of(samples: np.ndarray, confidence: float = CONFIDENCE) -> list[Estimate]:
    """What `mean_of` says of each of many samples, but for rounding; much faster.

    Args:
        samples: (k, n) [any] those that are no number are left out.
        confidence: [-] of the intervals.
    """
    found = [mean_of(row, confidence) if _is_special(row) else None for row in samples]
    plain = [k for k, one in enumerate(found) if one is None]
    size = samples.shape[1]
    for start in range(0, len(plain), TOGETHER):
        some = samples[plain[start : start + TOGETHER]]
        tail = expanded_tail(size, confidence)
        low, high = np.quantile(resampled_counts(size) @ some.T / size, (tail, 1.0 - tail), axis=0)
        mean, wide = some.mean(axis=1), student_quantile(0.5 + 0.5 * confidence, size - 1)
        half = wide * some.std(axis=1, ddof=1) / math.sqrt(size)
        ends = zip(
            plain[start : start + TOGETHER],
            mean,
            np.minimum(low, mean - half),
            np.maximum(high, mean + half),
            strict=True,
        )
        for place, middle, below, above in ends:
            found[place] = Estimate(float(middle), float(below), float(above), size)
    return [one for one in found if one is not None]


def _is_special(values: np.ndarray) -> bool:
    """Whether a sample is none that can be treated with all others at once."""
    is_whole = 1 < values.size <= TOGETHER_FROM and bool(np.isfinite(values).all())
    return not is_whole or float(np.ptp(values)) <= ROUNDING * abs(float(values.mean()))


def quantile(ordered: np.ndarray, share: float, confidence: float = CONFIDENCE) -> Quantile:
    """A quantile, and its interval between two values of the sample, whatever the distribution.

    P(x_(l) <= q_p <= x_(u)) = P(l <= B <= u - 1),  B the number of values below q_p, binomial (n, p)

    l and u are the innermost for which each end misses with (1 - confidence) / 2 at most.

    Args:
        ordered: (n,) [any] in ascending order, without NaN.
        share: [-] p.
        confidence: [-] of the interval.

    Source: Conover (1999), Practical Nonparametric Statistics, 3rd ed., section 3.2.
    """
    count = ordered.size
    if count == 0:
        return Quantile(share, math.nan, math.nan, math.nan)
    from scipy.stats import binom

    tail = 0.5 * (1.0 - confidence)
    below = int(binom.ppf(tail, count, share))  # P(B <= below - 1) < tail, so x_(below) is exceeded surely enough
    above = int(binom.ppf(1.0 - tail, count, share)) + 1
    low = float(ordered[below - 1]) if below >= 1 else math.nan
    high = float(ordered[above - 1]) if above <= count else math.nan
    return Quantile(share, float(np.quantile(ordered, share)), low, high)
