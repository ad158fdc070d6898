"""The messages figure: who spoke to whom and when, and what was lost."""

import math
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.simulation.flight import Flight

LANE, TOP, BOTTOM, LEFT, RIGHT = 0.36, 0.3, 0.45, 0.2, 0.15  # [inch]
TALL, BASE = 0.24, 0.62  # [lane] of a tick, and where it stands
MOST_LANES = 30


def draw_messages(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the messages of a flight over the time of their sending, one lane for each sender and receiver.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    flight = as_flight(log)
    lanes = links(flight)[:MOST_LANES]
    with style.styled():
        height = TOP + BOTTOM + LANE * max(1, len(lanes))
        figure = style.new_figure(width, height)
        inner, tall = width - LEFT - RIGHT, height - TOP - BOTTOM
        axes = figure.add_axes((LEFT / width, BOTTOM / height, inner / width, tall / height))
        first, last = (flight.times[0], flight.times[-1]) if len(flight.times) else (0.0, 1.0)
        axes.set_xlim(first, max(last, first + 1e-9))
        axes.set_ylim(max(1, len(lanes)), 0)
        axes.set_yticks([])
        axes.spines["left"].set_visible(False)
        axes.set_xlabel("time [s]")
        axes.set_title("tick up: delivered; tick down: lost", fontsize=7, loc="left", pad=4)
        for lane, pair in enumerate(lanes):
            _draw_lane(axes, flight, pair, lane)
        if not lanes:
            axes.text(0.5, 0.5, "no messages", transform=axes.transAxes, ha="center", va="center")
        return figure


def links(flight: Flight) -> list[tuple[int, int]]:
    """Who spoke to whom, by place in the fleet, in the fleet's order.

    Args:
        flight: what was flown.
    """
    pairs = zip(flight.messages["sender"], flight.messages["receiver"], strict=True)
    return sorted({(int(sender), int(receiver)) for sender, receiver in pairs})


def lane_words(flight: Flight, pair: tuple[int, int]) -> str:
    """How many messages of a lane arrived, and how late.

    Args:
        flight: what was flown.
        pair: sender and receiver, by place in the fleet.
    """
    table = {name: np.asarray(values, float) for name, values in flight.messages.items()}
    here = (table["sender"] == pair[0]) & (table["receiver"] == pair[1])
    lost = table["lost"][here] > 0.5
    delay = (table["time_received"] - table["time_sent"])[here][~lost]
    late = float(np.mean(delay)) if delay.size else math.nan
    said = f", {late:.2g} s on the way" if math.isfinite(late) else ""
    return f"{np.sum(~lost)} of {len(lost)} arrived{said}"


def _draw_lane(axes: Any, flight: Flight, pair: tuple[int, int], lane: int) -> None:
    sender, receiver = (style.shortened(flight.vehicle_names[k]) for k in pair)
    here = (np.asarray(flight.messages["sender"]) == pair[0]) & (np.asarray(flight.messages["receiver"]) == pair[1])
    lost = here & (np.asarray(flight.messages["lost"], float) > 0.5)
    for mask, direction, how in ((here & ~lost, -TALL, {"lw": 0.4}), (lost, TALL, {"lw": 0.8})):
        times = np.asarray(flight.messages["time_sent"], float)[mask]
        axes.vlines(times, lane + BASE, lane + BASE + direction, color=style.color(pair[0]), **how)
    words = f"{sender} → {receiver}: {lane_words(flight, pair)}"
    axes.text(0.0, lane + 0.3, words, transform=axes.get_yaxis_transform(), fontsize=7, va="bottom")
