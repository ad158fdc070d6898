"""What a study says, in plain words."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from cardume.report.study.blocks import chance_interval
from cardume.report.study.common import as_results, listed, percent
from cardume.report.study.influences import all_influences
from cardume.simulation.flight import METRICS
from cardume.studies.answers.differences import Differences, differences, swept_laws
from cardume.studies.answers.influences import Influences
from cardume.studies.answers.regions import WANTED, chance_maps, fewest_runs, numeric_keys, verdicts
from cardume.studies.answers.requirements import chance_of_all, chances_of_all, requirements
from cardume.studies.answers.results import Results
from cardume.studies.answers.worst import worst_runs
from cardume.studies.constants import FAILED, REFUSED
from cardume.studies.statistics import is_clear
from cardume.units import show_quantity

MOST_INPUTS = 3
MOST_OPTIONS = 6


def study_words(study: Any) -> list[str]:
    """A few sentences: what was flown, how often it is as required, what fails, what matters, and where.

    Args:
        study: `Results`, or its dataset.
    """
    results = as_results(study)
    if results.num_left == results.status.size:
        return ["Nothing was flown yet."]
    return [sentence for sentence in _sentences(results) if sentence]


def _sentences(results: Results) -> Iterator[str]:
    yield _flown(results)
    yield _failed(results)
    if results.num_cases == 1:
        yield from _required(results)
    elif results.requirements:
        yield from _cases(results)
        yield _along_one_key(results)
        yield _over_two_keys(results)
    if not results.requirements:
        yield "Nothing is required of this mission: with require, a study says how probable it is that it holds."
    for found in all_influences(results)[:2]:
        yield _influence(found)
    for key in swept_laws(results):
        yield from _laws(differences(results, key))
    yield _worst(results)


def _flown(results: Results) -> str:
    runs = int(np.sum(results.is_judged.any(axis=tuple(range(len(results.swept))))))
    of = f" of {results.status.size}" if results.num_flown < results.status.size else ""
    seeds = "the same seeds for all" if results.num_cases > 1 else f"seeds {results.seeds[0]} to {results.seeds[-1]}"
    cases = f"{results.num_cases} cases with {_runs(runs)} each" if results.num_cases > 1 else _runs(runs)
    whole = f"{results.num_flown}{of} missions were flown: {cases}, {seeds}."
    return f"{whole} What is missing is flown with --resume." if results.num_left else whole


def _failed(results: Results) -> str:
    failed, refused = (int(np.sum(results.status == status)) for status in (FAILED, REFUSED))
    told = []
    if failed:
        first = np.unravel_index(int(np.argmax(results.status == FAILED)), results.status.shape)
        why = str(results.array("failure")[first])
        when = float(np.nanmedian(results.failed_at))
        told.append(
            f"{_missions(failed)} failed in flight, in the median after {when:.4g} s, as: {why.partition(';')[0]}."
        )
    if refused:
        told.append(f"{_missions(refused)} could not be flown with what was drawn.")
    return " ".join(told)


def _runs(count: int) -> str:
    return "1 run" if count == 1 else f"{count} runs"


def _missions(count: int) -> str:
    return "1 mission" if count == 1 else f"{count} missions"


def _required(results: Results) -> Iterator[str]:
    if not results.requirements:
        return
    (case,) = np.ndindex(*results.shape)
    whole, each = chance_of_all(results, case), requirements(results, case)
    what = "All that is required holds" if len(each) > 1 else "What is required holds"
    yield f"{what} in {percent(whole.share)} of the missions (95 % interval {chance_interval(whole)})."
    worst = each[0]
    if not worst.missed:
        return
    text = f"Missed most often is {worst.name}: in {_missions(worst.missed)}"
    text += f", {worst.missed_alone} of them miss nothing else" if len(each) > 1 else ""
    if math.isfinite(worst.violated.value):
        text += f"; in the median it is first violated after {worst.violated.value:.4g} s"
    yield f"{text}."


def _cases(results: Results) -> Iterator[str]:
    share, low, high = chances_of_all(results)
    sure, not_sure = int(np.sum(low >= WANTED)), int(np.sum(high < WANTED))
    runs = int(np.max(np.sum(results.is_judged, axis=-1)))
    if runs == 1:
        yield f"All that is required holds in {int(np.nansum(share))} of {results.num_cases} cases, of one run each."
        return
    left = results.num_cases - sure - not_sure
    rest = f"; of {left} it cannot be said with {runs} runs" if left else ""
    yield (
        f"All that is required holds in 95 % of the missions surely in {sure} of {results.num_cases} cases, surely not"
        f" in {not_sure}{rest}."
    )
    if runs < fewest_runs():
        yield f"No case can be sure of it with fewer than {fewest_runs()} runs: fly more."
    if np.isfinite(share).any() and np.nanmax(share) > np.nanmin(share):
        best = tuple(int(k) for k in np.unravel_index(int(np.nanargmax(share)), share.shape))
        worst = tuple(int(k) for k in np.unravel_index(int(np.nanargmin(share)), share.shape))
        yield (
            f"It holds most often, in {percent(float(share[best]))}, with {results.case_label(best)}; least often, in"
            f" {percent(float(share[worst]))}, with {results.case_label(worst)}."
        )


def _along_one_key(results: Results) -> str:
    """Where along the only swept key the requirement holds."""
    keys = numeric_keys(results)
    if len(keys) != 1 or len(results.swept) != 1:
        return ""
    key = keys[0]
    _, low, high = chances_of_all(results)
    numbers = np.asarray(results.numbers(key))
    sure, lost = np.sort(numbers[low >= WANTED]), np.sort(numbers[high < WANTED])
    unit = results.unit(key)
    if not len(sure) or not len(lost):
        return ""
    told = [show_quantity(float(end), unit) for end in (sure[-1], lost[0], sure[0], lost[-1])]
    if sure[-1] < lost[0]:
        return f"It surely does up to {key} {told[0]}, surely not from {told[1]} on."
    return f"It surely does from {key} {told[2]} on, surely not up to {told[3]}." if sure[0] > lost[-1] else ""


def _over_two_keys(results: Results) -> str:
    """For each option of the second key how far the first may go."""
    keys = numeric_keys(results)
    if len(keys) < 2 or len(results.swept) != 2:
        return ""
    (chances,) = chance_maps(results, (keys[0], keys[1]))
    sure = verdicts(chances) > 0
    if not sure.any():
        return ""
    told = []
    for row, y in list(enumerate(chances.y))[:MOST_OPTIONS]:
        holds = chances.x[sure[row]]
        if len(holds):
            ends = [show_quantity(value, results.unit(keys[0])) for value in (holds[0], holds[-1])]
            reach = f"from {ends[0]} to {ends[1]}" if len(holds) > 1 else f"at {ends[0]}"
        else:
            reach = "nowhere"
        told.append(f"{reach} with {show_quantity(y, results.unit(keys[1]))}")
    return f"Along {keys[0]} it surely does {listed(told, MOST_OPTIONS)} of {keys[1]}."


def _influence(found: Influences) -> str:
    seen = [one for one in found.inputs if one.is_clear]
    if not seen:
        return f"No input has an influence on {found.metric} that {found.num_missions} missions show."
    told = []
    for one in seen[:MOST_INPUTS]:
        share = f"{percent(one.total.value, 2)} ({100.0 * one.total.low:.0f} to {100.0 * one.total.high:.0f} %)"
        way = ""
        if one.rank.low > 0.0 or one.rank.high < 0.0:
            way = f", more of it {'raises' if one.rank.value > 0.0 else 'lowers'} it"
        told.append(f"{one.key} makes {share} of its variance{way}")
    rest = 1.0 - found.explained.value
    chance = f" {percent(rest, 2)} is noise by the seed, or finer than what is fitted." if rest > 0.005 else ""
    return f"On {found.metric}: {'; '.join(told)}.{chance}"


def _laws(found: Differences) -> Iterator[str]:
    for place, label in list(enumerate(found.labels))[1:MOST_OPTIONS]:
        told: dict[str, list[str]] = {"better": [], "worse": [], "perhaps": []}
        for metric in found.metrics:
            more, base = found.differences[metric][place - 1], found.means[metric][0].mean
            change = f"{metric} ({100.0 * more.mean / abs(base):+.2g} %)" if base else metric
            if found.is_real[metric][place - 1]:
                grows_worse = METRICS[metric].wanted == "at most"
                told["worse" if (more.mean > 0.0) == grows_worse else "better"].append(change)
            elif is_clear(more):
                told["perhaps"].append(change)
        parts = [f"really {word} in {listed(told[word])}" for word in ("better", "worse") if told[word]]
        parts += [f"perhaps different in {listed(told['perhaps'])}"] if told["perhaps"] else []
        if parts:
            yield f"{label} against {found.labels[0]}: {', '.join(parts)}."
        else:
            yield f"{label} and {found.labels[0]} differ in nothing that {found.num_seeds} seeds could show."


def _worst(results: Results) -> str:
    found = worst_runs(results, 1)
    if not found or not (found[0].missed or found[0].failure):
        return ""
    one = found[0]
    where = f" with {one.label}" if one.label else ""
    if one.failure:
        return f"The worst run is seed {one.seed}{where}: it failed in flight."
    by = f", by {100.0 * one.excess:.0f} %" if math.isfinite(one.excess) else ", without a value" * (one.excess > 0.0)
    return f"The worst run is seed {one.seed}{where}: it missed {one.missed[0]}{by}."
