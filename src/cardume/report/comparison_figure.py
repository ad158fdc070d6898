"""A comparison as a figure: for each metric every run of every arm, the means, and the differences to the first."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.comparison_table import shortened
from cardume.report.figures import RESOLUTION
from cardume.simulation.flight import METRICS
from cardume.studies.comparing import Comparison

WIDTH = 7.2  # [inch]
TOP, BOTTOM, ROW, GAP = 0.3, 0.28, 0.2, 0.58  # [inch] above, below, for an arm, under a metric
MOST_DRAWN = 8  # metrics
MOST_ARMS = 24
MOST_DOTS = 200  # runs of an arm
NAMED = 26  # characters of an arm's name
LEGEND = "dots: runs; rings: means with their 95 % intervals; hollow: chance may be all of the difference"


def save_comparison(comparison: Comparison, folder: Path) -> None:
    """Draw the figure into a folder, as SVG and PNG; the same comparison gives the same bytes.

    Args:
        comparison: what was flown.
        folder: exists.
    """
    with style.styled():
        figure = draw_comparison(comparison)
        figure.savefig(folder / "compare.svg", metadata={"Date": None})
        figure.savefig(folder / "compare.png", dpi=RESOLUTION, metadata={"Software": None})


def draw_comparison(comparison: Comparison) -> Any:
    """The figure: on the left what each arm has, on the right how much more than the first.

    Args:
        comparison: with at least one seed.
    """
    metrics, arms = comparison.metrics[:MOST_DRAWN], range(len(comparison.arms))[:MOST_ARMS]
    height = TOP + BOTTOM + len(metrics) * (len(arms) * ROW + GAP)
    figure = style.new_figure(WIDTH, height)
    names = 0.2 + 0.06 * max(len(shortened(comparison.labels[k], NAMED)) for k in arms)
    split, width = names + 0.55 * (WIDTH - names - 0.5), WIDTH - 0.2
    for place, metric in enumerate(metrics):
        top = height - TOP - place * (len(arms) * ROW + GAP)
        low = top - len(arms) * ROW

        def axes(left: float, right: float, low: float = low, top: float = top) -> Any:
            box = (left / WIDTH, low / height, (right - left) / WIDTH, (top - low) / height)
            return figure.add_axes(box)

        _draw_arms(axes(names, split), comparison, metric, arms)
        _draw_differences(axes(split + 0.35, width), comparison, metric, arms)
    figure.text(names / WIDTH, 0.1 / height, LEGEND, fontsize=7.0, color=style.INK)
    return figure


def _draw_arms(axes: Any, comparison: Comparison, metric: str, arms: Sequence[int]) -> None:
    """Every run as a faint dot, the mean with its interval."""
    values = comparison.values(metric)
    for row, arm in enumerate(arms):
        dots = values[arm][:MOST_DOTS]
        spread = 0.22 * np.sin(2.4 * np.arange(len(dots)))  # apart from one another, the same every time
        axes.plot(dots, row + spread, ".", ms=3.0, color=style.color(arm), alpha=0.45, mew=0)
        _draw_interval(axes, comparison.estimates[metric][arm], row, style.color(arm))
    axes.set_yticks(range(len(arms)), [shortened(comparison.labels[arm], NAMED) for arm in arms])
    _finish(axes, len(arms))
    unit = METRICS[metric.rpartition(".")[2]].unit
    axes.set_title(f"{metric} [{unit}]" if unit else metric, fontsize=8.0, loc="left", pad=3.0)


def _draw_differences(axes: Any, comparison: Comparison, metric: str, arms: Sequence[int]) -> None:
    """The mean difference of each arm to the first with its interval; hollow where chance may be all of it."""
    axes.axvline(0.0, color=style.FAINT, lw=0.6)
    for row, arm in enumerate(arms):
        if arm:
            is_real = comparison.is_real[metric][arm - 1]
            _draw_interval(axes, comparison.differences[metric][arm - 1], row, style.color(arm), is_full=is_real)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    _finish(axes, len(arms))
    title = f"difference to {shortened(comparison.labels[0], 24)}"
    axes.set_title(title, fontsize=8.0, loc="left", pad=3.0, color=style.INK)


def _draw_interval(axes: Any, estimate: Any, row: int, color: str, is_full: bool = True) -> None:
    axes.plot([estimate.low, estimate.high], [row, row], color=color, lw=1.6)
    fill = color if is_full else "white"
    axes.plot(estimate.mean, row, "o", ms=4.5, mec=color, mfc=fill, mew=1.2)


def _finish(axes: Any, count: int) -> None:
    axes.set_ylim(count - 0.5, -0.5)
    axes.margins(x=0.08)
    axes.tick_params(axis="y", length=0.0)
    axes.tick_params(axis="x", labelsize=7.0, pad=2.0)
    axes.locator_params(axis="x", nbins=5)
