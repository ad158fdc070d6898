"""The message timeline of the page: one lane per sender and receiver."""

from typing import Any

import numpy as np

from cardume.report.message_lanes import lane_words
from cardume.report.page.store import color, packed, plotly_text, shown_messages
from cardume.simulation.flight import Flight

TALL, BASE, LABEL = 0.26, 0.2, -0.28  # [lane] of a tick, where it stands, and the words above


def lane_layout(count: int) -> dict[str, Any]:
    """The axis of so many lanes, the first on top; its labels are the lanes' own.

    Args:
        count: of lanes.
    """
    return {"range": [count - 0.5, -0.5], "showticklabels": False, "ticks": "", "zeroline": False, "nticks": 2}


def lane_annotations(place: int) -> list[dict[str, Any]]:
    """What the lanes show, above them.

    Args:
        place: of the panel, from 1.
    """
    text = "<b>Messages</b>, when sent: tick up delivered, down lost"
    where = {"xref": "paper", "yref": f"y{place} domain", "x": 0, "y": 1, "xanchor": "left", "yanchor": "bottom"}
    return [{"text": text, "showarrow": False, "font": {"size": 11}} | where]


def lane_traces(flight: Flight, lanes: list[tuple[int, int]], y: str) -> list[dict[str, Any]]:
    """Delivered and lost messages of each lane, and what became of them in words.

    Args:
        flight: what was flown.
        lanes: sender and receiver.
        y: name of the axis.
    """
    chosen = shown_messages(flight)
    table = {name: np.asarray(values, float)[chosen] for name, values in flight.messages.items()}
    traces: list[dict[str, Any]] = []
    for lane, (sender, receiver) in enumerate(lanes):
        here = (table["sender"] == sender) & (table["receiver"] == receiver)
        lost = here & (table["lost"] > 0.5)
        for mask, direction, width, dash in ((here & ~lost, -TALL, 1.0, "solid"), (lost, TALL, 1.8, "solid")):
            x, height = ticks(table["time_sent"][mask], lane + BASE, lane + BASE + direction)
            line = {"color": color(sender), "width": width, "dash": dash}
            shared = {"type": "scatter", "mode": "lines", "yaxis": y, "showlegend": False, "hoverinfo": "skip"}
            traces.append(shared | {"x": packed(x), "y": packed(height), "line": line})
        traces.append(_label(flight, (sender, receiver), lane, y))
    return traces


def ticks(times: np.ndarray, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """A short line at each time, as one line with gaps.

    Args:
        times: (n,) [s]
        start: where each begins.
        end: where it ends.

    Returns:
        Abscissas and ordinates, (3 n,) each.
    """
    x = np.repeat(np.asarray(times, float), 3)
    y = np.tile([start, end, np.nan], len(times))
    return x, y


def _label(flight: Flight, pair: tuple[int, int], lane: int, y: str) -> dict[str, Any]:
    sender, receiver = (plotly_text(flight.vehicle_names[k]) for k in pair)
    return {
        "type": "scatter",
        "mode": "text",
        "x": [0.0],
        "y": [lane + LABEL],
        "text": [f" {sender} → {receiver}: {lane_words(flight, pair)}"],
        "textposition": "middle right",
        "textfont": {"size": 11},
        "yaxis": y,
        "showlegend": False,
        "hoverinfo": "skip",
        "cliponaxis": False,
    }
