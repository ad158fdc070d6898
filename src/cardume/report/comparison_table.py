"""A comparison as a table of plain text: for each metric the arms, one under the other."""

import math
import textwrap
from collections.abc import Sequence

import numpy as np

from cardume.simulation.flight import METRICS
from cardume.studies.comparing import Comparison
from cardume.studies.statistics import Estimate, is_clear, share_interval

NOTHING = "-"
ROOMY = 100  # characters from which there is room for the change in percent
NARROWEST_NAME, WIDEST_NAME = 12, 44
MOST_DECIMALS = 6
INDENT = "  "


def comparison_table(comparison: Comparison, width: int) -> str:
    """Means, differences to the first arm, and their 95 % intervals, in ASCII.

    Args:
        comparison: what was flown.
        width: [characters] of the terminal.
    """
    table = _table(comparison, width, gap=2)
    if max(map(len, table)) > width or any(f"{INDENT}{label} " not in "\n".join(table) for label in comparison.labels):
        table = _table(comparison, width, gap=1)
    return "\n".join([*table, *_notes(comparison, width)])


def _table(comparison: Comparison, width: int, gap: int) -> list[str]:
    """The lines of the table, with so many spaces between columns."""
    blocks = [(_title(metric), _rows(comparison, metric, width)) for metric in comparison.metrics]
    if required := _required_rows(comparison, width):
        blocks.append(("required, met in", required))
    columns = len(_headings(comparison, width))
    widths = [
        max([len(_headings(comparison, width)[k]), *(len(row[k]) for _, rows in blocks for row in rows)])
        for k in range(columns)
    ]
    widths = [room if any(row[k] for _, rows in blocks for row in rows) else 0 for k, room in enumerate(widths)]
    taken = sum(room + gap for room in widths if room)
    longest = min(max(map(len, comparison.labels)), WIDEST_NAME, width - taken - len(INDENT))
    first = max(NARROWEST_NAME, longest)

    def line(label: str, cells: Sequence[str]) -> str:
        parts = [f"{' ' * gap}{cell:>{room}}" for cell, room in zip(cells, widths, strict=True) if room]
        return f"{label:<{first + len(INDENT)}}{''.join(parts)}".rstrip()

    lines = [_top_line(comparison, widths, first, gap), line("", _headings(comparison, width))]
    lines.append("-" * max(map(len, lines)))
    for title, rows in blocks:
        lines.append(title)
        lines += [
            line(f"{INDENT}{shortened(label, first)}", row) for label, row in zip(comparison.labels, rows, strict=True)
        ]
    return lines


def shortened(label: str, longest: int) -> str:
    """A label that fits, cut in its middle: arms often differ at their ends.

    Args:
        label: of an arm.
        longest: [characters]
    """
    if len(label) <= longest:
        return label
    end = (longest - 2) // 2
    return f"{label[: longest - 2 - end]}..{label[len(label) - end :]}"


def decimals_for(estimates: Sequence[Estimate]) -> int:
    """How many decimals show two digits of the narrowest interval, or four of the means where there is none.

    Args:
        estimates: [any] of one metric.
    """
    halves = [0.5 * (e.high - e.low) for e in estimates if e.high > e.low]
    sizes = [abs(e.mean) for e in estimates if math.isfinite(e.mean) and e.mean != 0.0]
    if not sizes:
        return 3
    most = 4 - math.floor(math.log10(max(sizes)))
    wanted = 1 - math.floor(math.log10(min(halves))) if halves else most - 1
    return min(max(0, min(wanted, most)), MOST_DECIMALS)


def _headings(comparison: Comparison, width: int) -> list[str]:
    many = f"of {len(comparison.seeds)}"
    percent = ["change"] if width >= ROOMY else []
    return ["mean", "95 % interval", many, "mean", *percent, "95 % interval", ""]


