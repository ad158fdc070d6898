"""Which inputs matter: rank correlations and shares of the variance, from whatever sample a study has.

Inputs are the swept keys and the drawn values. They are independent of one another: a swept key takes each of its
options in every run, a drawn value is drawn without regard to the others. So a metric is a sum of functions of one,
two, ... inputs, orthogonal to each other, and each function's share of the variance says what that input, or that
combination, does (Sobol 1993). The functions are found by least squares on products of polynomials that are
orthonormal over the sample (polynomial chaos; Sudret 2008, Reliab. Eng. Syst. Saf. 93, 964-979). What is left is
noise that the seed draws, and whatever is finer than the polynomials; both are told as unexplained, not hidden.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cardume.studies.answers.results import Results
from cardume.studies.statistics import CONFIDENCE, shared_confidence, student_quantile

GROUPS = 20  # of runs, of which one at a time is left out
FEWEST_RUNS = 20
MOST_ROWS = 3000  # missions that are used
MOST_DEGREE = 8
ROWS_PER_TERM = 4  # at least, of a fit
MOST_TERMS = 100  # of a fit
MOST_LEVELS = 8  # of an input that takes few values, each then stands for itself


class Share(NamedTuple):
    """A number with the interval that the jackknife over groups of runs gives it."""

    value: float  # [-]
    low: float  # [-]
    high: float  # [-]


@dataclass(frozen=True)
class Input:
    """One of the things that differ between missions.

    Attributes:
        key: of the mission file.
        values: (mission,) numbers; of laws and words the place among their kinds.
        is_ordered: whether more and less mean anything.
    """

    key: str
    values: np.ndarray
    is_ordered: bool


@dataclass(frozen=True)
class Influence:
    """What one input does to one metric.

    Attributes:
        key: of the input.
        rank: Spearman's correlation; NaN for laws and words.
        first: share of the metric's variance that the input makes alone.
        total: the same with all its combinations with other inputs.
        is_clear: whether an effect lies outside of what chance gives at odds that all inputs share.
    """

    key: str
    rank: Share
    first: Share
    total: Share
    is_clear: bool


@dataclass(frozen=True)
class Influences:
    """What all inputs do to one metric.

    Attributes:
        metric: its name.
        inputs: the most influential first.
        explained: share of the variance that all inputs together explain.
        degree: of the polynomials.
        num_missions: that were used.
    """

    metric: str
    inputs: tuple[Influence, ...]
    explained: Share
    degree: int
    num_missions: int


def influences(results: Results, metric: str) -> Influences | None:
    """What each input does to a metric.

    Args:
        results: of the study.
        metric: its name.

    Returns:
        None where nothing varies, the metric does not, or there are fewer than 20 runs.
    """
    return results.once(("influences", metric), lambda: _influences(results, metric))


def _influences(results: Results, metric: str) -> Influences | None:
    values = results.values(metric)
    runs = _chosen_runs(values)
    if len(runs) < FEWEST_RUNS:
        return None
    inputs = inputs_of(results, runs)
    output = values[..., runs].ravel()
    group = np.broadcast_to(np.arange(len(runs)) * min(GROUPS, len(runs)) // len(runs), values[..., runs].shape).ravel()
    known = np.isfinite(output)
    inputs = [Input(one.key, one.values[known], one.is_ordered) for one in inputs]
    inputs = [one for one in inputs if np.ptp(one.values) > 0.0]
    output, group = output[known], group[known]
    if not inputs or output.size < FEWEST_RUNS or not np.ptp(output) > 1e-12 * np.abs(output).max():
        return None
    return analyze(metric, inputs, output, group)


def inputs_of(results: Results, runs: np.ndarray) -> list[Input]:
    """All that differs between the missions of a study.

    Args:
        results: of the study.
        runs: (n,) places of the runs.
    """
    shape = (*results.shape, len(runs))
    found = []
    for axis, key in enumerate(results.swept):
        numbers = results.numbers(key)
        places = np.arange(results.shape[axis], dtype=float) if numbers is None else numbers
        along = places.reshape([-1 if k == axis else 1 for k in range(len(shape))])
        found.append(Input(key, np.broadcast_to(along, shape).ravel(), numbers is not None))
    for key, drawn in results.drawn.items():
        chosen = drawn[..., runs].ravel()
        is_number = chosen.dtype.kind in "fiub"
        numbers = chosen.astype(float) if is_number else np.unique(chosen, return_inverse=True)[1].astype(float)
        found.append(Input(key, np.where(np.isfinite(numbers), numbers, np.nanmin(numbers)), is_number))
    return found


def _chosen_runs(values: np.ndarray) -> np.ndarray:
    """Places of the runs that have a number in some case, no more than can be handled."""
    known = np.flatnonzero(np.isfinite(values).reshape(-1, values.shape[-1]).any(axis=0))
    cases = max(1, values.size // max(1, values.shape[-1]))
    most = max(FEWEST_RUNS, MOST_ROWS // cases)
    return known[np.linspace(0, len(known) - 1, most).astype(int)] if len(known) > most else known


def analyze(metric: str, inputs: Sequence[Input], output: np.ndarray, group: np.ndarray) -> Influences:
    """The influences of independent inputs on an output.

    Args:
        metric: name of the output.
        inputs: (mission,) each.
        output: (mission,) numbers.
        group: (mission,) whole numbers; missions with common random numbers are of one group.
    """
    y = (output - output.mean()) / output.std()
    degree = _best_degree(inputs, y)
    terms = _terms([basis(one, degree).shape[1] for one in inputs], degree, len(y))
    groups = np.unique(group)
    whole = _shares(inputs, y, np.full(len(y), True), degree, terms)
    parts = np.array([_shares(inputs, y, group != g, degree, terms) for g in groups])
    ranks = [_rank(one.values, y) if one.is_ordered else math.nan for one in inputs]
    rank_parts = np.array(
        [
            [_rank(one.values[group != g], y[group != g]) if one.is_ordered else math.nan for one in inputs]
            for g in groups
        ]
    )
    count, found = len(inputs), []
    strict = shared_confidence(2 * count)
    for k, one in enumerate(inputs):
        rank, strict_rank = (_in_fisher(ranks[k], rank_parts[:, k], level) for level in (CONFIDENCE, strict))
        first, total = (_interval(whole[place], parts[:, place]) for place in (k, count + k))
        strict_total = _interval(whole[count + k], parts[:, count + k], strict)
        is_clear = strict_total.low > 0.0 or strict_rank.low > 0.0 or strict_rank.high < 0.0
        found.append(Influence(one.key, rank, first, total, is_clear))
    found.sort(key=lambda influence: -influence.total.value)
    return Influences(metric, tuple(found), _interval(whole[-1], parts[:, -1]), degree, len(y))


def basis(one: Input, degree: int) -> np.ndarray:
    """Functions of one input that are orthonormal over the sample, and to a constant.

    Of an ordered input polynomials of its ranks, up to a degree; of one that takes few values as many as tell them
    apart; of laws and words a function that tells each apart.

    Args:
        one: the input.
        degree: of the polynomials.

    Returns:
        (mission, function)
    """
    levels, places = np.unique(one.values, return_inverse=True)
    if one.is_ordered:
        order = min(degree, len(levels) - 1)
        ranks = np.cumsum(np.bincount(places)) - 0.5 * np.bincount(places)
        at = 2.0 * ranks / len(places) - 1.0
        raw = np.polynomial.legendre.legvander(at, order)[places]
    else:
        raw = np.column_stack([np.ones(len(places)), *(places == k for k in range(1, min(len(levels), MOST_LEVELS)))])
    orthonormal, _ = np.linalg.qr(raw)
    return orthonormal[:, 1:] * math.sqrt(len(places))


Term = tuple[tuple[int, int], ...]  # (input, function) of each factor


def _terms(sizes: Sequence[int], degree: int, rows: int) -> list[Term]:
    """Products of functions up to a total degree, of one input, two, then three, while the sample suffices for them."""
    found: list[Term] = [((k, f),) for k, size in enumerate(sizes) for f in range(size)]
    for order in (2, 3):
        more: list[Term] = []
        for inputs in itertools.combinations(range(len(sizes)), order):
            for functions in itertools.product(*(range(sizes[k]) for k in inputs)):
                if sum(f + 1 for f in functions) <= max(degree, order):
                    more.append(tuple(zip(inputs, functions, strict=True)))
        if len(found) + len(more) > min(MOST_TERMS, rows // ROWS_PER_TERM):
            break
        found += more
    return found


def _design(bases: Sequence[np.ndarray], terms: Sequence[Term]) -> np.ndarray:
    columns = []
    for term in terms:
        column = np.ones(len(bases[0]))
        for place, function in term:
            column = column * bases[place][:, function]
        columns.append(column)
    return np.column_stack([np.ones(len(bases[0])), *columns])


def _best_degree(inputs: Sequence[Input], y: np.ndarray) -> int:
    """The degree whose fit predicts best what it has not seen (leave one out)."""
    best, least = 1, math.inf
    for degree in range(1, MOST_DEGREE + 1):
        bases = [basis(one, degree) for one in inputs]
        sizes = [columns.shape[1] for columns in bases]
        if sum(sizes) > min(MOST_TERMS, len(y) // ROWS_PER_TERM) and degree > 1:
            break
        design = _design(bases, _terms(sizes, degree, len(y)))
        q, _ = np.linalg.qr(design)
        leverage = np.minimum(np.sum(q * q, axis=1), 1.0 - 1e-9)
        error = float(np.mean(((y - q @ (q.T @ y)) / (1.0 - leverage)) ** 2))
        if error < least * (1.0 - 1e-9):
            best, least = degree, error
        elif degree > best + 1:
            break  # what comes after fits noise
    return best


def _shares(
    inputs: Sequence[Input], y: np.ndarray, chosen: np.ndarray, degree: int, terms: Sequence[Term]
) -> np.ndarray:
    """First-order and total share of each input, and the share explained (2 count + 1,), by some of the missions.

    A coefficient squared is too large by its own variance, which the residuals tell: it is taken off.
    """
    some, count = [Input(one.key, one.values[chosen], one.is_ordered) for one in inputs], len(inputs)
    bases, y = [basis(one, degree) for one in some], y[chosen]
    terms = [term for term in terms if all(f < bases[k].shape[1] for k, f in term)]
    design = _design(bases, terms)
    inverse = np.linalg.pinv(design.T @ design, hermitian=True)
    coefficients = inverse @ (design.T @ y)
    noise = float(np.sum((y - design @ coefficients) ** 2)) / max(1, len(y) - len(coefficients))
    parts = (coefficients**2 - noise * np.diag(inverse))[1:]
    parts = parts / (max(0.0, float(parts.sum())) + noise)
    first, total = np.zeros(count), np.zeros(count)
    for part, term in zip(parts, terms, strict=True):
        for place, _ in term:
            total[place] += part
        if len(term) == 1:
            first[term[0][0]] += part
    return np.concatenate([first, total, [parts.sum()]])


def _rank(one: np.ndarray, other: np.ndarray) -> float:
    """Spearman's correlation."""
    from scipy.stats import spearmanr

    return float(spearmanr(one, other).statistic) if np.ptp(one) > 0.0 and np.ptp(other) > 0.0 else math.nan


