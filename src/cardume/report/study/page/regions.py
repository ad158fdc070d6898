"""Charts of the page about swept keys: curves along one, maps over two."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.report.page.store import color, plotly_text
from cardume.report.study.common import axis_of, title_of
from cardume.report.study.curves import has_curves
from cardume.report.study.maps import Scale, has_map
from cardume.report.study.page.plotting import LINE, Chart, Trace, chart, ends, faded, level, named, plain
from cardume.studies.answers.regions import (
    MOST_PANELS,
    WANTED,
    Curve,
    Map,
    boundary,
    chance_curves,
    chance_maps,
    curves,
    mean_maps,
    numeric_keys,
)
from cardume.studies.answers.results import Results

MOST_METRICS = 4


def curve_charts(results: Results) -> list[Chart]:
    """Probability and metrics along the swept key with most options.

    Args:
        results: of the study.
    """
    if not has_curves(results):
        return []
    key, found = numeric_keys(results)[0], []
    if results.requirements:
        data = _curves(results, key, chance_curves(results, key), 100.0)
        shapes = [level(100.0 * WANTED, LINE, "dash", 1.0)]
        y = named("% of the missions", range=[-3, 103])
        found.append(_along(results, key, "all that is required holds", data, yaxis=y, shapes=shapes))
    for metric in results.shown[:MOST_METRICS]:
        data = _curves(results, key, curves(results, key, metric), 1.0)
        limits = [limit for limit in results.limits if limit.metric == metric and not limit.vehicle]
        shapes = [level(limit.bound, LINE, "dot") for limit in limits]
        found.append(_along(results, key, title_of(metric), data, shapes=shapes))
    return found


def _along(results: Results, key: str, title: str, data: list[Trace], **layout: Any) -> Chart:
    legend = {"orientation": "h", "y": -0.25, "yanchor": "top", "x": 0}
    return chart(title, data, xaxis=named(axis_of(results, key)[1]), showlegend=len(data) > 2, legend=legend, **layout)


def _curves(results: Results, key: str, found: Sequence[Curve], scale: float) -> list[Trace]:
    factor, data = axis_of(results, key)[0], []
    for k, curve in enumerate(found):
        x, name = plain(factor * curve.at), plotly_text(curve.label)
        means, low, high = scale * np.array([one[:3] for one in curve.means]).T
        low, high = (np.where(np.isfinite(end), end, means) for end in (low, high))
        shared: Trace = {"type": "scatter", "legendgroup": str(k)}
        band = {"fill": "toself", "mode": "none", "fillcolor": faded(color(k)), "hoverinfo": "skip"}
        data.append(shared | band | {"x": [*x, *x[::-1]], "y": [*plain(high), *plain(low)[::-1]], "showlegend": False})
        look = {"mode": "lines+markers", "line": {"color": color(k), "width": 1.8}, "marker": {"size": 6}}
        told = f"%{{y:.4~g}} (%{{customdata[0]:.4~g}} to %{{customdata[1]:.4~g}})<extra>{name}</extra>"
        line = {"x": x, "y": plain(means), "name": name, "customdata": ends(low, high), "hovertemplate": told}
        data.append(shared | look | line)
    return data


def map_charts(results: Results) -> list[Chart]:
    """Maps of the probability, with its boundary, and of the first metric over two swept keys.

    Args:
        results: of the study.
    """
    if not has_map(results):
        return []
    first, second = numeric_keys(results)[:2]
    scales, metric = [Scale(results, key) for key in (first, second)], results.shown[0]
    means = mean_maps(results, (first, second), metric)[:MOST_PANELS]
    chances = chance_maps(results, (first, second))[:MOST_PANELS] if results.requirements else ()
    every = [one.middle for one in means]
    limits = float(np.nanmin(every)), float(np.nanmax(every))
    found = []
    for place, one in enumerate(means):
        if chances:
            drawn = _map(chances[place], scales, "all required holds [%]", 100.0, (0.0, 100.0))
            drawn["data"] += _boundary(chances[place], scales)
            found.append(drawn)
        found.append(_map(one, scales, title_of(metric), 1.0, limits))
    return found


def _map(one: Map, scales: list[Scale], what: str, factor: float, limits: tuple[float, float]) -> Chart:
    x, y = scales

    def words(row: int, column: int) -> str:
        middle, low, high = (factor * part[row, column] for part in (one.middle, one.low, one.high))
        return f"{x.labels[column]}, {y.labels[row]}: {middle:.4g} ({low:.4g} to {high:.4g})"

    rows, columns = one.middle.shape
    cells: Trace = {
        "type": "heatmap",
        "x": plain(x.edges),
        "y": plain(y.edges),
        "z": [plain(factor * row) for row in one.middle],
        "zmin": limits[0],
        "zmax": limits[1],
        "colorscale": "Cividis",
        "text": [[words(row, column) for column in range(columns)] for row in range(rows)],
        "hovertemplate": "%{text}<extra></extra>",
        "colorbar": {"thickness": 10, "outlinewidth": 0},
    }
    axes = [named(s.name, tickvals=plain(s.places), ticktext=s.labels, showgrid=False, zeroline=False) for s in scales]
    return chart(f"{what}, {one.label}" if one.label else what, [cells], xaxis=axes[0], yaxis=axes[1])


def _boundary(chances: Map, scales: list[Scale]) -> list[Trace]:
    """White lines on black ones, which are seen on every color of the map."""
    data: list[Trace] = []
    for name, lines in boundary(chances, WANTED).items():
        is_middle = name == "middle"
        for line in lines:
            x, y = (plain(scales[k].place(line[:, k])) for k in (0, 1))
            shared: Trace = {"type": "scatter", "mode": "lines", "x": x, "y": y, "hoverinfo": "skip"}
            data.append(shared | {"line": {"color": "#000000", "width": 4.5 if is_middle else 3.0}})
            dash = "solid" if is_middle else "dot"
            data.append(shared | {"line": {"color": "#FFFFFF", "width": 2.2, "dash": dash}})
    return data
