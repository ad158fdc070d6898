"""The pieces that the page's charts are made of, as Plotly takes them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.page.layout import axis, base_layout
from cardume.report.page.store import plotly_text

Chart = dict[str, Any]
Trace = dict[str, Any]
LINE = "#808080"
BLUE, RED = style.PALETTE[0], style.PALETTE[1]
PALE = "#80B8D8"  # a lighter blue, for what stands beside blue bars


def chart(title: str, data: list[Trace], **layout: Any) -> Chart:
    """A chart with a title.

    Args:
        title: above it.
        data: traces.
        layout: what differs from the usual.
    """
    place = {"x": 0, "xref": "container", "y": 1, "yref": "container", "yanchor": "top", "pad": {"t": 6, "l": 4}}
    shared = {
        "title": {"text": f"<b>{plotly_text(title)}</b>", "font": {"size": 13}, **place},
        "margin": {"l": 50, "r": 12, "t": 34, "b": 44},
        "showlegend": False,
        "dragmode": "zoom",
    }
    return {"data": data, "layout": base_layout() | shared | layout}


def named(title: str, **more: Any) -> dict[str, Any]:
    """An axis with a name.

    Args:
        title: of the axis.
        more: what differs from the usual.
    """
    return axis() | {"title": {"text": plotly_text(title), "standoff": 6}} | more


def rows_axis(labels: Sequence[str]) -> dict[str, Any]:
    """A vertical axis of rows, the first on top.

    Args:
        labels: of the rows.
    """
    texts = [plotly_text(style.shortened(label, 40)) for label in labels]
    bare = {"zeroline": False, "showgrid": False, "ticks": "", "range": [len(labels) - 0.5, -0.5]}
    return axis() | bare | {"tickvals": list(range(len(labels))), "ticktext": texts}


def plain(values: Any) -> list[float | None]:
    """Numbers for JSON, with six digits; what is none becomes None.

    Args:
        values: (n,) [any]
    """
    return [float(f"{value:.6g}") if np.isfinite(value) else None for value in np.asarray(values, float).tolist()]


def ends(low: Any, high: Any) -> list[list[float | None]]:
    """Both ends of intervals, to be shown where the pointer is.

    Args:
        low: (n,) [any]
        high: (n,) [any]
    """
    return [[*pair] for pair in zip(plain(low), plain(high), strict=True)]


def bars_of(middle: np.ndarray, low: np.ndarray, high: np.ndarray, tint: str, width: float) -> dict[str, Any]:
    """Lines of intervals around values, as an error bar.

    Args:
        middle: (n,) [any]
        low: (n,) [any]
        high: (n,) [any]
        tint: color.
        width: [pixel] of their ends.
    """
    above, below = np.where(np.isfinite(high), high - middle, 0.0), np.where(np.isfinite(low), middle - low, 0.0)
    shape = {"type": "data", "symmetric": False, "color": tint, "thickness": 2, "width": width}
    return shape | {"array": plain(above), "arrayminus": plain(below)}


def dot(row: float, middle: float, low: float, high: float, tint: str, is_full: bool = False) -> Trace:
    """A point in a row with the line of its interval.

    Args:
        row: its place.
        middle: [any]
        low: [any]
        high: [any]
        tint: color.
        is_full: whether it is filled.
    """
    symbol = "circle" if is_full else "circle-open"
    return {
        "type": "scatter",
        "mode": "markers",
        "x": plain([middle]),
        "y": [row],
        "marker": {"size": 8, "color": tint, "symbol": symbol, "line": {"width": 2, "color": tint}},
        "error_x": bars_of(np.array([middle]), np.array([low]), np.array([high]), tint, 0.0),
        "customdata": ends([low], [high]),
        "hovertemplate": "%{x:.4~g} (%{customdata[0]:.4~g} to %{customdata[1]:.4~g})<extra></extra>",
    }


def upright(x: float, tint: str, dash: str, width: float = 1.5) -> dict[str, Any]:
    """A line over the whole height.

    Args:
        x: [any]
        tint: color.
        dash: solid, dash or dot.
        width: [pixel]
    """
    line = {"color": tint, "width": width, "dash": dash}
    return {"type": "line", "x0": x, "x1": x, "yref": "paper", "y0": 0, "y1": 1, "line": line}


def level(y: float, tint: str, dash: str, width: float = 1.5) -> dict[str, Any]:
    """A line over the whole width.

    Args:
        y: [any]
        tint: color.
        dash: solid, dash or dot.
        width: [pixel]
    """
    line = {"color": tint, "width": width, "dash": dash}
    return {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": y, "y1": y, "line": line}


def faded(tint: str) -> str:
    """A color through which one sees.

    Args:
        tint: color, as #0072B2.
    """
    red, green, blue = (int(tint[k : k + 2], 16) for k in (1, 3, 5))
    return f"rgba({red},{green},{blue},0.22)"
