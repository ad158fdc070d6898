"""What a handful of runs says: means, differences in pairs, and how sure they are."""

import math
from collections.abc import Callable
from functools import lru_cache
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

CONFIDENCE = 0.95
RESAMPLES = 20_000
QUANTILE_RESAMPLES = 2_000
KEY = 20_240_229  # of the resampling: the same numbers give the same intervals
MOST_AT_ONCE = 4_000_000  # random numbers held at a time
EXPANDED_FROM = 1000  # degrees of freedom, beyond which a series of as many terms takes too long
ROUNDING = 1e-12  # of a value: what is smaller comes of the arithmetic


class Estimate(NamedTuple):
    """A mean with its confidence interval, in the unit of its values; NaN where there is none."""

    mean: float
    low: float
    high: float
    size: int  # values that it was made from


def estimate(values: np.ndarray, confidence: float = CONFIDENCE) -> Estimate:
    """The mean of a sample, and its interval: each end the outer one of the bootstrap's and Student's.

    The expanded percentile bootstrap follows skew. Means of samples drawn with replacement lie too close together
    by sqrt((n - 1) / n) and lack the tails of Student's t, so its percentiles are moved outwards by both, to
    Phi(-sqrt(n / (n - 1)) t). They never leave the range of the sample, though: of a handful of values, or at
    high confidence, Student's interval is the wider one and covers as often as it says.

    Args:
        values: (n,) [any] one per run; those that are no number are left out.
        confidence: [-] of the interval.

    Returns:
        Mean, low and high end [any]; the ends are NaN with fewer than two values.

    Source: Hesterberg (2015), What Teachers Should Know About the Bootstrap, Am. Statistician 69(4), 371-386.
    """
    sample = np.asarray(values, float)
    sample = sample[np.isfinite(sample)]
    count = sample.size
    if count == 0:
        return Estimate(math.nan, math.nan, math.nan, 0)
    mean = float(sample.mean())
    if count == 1:
        return Estimate(mean, math.nan, math.nan, 1)
    if float(np.ptp(sample)) <= ROUNDING * abs(mean):
        return Estimate(mean, mean, mean, count)
    half = student_quantile(0.5 + 0.5 * confidence, count - 1) * float(sample.std(ddof=1)) / math.sqrt(count)
    tail = expanded_tail(count, confidence)
    low, high = np.quantile(resampled_means(sample), (tail, 1.0 - tail))
    return Estimate(mean, min(float(low), mean - half), max(float(high), mean + half), count)


def paired_difference(values: np.ndarray, baseline: np.ndarray, confidence: float = CONFIDENCE) -> Estimate:
    """The mean of values less those of a baseline with the same random numbers, and its interval.

    Args:
        values: (n,) [any] one per run.
        baseline: (n,) [any] of the same runs; pairs of which one is no number are left out.
        confidence: [-] of the interval.

    Returns:
        As `estimate` [any].
    """
    one, other = np.asarray(values, float), np.asarray(baseline, float)
    difference = one - other
    is_rounding = np.abs(difference) <= ROUNDING * np.maximum(1.0, np.abs(other))
    return estimate(np.where(is_rounding, 0.0, difference), confidence)


