"""The search of a tuning as a figure: each metric against each key, and how it fell; or two metrics and their front."""

from pathlib import Path
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.figures import RESOLUTION
from cardume.simulation.flight import METRICS
from cardume.studies.tuning.tune import Tuning
from cardume.units import SHOWN_IN, UNITS

WIDTH, HEIGHT = 2.7, 2.4  # [inch] of a panel
MOST_KNOBS = 4


def save_tuning(tuning: Tuning, folder: Path) -> None:
    """Draw the figure into a folder, as SVG and PNG; the same tuning gives the same bytes.

    Args:
        tuning: what was found.
        folder: exists.
    """
    with style.styled():
        figure = draw_tuning(tuning)
        figure.savefig(folder / "search.svg", metadata={"Date": None})
        figure.savefig(folder / "search.png", dpi=RESOLUTION, metadata={"Software": None})


def draw_tuning(tuning: Tuning) -> Any:
    """The figure: in each row a metric, against the keys and against the order of the tries.

    Args:
        tuning: what was found.
    """
    knobs = tuning.knobs[:MOST_KNOBS]
    columns, rows = len(knobs) + 1, len(tuning.metrics)
    figure = style.new_figure(WIDTH * columns + 0.3, HEIGHT * rows + 0.3)
    grid = figure.subplots(rows, columns, squeeze=False)
    well = np.array([one.met >= tuning.goal.met and one.counted == 1.0 for one in tuning.tries])
    values = np.array([one.values for one in tuning.tries])
    for row, metric in enumerate(tuning.metrics):
        unit = METRICS[metric.rpartition(".")[2]].unit
        reached = np.array([one.metrics[row] for one in tuning.tries])
        for column, knob in enumerate(knobs):
            axes, shown = grid[row, column], SHOWN_IN.get(knob.unit, knob.unit)
            scale = 1.0 / UNITS[shown].factor if shown != knob.unit else 1.0
            _dots(axes, values[:, column] * scale, reached, well)
            _marks(axes, tuning, scale * tuning.start.values[column], scale * tuning.best.values[column], row)
            axes.set_xscale("log" if knob.is_logarithmic else "linear")
            axes.set_xlabel(f"{knob.key} [{shown}]" if shown else knob.key, fontsize=8.0)
        axes = grid[row, -1]
        _dots(axes, np.arange(len(reached)), reached, well)
        _marks(axes, tuning, 0, tuning.tries.index(tuning.best), row)
        axes.set_xlabel("try", fontsize=8.0)
        grid[row, 0].set_ylabel(f"{metric} [{unit}]" if unit else metric, fontsize=8.0)
    text = "ring: start; star: best; faint: not all that is required is met"
    figure.text(0.01, 0.01, text, fontsize=7.0, color=style.INK)
    figure.tight_layout(rect=(0.0, 0.04, 1.0, 1.0))
    return figure


def _dots(axes: Any, x: np.ndarray, y: np.ndarray, well: np.ndarray) -> None:
    axes.plot(x[~well], y[~well], ".", ms=5.0, color=style.FAINT, mew=0)
    axes.plot(x[well], y[well], ".", ms=5.0, color=style.color(0), alpha=0.6, mew=0)
    axes.tick_params(labelsize=7.0)


def _marks(axes: Any, tuning: Tuning, start: float, best: float, row: int) -> None:
    axes.plot(start, tuning.start.metrics[row], "o", ms=6.0, mfc="none", mec=style.INK, mew=1.0)
    axes.plot(best, tuning.best.metrics[row], "*", ms=9.0, color=style.color(1), mec=style.INK, mew=0.5)
