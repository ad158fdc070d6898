"""A study as tables of plain text, in ASCII."""

import math
import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.report.comparison_table import decimals_for, shortened
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
NARROWEST = 12  # characters of the first column
MOST_CASES = 24
MOST_INPUTS = 8
MOST_METRICS = 3  # of which the influences are told

Row = tuple[str, Sequence[str]]


def study_table(study: Any, width: int) -> str:
    """What was required, how the metrics are distributed, and what influences them; of many cases one row each.

    Args:
        study: `Results`, or its dataset.
        width: [characters] of the terminal.
    """
    results = as_results(study)
    blocks = [_required_table(results, width), _numbers(results, width)]
    blocks += [_law_table(differences(results, key), width) for key in swept_laws(results)]
    blocks += [_influence_table(results, one, width) for one in all_influences(results)[:MOST_METRICS]]
    return "\n\n".join(block for block in blocks if block)


def _numbers(results: Results, width: int) -> str:
    if results.num_cases == 1:
        return _distribution_table(results, width)
    return _case_table(results, width) if results.num_cases <= MOST_CASES else _marginal_table(results, width)


def lay_out(heads: Sequence[str], rows: Sequence[Row], width: int, title: str = "") -> str:
    """Columns of text, the first to the left and the others to the right; columns that are empty are left out.

    Args:
        heads: of the columns after the first.
        rows: the first cell, and those after it.
        width: [characters] that should suffice.
        title: above the first column.
    """
    kept = [k for k in range(len(heads)) if any(row[1][k] for row in rows)]
    rooms = [max(len(heads[k]), *(len(row[1][k]) for row in rows)) for k in kept]
    gap = 2 if sum(rooms) + 2 * len(rooms) + max(len(row[0]) for row in rows) <= width else 1
    longest = max(len(row[0]) for row in rows)
    first = max(NARROWEST, min(longest, width - sum(rooms) - gap * len(rooms)))

    def line(name: str, cells: Sequence[str]) -> str:
        parts = [f"{' ' * gap}{cell:>{room}}" for cell, room in zip(cells, rooms, strict=True)]
        return f"{shortened(name, first):<{first}}{''.join(parts)}".rstrip()

    above = [title] if len(title) > first else []
    head = line("" if above else title, [heads[k] for k in kept])
    body = [line(name, [cells[k] for k in kept]) for name, cells in rows]
    return "\n".join([*above, head, "-" * max(map(len, [head, *body])), *body])


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


def _required_table(results: Results, width: int) -> str:
    if not results.requirements or results.num_cases > 1:
        return ""
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
    return lay_out(heads, rows, width, "Required")


def _distribution_table(results: Results, width: int) -> str:
    (case,) = np.ndindex(*results.shape)
    found = [distribution(results, metric, case) for metric in results.shown]
    rows: list[Row] = [(title_of(one.metric), _distribution_cells(one)) for one in found]
    heads = ["mean", "95 % interval", "5 %", "median", "95 %", "95 % interval", "missing"]
    if not rows:
        return ""
    table = lay_out(heads, rows, width)
    if max(map(len, table.splitlines())) > width:
        rows = [(name, [*cells[:2], "", *cells[3:5], "", cells[6]]) for name, cells in rows]
        table = lay_out(heads, rows, width)
    missing = any(one.missing for one in found)
    note = "missing: missions without that number, as one that never settled; they are left out"
    return f"{table}\n{textwrap.fill(note, max(width, 40))}" if missing else table


def _distribution_cells(one: Distribution) -> list[str]:
    decimals = decimals_for([one.mean])
    low, middle, high = one.quantiles[0], one.median, one.quantiles[-1]
    texts = [number(value, decimals) for value in (low.value, middle.value, high.value)]
    missing = str(one.missing) if one.missing else ""
    ends = interval(high.low, high.high, decimals)
    return [number(one.mean.mean, decimals), interval(one.mean.low, one.mean.high, decimals), *texts, ends, missing]


def _case_table(results: Results, width: int) -> str:
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
    return lay_out(["required holds", "95 % interval", *told], rows, width, ", ".join(results.swept))


def _chance_cells(one: Chance, is_required: bool) -> list[str]:
    return [percent(one.share), chance_interval(one)] if is_required and one.tries else ["", ""]


def _marginal_table(results: Results, width: int) -> str:
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
    table = lay_out(heads, told, width, "Option, whatever the other keys")
    return table


def _per_run(values: np.ndarray) -> np.ndarray:
    """The mean of (case, run) numbers over the cases; runs are what is independent."""
    count = np.sum(np.isfinite(values), axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def _law_table(found: Differences, width: int) -> str:
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
    return lay_out(heads, rows, width, f"{found.key}, against {found.labels[0]}{pooled}")


def _influence_table(results: Results, found: Influences, width: int) -> str:
    rows: list[Row] = []
    for one in found.inputs[:MOST_INPUTS]:
        rank = f"{one.rank.value:+.2f}" if math.isfinite(one.rank.value) else ""
        of_rank = f"{one.rank.low:+.2f} to {one.rank.high:+.2f}" if rank else ""
        cells = [percent(one.first.value, 2), percent(one.total.value, 2), _ends(one.total), rank, of_rank]
        rows.append((one.key, [*cells, "" if one.is_clear else "unseen"]))
    heads = ["alone", "in all", "95 % interval", "rank", "95 % interval", ""]
    table = lay_out(heads, rows, width, f"Share of {found.metric}")
    if max(map(len, table.splitlines())) > width:
        rows = [(name, [*cells[:4], "", cells[5]]) for name, cells in rows]
        table = lay_out(heads, rows, width, f"Share of {found.metric}")
    note = f"together {percent(found.explained.value, 2)} of the variance; the rest is noise by the seed, or finer"
    return f"{table}\n{textwrap.fill(note, max(width, 40))}"


def _ends(share: Share) -> str:
    return f"{100.0 * share.low:.0f} to {100.0 * share.high:.0f} %"
