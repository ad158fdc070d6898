"""The runs that went worst: which they are, and the same missions again."""

import math
from dataclasses import dataclass

import numpy as np

from cardume.studies.answers.results import Results
from cardume.studies.constants import FAILED, FLOWN

NUMBER = 5


@dataclass(frozen=True)
class WorstRun:
    """A run that went badly.

    Attributes:
        case: the place of the option of each swept key.
        run: its place among the runs.
        seed: that it flew with.
        label: of the case, in words.
        missed: what it missed, readable, the worst first.
        excess: [-] by which share of the limit it missed at most; of one that met everything how near it came, < 0;
            infinite where it has no value, and minus that where only limits were missed that each run has of its own.
        failure: why it failed in flight, or "".
    """

    case: tuple[int, ...]
    run: int
    seed: int
    label: str
    missed: tuple[str, ...]
    excess: float
    failure: str = ""


def worst_runs(results: Results, number: int = NUMBER) -> tuple[WorstRun, ...]:
    """The worst runs: failed in flight, then those that miss most requirements, then by how far.

    Where nothing is required, those whose first shown metric is worst.

    Args:
        results: of the study.
        number: how many at most.
    """
    status, excess = results.status, _excess(results)
    missed = np.sum(~results.met, axis=-1) if results.requirements else np.zeros(status.shape, int)
    furthest = np.max(excess, axis=-1, initial=-math.inf)
    order = np.lexsort((np.arange(status.size), -furthest.ravel(), -missed.ravel(), status.ravel() != FAILED))
    order = order[np.isin(status.ravel()[order], (FLOWN, FAILED))][:number]
    found = []
    for place in order:
        *case, run = (int(k) for k in np.unravel_index(place, status.shape))
        at = (*case, run)
        names = [k for k in np.argsort(-excess[at]) if results.requirements and not results.met[at][k]]
        found.append(
            WorstRun(
                tuple(case),
                run,
                int(results.seeds[run]),
                results.case_label(tuple(case)),
                tuple(results.requirements[k] for k in names),
                float(furthest[at]),
                failure_at(results, at),
            )
        )
    return tuple(found)


def _excess(results: Results) -> np.ndarray:
    """(swept ..., run, requirement) [-] by which share of its limit a metric is worse; infinite where it has no value.

    Without requirements the first shown metric itself, worse being more.
    """
    if not results.requirements:
        if not results.shown:
            return np.zeros((*results.status.shape, 1))
        values = results.values(results.shown[0])[..., None]
        return np.where(np.isfinite(values), values, math.inf)
    got = results.array("got", "requirement").astype(float)
    bounds, signs = (np.array([getattr(limit, name) for limit in results.limits]) for name in ("bound", "sign"))
    scale = np.where(np.abs(bounds) > 0.0, np.abs(bounds), 1.0)
    over = np.where(np.isfinite(bounds), signs * (got - bounds) / scale, -math.inf)
    return np.where(np.isfinite(got), over, math.inf)


def failure_at(results: Results, at: tuple[int, ...]) -> str:
    """Why a run failed in flight; empty where it did not.

    Args:
        results: of the study.
        at: place of its case and run.
    """
    return str(results.array("failure")[at])
