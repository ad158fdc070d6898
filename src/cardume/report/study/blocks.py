"""The tables of a study, as cells; `table.py` sets them in plain text, the page in HTML."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.report.comparison_table import decimals_for
from cardume.report.study.common import as_results, percent, title_of
from cardume.report.study.influences import all_influences
from cardume.studies.answers.differences import Differences, differences, swept_laws
from cardume.studies.answers.distributions import Distribution, distribution, mean_of
from cardume.studies.answers.influences import Influences, Share
from cardume.studies.answers.requirements import Chance, chance, chance_of_all, requirements
from cardume.studies.answers.results import Results
from cardume.studies.statistics import Estimate, is_clear

NOTHING = "-"
INDENT = "  "
MOST_CASES = 24
MOST_INPUTS = 8
MOST_METRICS = 3  # of which the influences are told

Row = tuple[str, Sequence[str]]


class Block(NamedTuple):
    """One table.

    Attributes:
        title: of the first column.
        heads: of the others.
        rows: the first cell, and the others.
        note: below it.
        spare: places of columns that are left out where room is scarce, the first first.
    """

    title: str
    heads: Sequence[str]
    rows: Sequence[Row]
    note: str = ""
    spare: tuple[int, ...] = ()


def study_blocks(study: Any) -> list[Block]:
    """What was required, how the metrics are distributed, and what influences them; of many cases one row each.

    Args:
        study: `Results`, or its dataset.
    """
    results = as_results(study)
    blocks = [*_required(results), *_numbers(results)]
    blocks += [_laws(differences(results, key)) for key in swept_laws(results)]
    return [*blocks, *(_influence(one) for one in all_influences(results)[:MOST_METRICS])]


def _numbers(results: Results) -> list[Block]:
    if not results.shown:
        return []
    if results.num_cases == 1:
        return [_distributions(results)]
    return [_cases(results) if results.num_cases <= MOST_CASES else _options(results)]


def number(value: float, decimals: int, sign: str = "") -> str:
    """A number with so many decimals, or a dash.

    Args:
        value: [any]
        decimals: how many.
        sign: "+" for one with its sign.
    """
    if not math.isfinite(value):
        return NOTHING
    text = f"{value:{sign}.{decimals}f}"
    return text.lstrip("+-") if float(text) == 0.0 else text


def interval(low: float, high: float, decimals: int) -> str:
    """Both ends of an interval; nothing where it has none.

    Args:
        low: [any]
        high: [any]
        decimals: how many.
    """
    if not math.isfinite(low) and not math.isfinite(high):
        return ""
    if low == high:
        return "exact"
    if not math.isfinite(high):
        return f"from {number(low, decimals)}"
    begin = f"{number(low, decimals)} " if math.isfinite(low) else ""
    return f"{begin}to {number(high, decimals)}"


def chance_interval(one: Chance) -> str:
    """Both ends of a probability's interval.

    Args:
        one: the probability.
    """
    return f"{percent(one.low).removesuffix(' %')} to {percent(one.high)}"


def _required(results: Results) -> list[Block]:
    if not results.requirements or results.num_cases > 1:
        return []
    (case,) = np.ndindex(*results.shape)
    found = requirements(results, case)
    rows: list[Row] = []
    if len(found) > 1:
        whole = chance_of_all(results, case)
        rows = [("all of it", [percent(whole.share), chance_interval(whole), "", "", ""])]
    for one in found:
        when = f"{one.violated.value:.4g} s" if math.isfinite(one.violated.value) else ""
        alone = str(one.missed_alone) if one.missed and len(found) > 1 else ""
        cells = [percent(one.chance.share), chance_interval(one.chance), str(one.missed or ""), alone, when]
        rows.append((one.name, cells))
    heads = ["holds in", "95 % interval", "missed", "it alone", "first after"]
    return [Block("Required", heads, rows)]


def _distributions(results: Results) -> Block:
    (case,) = np.ndindex(*results.shape)
    found = [distribution(results, metric, case) for metric in results.shown]
    rows: list[Row] = [(title_of(one.metric), _distribution_cells(one)) for one in found]
    heads = ["mean", "95 % interval", "5 %", "median", "95 %", "95 % interval", "missing"]
    missing = any(one.missing for one in found)
    note = "missing: missions without that number, as one that never settled; they are left out" if missing else ""
    return Block("", heads, rows, note, (5, 2))


def _distribution_cells(one: Distribution) -> list[str]:
    decimals = decimals_for([one.mean])
    low, middle, high = one.quantiles[0], one.median, one.quantiles[-1]
    texts = [number(value, decimals) for value in (low.value, middle.value, high.value)]
    missing = str(one.missing) if one.missing else ""
    ends = interval(high.low, high.high, decimals)
    return [number(one.mean.mean, decimals), interval(one.mean.low, one.mean.high, decimals), *texts, ends, missing]


def _cases(results: Results) -> Block:
    """A row for each case: the probability that all holds, and the mean of the first metric."""
    metrics = results.shown[:1]
    cases = list(np.ndindex(*results.shape))
    means = [[mean_of(results.values(metric)[case]) for metric in metrics] for case in cases]
    decimals = [decimals_for([row[k] for row in means]) for k in range(len(metrics))]
    rows: list[Row] = []
    for case, estimates in zip(cases, means, strict=True):
        cells = _chance_cells(chance_of_all(results, case), bool(results.requirements))
        for estimate, digits in zip(estimates, decimals, strict=True):
            cells += [number(estimate.mean, digits), interval(estimate.low, estimate.high, digits)]
        options = [results.labels(key)[place] for key, place in zip(results.swept, case, strict=True)]
        rows.append((", ".join(options), cells))
    told = [text for metric in metrics for text in (title_of(metric), "95 % interval")]
    return Block(", ".join(results.swept), ["required holds", "95 % interval", *told], rows, "", (1,))


def _chance_cells(one: Chance, is_required: bool) -> list[str]:
    return [percent(one.share), chance_interval(one)] if is_required and one.tries else ["", ""]


def _options(results: Results) -> Block:
    """A row for each option of each key, whatever the others are."""
    metric, rows = results.shown[0], []
    values = results.values(metric)
    estimates: list[Estimate] = []
    for axis, key in enumerate(results.swept):
        for place, label in enumerate(results.labels(key)):
            known = np.take(values, place, axis=axis).reshape(-1, values.shape[-1])
            estimates.append(mean_of(_per_run(known)))
            met, judged = (np.take(array, place, axis=axis) for array in (results.all_met, results.is_judged))
            cells = _chance_cells(chance(met[judged]), bool(results.requirements))[:1]
            rows.append((f"{key} {label}", cells))
    decimals = decimals_for(estimates)
    told: list[Row] = [
        (name, [*cells, number(one.mean, decimals), interval(one.low, one.high, decimals)])
        for (name, cells), one in zip(rows, estimates, strict=True)
    ]
    heads = ["required holds", title_of(metric), "95 % interval"]
    return Block("Option, whatever the other keys", heads, told)


def _per_run(values: np.ndarray) -> np.ndarray:
    """The mean of (case, run) numbers over the cases; runs are what is independent."""
    count = np.sum(np.isfinite(values), axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def _laws(found: Differences) -> Block:
    rows: list[Row] = []
    for metric in found.metrics:
        decimals = decimals_for(found.means[metric])
        rows.append((title_of(metric), [""] * 5))
        for place, label in enumerate(found.labels):
            mean = found.means[metric][place]
            cells = [number(mean.mean, decimals), interval(mean.low, mean.high, decimals), "", "", ""]
            if place:
                more = found.differences[metric][place - 1]
                fine = min(max(decimals, decimals_for([more])), decimals + 1)
                word = "real" if found.is_real[metric][place - 1] else "maybe" if is_clear(more) else ""
                cells[2:] = [number(more.mean, fine, "+"), interval(more.low, more.high, fine), word]
            rows.append((f"{INDENT}{label}", cells))
    heads = ["mean", "95 % interval", "difference", "95 % interval", ""]
    pooled = ", means over the other keys" if found.is_pooled else ""
    told = [one for metric in found.metrics for one in found.differences[metric]]
    note = (
        "real: zero lies outside of the interval even at odds that all differences here share; maybe: of its own only"
    )
    return Block(
        f"{found.key}, against {found.labels[0]}{pooled}",
        heads,
        rows,
        note if any(is_clear(one) and one.low < one.high for one in told) else "",
    )


def _influence(found: Influences) -> Block:
    rows: list[Row] = []
    for one in found.inputs[:MOST_INPUTS]:
        rank = f"{one.rank.value:+.2f}" if math.isfinite(one.rank.value) else ""
        of_rank = f"{one.rank.low:+.2f} to {one.rank.high:+.2f}" if rank else ""
        cells = [percent(one.first.value, 2), percent(one.total.value, 2), _ends(one.total), rank, of_rank]
        rows.append((one.key, [*cells, "" if one.is_clear else "unseen"]))
    heads = ["alone", "in all", "95 % interval", "rank", "95 % interval", ""]
    note = f"together {percent(found.explained.value, 2)} of the variance; the rest is noise by the seed, or finer"
    return Block(f"Share of {found.metric}", heads, rows, note, (4,))


def _ends(share: Share) -> str:
    return f"{100.0 * share.low:.0f} to {100.0 * share.high:.0f} %"
