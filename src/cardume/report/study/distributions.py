"""How the metrics are distributed: a histogram of each, or one row for each case."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, dress, grid_of, histogram, runs_axis, title_of
from cardume.studies.answers.distributions import Distribution, distribution
from cardume.studies.answers.results import Results

MOST_CASES = 16
BAR = "#BFD9EA"  # the palette's blue, on white
ROW = 0.2  # [inch] of a case


def draw_distributions(study: Any, width: float = style.WIDTH) -> Any:
    """Every metric worth showing: of one case a histogram with mean, quantiles and their intervals; else a row each.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    cases = list(np.ndindex(*results.shape))[:MOST_CASES]
    with style.styled():
        height = 1.75 if len(cases) == 1 else 0.65 + ROW * len(cases)
        figure, axes = grid_of(len(results.shown), width, height, 2 if len(cases) == 1 else 1)
        for metric, panel in zip(results.shown, axes, strict=True):
            if len(cases) == 1:
                _draw_histogram(panel, results, metric, cases[0])
            else:
                _draw_rows(panel, results, metric, cases)
        return figure


def has_distributions(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return bool(results.shown) and results.num_cases <= MOST_CASES


def _draw_histogram(axes: Any, results: Results, metric: str, case: tuple[int, ...]) -> None:
    values = results.values(metric)[case]
    known, found = values[np.isfinite(values)], distribution(results, metric, case)
    bars = histogram(known)
    axes.stairs(bars.counts, bars.edges, fill=True, color=BAR, zorder=1)
    for one in (found.quantiles[0], found.median, found.quantiles[-1]):
        if np.isfinite([one.low, one.high]).all():
            axes.axvspan(one.low, one.high, color=style.color(0), alpha=0.18, lw=0.0, zorder=2)
        axes.axvline(one.value, color=style.color(0), lw=0.9, dashes=(3, 2) if one.share != 0.5 else (), zorder=3)
    top = axes.get_ylim()[1]
    axes.plot([found.mean.low, found.mean.high], [1.06 * top] * 2, color=style.color(1), lw=2.0)
    axes.plot(found.mean.mean, 1.06 * top, "o", ms=4.5, mfc="white", mec=style.color(1), mew=1.2)
    axes.set_ylim(0.0, 1.16 * top)
    _mark_limits(axes, results, metric)
    dress(axes, title_of(metric), "", runs_axis(bars.outside))
    axes.grid(visible=False)


def _draw_rows(axes: Any, results: Results, metric: str, cases: list[tuple[int, ...]]) -> None:
    for row, case in enumerate(cases):
        _draw_row(axes, row, distribution(results, metric, case))
    axes.set_yticks(range(len(cases)), [results.case_label(case) for case in cases], fontsize=7.0)
    axes.set_ylim(len(cases) - 0.5, -0.5)
    _mark_limits(axes, results, metric)
    dress(axes, title_of(metric))
    axes.tick_params(axis="y", length=0.0)
    axes.grid(axis="y", visible=False)


def _draw_row(axes: Any, row: int, found: Distribution) -> None:
    values = [one.value for one in found.quantiles]
    blue, red = style.color(0), style.color(1)
    axes.plot([values[0], values[-1]], [row, row], color=blue, lw=1.0)
    axes.plot([values[1], values[3]], [row, row], color=blue, lw=4.5, alpha=0.45, solid_capstyle="butt")
    axes.plot(values[2], row, "|", color=blue, ms=8.0, mew=1.4)
    axes.plot([found.mean.low, found.mean.high], [row, row], color=red, lw=1.6, zorder=4)
    axes.plot(found.mean.mean, row, "o", ms=4.0, mfc="white", mec=red, mew=1.2, zorder=5)


def _mark_limits(axes: Any, results: Results, metric: str) -> None:
    """The required value, where it lies near what came out."""
    low, high = axes.get_xlim()
    for limit in results.limits:
        is_near = low - 0.6 * (high - low) <= limit.bound <= high + 0.6 * (high - low)
        if limit.metric == metric and not limit.vehicle and is_near:
            axes.axvline(limit.bound, color=style.INK, lw=1.1, dashes=(1, 1.5))
            axes.text(limit.bound, 1.0, " required", transform=axes.get_xaxis_transform(), va="top", fontsize=6.5)