def _top_line(comparison: Comparison, widths: Sequence[int], first: int, gap: int) -> str:
    """What the right-hand columns are, above them."""
    end = len(INDENT) + first + sum(room + gap for room in widths[:-1] if room)
    said = "difference to "
    return f"{said + shortened(comparison.labels[0], min(end - len(said), WIDEST_NAME)):>{end}}"


def _title(metric: str) -> str:
    unit = METRICS[metric.rpartition(".")[2]].unit
    return f"{metric} [{unit}]" if unit else metric


def _rows(comparison: Comparison, metric: str, width: int) -> list[list[str]]:
    means, differences = comparison.estimates[metric], comparison.differences[metric]
    decimals = decimals_for(means)
    rows = []
    for k, mean in enumerate(means):
        is_short = mean.size < len(comparison.seeds)
        cells = [_number(mean.mean, decimals), _interval(mean, decimals), str(mean.size) if is_short else ""]
        percent = [""] if width >= ROOMY else []
        if k == 0:
            rows.append([*cells, "", *percent, "", ""])
            continue
        difference = differences[k - 1]
        fine = min(max(decimals, decimals_for([difference])), decimals + 1)
        if percent:
            percent = [_percent(difference.mean, means[0].mean)]
        is_real = comparison.is_real[metric][k - 1]
        shown = [_number(difference.mean, fine, sign="+"), *percent, _interval(difference, fine)]
        rows.append([*cells, *shown, "real" if is_real else "maybe" if is_clear(difference) else ""])
    return rows


def _required_rows(comparison: Comparison, width: int) -> list[list[str]]:
    told = [comparison.met(k) for k in range(len(comparison.arms))]
    if all(met is None for met in told):
        return []
    empty = [""] * (len(_headings(comparison, width)) - 2)
    return [
        [NOTHING, "", *empty]
        if met is None
        else [f"{100.0 * met[0] / met[1]:.0f} %", _share(*share_interval(*met)), *empty]
        for met in told
    ]


def _share(low: float, high: float) -> str:
    return f"{100.0 * low:.0f} to {100.0 * high:.0f} %"


def _number(value: float, decimals: int, sign: str = "") -> str:
    if not math.isfinite(value):
        return NOTHING
    if value == 0.0:
        return "0"
    text = f"{value:{sign}.{decimals}f}"
    return text.lstrip("+-") if float(text) == 0.0 else text


def _interval(estimate: Estimate, decimals: int) -> str:
    if not math.isfinite(estimate.low):
        return ""
    if estimate.low == estimate.high:
        return "exact" if estimate.mean else "equal"
    return f"{_number(estimate.low, decimals)} to {_number(estimate.high, decimals)}"


def _percent(difference: float, baseline: float) -> str:
    if not (math.isfinite(difference) and math.isfinite(baseline)) or baseline == 0.0:
        return ""
    percent = 100.0 * difference / abs(baseline)
    return f"{percent:+.1f} %" if abs(percent) < 99.95 else f"{percent:+.0f} %"


def _notes(comparison: Comparison, width: int) -> list[str]:
    notes = []
    differences = [d for metric in comparison.metrics for d in comparison.differences[metric]]
    if len(differences) > 1 and any(is_clear(d) and d.low < d.high for d in differences):
        notes.append(
            f"real: zero lies outside the interval even at {100.0 * comparison.shared_confidence:.3g} %, so that in"
            f" 95 % of such comparisons none of {len(differences)} differences is called real by chance; maybe: only"
            " outside the one shown"
        )
    counts = [e.size for metric in comparison.metrics for e in comparison.estimates[metric]]
    if min(counts, default=0) < len(comparison.seeds):
        notes.append(
            f"of {len(comparison.seeds)}: runs that have the number, where some have none, as one that never settled;"
            " the others are left out"
        )
    if any(np.isfinite([e.mean for e in comparison.estimates[m]]).any() for m in comparison.metrics if "." not in m):
        fleets = max(len(arm.mission.vehicles) for arm in comparison.arms) > 1
        notes += ["of a fleet: its worst vehicle"] if fleets else []
    return [textwrap.fill(note, max(width, 40)) for note in notes]
