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
LEGEND = "white line: 95 %, dashed: both ends of its interval; dot: surely holds so often, cross: surely not"


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
        factors = [axis_of(results, key) for key in (x, y)]
        limits = [float(np.nanmin([one.middle for one in means])), float(np.nanmax([one.middle for one in means]))]
        for row, one in enumerate(means):
            drawn = _draw_cells(panels[row, -1], one, factors, limits, "{:.3g}", 1.0)
            dress(panels[row, -1], _title(title_of(metric), one))
            figure.colorbar(drawn, ax=panels[row, -1])
        for row, chance in enumerate(chances):
            drawn = _draw_cells(panels[row, 0], chance, factors, [0.0, 100.0], "{:.0f}", 100.0)
            _draw_boundary(panels[row, 0], chance, factors)
            dress(panels[row, 0], _title("all required holds [%]", chance))
            figure.colorbar(drawn, ax=panels[row, 0])
        for panel in panels.ravel():
            panel.grid(visible=False)
        for panel in panels[-1]:
            panel.set_xlabel(factors[0][1])
        for panel in panels[:, 0]:
            panel.set_ylabel(factors[1][1])
        if chances:
            figure.supxlabel(LEGEND if width > 6.0 else LEGEND.replace("; ", "\n"), fontsize=6.5, color=style.INK)
        return figure


def has_map(results: Results) -> bool:
    """Whether the figure has something to show.

    Args:
        results: of the study.
    """
    return len(numeric_keys(results)) > 1 and bool(results.shown)


def edges_of(centers: np.ndarray) -> np.ndarray:
    """(n + 1,) the edges of cells around their centers (n,), in the middle between them.

    Args:
        centers: in ascending order, two at least.
    """
    middle = 0.5 * (centers[1:] + centers[:-1])
    first, last = 2.0 * centers[0] - middle[0], 2.0 * centers[-1] - middle[-1]
    return np.concatenate([[first], middle, [last]])


def _title(what: str, one: Map) -> str:
    return f"{what}, {one.label}" if one.label else what


def _draw_cells(
    axes: Any, one: Map, factors: list[tuple[float, str]], limits: list[float], form: str, scale: float
) -> Any:
    x, y = factors[0][0] * one.x, factors[1][0] * one.y
    values = scale * one.middle
    drawn = axes.pcolormesh(edges_of(x), edges_of(y), values, cmap=COLORS, vmin=limits[0], vmax=limits[1], lw=0.0)
    if values.size <= MOST_WRITTEN:
        dark = limits[0] + 0.55 * (limits[1] - limits[0])
        for (row, column), value in np.ndenumerate(values):
            if np.isfinite(value):
                color = "white" if value < dark else "black"
                axes.text(x[column], y[row], form.format(value), ha="center", va="center", fontsize=6.0, color=color)
    return drawn


def _draw_boundary(axes: Any, chances: Map, factors: list[tuple[float, str]]) -> None:
    import matplotlib.patheffects as effects

    outline = [effects.Stroke(linewidth=2.6, foreground="black"), effects.Normal()]
    scale = np.array([factors[0][0], factors[1][0]])
    for name, lines in boundary(chances, WANTED).items():
        dashes: Any = () if name == "middle" else (2.5, 1.5)
        for line in lines:
            drawn = (line * scale).T
            axes.plot(*drawn, color="white", lw=1.6 if name == "middle" else 1.1, dashes=dashes, path_effects=outline)
    sure = verdicts(chances, WANTED)
    offset = 0.32 * np.diff(edges_of(factors[1][0] * chances.y))
    for (row, column), value in np.ndenumerate(sure):
        if value:
            mark = SURE if value > 0 else SURELY_NOT
            place = factors[0][0] * chances.x[column], factors[1][0] * chances.y[row] - offset[row]
            axes.plot(*place, mark, ms=2.6, color="black" if chances.middle[row, column] > 0.55 else "white", mew=0.8)
