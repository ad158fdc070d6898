"""What tables and figures of a study share."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.report import style
from cardume.simulation.flight import METRICS
from cardume.studies.answers.results import Results, shown_in

GRID = "#EEEEEE"
ERROR = {"capsize": 2.0, "lw": 1.2, "capthick": 1.2}


def as_results(study: Any) -> Results:
    """A study however it is given.

    Args:
        study: `Results`, or the dataset that `open_study` gives.
    """
    return study if isinstance(study, Results) else Results(study)


def title_of(metric: str) -> str:
    """A metric with its unit.

    Args:
        metric: its name.
    """
    known = METRICS.get(metric.rpartition(".")[2])
    return f"{metric} [{known.unit}]" if known and known.unit else metric


def axis_of(results: Results, key: str) -> tuple[float, str]:
    """A factor for the numbers of a key, and its name with the unit in which people read it.

    Args:
        results: of the study.
        key: swept or drawn.
    """
    factor, unit = shown_in(results.unit(key))
    return factor, f"{key} [{unit}]" if unit else key


def dress(axes: Any, title: str = "", x: str = "", y: str = "") -> None:
    """Title, names of the axes and a faint grid.

    Args:
        axes: of a figure.
        title: above it, to the left.
        x: name of the axis.
        y: name of the axis.
    """
    axes.set_title(title, fontsize=8.0, loc="left", pad=4.0)
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(color=GRID, lw=0.6)
    axes.set_axisbelow(True)


def grid_of(count: int, width: float, height: float, most_columns: int = 2, **how: Any) -> tuple[Any, list[Any]]:
    """A figure with so many panels, and these.

    Args:
        count: of panels.
        width: [inch] of the figure.
        height: [inch] of a row.
        most_columns: beside one another, where the width allows it.
        how: as `subplots` takes it.
    """
    columns = max(1, min(most_columns, count, int(width / 2.6)))
    rows = math.ceil(count / columns)
    figure = style.new_figure(width, height * rows + 0.15)
    figure.set_layout_engine("constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **how).ravel().tolist()
    for unused in axes[count:]:
        unused.set_visible(False)
    return figure, axes[:count]


class Histogram(NamedTuple):
    """How many values lie where.

    Attributes:
        counts: (n,) values in each bin.
        edges: (n + 1,) of the bins.
        outside: values that lie far from all others and are in no bin.
    """

    counts: np.ndarray
    edges: np.ndarray
    outside: int


def histogram(values: np.ndarray, *, is_trimmed: bool = True) -> Histogram:
    """About as many bins as the root of the number of values, from 8 to 40.

    A few stragglers would leave the bulk a single bar, so they are counted apart.

    Args:
        values: (n,) [any] finite, at least one.
        is_trimmed: whether what lies far outside is left out.
    """
    inside = values
    if is_trimmed:
        low, high = np.quantile(values, (0.005, 0.995))
        room = 0.15 * max(high - low, 1e-12 * max(1.0, abs(high)))
        inside = values[(values >= low - room) & (values <= high + room)]
    counts, edges = np.histogram(inside, bins=min(40, max(8, int(np.sqrt(inside.size)))))
    return Histogram(counts, edges, values.size - inside.size)


def runs_axis(outside: int) -> str:
    """What the axis of a histogram counts.

    Args:
        outside: values that are in no bin.
    """
    return f"runs, {outside} further out" if outside else "runs"


def percent(share: float, digits: int = 3) -> str:
    """A share as a percentage, never rounded to all or nothing.

    Args:
        share: [-] from 0 to 1.
        digits: significant ones.
    """
    if not math.isfinite(share):
        return "-"
    if share < 1e-9 or share > 1.0 - 1e-9:
        return f"{100.0 * share:.0f} %"
    text = f"{100.0 * share:.{digits}g}"
    if float(text) >= 100.0:
        return "> 99.9 %"
    return f"{text} %" if float(text) >= 0.01 else "< 0.01 %"


def listed(words: Sequence[str], most: int = 4) -> str:
    """Words with commas and an and; of many the first few.

    Args:
        words: at least one.
        most: that are told.
    """
    shown = list(words[:most])
    if len(words) > most:
        return f"{', '.join(shown)} and {len(words) - most} more"
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)