def paired_quantile_difference(
    values: np.ndarray, baseline: np.ndarray, quantile: float, confidence: float = CONFIDENCE
) -> Estimate:
    """The quantile of values less that of a baseline with the same random numbers, and its interval.

    Pairs are drawn with replacement, and the interval lies between percentiles of what they give.

    Args:
        values: (n,) [any] one per run.
        baseline: (n,) [any] of the same runs; pairs of which one is no number are left out.
        quantile: [-] between 0 and 1.
        confidence: [-] of the interval.

    Returns:
        As `estimate` [any], the difference in the place of the mean.

    Source: Efron & Tibshirani (1993), An Introduction to the Bootstrap, chapters 8 and 13.
    """
    one, other = np.asarray(values, float), np.asarray(baseline, float)
    is_pair = np.isfinite(one) & np.isfinite(other)
    pairs = np.stack([one[is_pair], other[is_pair]])
    count = pairs.shape[1]
    if count == 0:
        return Estimate(math.nan, math.nan, math.nan, 0)
    above, below = np.quantile(pairs, quantile, axis=1)
    difference = float(above - below)
    if count == 1:
        return Estimate(difference, math.nan, math.nan, 1)
    generator, found = np.random.Philox(KEY), []
    rows = max(1, MOST_AT_ONCE // (2 * count))
    for start in range(0, QUANTILE_RESAMPLES, rows):
        places = _drawn(generator, min(rows, QUANTILE_RESAMPLES - start), count)
        above, below = np.quantile(pairs[:, places], quantile, axis=2)
        found.append(above - below)
    tail = 0.5 * (1.0 - confidence)
    low, high = np.quantile(np.concatenate(found), (tail, 1.0 - tail))
    return Estimate(difference, float(low), float(high), count)


def is_clear(difference: Estimate) -> bool:
    """Whether zero lies outside the interval.

    Args:
        difference: [any] of two arms.
    """
    return difference.low > 0.0 or difference.high < 0.0


def shared_confidence(count: int, confidence: float = CONFIDENCE) -> float:
    """The confidence [-] for each of several intervals with which all of them hold together (Bonferroni).

    Args:
        count: how many intervals.
        confidence: [-] for all of them.
    """
    return 1.0 - (1.0 - confidence) / max(count, 1)


def share_interval(successes: int, count: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Wilson's interval for a probability.

    Args:
        successes: among the runs.
        count: runs.
        confidence: [-] of the interval.

    Returns:
        Low and high end [-].

    Source: Wilson (1927), Probable inference, J. Am. Stat. Assoc. 22, 209-212.
    """
    if count == 0:
        return 0.0, 1.0
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    share, weight = successes / count, z * z / count
    middle = (share + 0.5 * weight) / (1.0 + weight)
    half = z * math.sqrt(share * (1.0 - share) / count + 0.25 * weight / count) / (1.0 + weight)
    return max(0.0, middle - half), min(1.0, middle + half)


def resampled_means(sample: np.ndarray) -> np.ndarray:
    """Means (RESAMPLES,) [any] of samples drawn with replacement; drawn alike for samples of equal size.

    Args:
        sample: (n,) [any] without NaN.
    """
    if sample.size * RESAMPLES <= MOST_AT_ONCE:
        return np.asarray(sample[_places(sample.size)].mean(axis=1))
    rows, generator = max(1, MOST_AT_ONCE // sample.size), np.random.Philox(KEY)
    counts = [min(rows, RESAMPLES - start) for start in range(0, RESAMPLES, rows)]
    return np.concatenate([sample[_drawn(generator, count, sample.size)].mean(axis=1) for count in counts])


@lru_cache(maxsize=2)  # 8 MB for 400 values
def resampled_counts(size: int) -> np.ndarray:
    """How often each value is in each of the samples of `resampled_means` (RESAMPLES, size) [-], small whole numbers.

    Args:
        size: of the sample.
    """
    rows = _places(size) + size * np.arange(RESAMPLES)[:, None]
    return np.bincount(rows.ravel(), minlength=RESAMPLES * size).reshape(RESAMPLES, size).astype(np.uint8)


@lru_cache(maxsize=2)  # 16 MB for 400 values
def _places(size: int) -> np.ndarray:
    return _drawn(np.random.Philox(KEY), RESAMPLES, size).astype(np.uint16 if size <= 2**16 else np.int64)


def _drawn(generator: np.random.Philox, count: int, size: int) -> np.ndarray:
    """Places (count, size) in a sample, from raw bits, which no version of NumPy may change."""
    raw = generator.random_raw(count * size).reshape(count, size)
    places: np.ndarray = ((raw >> np.uint64(11)) * (2.0**-53 * size)).astype(np.int64)
    return places


def expanded_tail(count: int, confidence: float) -> float:
    """The share [-] of resampled means below the interval.

    Args:
        count: values in the sample, at least 2.
        confidence: [-] of the interval.
    """
    wide = math.sqrt(count / (count - 1)) * student_quantile(0.5 + 0.5 * confidence, count - 1)
    return NormalDist().cdf(-wide)


@lru_cache(maxsize=1024)
def student_quantile(probability: float, freedom: int) -> float:
    """The quantile [-] of Student's t above one half.

    Of many degrees of freedom n by its expansion about the normal quantile x, to 1e-10 of itself:

    t = x + g1(x) / n + g2(x) / n^2 + g3(x) / n^3 + g4(x) / n^4

    Args:
        probability: [-] in [0.5, 1).
        freedom: degrees of freedom, at least 1.

    Source: Abramowitz & Stegun (1964), 26.7.5, held against scipy in the tests.
    """
    if freedom > EXPANDED_FROM:
        return _expanded_quantile(NormalDist().inv_cdf(probability), freedom)
    within = 2.0 * probability - 1.0
    high = 1.0
    while student_within(high, freedom) < within and high < 1e12:
        high *= 2.0
    return _bisected(lambda t: student_within(t, freedom) < within, 0.0, high)


def _expanded_quantile(x: float, freedom: int) -> float:
    g = (
        (x**3 + x) / 4.0,
        (5.0 * x**5 + 16.0 * x**3 + 3.0 * x) / 96.0,
        (3.0 * x**7 + 19.0 * x**5 + 17.0 * x**3 - 15.0 * x) / 384.0,
        (79.0 * x**9 + 776.0 * x**7 + 1482.0 * x**5 - 1920.0 * x**3 - 945.0 * x) / 92160.0,
    )
    return x + sum(term / float(freedom) ** (k + 1) for k, term in enumerate(g))


def student_within(t: float, freedom: int) -> float:
    """The probability [-] that Student's t lies within (-t, t).

    A(t | n) = sin th (1 + cos^2 th / 2 + 1 3 / (2 4) cos^4 th + ...),  th = atan(t / sqrt n),  for even n, and
    2 / pi (th + sin th (cos th + 2 / 3 cos^3 th + ...)) for odd n

    Args:
        t: [-] at least 0.
        freedom: degrees of freedom, at least 1.

    Source: Abramowitz & Stegun (1964), 26.7.3 and 26.7.4.
    """
    angle = math.atan(t / math.sqrt(freedom))
    sine, cosine = math.sin(angle), math.cos(angle)
    is_odd = freedom % 2
    term, total = (cosine, cosine) if is_odd else (1.0, 1.0)
    for k in range(3 if is_odd else 2, freedom - 1, 2):
        term *= cosine * cosine * (k - 1) / k
        total += term
    if not is_odd:
        return sine * total
    return 2.0 / math.pi * (angle + (sine * total if freedom > 1 else 0.0))


def _bisected(is_below: Callable[[float], bool], low: float, high: float) -> float:
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_below(middle) else (low, middle)
    return 0.5 * (low + high)
