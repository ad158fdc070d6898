"""Where in the space of swept keys a metric is how large, and where what is required holds in 95 % of the missions."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cardume.studies.answers.distributions import means_of
from cardume.studies.answers.requirements import chances_of_all
from cardume.studies.answers.results import Results
from cardume.studies.statistics import Estimate

WANTED = 0.95  # [-] of the missions
MOST_PANELS = 9
LEAST = 1e-9  # [-] of a probability: its logit must be finite


@dataclass(frozen=True)
class Curve:
    """One metric along one swept key of numbers.

    Attributes:
        label: of the options of the other keys; empty where there are none.
        at: (option,) the numbers of the key.
        means: for each option the mean with its interval.
        low: (option,) the 5 % quantile of the runs.
        high: (option,) the 95 % quantile of the runs.
    """

    label: str
    at: np.ndarray
    means: tuple[Estimate, ...]
    low: np.ndarray
    high: np.ndarray


@dataclass(frozen=True)
class Map:
    """Something over two swept keys of numbers.

    Attributes:
        label: of the options of the other keys; empty where there are none.
        x: (column,) numbers of the first key.
        y: (row,) numbers of the second key.
        middle: (row, column) the mean of a metric, or the share of the runs that are as required.
        low: (row, column) lower end of its 95 % interval.
        high: (row, column) upper end.
    """

    label: str
    x: np.ndarray
    y: np.ndarray
    middle: np.ndarray
    low: np.ndarray
    high: np.ndarray


def numeric_keys(results: Results) -> tuple[str, ...]:
    """The swept keys that are numbers and have two options at least, those with most options first.

    Args:
        results: of the study.
    """
    found = [key for key in results.swept if results.numbers(key) is not None and len(set(results.labels(key))) > 1]
    return tuple(sorted(found, key=lambda key: -results.shape[results.swept.index(key)]))


def panels(results: Results, along: Sequence[str]) -> Iterator[tuple[str, tuple[int | slice, ...]]]:
    """Every combination of the options of the other keys: its words, and the index that picks it.

    Args:
        results: of the study.
        along: keys that are not fixed.
    """
    others = [key for key in results.swept if key not in along]
    sizes = [results.shape[results.swept.index(key)] for key in others]
    for places in np.ndindex(*sizes):
        chosen = dict(zip(others, places, strict=True))
        label = ", ".join(f"{key} {results.labels(key)[place]}" for key, place in chosen.items())
        yield label, tuple(chosen.get(key, slice(None)) for key in results.swept)


def curves(results: Results, key: str, metric: str) -> tuple[Curve, ...]:
    """One metric along one swept key, a curve for every combination of the other keys.

    Args:
        results: of the study.
        key: a swept key of numbers.
        metric: its name.

    Raises:
        ValueError: the options of the key are no numbers.
    """
    numbers, values = results.numbers(key), results.values(metric)
    if numbers is None:
        raise ValueError(f"{key} is no key of numbers")
    order = np.argsort(numbers)
    found = []
    for label, index in panels(results, [key]):
        rows = values[index][order]
        known = [row[np.isfinite(row)] for row in rows]
        ends = np.array([np.quantile(row, (0.05, 0.95)) if row.size else (math.nan, math.nan) for row in known])
        found.append(Curve(label, numbers[order], tuple(means_of(rows)), ends[:, 0], ends[:, 1]))
    return tuple(found)


def chance_curves(results: Results, key: str) -> tuple[Curve, ...]:
    """The probability that everything required holds along one swept key, with Wilson's interval.

    Args:
        results: of the study.
        key: a swept key of numbers.

    Raises:
        ValueError: the options of the key are no numbers.
    """
    numbers, counts = results.numbers(key), np.sum(results.is_judged, axis=-1)
    if numbers is None:
        raise ValueError(f"{key} is no key of numbers")
    share, low, high = chances_of_all(results)
    order = np.argsort(numbers)
    found = []
    for label, index in panels(results, [key]):
        parts = zip(share[index][order], low[index][order], high[index][order], counts[index][order], strict=True)
        means = tuple(Estimate(float(s), float(a), float(b), int(n)) for s, a, b, n in parts)
        nothing = np.full(len(order), math.nan)
        found.append(Curve(label, numbers[order], means, nothing, nothing))
    return tuple(found)


def mean_maps(results: Results, keys: tuple[str, str], metric: str) -> tuple[Map, ...]:
    """The mean of a metric over two swept keys, with Student's interval; a map for each option of the others.

    Args:
        results: of the study.
        keys: along x and along y.
        metric: its name.
    """
    from scipy.stats import t

    values = results.values(metric)
    count = np.sum(np.isfinite(values), axis=-1)
    total = np.nansum(values, axis=-1)
    mean = np.where(count > 0, total / np.maximum(count, 1), math.nan)
    spread = np.nansum((values - mean[..., None]) ** 2, axis=-1) / np.maximum(count - 1, 1)
    half = np.where(
        count > 1, t.ppf(0.975, np.maximum(count - 1, 1)) * np.sqrt(spread / np.maximum(count, 1)), math.nan
    )
    return _maps(results, keys, mean, mean - half, mean + half)


def chance_maps(results: Results, keys: tuple[str, str]) -> tuple[Map, ...]:
    """The probability that everything required holds over two swept keys; a map for each option of the others.

    Args:
        results: of the study.
        keys: along x and along y.
    """
    return _maps(results, keys, *chances_of_all(results))


def _maps(
    results: Results, keys: tuple[str, str], middle: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[Map, ...]:
    x, y = (results.numbers(key) for key in keys)
    if x is None or y is None:
        raise ValueError(f"{keys} are no keys of numbers")
    columns, rows = np.argsort(x), np.argsort(y)
    is_turned = results.swept.index(keys[0]) < results.swept.index(keys[1])
    found = []
    for label, index in panels(results, keys):
        parts = [part[index].T if is_turned else part[index] for part in (middle, low, high)]
        found.append(Map(label, x[columns], y[rows], *(part[np.ix_(rows, columns)] for part in parts)))
    return tuple(found)


def boundary(chances: Map, wanted: float = WANTED) -> dict[str, list[np.ndarray]]:
    """The lines on which a probability crosses what is wanted: of its estimate and of both ends of its interval.

    Between the cases a probability is interpolated linearly in its logit. Inside of the line of `low` the requirement
    holds in so many missions with some 97.5 % confidence at each point, outside of that of `high` it does not. The
    estimate is the middle of Wilson's interval, which is never 0 or 1, and nearer to 1/2 than the share: with fewer
    than 35 runs it is below 0.95 even where none failed.

    Args:
        chances: a map of probabilities.
        wanted: [-] share of the missions.

    Returns:
        For `low`, `middle` and `high` the lines, each (point, 2) in the units of x and y.
    """
    from contourpy import contour_generator

    surfaces = {"low": chances.low, "middle": 0.5 * (chances.low + chances.high), "high": chances.high}
    found: dict[str, list[np.ndarray]] = {}
    for name, surface in surfaces.items():
        bounded = np.clip(surface, LEAST, 1.0 - LEAST)
        height = np.log(bounded / (1.0 - bounded))
        lines = contour_generator(chances.x, chances.y, height).lines(math.log(wanted / (1.0 - wanted)))
        found[name] = [np.asarray(line) for line in lines]
    return found


def fewest_runs(wanted: float = WANTED) -> int:
    """How many runs without one miss show that a probability is as large as wanted, by Wilson's interval.

    n / (n + z^2) >= p

    Args:
        wanted: [-] the probability.
    """
    from statistics import NormalDist

    return math.ceil(NormalDist().inv_cdf(0.975) ** 2 * wanted / (1.0 - wanted))


def verdicts(chances: Map, wanted: float = WANTED) -> np.ndarray:
    """For each case 1 where the requirement surely holds so often, -1 where it surely does not, else 0.

    Args:
        chances: a map of probabilities.
        wanted: [-] share of the missions.

    Returns:
        (row, column) whole numbers [-].
    """
    found: np.ndarray = np.where(chances.low >= wanted, 1, np.where(chances.high < wanted, -1, 0))
    return found
