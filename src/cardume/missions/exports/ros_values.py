"""Small records of ROS messages, from north, east and down."""

import math
from typing import Any


def header(time: float, frame: str) -> dict[str, Any]:
    """A header.

    Args:
        time: [s] of the mission.
        frame: in which the contents are given.
    """
    return {"stamp": stamp(time), "frame_id": frame}


def stamp(time: float) -> dict[str, int]:
    """A time in whole seconds and nanoseconds.

    Args:
        time: [s]
    """
    nanoseconds = round(time * 1e9)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def vector(x: float, y: float, z: float) -> dict[str, float]:
    """A point or a vector."""
    return {"x": x, "y": y, "z": z}


def turned(yaw: float) -> dict[str, float]:
    """A turn about the upward axis.

    Args:
        yaw: [rad] counterclockwise from x, which is east.
    """
    return {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2.0), "w": math.cos(yaw / 2.0)}


def place(north: float, east: float, depth: float, heading: float) -> dict[str, Any]:
    """A pose.

    Args:
        north: [m]
        east: [m]
        depth: [m] below the surface.
        heading: [rad] clockwise from north.
    """
    return {"position": vector(east, north, -depth), "orientation": turned(math.pi / 2.0 - heading)}