def _interval(value: float, parts: np.ndarray, confidence: float = CONFIDENCE) -> Share:
    """A share within [0, 1] with the interval of a jackknife that leaves one group out.

    se^2 = (g - 1) / g sum (x_-k - mean)^2

    Source: Efron & Tibshirani (1993), An Introduction to the Bootstrap, eq. (11.5), by groups.
    """
    half = _half(parts, confidence)
    clipped = [min(max(float(end), 0.0), 1.0) for end in (value, value - half, value + half)]
    return Share(*clipped)


def _in_fisher(value: float, parts: np.ndarray, confidence: float = CONFIDENCE) -> Share:
    """A correlation with its jackknife's interval, made where its distribution is nearly normal: at atanh r."""
    if not math.isfinite(value):
        return Share(math.nan, math.nan, math.nan)
    bound = 1.0 - 1e-12
    middle = math.atanh(min(max(value, -bound), bound))
    half = _half(np.arctanh(np.clip(parts, -bound, bound)), confidence)
    return Share(value, math.tanh(middle - half), math.tanh(middle + half))


def _half(parts: np.ndarray, confidence: float) -> float:
    count = len(parts)
    if count < 2:
        return math.inf
    error = math.sqrt((count - 1) / count * float(np.sum((parts - parts.mean()) ** 2)))
    return student_quantile(0.5 + 0.5 * confidence, count - 1) * error
