"""A ROS 2 bag in MCAP, for Foxglove, RViz and `ros2 bag`: poses, paths, transforms, markers, diagnostics.

Axes are those of ROS: x east, y north, z up in the frame `map`; x ahead, y to port, z up aboard. Time is that of the
mission, from 0. The believed pose has the true depth and heading, for a log has no others.

Source: REP 103 (units and axes); MCAP's registry of profiles, `ros2`.
"""

import io
import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from cardume.errors import InputError
from cardume.missions.exports.ros_markers import markers_at
from cardume.missions.exports.ros_values import header, place, turned, vector
from cardume.missions.log import VARIABLES
from cardume.simulation.flight import CHANNELS, Flight

MAP = "map"
TYPES = {
    "pose": "geometry_msgs/msg/PoseStamped",
    "path": "nav_msgs/msg/Path",
    "tf": "tf2_msgs/msg/TFMessage",
    "markers": "visualization_msgs/msg/MarkerArray",
    "diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}


def mcap_of(flight: Flight) -> bytes:
    """The flight as a bag: /tf, /markers, /diagnostics, for each vehicle /NAME/pose, /NAME/pose_estimate, /NAME/path.

    Args:
        flight: what was flown.

    Raises:
        InputError: the libraries are not installed.
    """
    try:
        from mcap_ros2.writer import Writer
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError:
        raise InputError("MCAP needs mcap-ros2-support and rosbags: pip install 'cardume[ros]'") from None
    out, store = io.BytesIO(), get_typestore(Stores.ROS2_HUMBLE)
    writer = Writer(out)
    schemas = {
        name: writer.register_msgdef(kind, store.generate_msgdef(kind, ros_version=2)[0])
        for name, kind in TYPES.items()
    }
    topics = topics_of(flight.vehicle_names)
    for row, time in enumerate(flight.times):
        stamp = round(float(time) * 1e9)
        for topic, kind, message in _messages(flight, topics, row):
            writer.write_message(topic, schemas[kind], message, stamp, stamp, row)
    writer.finish()
    return out.getvalue()


def topics_of(names: tuple[str, ...]) -> dict[str, str]:
    """Names of vehicles as ROS takes them: letters, digits and _, not beginning with a digit, none twice.

    Args:
        names: of the vehicles.
    """
    topics: dict[str, str] = {}
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        plain = re.sub(r"_+", "_", plain).strip("_") or "vehicle"
        plain = f"v{plain}" if plain[0].isdigit() else plain
        taken, number = set(topics.values()), 2
        unique = plain
        while unique in taken:
            unique, number = f"{plain}_{number}", number + 1
        topics[name] = unique
    return topics


def _messages(flight: Flight, topics: Mapping[str, str], row: int) -> list[tuple[str, str, dict[str, Any]]]:
    """All messages of one record: topic, kind, contents."""
    time = float(flight.times[row])
    found: list[tuple[str, str, dict[str, Any]]] = []
    transforms, statuses = [], []
    for k, name in enumerate(flight.vehicle_names):
        now = {channel: float(flight.channels[channel][row, k]) for channel in CHANNELS}
        topic = topics[name]
        if row == 0:
            found.append((f"/{topic}/path", "path", _path(flight, k)))
        pose = place(now["north"], now["east"], now["depth"], now["heading"])
        believed = place(now["north_estimate"], now["east_estimate"], now["depth"], now["heading"])
        found.append((f"/{topic}/pose", "pose", {"header": header(time, MAP), "pose": pose}))
        if math.isfinite(now["north_estimate"]):
            found.append((f"/{topic}/pose_estimate", "pose", {"header": header(time, MAP), "pose": believed}))
        transforms.append(
            {
                "header": header(time, MAP),
                "child_frame_id": topic,
                "transform": {"translation": pose["position"], "rotation": pose["orientation"]},
            }
        )
        statuses.append(_status(name, now))
    found.append(("/tf", "tf", {"transforms": transforms}))
    found.append(("/markers", "markers", {"markers": markers_at(flight, row, MAP)}))
    found.append(("/diagnostics", "diagnostics", {"header": header(time, ""), "status": statuses}))
    return found


def _path(flight: Flight, vehicle: int) -> dict[str, Any]:
    """The path that a vehicle was to follow, at the depth that it kept most of the time."""
    line, depths = flight.own_paths[vehicle], flight.channels["depth"][:, vehicle]
    depth = float(np.nanmedian(depths)) if np.isfinite(depths).any() else 0.0
    poses = [
        {"header": header(0.0, MAP), "pose": {"position": vector(east, north, -depth), "orientation": turned(0.0)}}
        for north, east in line.tolist()
    ]
    return {"header": header(0.0, MAP), "poses": poses}


def _status(name: str, now: Mapping[str, float]) -> dict[str, Any]:
    """Every channel of the log as text, to the last bit; the unit in the key."""
    values = [{"key": f"{channel} [{VARIABLES[channel].units}]", "value": repr(now[channel])} for channel in CHANNELS]
    said = f"cross-track {now['cross_track']:.2f} m"
    return {"level": 0, "name": name, "message": said, "hardware_id": name, "values": values}
