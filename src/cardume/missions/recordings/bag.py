"""Bags of ROS 1 and ROS 2: which topics say what is told by `--topic ROLE=/topic`.

fix, truth    NavSatFix, PoseWithCovarianceStamped, PoseStamped, PointStamped, Odometry
heading       Imu, QuaternionStamped, PoseStamped, PoseWithCovarianceStamped, Odometry
velocity      TwistStamped, TwistWithCovarianceStamped, Odometry: through the water, in axes of the vehicle
depth         Float64, Float32, PointStamped and poses (z up), FluidPressure

Axes are those of ROS: x east, y north, z up in the world; x ahead, y to port aboard. A message was true at the stamp
of its header, and heard when the bag has it.

Source: REP 103 (units and axes), REP 145 (Imu).
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from cardume.errors import DataError, InputError
from cardume.missions.geodesy import GeoPoint, to_local
from cardume.missions.recordings.base import Options, Recorded, Recording, Sighted, stream_of
from cardume.units import nearest, printable

AIR_PRESSURE = 101_325.0  # [Pa]
WEIGHT = 1025.0 * 9.81  # [N/m^3] of sea water
CLOCKS_APART = 60.0  # [s] between the stamp of a message and the bag's, from which they are clocks of different worlds
PLACES = ("NavSatFix", "PoseWithCovarianceStamped", "PoseStamped", "PointStamped", "Odometry")
ROLES = {
    "fix": PLACES,
    "truth": PLACES,
    "heading": ("Imu", "QuaternionStamped", "PoseStamped", "PoseWithCovarianceStamped", "Odometry"),
    "velocity": ("TwistStamped", "TwistWithCovarianceStamped", "Odometry"),
    "depth": (
        "Float64",
        "Float32",
        "FluidPressure",
        "PointStamped",
        "PoseStamped",
        "PoseWithCovarianceStamped",
        "Odometry",
    ),
}


class Spot(NamedTuple):
    """A position in a message."""

    east: float  # [m], or longitude [rad]
    north: float  # [m], or latitude [rad]
    north_variance: float  # [m^2]
    covariance: float  # [m^2]
    east_variance: float  # [m^2]
    is_geographic: bool


def read(path: Path, options: Options) -> Recording:
    """A bag.

    Args:
        path: of a .bag, an .mcap, or the directory of a ROS 2 bag.
        options: with the topics.

    Raises:
        DataError: damaged, or without a topic that is named.
        InputError: the library is not installed, or no topic is named; then it says which there are.
    """
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError:
        raise InputError("bags are read by rosbags: pip install 'cardume[ros]'") from None
    name = printable(str(path))
    messages: list[tuple[str, int, Any]] = []
    notes, roles, kinds = list[str](), dict[str, list[str]](), dict[str, str]()
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            kinds = {c.topic: c.msgtype.split("/")[-1] for c in reader.connections}
            roles = _roles(options, kinds, name)
            for connection, stamp, raw in reader.messages([c for c in reader.connections if c.topic in roles]):
                messages.append((connection.topic, stamp, reader.deserialize(raw, connection.msgtype)))
    except InputError:
        raise
    except Exception as problem:  # the library tells a damaged file in many ways
        what = printable(f"{type(problem).__name__}: {problem}")[:160]
        if not messages:
            raise DataError(
                f"{name} cannot be read as a bag ({what}); give a .bag, an .mcap or the folder of a ROS 2 bag. One that"
                " was cut off is mended by rosbag reindex, ros2 bag reindex or mcap recover"
            ) from None
        notes.append(f"the bag is damaged after {len(messages)} messages ({what}); what stands before it was read")
    return _recording(messages, roles, kinds, name, notes)


def _roles(options: Options, kinds: dict[str, str], name: str) -> dict[str, list[str]]:
    """Of each topic that is named, the roles it plays."""
    roles: dict[str, list[str]] = {}
    for role, topic in options.topics:
        if role not in ROLES:
            raise InputError(
                f"--topic {printable(role)}=: no such role{nearest(role, list(ROLES)) or '.'} Valid: {', '.join(ROLES)}"
            )
        if topic not in kinds:
            raise InputError(
                f"--topic {role}={printable(topic)}: {name} has no such topic{nearest(topic, list(kinds)) or '.'}"
                f" {_there(kinds)}"
            )
        if kinds[topic] not in ROLES[role]:
            raise InputError(
                f"--topic {role}={topic}: is {kinds[topic]}; as {role} these are read: {', '.join(ROLES[role])}"
            )
        roles.setdefault(topic, []).append(role)
    if not any("fix" in found for found in roles.values()):
        raise InputError(f"{name}: say which topic holds fixes, with --topic fix=/...; {_there(kinds)}")
    return roles


def _there(kinds: dict[str, str]) -> str:
    """What a bag has, those that could be used first."""
    usable = {kind for kinds_of in ROLES.values() for kind in kinds_of}
    found = sorted(kinds, key=lambda topic: (kinds[topic] not in usable, topic))
    return "It has " + (", ".join(f"{topic} ({kinds[topic]})" for topic in found[:20]) or "no topics")


def _recording(
    messages: list[tuple[str, int, Any]],
    roles: dict[str, list[str]],
    kinds: dict[str, str],
    name: str,
    notes: list[str],
) -> Recording:
    if not messages:
        raise DataError(f"{name} has no message on {', '.join(roles)}")
    stamps = [stamp for _, stamp, _ in messages]
    times = [_stamp(message, stamp) for _, stamp, message in messages]
    apart = sorted(abs(time - stamp) for time, stamp in zip(times, stamps, strict=True))[len(times) // 2] * 1e-9
    if apart > CLOCKS_APART:
        notes.append(
            f"stamps of headers are {apart:.0f} s from those of the bag: messages are taken to be heard when they were"
            " true"
        )
    zero = min(times) if apart > CLOCKS_APART else min([*times, *stamps])
    rows: dict[str, list[tuple[float, ...]]] = {"heading": [], "velocity": [], "depth": []}
    spots: dict[str, list[tuple[float, float, str, Spot]]] = {"fix": [], "truth": []}
    for (topic, stamp, message), true in zip(messages, times, strict=True):
        valid = (true - zero) * 1e-9
        heard = valid if apart > CLOCKS_APART else max(valid, (stamp - zero) * 1e-9)
        for role in roles[topic]:
            if role in spots:
                spots[role] += [(heard, valid, topic, spot) for spot in _spots(message, kinds[topic])]
            else:
                rows[role] += [(valid, *values) for values in READ[role](message, kinds[topic])]
    origin = next((GeoPoint(s.north, s.east) for r in ("fix", "truth") for *_, s in spots[r] if s.is_geographic), None)
    sighted = [Sighted(heard, valid, topic, *_local(spot, origin)) for heard, valid, topic, spot in spots["fix"]]
    truth = [(valid, *_local(spot, origin)[:2]) for _, valid, _, spot in spots["truth"]]
    vehicle = Recorded(
        name="vehicle",
        attitude=stream_of(rows["heading"], 2),
        velocity=stream_of(rows["velocity"], 2),
        depth=stream_of(rows["depth"], 1),
        sighted=tuple(sorted(sighted)),
        truth=stream_of(truth, 2),
    )
    return Recording(kind="bag", vehicles=(vehicle,), origin=origin, notes=tuple(notes))


def _stamp(message: Any, otherwise: int) -> int:
    """[ns] of a message's header; of one without, or with none in it, the bag's."""
    header = getattr(message, "header", None)
    if header is None:
        return otherwise
    return int(header.stamp.sec) * 10**9 + int(header.stamp.nanosec) or otherwise


def _local(spot: Spot, origin: GeoPoint | None) -> tuple[float, float, float, float, float]:
    north, east = spot.north, spot.east
    if spot.is_geographic and origin is not None:
        local = to_local(north, east, origin)
        north, east = float(local[0]), float(local[1])
    return north, east, spot.north_variance, spot.covariance, spot.east_variance


# ---- messages --------------------------------------------------------------------------------------------------------


def _pose(message: Any, kind: str) -> Any:
    """Position and orientation of a message that has a pose."""
    return message.pose.pose if kind in ("PoseWithCovarianceStamped", "Odometry") else message.pose


def _spots(message: Any, kind: str) -> Iterator[Spot]:
    if kind == "NavSatFix":
        latitude, longitude, c = float(message.latitude), float(message.longitude), message.position_covariance
        is_told = int(message.position_covariance_type) > 0
        if int(message.status.status) >= 0 and math.isfinite(latitude + longitude):
            told = (float(c[4]), float(c[1]), float(c[0])) if is_told else (math.nan,) * 3
            yield Spot(math.radians(longitude), math.radians(latitude), *told, is_geographic=True)
        return
    point = message.point if kind == "PointStamped" else _pose(message, kind).position
    told = (math.nan,) * 3
    if kind in ("PoseWithCovarianceStamped", "Odometry"):
        c = message.pose.covariance
        told = (float(c[7]), float(c[1]), float(c[0])) if float(c[0]) > 0.0 and float(c[7]) > 0.0 else told
    if math.isfinite(float(point.x) + float(point.y)):
        yield Spot(float(point.x), float(point.y), *told, is_geographic=False)


def _heading(message: Any, kind: str) -> Iterator[tuple[float, ...]]:
    if kind == "Imu":
        q, rate = message.orientation, -float(message.angular_velocity.z)
    else:
        q, rate = message.quaternion if kind == "QuaternionStamped" else _pose(message, kind).orientation, math.nan
    x, y, z, w = (float(v) for v in (q.x, q.y, q.z, q.w))
    if abs(x * x + y * y + z * z + w * w - 1.0) < 0.01:
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        yield math.pi / 2.0 - yaw, rate


def _velocity(message: Any, kind: str) -> Iterator[tuple[float, ...]]:
    twist = message.twist if kind == "TwistStamped" else message.twist.twist
    ahead, port = float(twist.linear.x), float(twist.linear.y)
    if math.isfinite(ahead + port):
        yield ahead, -port


def _depth(message: Any, kind: str) -> Iterator[tuple[float, ...]]:
    if kind in ("Float64", "Float32"):
        depth = float(message.data)
    elif kind == "FluidPressure":
        depth = (float(message.fluid_pressure) - AIR_PRESSURE) / WEIGHT
    else:
        depth = -float((message.point if kind == "PointStamped" else _pose(message, kind).position).z)
    if math.isfinite(depth):
        yield (depth,)


READ: dict[str, Callable[[Any, str], Iterator[tuple[float, ...]]]] = {
    "heading": _heading,
    "velocity": _velocity,
    "depth": _depth,
}
