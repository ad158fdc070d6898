"""What a study says, from numbers made up for it; the judges are SciPy, closed forms and repeated sampling."""

import math

import numpy as np
import pytest
from scipy import stats

from cardume.errors import DataError
from cardume.report.study.words import study_words
from cardume.studies.answers.differences import differences, swept_laws
from cardume.studies.answers.distributions import MOST_RESAMPLED, distribution, mean_of, means_of, quantile
from cardume.studies.answers.regions import (
    boundary,
    chance_curves,
    chance_maps,
    curves,
    fewest_runs,
    mean_maps,
    numeric_keys,
    verdicts,
)
from cardume.studies.answers.requirements import chance, chance_of_all, requirements
from cardume.studies.answers.results import Limit, Results
from cardume.studies.answers.worst import worst_runs
from cardume.studies.statistics import estimate
from cardume.studies.summing_up import summarize_study
from studies.datasets import make_dataset


def rng(*seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


# ---- distributions ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("count", "share"), [(20, 0.5), (57, 0.5), (100, 0.95), (200, 0.05), (999, 0.95), (31, 0.25)])
def test_quantile_interval_is_scipys(count: int, share: float) -> None:
    sample = np.sort(rng(count).normal(size=count))
    found = quantile(sample, share)
    judge = stats.quantile_test(sample, p=share).confidence_interval(0.95)
    assert found.value == np.quantile(sample, share)
    assert np.array_equal([found.low, found.high], [judge.low, judge.high], equal_nan=True)


def test_quantile_interval_covers() -> None:
    """Exponential values, whose 95 % quantile is log 20: an interval that covers it at least as often as it says."""
    samples = np.sort(rng(1).exponential(size=(2000, 120)), axis=1)
    hits = [quantile(row, 0.95) for row in samples]
    covered = np.mean([one.low <= math.log(20.0) <= (one.high if math.isfinite(one.high) else np.inf) for one in hits])
    assert 0.945 <= covered <= 0.985


def test_a_quantile_that_no_run_bounds_says_so() -> None:
    found = quantile(np.arange(30.0), 0.95)
    assert math.isfinite(found.low)
    assert math.isnan(found.high)
    assert math.isnan(quantile(np.zeros(0), 0.5).value)


def test_mean_of_many_runs_is_students_and_near_the_bootstraps() -> None:
    sample = rng(2).exponential(size=MOST_RESAMPLED + 1)
    found, slow = mean_of(sample), estimate(sample)
    half = stats.t.ppf(0.975, sample.size - 1) * stats.sem(sample)
    np.testing.assert_allclose([found.low, found.high], [sample.mean() - half, sample.mean() + half], rtol=1e-12)
    assert abs(found.low - slow.low) < 0.1 * half
    assert abs(found.high - slow.high) < 0.1 * half
    assert mean_of(sample[:200]) == estimate(sample[:200])


def test_means_of_many_samples_are_those_of_each() -> None:
    samples = rng(9).exponential(size=(5, 40))
    samples[1, 3:9], samples[2] = np.nan, 7.0
    for found, sample in zip(means_of(samples), samples, strict=True):
        np.testing.assert_allclose(found, mean_of(sample), rtol=1e-12)


def test_distribution_counts_what_is_missing() -> None:
    values = rng(3).normal(size=50)
    values[:4] = np.nan
    status = np.ones(50, np.int8)
    status[-3:], status[-5:-3] = 0, 2
    found = distribution(Results(make_dataset({"energy": values}, status=status)), "energy")
    assert found.missing == 4 + 2  # without the number, failed; those not flown are not missing
    assert found.mean.size == 41
    assert found.least == np.nanmin(values[:45])
    assert found.median.value == pytest.approx(np.nanmedian(values[:45]))


# ---- requirements ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("met", "count"), [(0, 10), (10, 10), (3, 17), (950, 1000)])
def test_chances_have_wilsons_interval(met: int, count: int) -> None:
    found = chance(np.arange(count) < met)
    judge = stats.binomtest(met, count).proportion_ci(method="wilson")
    np.testing.assert_allclose([found.low, found.high], [judge.low, judge.high], atol=1e-12)
    assert found.share == met / count


def test_requirements_jointly_and_each() -> None:
    errors, energies = np.arange(20.0), np.arange(20.0)[::-1].copy()
    status = np.ones(20, np.int8)
    status[10] = 2
    dataset = make_dataset(
        {"cross_track_rms": errors, "energy": energies},
        required=["cross_track_rms <= 14.5 m", "energy <= 17.5 J"],
        status=status,
    )
    dataset["violated_at"].values[:2, 1] = 30.0, 40.0
    results = Results(dataset)
    both = chance_of_all(results)
    assert (both.successes, both.tries) == (20 - 5 - 2 - 1, 20)
    worst, other = requirements(results)
    assert worst.name.startswith("cross_track_rms")
    assert (worst.missed, worst.missed_alone, worst.chance.successes) == (5, 5, 14)
    assert (other.missed, other.missed_alone, other.violated.value) == (2, 2, 35.0)


def test_limits_are_read_from_what_stands_beside_their_names() -> None:
    names = ["cross_track_rms <= 0.5 m", "port: altitude_min >= 3 m", "depth_max <= its limit"]
    dataset = make_dataset({"energy": np.arange(3.0)}, required=names)
    expected = (
        Limit("cross_track_rms", 0.5, 1.0),
        Limit("altitude_min", 3.0, -1.0, "port"),
        Limit("depth_max", pytest.approx(math.nan, nan_ok=True), 1.0),
    )
    assert Results(dataset).limits == expected
    renamed = dataset.assign_coords(requirement=["on the path", "clear of the ground", "not too deep"])
    assert Results(renamed).limits == expected  # the words are for people
    assert Results(renamed.isel(requirement=[1])).limits == expected[1:2]
    with pytest.raises(DataError, match="lacks limit"):
        _ = Results(dataset.drop_vars("limit")).limits
    with pytest.raises(DataError, match="requires roll_max, and there is no metric"):
        _ = Results(dataset.assign_coords(limit_metric=("requirement", ["roll_max"] * 3))).limits


# ---- regions ---------------------------------------------------------------------------------------------------------


def plane(runs: int = 400) -> Results:
    """A metric that is N(x + 2 y, 1) over two keys, the second given first and downwards."""
    y, x = np.array([0.3, 0.2, 0.1, 0.0]), np.array([0.0, 1.0, 2.0])
    values = 10.0 + x[None, :, None] + 2.0 * y[:, None, None] + rng(4).normal(size=(4, 3, runs))
    swept = {"current.speed": (y, "m/s"), "acoustics.delay": (x, "s")}
    return Results(make_dataset({"cross_track_rms": values}, swept, required=["cross_track_rms <= 12 m"]))


def test_maps_lie_as_their_keys_say() -> None:
    results = plane()
    (found,) = mean_maps(results, ("acoustics.delay", "current.speed"), "cross_track_rms")
    np.testing.assert_array_equal(found.x, [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(found.y, [0.0, 0.1, 0.2, 0.3])
    truth = 10.0 + found.x[None, :] + 2.0 * found.y[:, None]
    assert np.all((found.low < truth + 0.1) & (found.high > truth - 0.1))
    np.testing.assert_allclose(found.middle, truth, atol=0.2)
    (turned,) = mean_maps(results, ("current.speed", "acoustics.delay"), "cross_track_rms")
    np.testing.assert_array_equal(turned.middle, found.middle.T)
    sample = results.values("cross_track_rms")[3, 2]
    judge = stats.t.interval(0.95, 399, sample.mean(), stats.sem(sample))
    np.testing.assert_allclose([found.low[0, 2], found.high[0, 2]], judge)


def test_boundary_is_where_the_probability_crosses() -> None:
    """P(N(x, 1) <= 12 - 10) = 0.5 where x = 2, on a grid so fine that the logit is straight between its points."""
    x, y = np.linspace(0.0, 3.0, 13), np.array([0.0, 1.0])
    values = np.broadcast_to(10.0 + x[None, :, None], (2, 13, 3000)) + rng(5).normal(size=(1, 1, 3000))
    swept = {"current.speed": (y, "m/s"), "acoustics.delay": (x, "s")}
    results = Results(make_dataset({"cross_track_rms": values}, swept, required=["cross_track_rms <= 12 m"]))
    (chances,) = chance_maps(results, ("acoustics.delay", "current.speed"))
    for wanted in (0.5, 0.95):
        truth = 2.0 - stats.norm.ppf(wanted)
        lines = boundary(chances, wanted)
        low, middle, high = (lines[name][0][:, 0].mean() for name in ("low", "middle", "high"))
        assert low < middle < high
        assert low - 0.02 <= truth <= high + 0.02
        assert middle == pytest.approx(truth, abs=0.08)


def test_what_is_sure_and_what_is_not() -> None:
    (chances,) = chance_maps(plane(), ("acoustics.delay", "current.speed"))
    sure = verdicts(chances, 0.9)
    np.testing.assert_array_equal(sure[0], [1, -1, -1])  # P(N(0, 1) <= 2) = .977, P(N(1, 1) <= 2) = .84, .5
    enough, few = fewest_runs(), fewest_runs() - 1
    assert stats.binomtest(enough, enough).proportion_ci(method="wilson").low >= 0.95
    assert stats.binomtest(few, few).proportion_ci(method="wilson").low < 0.95


def test_curves_of_one_key_with_another_as_label() -> None:
    x = np.array([2.0, 0.0, 1.0])
    noise = rng(6).normal(size=(2, 1, 100))
    values = np.array([[[1.0], [3.0]]]).reshape(2, 1, 1) * x[None, :, None] + noise
    swept = {"guidance": (["arcsine", "line_of_sight"], ""), "acoustics.delay": (x, "s")}
    results = Results(make_dataset({"cross_track_rms": values}, swept, required=["cross_track_rms <= 2 m"]))
    assert numeric_keys(results) == ("acoustics.delay",)
    assert swept_laws(results) == ("guidance",)
    first, second = curves(results, "acoustics.delay", "cross_track_rms")
    assert (first.label, second.label) == ("guidance arcsine", "guidance line_of_sight")
    np.testing.assert_array_equal(first.at, [0.0, 1.0, 2.0])
    np.testing.assert_allclose([mean.mean for mean in second.means], [0.0, 3.0, 6.0], atol=0.3)
    assert np.all(first.low < first.high)
    chances = chance_curves(results, "acoustics.delay")
    assert [mean.size for mean in chances[0].means] == [100, 100, 100]
    assert chances[1].means[2].mean < 0.01 < 0.9 < chances[0].means[0].mean


# ---- differences -----------------------------------------------------------------------------------------------------


def test_laws_are_compared_in_pairs() -> None:
    weather = rng(7).normal(10.0, 3.0, size=(1, 4, 60))
    shift = np.array([0.0, 0.3, 0.0])[:, None, None]
    values = weather + shift + rng(8).normal(0.0, 0.2, size=(3, 4, 60))
    swept = {"guidance": (["a", "b", "c"], ""), "acoustics.delay": ([0.0, 1.0, 2.0, 3.0], "s")}
    found = differences(Results(make_dataset({"cross_track_rms": values}, swept)), "guidance")
    assert found.is_real["cross_track_rms"] == (True, False)
    assert found.differences["cross_track_rms"][0].mean == pytest.approx(0.3, abs=0.06)
    assert found.differences["cross_track_rms"][0].size == 60  # one pair per seed, not per mission
    assert found.is_pooled
    same = differences(Results(make_dataset({"cross_track_rms": weather + 0.0 * shift}, swept)), "guidance")
    assert same.differences["cross_track_rms"][0][:3] == (0.0, 0.0, 0.0)


# ---- worst runs ------------------------------------------------------------------------------------------------------


def test_worst_runs_in_order() -> None:
    errors = np.array([[0.1, 0.9, 0.6, 0.2], [0.55, 0.3, 0.1, np.nan]])
    energies = np.array([[5.0, 5.0, 20.0, 5.0], [5.0, 5.0, 5.0, 5.0]])
    status = np.array([[1, 1, 1, 1], [1, 2, 0, 1]], np.int8)
    dataset = make_dataset(
        {"cross_track_rms": errors, "energy": energies},
        {"acoustics.delay": ([0.0, 1.5], "s")},
        required=["cross_track_rms <= 0.5 m", "energy <= 10 J"],
        status=status,
    )
    found = worst_runs(Results(dataset))
    assert [(one.case, one.seed) for one in found] == [((1,), 2), ((0,), 3), ((1,), 4), ((0,), 2), ((1,), 1)]
    failed, both, nothing, *_ = found
    assert failed.failure.startswith("the state of vehicle a")
    assert both.missed == ("energy <= 10 J", "cross_track_rms <= 0.5 m")
    assert both.excess == pytest.approx(1.0)
    assert nothing.excess == math.inf
    assert found[3].label == "acoustics.delay 0 s"


def test_by_how_much_a_limit_of_its_own_was_missed_is_not_told() -> None:
    """A least altitude that is drawn: more of it is no worse, and 12 m are not 1200 % too much."""
    dataset = make_dataset({"altitude_min": np.array([12.0, 3.0, 8.0])}, required=["altitude_min >= its limit"])
    dataset["met"].values[:] = [[True], [False], [True]]
    worst, *others = worst_runs(Results(dataset))
    assert (worst.seed, worst.missed, worst.excess) == (2, ("altitude_min >= its limit",), -math.inf)
    assert not any(one.missed for one in others)
    assert study_words(dataset)[-1] == "The worst run is seed 2: it missed altitude_min >= its limit."


def test_without_requirements_the_first_metric_decides() -> None:
    values = np.array([0.3, 0.9, 0.1, 0.5])
    found = worst_runs(Results(make_dataset({"cross_track_rms": values})), 2)
    assert [one.seed for one in found] == [2, 4]


def test_what_is_no_study_is_refused() -> None:
    dataset = make_dataset({"energy": np.arange(3.0)})
    with pytest.raises(DataError, match="lacks status"):
        Results(dataset.drop_vars("status"))


def test_runs_that_could_not_be_flown_count_for_nothing() -> None:
    errors = np.arange(20.0)
    status = np.ones(20, np.int8)
    status[:4], status[4] = 3, 2  # refused, failed in flight
    dataset = make_dataset({"cross_track_rms": errors}, required=["cross_track_rms <= 14.5 m"], status=status)
    results = Results(dataset)
    assert results.num_flown == 16
    both = chance_of_all(results)
    assert (both.successes, both.tries) == (10, 16)
    (only,) = requirements(results)
    assert (only.missed, only.chance.tries) == (5, 16)
    assert distribution(results, "cross_track_rms").missing == 1
    attrs = dict.fromkeys(("version", "title", "sampling", "seed", "runs", "command", "mission_hash"), "")
    (case,) = summarize_study(dataset.assign_attrs(attrs))["cases"]
    assert (case["flown"], case["failed"], case["refused"]) == (15, 1, 4)
    assert case["requirements"]["cross_track_rms <= 14.5 m"]["runs"] == 16
