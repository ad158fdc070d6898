"""Metrics and probability along one swept key, with intervals."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, axis_of, dress, grid_of, title_of
from cardume.studies.answers.regions import WANTED, Curve, chance_curves, curves, numeric_keys
from cardume.studies.answers.results import Results

MOST_CURVES = 8
MOST_METRICS = 4
MARKERS = "osD^v<>p"


def draw_curves(study: Any, width: float = style.WIDTH, key: str = "", metrics: Sequence[str] = ()) -> Any:
    """The probability that all required holds, and the means of metrics, along one swept key.

    A curve stands for each combination of the others.

    Bands are 95 % intervals; of a single curve the 5 and 95 % quantiles of the runs are dashed.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.
        key: a swept key of numbers; the one with most options where none is given.
        metrics: to draw; those worth showing where none is given.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    key = key or numeric_keys(results)[0]
    names = list(metrics or results.shown[:MOST_METRICS])
    factor, label = axis_of(results, key)
    with style.styled():
        figure, panels = grid_of(len(names) + bool(results.requirements), width, 2.1)
        axes = iter(panels)
        if results.requirements:
            panel = next(axes)
            found = chance_curves(results, key)[:MOST_CURVES]
            panel.axhline(100.0 * WANTED, color=style.FAINT, lw=0.8, dashes=(3, 2))
            draw_lines(panel, found, factor, 100.0)
            panel.set_ylim(-3.0, 103.0)
            dress(panel, "all that is required holds", label, "% of the missions")
        for metric in names:
            panel, found = next(axes), curves(results, key, metric)[:MOST_CURVES]
            draw_lines(panel, found, factor)
            _mark_limits(panel, results, metric)
            dress(panel, title_of(metric), label)
        if len(found) > 1:
            panels[0].legend(fontsize=6.5, frameon=False)
        return figure


def has_curves(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    keys = numeric_keys(results)
    return bool(keys) and results.num_cases // results.shape[results.swept.index(keys[0])] <= MOST_CURVES


def draw_lines(axes: Any, found: Sequence[Curve], factor: float = 1.0, scale: float = 1.0) -> None:
    """Curves with the bands of their intervals.

    Args:
        axes: of a figure.
        found: curves.
        factor: by which their numbers are multiplied.
        scale: by which their means are.
    """
    for k, curve in enumerate(found):
        x = factor * curve.at
        means, low, high = scale * np.array([one[:3] for one in curve.means]).T
        axes.fill_between(x, low, high, color=style.color(k), alpha=0.2, lw=0.0)
        how = {"color": style.color(k), "lw": 1.1, "ms": 3.5, "marker": MARKERS[k % len(MARKERS)], "mfc": "white"}
        axes.plot(x, means, label=curve.label, **how)
        if len(found) == 1:
            for quantile in (curve.low, curve.high):
                axes.plot(x, scale * quantile, color=style.color(k), lw=0.7, dashes=(3, 2))


def _mark_limits(axes: Any, results: Results, metric: str) -> None:
    for limit in results.limits:
        if limit.metric == metric and not limit.vehicle and np.isfinite(limit.bound):
            low, high = axes.get_ylim()
            if low - (high - low) <= limit.bound <= high + (high - low):
                axes.axhline(limit.bound, color=style.INK, lw=1.0, dashes=(1, 1.5))
                axes.text(
                    1.0,
                    limit.bound,
                    "required",
                    transform=axes.get_yaxis_transform(),
                    ha="right",
                    va="bottom",
                    fontsize=6.5,
                )
