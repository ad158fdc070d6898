"""The 3-D view of the page: tracks at their depths, and the vehicles that the slider moves."""

from typing import Any

import numpy as np

from cardume.report.page.layout import NEUTRAL, base_layout
from cardume.report.page.plan_view import extent
from cardume.report.page.store import GRAY, Store, color, packed, plotly_text

FLATTEST = 0.25  # height of the box over its longer side; where the dive is flatter, depth is stretched to it
# Traces that the page moves, in this order behind the fixed ones.
MOVING = ("drops", "doubts", "believed", "links", "lost_links", "dots", "noses", "vehicles")


def space_view(store: Store) -> dict[str, Any]:
    """The figure: east to the right, north away, depth down.

    Args:
        store: of the flight.

    Returns:
        `data` and `layout` as Plotly takes them, with references in place of columns; `moving` says which trace is
        which of MOVING; `stretch` by how much depths are exaggerated.
    """
    fixed = _tracks(store)
    low, high, deepest = _box(store)
    sides = np.maximum(high - low, 0.25 * np.max(high - low))
    middle = (low + high) / 2
    width = float(np.max(sides))
    height = max(FLATTEST, deepest / width)
    scene = {
        "xaxis": _axis("east [m]", (middle[1] - sides[1] / 2, middle[1] + sides[1] / 2)),
        "yaxis": _axis("north [m]", (middle[0] - sides[0] / 2, middle[0] + sides[0] / 2)),
        "zaxis": _axis("depth [m]", (deepest, -0.08 * deepest)) | {"nticks": 5},
        "aspectmode": "manual",
        "aspectratio": {"x": 1.4 * sides[1] / width, "y": 1.4 * sides[0] / width, "z": 1.4 * height},
        "camera": {"eye": {"x": -1.05, "y": -1.6, "z": 1.1}, "center": {"x": 0, "y": 0, "z": -0.15}},
        "dragmode": "orbit",
    }
    layout = base_layout() | {"scene": scene, "margin": {"l": 0, "r": 0, "t": 0, "b": 0}, "showlegend": False}
    moving = {name: len(fixed) + place for place, name in enumerate(MOVING)}
    return {
        "data": [*fixed, *_moving(store)],
        "layout": layout,
        "moving": moving,
        "stretch": height * width / deepest,
        "nose": 0.05 * extent(store),
    }


def _axis(title: str, limits: tuple[float, float]) -> dict[str, Any]:
    line = "#9A9A9A"
    return {
        "title": {"text": title},
        "range": [float(x) for x in limits],
        "color": NEUTRAL,
        "gridcolor": line,
        "zerolinecolor": line,
        "showbackground": False,
        "showspikes": False,
    }


def _box(store: Store) -> tuple[np.ndarray, np.ndarray, float]:
    """Corners (north, east) and the depth of the box around all that is drawn."""
    tracks = np.column_stack([store.values("north").ravel(), store.values("east").ravel()])
    points = np.concatenate([*store.flight.own_paths, tracks])
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        points = np.zeros((1, 2))
    low, high = points.min(axis=0), points.max(axis=0)
    margin = max(0.05 * float(np.max(high - low)), 1.0)
    depths = store.values("depth")
    known = depths[np.isfinite(depths)]
    deepest = max(1.15 * float(known.max()), 1.0) if known.size else 1.0
    return low - margin, high + margin, deepest


def _tracks(store: Store) -> list[dict[str, Any]]:
    traces: list[dict[str, Any]] = []
    for k, name in enumerate(store.flight.vehicle_names):
        line = store.flight.own_paths[k]
        depth = _usual_depth(store.values("depth")[:, k])
        path = {
            "x": packed(line[:, 1]),
            "y": packed(line[:, 0]),
            "z": packed(np.full(len(line), depth)),
            "line": {"color": color(k), "width": 8},
            "opacity": 0.2,
        }
        track = {
            "x": store.column("east", k),
            "y": store.column("north", k),
            "z": store.column("depth", k),
            "line": {"color": color(k), "width": 3},
            "name": plotly_text(name),
        }
        traces += [{"type": "scatter3d", "mode": "lines", "hoverinfo": "skip"} | trace for trace in (path, track)]
    return traces


def _usual_depth(depths: np.ndarray) -> float:
    """[m] the depth that a vehicle keeps most of the time."""
    known = depths[np.isfinite(depths)]
    return float(np.median(known)) if known.size else 0.0


def _moving(store: Store) -> list[dict[str, Any]]:
    names = store.flight.vehicle_names
    colors = [color(k) for k in range(len(names))]
    empty: dict[str, Any] = {"type": "scatter3d", "x": [], "y": [], "z": [], "hoverinfo": "skip"}
    text = {"hoverinfo": "text", "text": [plotly_text(name) for name in names]}
    looks: dict[str, dict[str, Any]] = {
        "drops": {"mode": "lines", "line": {"color": GRAY, "width": 1.5, "dash": "dot"}},
        "doubts": {"mode": "lines", "line": {"color": GRAY, "width": 2}},
        "believed": {"mode": "markers", "marker": {"symbol": "circle-open", "size": 6, "color": colors}},
        "links": {"mode": "lines", "line": {"color": GRAY, "width": 2}},
        "lost_links": {"mode": "lines", "line": {"color": GRAY, "width": 2, "dash": "dot"}},
        "dots": {"mode": "markers", "marker": {"symbol": "circle", "size": 4, "color": GRAY}},
        "noses": {"mode": "lines", "line": {"color": GRAY, "width": 5}},
        "vehicles": {"mode": "markers", "marker": {"symbol": "circle", "size": 6, "color": colors}} | text,
    }
    return [empty | looks[name] for name in MOVING]
