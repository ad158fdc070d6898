"""Markers of a ROS viewer: vehicles as arrows with their names, believed positions, messages as lines."""

import math
from typing import Any

import numpy as np

from cardume.missions.exports.ros_values import header, place, turned, vector
from cardume.simulation.flight import Flight

ARROW, SPHERE, LINES, TEXT = 0, 2, 5, 9  # visualization_msgs/Marker
# Okabe and Ito (2008), 0 to 1
COLORS = ((0.0, 0.45, 0.70), (0.84, 0.37, 0.0), (0.0, 0.62, 0.45), (0.80, 0.47, 0.65), (0.90, 0.62, 0.0))
DELIVERED, LOST = (0.6, 0.6, 0.6), (0.84, 0.0, 0.0)


def markers_at(flight: Flight, row: int, frame: str) -> list[dict[str, Any]]:
    """What a viewer draws at one record of the log.

    Args:
        flight: what was flown.
        row: of the log.
        frame: in which markers are placed.
    """
    time, markers = float(flight.times[row]), []
    for k, name in enumerate(flight.vehicle_names):
        north, east, depth, heading, north_estimate, east_estimate = (
            float(flight.channels[channel][row, k])
            for channel in ("north", "east", "depth", "heading", "north_estimate", "east_estimate")
        )
        color = COLORS[k % len(COLORS)]
        pose = place(north, east, depth, heading)
        markers.append(_marker((time, frame, "vehicles", k), ARROW, pose, (2.0, 0.5, 0.5), color))
        above = {**pose, "position": vector(east, north, 1.5 - depth)}
        markers.append(_marker((time, frame, "names", k), TEXT, above, (0.0, 0.0, 1.0), color, text=name))
        if math.isfinite(north_estimate) and math.isfinite(east_estimate):
            believed = place(north_estimate, east_estimate, depth, heading)
            markers.append(_marker((time, frame, "believed", k), SPHERE, believed, (0.8, 0.8, 0.8), color, alpha=0.4))
    for number, (kind, color) in enumerate((("delivered", DELIVERED), ("lost", LOST))):
        still = {"position": vector(0.0, 0.0, 0.0), "orientation": turned(0.0)}
        ends = _message_ends(flight, row, is_lost=kind == "lost")
        lines = _marker((time, frame, f"messages {kind}", number), LINES, still, (0.12, 0.0, 0.0), color)
        markers.append(lines | {"points": ends})
    return markers


def _message_ends(flight: Flight, row: int, is_lost: bool) -> list[dict[str, float]]:
    """Sender and receiver, in turn, of the messages sent since the record before."""
    since = flight.times[row - 1] if row else -np.inf
    sent, lost = np.asarray(flight.messages["time_sent"]), np.asarray(flight.messages["lost"]) > 0.5
    chosen = np.flatnonzero((sent > since) & (sent <= flight.times[row]) & (lost == is_lost))
    ends = []
    for message in chosen:
        for end in ("sender", "receiver"):
            k = int(flight.messages[end][message])
            north, east, depth = (float(flight.channels[channel][row, k]) for channel in ("north", "east", "depth"))
            ends.append(vector(east, north, -depth))
    return ends


def _marker(
    key: tuple[float, str, str, int],
    kind: int,
    pose: dict[str, Any],
    scale: tuple[float, float, float],
    color: tuple[float, float, float],
    **other: Any,
) -> dict[str, Any]:
    """A marker; what is not said here is zero or empty in the message."""
    time, frame, space, number = key
    red, green, blue = color
    return {
        "header": header(time, frame),
        "ns": space,
        "id": number,
        "type": kind,
        "action": 0,
        "pose": pose,
        "scale": vector(*scale),
        "color": {"r": red, "g": green, "b": blue, "a": other.get("alpha", 1.0)},
        "text": other.get("text", ""),
    }
