"""Maps over two swept keys: the mean of a metric, and how probable it is that what is required holds."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import as_results, axis_of, dress, title_of
from cardume.studies.answers.regions import (
    MOST_PANELS,
    WANTED,
    Map,
    boundary,
    chance_maps,
    mean_maps,
    numeric_keys,
    verdicts,
)
from cardume.studies.answers.results import Results

COLORS = "cividis"  # told apart by the color-blind, and in gray
ROW = 2.35  # [inch] of a map
MOST_WRITTEN = 64  # cells with their numbers in them
SURE, SURELY_NOT = "o", "x"
UNEVEN = 2.5  # the widest gap between options over the narrowest, from which they are drawn one after the other
MOST_TICKS = 12
LEGEND = "lines: 95 % in the middle of its interval, dashed: at the ends; dot: surely holds so often, cross: surely not"


def draw_map(study: Any, width: float = style.WIDTH, keys: tuple[str, str] | None = None, metric: str = "") -> Any:
    """For each option of the other keys a row: the probability that all required holds, and the mean of a metric.

    Args:
        study: `Results`, or its dataset.
        width: [inch] of the figure.
        keys: along x and along y; the two with most options where none are given.
        metric: the first worth showing where none is given.

    Returns:
        A matplotlib figure.
    """
    results = as_results(study)
    x, y = keys or (numeric_keys(results)[0], numeric_keys(results)[1])
    metric = metric or results.shown[0]
    means = mean_maps(results, (x, y), metric)[:MOST_PANELS]
    chances = chance_maps(results, (x, y))[:MOST_PANELS] if results.requirements else ()
    columns = 2 if chances else 1
    with style.styled():
        figure = style.new_figure(width, ROW * len(means) + 0.35)
        figure.set_layout_engine("constrained")
        panels = figure.subplots(len(means), columns, squeeze=False, sharex=True, sharey=True)
        scales = [Scale(results, key) for key in (x, y)]
        limits = [float(np.nanmin([one.middle for one in means])), float(np.nanmax([one.middle for one in means]))]
        for row, one in enumerate(means):
            drawn = _draw_cells(panels[row, -1], one, scales, limits, "{:.3g}", 1.0)
            dress(panels[row, -1], _title(title_of(metric), one))
            figure.colorbar(drawn, ax=panels[row, -1])
        for row, chance in enumerate(chances):
            drawn = _draw_cells(panels[row, 0], chance, scales, [0.0, 100.0], "{:.0f}", 100.0)
            _draw_boundary(panels[row, 0], chance, scales)
            dress(panels[row, 0], _title("all required holds [%]", chance))
            figure.colorbar(drawn, ax=panels[row, 0])
        for panel in panels.ravel():
            panel.grid(visible=False)
        for panel in panels[-1]:
            scales[0].mark(panel.xaxis)
        for panel in panels[:, 0]:
            scales[1].mark(panel.yaxis)
        if chances:
            figure.supxlabel(LEGEND if width > 6.0 else LEGEND.replace("; ", "\n"), fontsize=6.5, color=style.INK)
        return figure


def has_map(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return len(numeric_keys(results)) > 1 and bool(results.shown)


class Scale:
    """Where the options of a key are drawn: at their numbers, or, where these are unevenly spaced, one after the other.

    Attributes:
        numbers: (option,) in ascending order, SI.
        places: (option,) on the axis.
        edges: (option + 1,) of their cells, on the axis.
    """

    def __init__(self, results: Results, key: str) -> None:
        factor, self.name = axis_of(results, key)
        self.numbers = np.sort(np.asarray(results.numbers(key)))
        gaps = np.diff(self.numbers)
        self.is_even = bool(gaps.max() <= UNEVEN * gaps.min())
        self.labels = [f"{factor * number:.4g}" for number in self.numbers]
        self.places = factor * self.numbers if self.is_even else np.arange(float(len(self.numbers)))
        middle = 0.5 * (self.places[1:] + self.places[:-1])
        self.edges = np.concatenate([[2.0 * self.places[0] - middle[0]], middle, [2.0 * self.places[-1] - middle[-1]]])

    def place(self, numbers: np.ndarray) -> np.ndarray:
        """Where numbers between the options lie on the axis.

        Args:
            numbers: (n,) SI.
        """
        found: np.ndarray = np.interp(numbers, self.numbers, self.places)
        return found

    def mark(self, axis: Any) -> None:
        """Name an axis, and say where the options are.

        Args:
            axis: of matplotlib.
        """
        axis.set_label_text(self.name)
        stride = -(-len(self.labels) // MOST_TICKS)
        axis.set_ticks(self.places[::stride], self.labels[::stride])


def _title(what: str, one: Map) -> str:
    return f"{what}, {one.label}" if one.label else what


def _draw_cells(axes: Any, one: Map, scales: list[Scale], limits: list[float], form: str, factor: float) -> Any:
    import matplotlib.patheffects as effects

    values = factor * one.middle
    x, y = scales
    drawn = axes.pcolormesh(x.edges, y.edges, values, cmap=COLORS, vmin=limits[0], vmax=limits[1], lw=0.0)
    if values.size <= MOST_WRITTEN:
        dark = limits[0] + 0.55 * (limits[1] - limits[0])
        for (row, column), value in np.ndenumerate(values):
            if np.isfinite(value):
                # in the color of its cell, so that lines end before the number
                halo = effects.withStroke(linewidth=3.0, foreground=drawn.cmap(drawn.norm(value)))
                text = axes.text(x.places[column], y.places[row], form.format(value), ha="center", va="center")
                text.set(fontsize=6.0, zorder=6, color="white" if value < dark else "black", path_effects=[halo])
    return drawn


def _draw_boundary(axes: Any, chances: Map, scales: list[Scale]) -> None:
    import matplotlib.patheffects as effects

    outline = [effects.Stroke(linewidth=2.6, foreground="black"), effects.Normal()]
    for name, lines in boundary(chances, WANTED).items():
        is_middle = name == "middle"
        how = {"color": "white", "lw": 1.6 if is_middle else 1.1, "dashes": () if is_middle else (2.5, 1.5)}
        for line in lines:
            axes.plot(scales[0].place(line[:, 0]), scales[1].place(line[:, 1]), path_effects=outline, **how)
    below = 0.33 * np.diff(scales[1].edges)
    for (row, column), value in np.ndenumerate(verdicts(chances, WANTED)):
        if value:
            color = "black" if chances.middle[row, column] > 0.55 else "white"
            place = scales[0].places[column], scales[1].places[row] - below[row]
            axes.plot(*place, SURE if value > 0 else SURELY_NOT, ms=2.6, color=color, mew=0.8)
