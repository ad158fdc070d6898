"""Looking for the best values with a given number of tries: one metric by scipy, several by Optuna.

Tries meet the same seeds, so their results differ by the values alone.  They are only ever compared with one another,
which lets what is required come first: whatever meets it is better than whatever does not.
"""

import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import InputError

GLOBAL_SHARE = 0.6  # of the tries, before the best of them is refined
FIRST_STEP = 0.08  # of the range, where it is refined
CLOSE = 1e-3  # of the range: nearer, it is found
MISSED, INCOMPLETE = 1e12, 1e13  # cost beyond any metric
FEWEST_POINTS = 5  # that scipy's differential evolution begins with


class Try(NamedTuple):
    """What some values led to.

    Attributes:
        values: [any] of the knobs.
        metrics: [any] means or quantiles over the runs; NaN where some run has no number.
        met: [-] share of the runs in which all is met that the mission requires; 1 where nothing is.
        counted: [-] share of the runs in which every metric has a number.
    """

    values: tuple[float, ...]
    metrics: tuple[float, ...]
    met: float
    counted: float


class Goal(NamedTuple):
    """What is better: by metric -1 where more is, and the share [-] of runs that are to meet what is required."""

    signs: tuple[float, ...]
    met: float


class Enough(Exception):
    """There are no tries left, or the user said stop."""


Shares = tuple[float, ...]
Attempt = Callable[[Shares], Try]


def cost(found: Try, goal: Goal) -> float:
    """A number [-] that is smaller for the better of two tries of a single metric.

    Args:
        found: a try.
        goal: what is better.
    """
    if found.counted < 1.0:
        return INCOMPLETE * (2.0 - found.counted)
    value = goal.signs[0] * found.metrics[0]
    if found.met < goal.met:
        return MISSED * (1.0 + goal.met - found.met) + value / (1.0 + abs(value))
    return value


def search_one(attempt: Attempt, start: Shares, tries: int, goal: Goal, seed: int) -> None:
    """Differential evolution, then the simplex of Nelder and Mead around the best.

    Args:
        attempt: tries shares of the ranges of the knobs; raises Enough.
        start: where the mission begins.
        tries: how many there are.
        goal: what is better.
        seed: of the search.

    Source: Storn & Price (1997); Nelder & Mead (1965); as scipy.optimize has them.
    """
    optimize, qmc = _scipy()
    size = len(start)
    best: list[tuple[float, Shares]] = []

    def measure(shares: Sequence[float]) -> float:
        place = tuple(float(share) for share in shares)
        value = cost(attempt(place), goal)
        best[:] = [min([*best, (value, place)])]
        return value

    left = iter(range(max(FEWEST_POINTS, int(GLOBAL_SHARE * tries))))

    def measure_some(shares: Sequence[float]) -> float:
        if next(left, None) is None:
            raise _Elsewhere
        return measure(shares)

    count = max(FEWEST_POINTS, min(4 * size + 3, tries // 4))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that so few points are no whole Sobol sequence
        points = np.vstack([start, qmc.Sobol(size, rng=seed).random(count - 1)])
    with suppress(_Elsewhere):
        optimize.differential_evolution(
            measure_some, [(0.0, 1.0)] * size, init=points, maxiter=10**6, tol=CLOSE, polish=False, rng=seed
        )
    while True:
        (value, place) = best[0]
        optimize.minimize(
            measure,
            place,
            method="Nelder-Mead",
            bounds=[(0.0, 1.0)] * size,
            options={"initial_simplex": _simplex(place), "xatol": CLOSE, "fatol": 0.0, "maxfev": 10**6},
        )
        if best[0][0] >= value:
            return


class _Elsewhere(Exception):
    """The search over all of the range is over."""


def _simplex(place: Shares) -> np.ndarray:
    corners = np.tile(place, (len(place) + 1, 1))
    for k in range(len(place)):
        step = FIRST_STEP if place[k] + FIRST_STEP <= 1.0 else -FIRST_STEP
        corners[k + 1, k] += step
    return corners


def _scipy() -> tuple[Any, Any]:
    try:
        from scipy import optimize
        from scipy.stats import qmc
    except ImportError:
        raise InputError("tuning needs scipy; install it with: pip install 'cardume[study]'") from None
    return optimize, qmc


def search_several(attempt: Attempt, start: Shares, tries: int, goal: Goal, seed: int) -> None:
    """NSGA-II: values of which no others are better in every metric.

    Args:
        attempt: tries shares of the ranges of the knobs; raises Enough.
        start: where the mission begins.
        tries: how many there are.
        goal: what is better.
        seed: of the search.

    Raises:
        InputError: Optuna is not installed.

    Source: Deb, Pratap, Agarwal & Meyarivan (2002), as Optuna has it.
    """
    try:
        import optuna
    except ImportError:
        raise InputError(
            "tuning for several metrics needs Optuna; install it with: pip install 'cardume[tune]', or give one --for"
        ) from None
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.NSGAIISampler(population_size=max(8, min(40, tries // 5)), seed=seed % 2**32)
        study = optuna.create_study(directions=["minimize"] * len(goal.signs), sampler=sampler)
        names = [f"share {k}" for k in range(len(start))]
        study.enqueue_trial(dict(zip(names, start, strict=True)))
        for _ in range(20 * tries):  # one that was tried before costs nothing; `attempt` says when it is enough
            trial = study.ask()
            found = attempt(tuple(trial.suggest_float(name, 0.0, 1.0) for name in names))
            trial.set_constraint("required", goal.met - found.met)
            trial.set_constraint("numbers", 1.0 - found.counted)
            values = [sign * value for sign, value in zip(goal.signs, found.metrics, strict=True)]
            study.tell(trial, [value if np.isfinite(value) else INCOMPLETE for value in values])


def best_of(tries: Sequence[Try], goal: Goal) -> Try:
    """The best try of a single metric; of several the one of the front that is nearest to being best in all.

    Where some of the front are in no metric worse than the first try, as the mission is, it is one of those.

    Args:
        tries: at least one; the first is the mission as it is.
        goal: what is better.
    """
    if len(goal.signs) == 1:
        return min(tries, key=lambda found: cost(found, goal))
    front = front_of(tries, goal)
    if not front:
        return max(tries, key=lambda found: (found.counted, found.met))
    values = np.array([found.metrics for found in front]) * np.array(goal.signs)
    spread = np.ptp(values, axis=0)
    away = np.hypot.reduce((values - values.min(axis=0)) / np.where(spread > 0.0, spread, 1.0), axis=1)
    is_no_worse = (values <= np.array(tries[0].metrics) * np.array(goal.signs)).all(axis=1)
    if any(found != tries[0] for found, is_one in zip(front, is_no_worse, strict=True) if is_one):
        away = np.where(is_no_worse, away, np.inf)
    return front[int(away.argmin())]


def front_of(tries: Sequence[Try], goal: Goal) -> list[Try]:
    """The tries that meet what is required and of which no other is at least as good in all and better in one metric.

    Args:
        tries: in any order.
        goal: what is better.
    """
    good = [found for found in dict.fromkeys(tries) if found.counted == 1.0 and found.met >= goal.met]
    values = np.array([found.metrics for found in good]).reshape(len(good), -1) * np.array(goal.signs)
    is_better = [(values <= row).all(axis=1) & (values < row).any(axis=1) for row in values]
    return sorted(
        (found for found, others in zip(good, is_better, strict=True) if not others.any()), key=lambda t: t.metrics
    )
