"""How probable it is that what is required holds, and when it first does not."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, dress, histogram, percent
from cardume.studies.answers.regions import WANTED
from cardume.studies.answers.requirements import Chance, chance_of_all, requirements
from cardume.studies.answers.results import Results

MOST_ROWS = 24
ROW = 0.23  # [inch]


def draw_requirements(study: Any, width: float = style.WIDTH) -> Any:
    """The probability that each requirement holds, and all of them; or, of several cases, that all hold in each.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    rows, times = _rows(results), _violations(results)
    with style.styled():
        height = 0.75 + ROW * len(rows)
        figure = style.new_figure(width, height + (1.3 if times.size else 0.0))
        figure.set_layout_engine("constrained")
        if times.size:
            grid = figure.add_gridspec(2, 1, height_ratios=(height, 1.3))
            _draw_chances(figure.add_subplot(grid[0]), rows)
            _draw_times(figure.add_subplot(grid[1]), times)
        else:
            _draw_chances(figure.add_subplot(), rows)
        return figure


def has_requirements(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return bool(results.requirements) and results.num_cases <= MOST_ROWS


def _rows(results: Results) -> list[tuple[str, Chance]]:
    if results.num_cases > 1:
        cases = list(np.ndindex(*results.shape))[:MOST_ROWS]
        return [(results.case_label(case), chance_of_all(results, case)) for case in cases]
    (case,) = np.ndindex(*results.shape)
    each = [(one.name, one.chance) for one in requirements(results, case)]
    return [("all of it", chance_of_all(results, case)), *each] if len(each) > 1 else each


def _violations(results: Results) -> np.ndarray:
    """[s] when missions first missed something, as far as that is known."""
    known = np.concatenate([results.violated_at, results.failed_at[..., None]], axis=-1)
    first = np.min(np.where(np.isfinite(known), known, np.inf), axis=-1).ravel()
    found: np.ndarray = first[np.isfinite(first)]
    return found


def _draw_chances(axes: Any, rows: list[tuple[str, Chance]]) -> None:
    axes.axvline(100.0 * WANTED, color=style.FAINT, lw=0.8, dashes=(3, 2))
    for row, (_, one) in enumerate(rows):
        blue = style.color(0)
        axes.plot([100.0 * one.low, 100.0 * one.high], [row, row], color=blue, lw=1.8)
        axes.plot(100.0 * one.share, row, "o", ms=5.0, mfc="white", mec=blue, mew=1.3)
        axes.text(1.01, row, percent(one.share), transform=axes.get_yaxis_transform(), va="center", fontsize=7.0)
    axes.set_yticks(range(len(rows)), [name for name, _ in rows], fontsize=7.0)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    low = min([100.0 * one.low for _, one in rows])
    axes.set_xlim(max(0.0, low - 0.08 * (100.0 - low) - 0.5), 100.5)
    dress(axes, "share of the missions in which it holds; line: its 95 % interval, by Wilson", "% of the missions")
    axes.tick_params(axis="y", length=0.0)
    axes.grid(axis="y", visible=False)


def _draw_times(axes: Any, times: np.ndarray) -> None:
    bars = histogram(times, is_trimmed=False)
    axes.stairs(bars.counts, bars.edges, fill=True, color=style.color(1), alpha=0.7)
    dress(axes, f"when {times.size} missions first missed something", "time in the mission [s]", "missions")
