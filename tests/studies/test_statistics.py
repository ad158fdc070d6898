"""Means, intervals and paired differences, against scipy, closed forms and simulated coverage."""

import math

import numpy as np
import pytest
from scipy import stats

from cardume.studies import statistics
from cardume.studies.statistics import (
    estimate,
    expanded_tail,
    is_clear,
    paired_difference,
    resampled_means,
    share_interval,
    shared_confidence,
    student_quantile,
    student_within,
)


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 7, 8, 19, 50, 199, 1000])
@pytest.mark.parametrize("probability", [0.6, 0.9, 0.975, 0.9995])
def test_students_quantile_is_that_of_scipy(freedom: int, probability: float) -> None:
    expected = stats.t.ppf(probability, freedom)
    assert student_quantile(probability, freedom) == pytest.approx(expected, rel=1e-8)
    assert student_within(expected, freedom) == pytest.approx(2.0 * probability - 1.0, rel=1e-10)


@pytest.mark.timeout(20)
@pytest.mark.parametrize("freedom", [1001, 5000, 10**8])
@pytest.mark.parametrize("probability", [0.5, 0.6, 0.975, 0.9995, 1.0 - 1e-7])
def test_students_quantile_of_many_takes_no_time(freedom: int, probability: float) -> None:
    """By the series of as many terms it would take hours."""
    assert student_quantile(probability, freedom) == pytest.approx(
        stats.t.ppf(probability, freedom), rel=1e-8, abs=1e-12
    )


def test_what_is_remembered_of_resampling_is_small() -> None:
    kept = statistics.resampled_counts(400).nbytes + statistics._places(400).nbytes
    assert 2 * kept <= 50e6  # both caches hold two
    sample = np.random.default_rng(4).normal(size=150)
    counted = statistics.resampled_counts(150) @ sample / 150
    np.testing.assert_allclose(counted, resampled_means(sample), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(("successes", "count"), [(0, 20), (1, 3), (19, 20), (20, 20), (50, 100)])
def test_wilsons_interval_is_that_of_scipy(successes: int, count: int) -> None:
    expected = stats.binomtest(successes, count).proportion_ci(0.95, method="wilson")
    assert share_interval(successes, count) == pytest.approx((expected.low, expected.high), abs=1e-12)
    assert share_interval(0, 0) == (0.0, 1.0)


def test_a_handful_of_values_gets_students_interval() -> None:
    sample = np.array([1.0, 2.0, 3.0, 4.0])
    low, high = stats.t.interval(0.9, 3, sample.mean(), stats.sem(sample))
    found = estimate(sample, 0.9)
    assert (found.mean, found.size) == (2.5, 4)
    assert (found.low, found.high) == pytest.approx((low, high), rel=1e-8)


@pytest.mark.parametrize("size", [8, 20, 100])
def test_the_bootstrap_of_normal_values_is_students_interval(size: int) -> None:
    """Of a sample without skew the two agree; Student's is exact for normal values."""
    sample = stats.norm.ppf((np.arange(size) + 0.5) / size)
    low, high = stats.t.interval(0.95, size - 1, sample.mean(), stats.sem(sample))
    found = estimate(sample)
    assert (found.low, found.high) == pytest.approx((low, high), rel=0.05)


@pytest.mark.parametrize(("size", "lowest"), [(3, 0.92), (10, 0.92), (30, 0.92)])
def test_intervals_cover_the_truth_as_often_as_they_say(size: int, lowest: float) -> None:
    generator = np.random.default_rng(5)
    found = [estimate(generator.normal(7.0, 2.0, size)) for _ in range(400)]
    covered = np.mean([one.low <= 7.0 <= one.high for one in found])
    assert lowest <= covered <= 0.98  # 0.95, and three standard deviations of the share


def test_the_plain_percentile_bootstrap_would_not_cover() -> None:
    """What the expansion is for: the same without it covers too rarely."""
    generator, tail = np.random.default_rng(5), 0.025
    hits = 0
    for _ in range(400):
        low, high = np.quantile(resampled_means(generator.normal(size=8)), (tail, 1.0 - tail))
        hits += low <= 0.0 <= high
    assert hits / 400 < 0.92
    assert expanded_tail(8, 0.95) < 0.5 * tail


def test_skew_is_in_the_interval() -> None:
    sample = np.random.default_rng(1).exponential(size=40)
    found = estimate(sample)
    assert found.high - found.mean > found.mean - found.low


def test_the_same_numbers_give_the_same_interval_however_the_work_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    sample = np.random.default_rng(2).normal(size=30)
    whole = estimate(sample)
    assert estimate(sample) == whole
    monkeypatch.setattr(statistics, "MOST_AT_ONCE", 10_000)
    assert estimate(sample) == whole


def test_what_is_no_number_is_left_out() -> None:
    nan = math.nan
    assert estimate(np.array([1.0, nan, 3.0])).size == 2
    assert estimate(np.array([1.0, nan, 3.0])).mean == 2.0
    lonely = estimate(np.array([nan, 3.0]))
    assert (lonely.mean, lonely.size) == (3.0, 1)
    assert math.isnan(lonely.low)
    assert estimate(np.array([nan])).size == 0
    assert paired_difference(np.array([1.0, nan, 5.0]), np.array([nan, 1.0, 2.0])).mean == 3.0


def test_pairs_tell_apart_what_means_do_not() -> None:
    generator = np.random.default_rng(3)
    weather = generator.normal(10.0, 3.0, 20)  # what both arms meet
    one, other = weather + generator.normal(0.0, 0.1, 20), weather + 0.3 + generator.normal(0.0, 0.1, 20)
    first, second = estimate(one), estimate(other)
    assert first.high > second.low
    difference = paired_difference(other, one)
    assert is_clear(difference)
    assert difference.low < 0.3 < difference.high


def test_equal_values_are_equal_and_rounding_is_nothing() -> None:
    same = paired_difference(np.array([1.0, 2.0]), np.array([1.0, 2.0 + 1e-15]))
    assert (same.mean, same.low, same.high) == (0.0, 0.0, 0.0)
    assert not is_clear(same)
    always = paired_difference(np.array([1.5, 2.5]), np.array([1.0, 2.0]))
    assert (always.low, always.high) == (0.5, 0.5)
    assert is_clear(always)


def test_many_answers_share_the_risk() -> None:
    assert shared_confidence(1) == pytest.approx(0.95)
    assert shared_confidence(10) == pytest.approx(0.995)
    generator = np.random.default_rng(11)
    families = 0
    for _ in range(100):  # of ten differences that are none, some interval at 95 % is clear most of the time
        found = [estimate(generator.normal(size=12), shared_confidence(10)) for _ in range(10)]
        families += any(map(is_clear, found))
    assert families <= 12  # 5 expected; with the bootstrap alone it is 15
