"""Which inputs matter, as bars."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, dress, percent, title_of
from cardume.studies.answers.influences import Influences, influences
from cardume.studies.answers.results import Results

MOST_METRICS, MOST_INPUTS = 4, 10
ROW = 0.3  # [inch] of an input
LEGEND = "dark: alone; light: with all its combinations; lines: 95 % intervals"


def draw_influences(study: Any, width: float = style.WIDTH) -> Any:
    """For each metric the share of its variance that each input makes, and how it goes with the input.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    found = all_influences(results)
    with style.styled():
        heights = [0.55 + ROW * min(len(one.inputs), MOST_INPUTS) for one in found]
        figure = style.new_figure(width, sum(heights) + 0.45)
        figure.set_layout_engine("constrained")
        panels = figure.subplots(len(found), 2, squeeze=False, width_ratios=(1.5, 1.0), height_ratios=heights)
        for row, one in enumerate(found):
            _draw_shares(panels[row, 0], one)
            _draw_ranks(panels[row, 1], one)
        panels[-1, 0].set_xlabel("% of the variance")
        panels[-1, 1].set_xlabel("rank correlation (Spearman)")
        figure.supxlabel(LEGEND, fontsize=6.5, color=style.INK)
        return figure


def all_influences(results: Results) -> list[Influences]:
    """The influences on each metric that is worth showing.

    Args:
        results: of the study.
    """
    found = (influences(results, metric) for metric in results.shown[:MOST_METRICS])
    return [one for one in found if one is not None]


def has_influences(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return bool(all_influences(results))


def _draw_shares(axes: Any, found: Influences) -> None:
    inputs = found.inputs[:MOST_INPUTS]
    for row, one in enumerate(inputs):
        for share, offset, alpha in ((one.first, -0.17, 1.0), (one.total, 0.17, 0.45)):
            axes.barh(row + offset, 100.0 * share.value, 0.32, color=style.color(0), alpha=alpha, lw=0.0)
            ends = [100.0 * share.low, 100.0 * share.high]
            axes.plot(ends, [row + offset] * 2, color=style.INK, lw=0.9)
    axes.set_yticks(range(len(inputs)), [one.key for one in inputs], fontsize=7.0)
    for label, one in zip(axes.get_yticklabels(), inputs, strict=True):
        label.set_color(style.INK if one.is_clear else style.FAINT)
    axes.set_ylim(len(inputs) - 0.5, -0.5)
    axes.set_xlim(0.0, max(5.0, *(105.0 * one.total.high for one in inputs)))
    dress(axes, f"{title_of(found.metric)}: {percent(found.explained.value, 2)} explained")
    axes.tick_params(axis="y", length=0.0)
    axes.grid(axis="y", visible=False)


def _draw_ranks(axes: Any, found: Influences) -> None:
    inputs = found.inputs[:MOST_INPUTS]
    axes.axvline(0.0, color=style.FAINT, lw=0.6)
    for row, one in enumerate(inputs):
        if np.isfinite(one.rank.value):
            axes.plot([one.rank.low, one.rank.high], [row, row], color=style.color(1), lw=1.6)
            axes.plot(one.rank.value, row, "o", ms=4.5, mec=style.color(1), mfc="white", mew=1.2)
        else:
            axes.text(
                0.0, row, "laws or words have no order", fontsize=6.0, ha="center", va="center", color=style.FAINT
            )
    axes.set_yticks([])
    axes.set_ylim(len(inputs) - 0.5, -0.5)
    axes.set_xlim(-1.05, 1.05)
    dress(axes)
    axes.grid(axis="y", visible=False)
