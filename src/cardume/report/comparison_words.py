"""What a comparison says, in plain words."""

from collections.abc import Iterator

import numpy as np

from cardume.simulation.flight import METRICS
from cardume.studies.comparing import Comparison
from cardume.studies.statistics import is_clear

MOST_TOLD = 6  # arms of which a sentence is made; the table has all


def conclusions(comparison: Comparison) -> list[str]:
    """A few sentences: which differences are real, which are not seen, and what failed.

    Args:
        comparison: what was flown.
    """
    return [sentence for sentence in _sentences(comparison) if sentence]


def _sentences(comparison: Comparison) -> Iterator[str]:
    count = len(comparison.seeds)
    if comparison.is_interrupted:
        yield f"Interrupted: all arms were flown with {count} of {comparison.asked} seeds."
    if count == 0:
        return
    yield from _of_chance(comparison)
    if count > 1:
        for arm in range(1, len(comparison.arms))[:MOST_TOLD]:
            yield _against_first(comparison, arm)
        if len(comparison.arms) - 1 > MOST_TOLD:
            yield f"Of {len(comparison.arms) - 1 - MOST_TOLD} more arms the table tells."
    for arm, label in enumerate(comparison.labels):
        flew = [not why for why in comparison.runs[arm].failure]
        lost = int((np.isnan(comparison.values("settling_time")[arm]) & flew).sum())
        if lost:
            which = f"{lost} of {count} missions" if count > 1 else "its mission"
            yield f"{label} did not settle on its path in {which}: most numbers are missing there."
        if failed := comparison.failures(arm):
            seed, why = failed[0]
            yield f"{label} failed in {len(failed)} of {count} missions; with seed {seed} {why}."


def _of_chance(comparison: Comparison) -> Iterator[str]:
    """What the spread over the seeds says of the comparison itself."""
    count = len(comparison.seeds)
    table = np.array([comparison.values(metric) for metric in comparison.metrics])  # (metric, arm, seed)
    if _is_same(table, table[:, :1]):
        keys = " or ".join(comparison.varied) or "what differs"
        yield f"All arms flew alike: {keys} has no influence on any of these numbers."
    elif count == 1:
        yield "One seed says what happened, not what will: for intervals add --runs 20."
    elif _is_same(table, table[:, :, :1]):
        yield "Every seed gave the same: nothing in these missions is random, and one seed is enough."


def _is_same(values: np.ndarray, others: np.ndarray) -> bool:
    return bool(np.all((values == others) | (np.isnan(values) & np.isnan(others))))


def _against_first(comparison: Comparison, arm: int) -> str:
    """One arm against the first: what is better, what is worse, what may be, what is not seen."""
    told: dict[str, list[str]] = {"better": [], "worse": [], "perhaps": [], "unseen": []}
    for metric in comparison.metrics:
        difference = comparison.differences[metric][arm - 1]
        change = f"{metric} ({_change(difference.mean, comparison.estimates[metric][0].mean)})"
        if comparison.is_real[metric][arm - 1]:
            grows_worse = METRICS[metric.rpartition(".")[2]].wanted == "at most"
            told["worse" if (difference.mean > 0.0) == grows_worse else "better"].append(change)
        elif is_clear(difference):
            told["perhaps"].append(change)
        elif difference.size:
            told["unseen"].append(metric)
    label, first, count = comparison.labels[arm], comparison.labels[0], len(comparison.seeds)
    parts = [f"{word} in {listed(told[word])}" for word in ("better", "worse") if told[word]]
    sentences = [f"really {', and '.join(parts)}"] if parts else []
    if told["perhaps"]:
        sentences.append(f"perhaps different in {listed(told['perhaps'])}, which more seeds would tell")
    if not sentences:
        return f"{label} and {first} differ in nothing that {count} seeds could show." if told["unseen"] else ""
    rest = f" {count} seeds show no difference in {listed(told['unseen'])}." if told["unseen"] else ""
    return f"{label} against {first}: {'; '.join(sentences)}.{rest}"


def _change(difference: float, baseline: float) -> str:
    if not baseline:
        return f"{difference:+.3g}"
    percent = 100.0 * difference / abs(baseline)
    return f"{percent:+.2g} %" if abs(percent) < 10.0 else f"{percent:+.0f} %"


def listed(words: list[str]) -> str:
    """Words with commas and an and."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
