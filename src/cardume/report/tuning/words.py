"""What a tuning found, as a table and sentences."""

from collections.abc import Iterator

import numpy as np

from cardume.simulation.flight import METRICS
from cardume.studies.comparing import values_of
from cardume.studies.tuning.trying import summarized
from cardume.studies.tuning.tune import Tuning
from cardume.units import SHOWN_IN, UNITS, show_quantity

NEAR_END = 0.01  # of a range


def tuning_table(tuning: Tuning) -> str:
    """Start, best and range of each knob; then the metrics on fresh seeds, where there are any.

    Args:
        tuning: what was found.
    """
    rows: list[tuple[str, ...]] = [("", "start", "best", "tried from", "to")]
    for knob, first, last in zip(tuning.knobs, tuning.start.values, tuning.best.values, strict=True):
        rows.append((_title(knob.key, knob.unit), *(_number(v, knob.unit) for v in (first, last, knob.low, knob.high))))
    lines = _aligned(rows)
    if (evidence := tuning.evidence) is None:
        return "\n".join(lines)
    count = len(evidence.start)
    seeds = f"{count} fresh seeds" if count > 1 else "one run, as nothing is random"
    rows = [(f"On {seeds}", "start", "best", "difference", "95 % interval")]
    for metric, difference, change in zip(tuning.metrics, evidence.differences, evidence.changes, strict=True):
        unit = METRICS[metric.rpartition(".")[2]].unit
        columns = [values_of(table, metric, tuning.mission) for table in (evidence.start, evidence.best)]
        told = [_number(summarized(column[np.isfinite(column)], tuning.quantile), unit) for column in columns]
        interval = f"{_number(difference.low, unit)} to {_number(difference.high, unit)}" if count > 1 else ""
        real = "real" if change and count > 1 else ""
        rows.append((_title(metric, unit), *told, f"{_number(difference.mean, unit)}", f"{interval} {real}".strip()))
    if evidence.start.requirements:
        met = [f"{int(table.all_met.sum())} of {count}" for table in (evidence.start, evidence.best)]
        rows.append(("all required is met", *met, "", ""))
    return "\n".join([*lines, "", *_aligned(rows)])


def tuning_words(tuning: Tuning) -> list[str]:
    """What it means, in sentences.

    Args:
        tuning: what was found.
    """
    return list(_sentences(tuning))


def _sentences(tuning: Tuning) -> Iterator[str]:
    what = " and ".join(tuning.metrics)
    of = "mean" if tuning.quantile is None else f"{100.0 * tuning.quantile:g} % quantile"
    tries = (
        f"{len(tuning.tries)} tries of {tuning.runs} runs each" if tuning.is_random else f"{len(tuning.tries)} tries"
    )
    gained, lost = _which(tuning, 1), _which(tuning, -1)
    if tuning.evidence is None:
        yield f"Interrupted after {tries}: the best of them is kept, but not proved on fresh seeds."
    elif tuning.is_better:
        values = ", ".join(
            f"{k.key} {show_quantity(v, k.unit)}" for k, v in zip(tuning.knobs, tuning.best.values, strict=True)
        )
        better = f"{gained}, by the {of}," if gained else "how often runs are as required, or have numbers at all,"
        yield f"Better in {better} after {tries}: {values}. Seeds that the search never saw agree."
    elif gained and lost:
        yield (
            f"After {tries} the best compromise gains in {gained} and loses in {lost}, as fresh seeds confirm."
            " The mission that is kept has its own values; the compromises are in summary.json."
        )
    else:
        yield (
            f"After {tries} nothing is really better in {what} than what the mission has: on fresh seeds what was best"
            " does no better than chance. The mission that is kept has its own values."
        )
    if tuning.best.counted < 1.0:
        yield f"In {100.0 * (1.0 - tuning.best.counted):.0f} % of the runs of the best try {what} has no number."
    elif tuning.best.met < tuning.goal.met:
        yield (
            f"No try meets all that is required in {100.0 * tuning.goal.met:g} % of its runs; the best does in"
            f" {100.0 * tuning.best.met:.0f} %. More keys to vary, wider ranges or other laws might."
        )
    for knob, value in zip(tuning.knobs, tuning.best.values, strict=True):
        share = knob.share(value)
        if share < NEAR_END or share > 1.0 - NEAR_END:
            end = show_quantity(value, knob.unit)
            yield f"{knob.key} ends at the edge of what was tried, {end}: if the mission allows it, try a wider range."
    if len(tuning.metrics) > 1 and tuning.front:
        yield (
            f"{len(tuning.front)} tries are such that none is better in all of {what}; the one recommended lies nearest"
            " to the best of each. All of them are in summary.json."
        )


def _which(tuning: Tuning, change: int) -> str:
    """The metrics that are really better, 1, or worse, -1."""
    changes = tuning.evidence.changes if tuning.evidence else ()
    return " and ".join(metric for metric, one in zip(tuning.metrics, changes, strict=False) if one == change)


def _title(name: str, unit: str) -> str:
    return f"{name} [{SHOWN_IN.get(unit, unit)}]" if unit else name


def _number(value: float, unit: str) -> str:
    shown = SHOWN_IN.get(unit, unit)
    return f"{value / UNITS[shown].factor if shown != unit else value:.4g}"


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = [
        "  ".join(
            [row[0].ljust(widths[0]), *(text.rjust(width) for text, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]
    return [lines[0].rstrip(), "-" * max(map(len, lines)), *(line.rstrip() for line in lines[1:])]
