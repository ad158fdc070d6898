"""The plan view of the page: paths, tracks, and what moves when the slider does."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cardume.report.ellipse import LABEL, vehicles_with_certainty
from cardume.report.page.layout import base_layout
from cardume.report.page.store import GRAY, Store, color, packed, plotly_text

ARROW_SHARE = 0.12  # of the area's width, for the strongest current
# Traces that the page moves, in this order behind the fixed ones.
MOVING = ("doubts", "believed", "currents", "links", "lost_links", "dots", "crosses", "vehicles")


def extent(store: Store) -> float:
    """[m] the larger side of all that is drawn."""
    flight = store.flight
    tracks = np.column_stack([store.values("north").ravel(), store.values("east").ravel()])
    points = np.concatenate([flight.reference_path, *flight.own_paths, tracks])
    points = points[np.isfinite(points).all(axis=1)]
    return max(float(np.max(np.ptp(points, axis=0))), 1.0) if len(points) else 1.0


def arrow_scale(store: Store) -> float:
    """[m per m/s] by which currents are drawn; 0 where the water stands still."""
    speeds = np.hypot(store.values("current_north"), store.values("current_east"))
    known = speeds[np.isfinite(speeds)]
    strongest = float(known.max()) if known.size else 0.0
    return ARROW_SHARE * extent(store) / strongest if strongest > 1e-3 else 0.0


def plan_view(store: Store) -> dict[str, Any]:
    """The figure, north up and with equal scales.

    Args:
        store: of the flight.

    Returns:
        `data` and `layout` as Plotly takes them, with references in place of columns; `moving` says which trace
        is which of MOVING, and `ellipse_K` of the vehicles K that tell their error.
    """
    ellipses = _ellipses(vehicles_with_certainty(store.flight))
    fixed = [_reference(store), *_paths(store), *_tracks(store), *_ellipse_legend(ellipses)]
    layout = base_layout() | {
        "xaxis": {"title": {"text": "east [m]"}, "constrain": "domain"},
        "yaxis": {"title": {"text": "north [m]"}, "scaleanchor": "x", "scaleratio": 1, "constrain": "domain"},
        "hovermode": "closest",
        "dragmode": "pan",
        "margin": {"l": 55, "r": 36, "t": 10, "b": 45},
        "legend": {"orientation": "h", "y": 1.0, "yanchor": "bottom", "x": 0},
        "modebar": base_layout()["modebar"] | {"orientation": "v"},  # beside the plan, not over its legend
    }
    moving = {name: len(fixed) + place for place, name in enumerate([*ellipses, *MOVING])}
    return {"data": [*fixed, *ellipses.values(), *_moving(store)], "layout": layout, "moving": moving}


def _reference(store: Store) -> dict[str, Any]:
    line = store.flight.reference_path
    return {
        "type": "scatter",
        "mode": "lines",
        "name": "reference path",
        "x": packed(line[:, 1]),
        "y": packed(line[:, 0]),
        "line": {"color": GRAY, "width": 1, "dash": "dot"},
        "hoverinfo": "skip",
    }


def _paths(store: Store) -> list[dict[str, Any]]:
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "x": packed(line[:, 1]),
            "y": packed(line[:, 0]),
            "line": {"color": color(k), "width": 7},
            "opacity": 0.2,
            "hoverinfo": "skip",
            "showlegend": False,
        }
        for k, line in enumerate(store.flight.own_paths)
    ]


def _tracks(store: Store) -> list[dict[str, Any]]:
    traces: list[dict[str, Any]] = []
    for k, name in enumerate(store.flight.vehicle_names):
        shared: dict[str, Any] = {"type": "scatter", "mode": "lines", "legendgroup": f"v{k}"}
        text = plotly_text(name)
        believed = {
            "x": store.column("east_estimate", k),
            "y": store.column("north_estimate", k),
            "line": {"color": color(k), "width": 1, "dash": "dot"},
            "showlegend": False,
            "hoverinfo": "skip",
        }
        true = {
            "x": store.column("east", k),
            "y": store.column("north", k),
            "line": {"color": color(k), "width": 1.6},
            "name": text,
            "hovertemplate": f"{text}<br>north %{{y:.2f}} m, east %{{x:.2f}} m<extra></extra>",
        }
        traces += [shared | believed, shared | true]
    return traces


def _ellipses(vehicles: list[int]) -> dict[str, dict[str, Any]]:
    """A trace for each of these vehicles, which the page fills in."""
    shared: dict[str, Any] = {"type": "scatter", "mode": "lines", "x": [], "y": [], "legendgroup": "ellipses"}
    quiet: dict[str, Any] = {"hoverinfo": "skip", "showlegend": False}
    return {f"ellipse_{k}": shared | quiet | {"line": {"color": color(k), "width": 1}} for k in vehicles}


def _ellipse_legend(ellipses: Mapping[str, Any]) -> list[dict[str, Any]]:
    """A word in the legend for all ellipses, which hides them too; nothing where there are none."""
    shared: dict[str, Any] = {"type": "scatter", "mode": "lines", "x": [None], "y": [None], "hoverinfo": "skip"}
    look: dict[str, Any] = {"name": LABEL, "legendgroup": "ellipses", "line": {"color": GRAY, "width": 1}}
    return [shared | look] if ellipses else []


def _moving(store: Store) -> list[dict[str, Any]]:
    names = store.flight.vehicle_names
    colors = [color(k) for k in range(len(names))]
    empty: dict[str, Any] = {"type": "scatter", "x": [], "y": [], "hoverinfo": "skip", "showlegend": False}
    arrow = {"symbol": "arrow", "angleref": "previous", "size": 11, "color": "#56B4E9"}
    looks: dict[str, dict[str, Any]] = {
        "doubts": {"mode": "lines", "line": {"color": GRAY, "width": 1}},
        "believed": {
            "mode": "markers",
            "name": "believed",
            "marker": {"symbol": "circle-open", "size": 12, "color": colors, "line": {"width": 2}},
            "hoverinfo": "text",
            "text": [f"{plotly_text(name)} believes to be here" for name in names],
        },
        "currents": {"mode": "lines+markers", "line": {"color": "#56B4E9", "width": 2}, "marker": arrow},
        "links": {"mode": "lines", "line": {"color": GRAY, "width": 1.2}},
        "lost_links": {"mode": "lines", "line": {"color": GRAY, "width": 1.2, "dash": "dot"}},
        "dots": {"mode": "markers", "marker": {"symbol": "circle", "size": 8, "color": GRAY}},
        "crosses": {"mode": "markers", "marker": {"symbol": "x-thin", "size": 11, "line": {"width": 3, "color": GRAY}}},
        "vehicles": {
            "mode": "markers",
            "marker": {"symbol": "arrow", "size": 17, "color": colors, "line": {"width": 1, "color": "white"}},
            "hoverinfo": "text",
            "text": [plotly_text(name) for name in names],
        },
    }
    return [empty | looks[name] for name in MOVING]
