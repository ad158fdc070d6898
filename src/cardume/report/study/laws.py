"""The options of a swept law side by side: what each has, and how much more than the first."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, dress, title_of
from cardume.studies.answers.differences import Differences, differences, swept_laws
from cardume.studies.answers.results import Results

ROW, GAP = 0.22, 0.62  # [inch] of an option, around the rows of a metric
MOST_OPTIONS = 12


def draw_laws(study: Any, width: float = style.WIDTH, key: str = "") -> Any:
    """For each metric the mean of each option, and its difference to the first; hollow where chance may be all of it.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.
        key: the swept key; the first whose options are laws or words where none is given.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    found = differences(results, key or swept_laws(results)[0])
    options = range(len(found.labels))[:MOST_OPTIONS]
    with style.styled():
        figure = style.new_figure(width, len(found.metrics) * (GAP + ROW * len(options)) + 0.2)
        figure.set_layout_engine("constrained")
        panels = figure.subplots(len(found.metrics), 2, squeeze=False)
        for row, metric in enumerate(found.metrics):
            _draw_means(panels[row, 0], found, metric, options)
            _draw_differences(panels[row, 1], found, metric, options)
        return figure


def has_laws(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return bool(swept_laws(results)) and bool(results.shown)


def _draw_means(axes: Any, found: Differences, metric: str, options: range) -> None:
    for option in options:
        _draw_interval(axes, found.means[metric][option], option, True)
    axes.set_yticks(options, [found.labels[option] for option in options], fontsize=7.0)
    _finish(axes, len(options))
    dress(axes, title_of(metric))


def _draw_differences(axes: Any, found: Differences, metric: str, options: range) -> None:
    axes.axvline(0.0, color=style.FAINT, lw=0.6)
    for option in options[1:]:
        _draw_interval(axes, found.differences[metric][option - 1], option, found.is_real[metric][option - 1])
    axes.set_yticks([])
    _finish(axes, len(options))
    dress(axes, f"more than {found.labels[0]}")


def _draw_interval(axes: Any, one: Any, row: int, is_full: bool) -> None:
    color = style.color(row)
    if np.isfinite([one.low, one.high]).all():
        axes.plot([one.low, one.high], [row, row], color=color, lw=1.6)
    axes.plot(one.mean, row, "o", ms=4.5, mec=color, mfc=color if is_full else "white", mew=1.2)


def _finish(axes: Any, count: int) -> None:
    axes.set_ylim(count - 0.5, -0.5)
    axes.margins(x=0.1)
    axes.tick_params(axis="y", length=0.0)
    axes.locator_params(axis="x", nbins=5)
