"""Charts of the page about what was flown: distributions, influences, laws and single flights."""

from typing import Any

import numpy as np

from cardume.report.page.store import color, plotly_text
from cardume.report.study.common import histogram, runs_axis, title_of
from cardume.report.study.distributions import has_distributions
from cardume.report.study.influences import all_influences
from cardume.report.study.page.plotting import (
    BLUE,
    LINE,
    PALE,
    RED,
    Chart,
    Trace,
    bars_of,
    chart,
    dot,
    named,
    plain,
    rows_axis,
    upright,
)
from cardume.simulation.flight import Flight
from cardume.studies.answers.differences import Differences, differences, swept_laws
from cardume.studies.answers.distributions import distribution
from cardume.studies.answers.influences import Influences
from cardume.studies.answers.results import Results

MOST_INPUTS = 10
MOST_POINTS = 400  # of a track


def distribution_charts(results: Results) -> list[Chart]:
    """A histogram of each metric of a single case, with median, quantiles, mean and what is required.

    Args:
        results: of the study.
    """
    if results.num_cases > 1 or not has_distributions(results):
        return []
    return [_histogram(results, metric) for metric in results.shown]


def _histogram(results: Results, metric: str) -> Chart:
    (case,) = np.ndindex(*results.shape)
    values = results.values(metric)[case]
    known, found = values[np.isfinite(values)], distribution(results, metric, case)
    counts, edges, outside = histogram(known)
    bars: Trace = {
        "type": "bar",
        "x": plain(0.5 * (edges[1:] + edges[:-1])),
        "y": counts.tolist(),
        "width": plain(np.diff(edges)),
        "marker": {"color": BLUE, "opacity": 0.45, "line": {"width": 0}},
        "hovertemplate": "%{y} runs<extra></extra>",
    }
    shapes, notes = [], []
    for one in (found.quantiles[0], found.median, found.quantiles[-1]):
        shapes.append(upright(one.value, BLUE, "solid" if one.share == 0.5 else "dash"))
        if np.isfinite([one.low, one.high]).all():
            look = {"fillcolor": BLUE, "opacity": 0.15, "line": {"width": 0}}
            shapes.append({"type": "rect", "x0": one.low, "x1": one.high, "yref": "paper", "y0": 0, "y1": 1, **look})
    for limit in results.limits:
        if limit.metric == metric and not limit.vehicle and edges[0] <= limit.bound <= edges[-1]:
            shapes.append(upright(limit.bound, LINE, "dot"))
            where = {"x": limit.bound, "y": 1, "yref": "paper", "xanchor": "left", "yanchor": "bottom"}
            notes.append({"text": "required", "showarrow": False, "font": {"size": 11}, **where})
    mean = dot(1.05 * float(counts.max()), found.mean.mean, found.mean.low, found.mean.high, RED)
    return chart(
        title_of(metric), [bars, mean], shapes=shapes, annotations=notes, bargap=0, yaxis=named(runs_axis(outside))
    )


def influence_charts(results: Results) -> list[Chart]:
    """For each metric the share of its variance that each input makes.

    Args:
        results: of the study.
    """
    return [_influence(one) for one in all_influences(results)]


def _influence(found: Influences) -> Chart:
    inputs, data = found.inputs[:MOST_INPUTS], []
    kinds = ("alone", [one.first for one in inputs], BLUE), ("with others", [one.total for one in inputs], PALE)
    for name, shares, shade in kinds:
        values, low, high = 100.0 * np.array([tuple(share) for share in shares]).T
        data.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": name,
                "x": plain(values),
                "y": list(range(len(inputs))),
                "marker": {"color": shade},
                "error_x": bars_of(values, low, high, LINE, 3.0),
                "hovertemplate": f"%{{x:.3~g}} %<extra>{name}</extra>",
            }
        )
    title = f"{title_of(found.metric)}: {100.0 * found.explained.value:.0f} % explained"
    legend = {"orientation": "h", "x": 1, "xanchor": "right", "y": 0, "yanchor": "bottom"}
    axes = {"xaxis": named("% of the variance", rangemode="tozero"), "yaxis": rows_axis([one.key for one in inputs])}
    return chart(title, data, barmode="group", showlegend=True, legend=legend, **axes)


def law_charts(results: Results) -> list[Chart]:
    """Differences of the options of swept laws to the first.

    Args:
        results: of the study.
    """
    told = [differences(results, key) for key in swept_laws(results)]
    return [_law(found, metric) for found in told for metric in found.metrics]


def _law(found: Differences, metric: str) -> Chart:
    data = []
    for place, (one, is_real) in enumerate(zip(found.differences[metric], found.is_real[metric], strict=True)):
        data.append(dot(place, one.mean, one.low, one.high, color(place + 1), is_real))
    unit = title_of(metric).partition(" ")[2]
    axes = {"xaxis": named(f"more than {found.labels[0]} {unit}"), "yaxis": rows_axis(found.labels[1:])}
    return chart(title_of(metric), data, shapes=[upright(0.0, LINE, "solid", 1.0)], **axes)


def flight_chart(flight: Flight) -> Chart:
    """A flight seen from above, and its cross-track errors over time.

    Args:
        flight: with its log.
    """
    rows = np.unique(np.linspace(0, len(flight.times) - 1, MOST_POINTS).astype(int))
    line: Trace = {"type": "scatter", "mode": "lines"}
    data: list[Trace] = []
    for k, path in enumerate(flight.own_paths):
        some = path[:: max(1, len(path) // MOST_POINTS)]
        look = {"line": {"color": color(k), "width": 6}, "opacity": 0.2, "hoverinfo": "skip", "showlegend": False}
        data.append(line | look | {"x": plain(some[:, 1]), "y": plain(some[:, 0])})
    for k, name in enumerate(flight.vehicle_names):
        shared = line | {"line": {"color": color(k), "width": 1.4}, "name": plotly_text(name), "legendgroup": str(k)}
        north, east, error = (plain(flight.channels[c][rows, k]) for c in ("north", "east", "cross_track"))
        data.append(shared | {"x": east, "y": north, "hovertemplate": "%{x:.4~g}, %{y:.4~g} m<extra></extra>"})
        below = {"xaxis": "x2", "yaxis": "y2", "showlegend": False}
        told = {"x": plain(flight.times[rows]), "y": error, "hovertemplate": "%{x} s: %{y:.3~g} m<extra></extra>"}
        data.append(shared | below | told)
    layout: dict[str, Any] = {
        "xaxis": named("east [m]", domain=[0, 1], constrain="domain", anchor="y"),
        "yaxis": named("north [m]", domain=[0.48, 1], scaleanchor="x", constrain="domain"),
        "xaxis2": named("time [s]", domain=[0, 1], anchor="y2"),
        "yaxis2": named("error [m]", domain=[0, 0.26], anchor="x2"),
        "legend": {"orientation": "h", "y": 1.0, "yanchor": "bottom", "x": 0, "font": {"size": 11}},
        "margin": {"l": 48, "r": 8, "t": 26, "b": 40},
        "showlegend": len(flight.vehicle_names) > 1,
    }
    return chart("", data, **layout)
