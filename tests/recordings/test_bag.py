"""Bags written by rosbags itself, ROS 1 and ROS 2, and by another library: the flight's own track comes back."""

import math
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer as Writer2
from rosbags.typesys import Stores, get_typestore

from cardume.errors import DataError, InputError
from cardume.missions.exports.ros import mcap_of
from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.missions.recordings.asking import Request, read_start
from cardume.missions.recordings.base import Options
from cardume.missions.recordings.replaying import replay
from recordings.flown import apart, surface

ROLES = (("fix", "/fix"), ("heading", "/imu"), ("velocity", "/dvl"), ("truth", "/truth"))
BEGAN = 1_700_000_000 * 10**9  # [ns]
ORIGIN = GeoPoint(math.radians(38.7), math.radians(-9.1))


class Pen:
    """Writes the surface vehicle's readings with the messages of one generation of ROS."""

    def __init__(self, store, is_first: bool) -> None:
        self.store, self.types, self.is_first, self.count = store, store.types, is_first, 0

    def header(self, stamp: int):
        self.count += 1
        time = self.types["builtin_interfaces/msg/Time"](sec=stamp // 10**9, nanosec=stamp % 10**9)
        sequence = {"seq": self.count} if self.is_first else {}
        return self.types["std_msgs/msg/Header"](**sequence, stamp=time, frame_id="map")

    def pose(self, stamp: int, north: float, east: float, variance: float):
        t, covariance = self.types, np.zeros(36)
        covariance[[0, 7]] = variance
        pose = t["geometry_msgs/msg/Pose"](
            position=t["geometry_msgs/msg/Point"](x=east, y=north, z=0.0),
            orientation=t["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0),
        )
        whole = t["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=covariance)
        return t["geometry_msgs/msg/PoseWithCovarianceStamped"](header=self.header(stamp), pose=whole)

    def imu(self, stamp: int, heading: float, yaw_rate: float):
        t, half = self.types, 0.5 * (math.pi / 2.0 - heading)
        vector = t["geometry_msgs/msg/Vector3"]
        return t["sensor_msgs/msg/Imu"](
            header=self.header(stamp),
            orientation=t["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=math.sin(half), w=math.cos(half)),
            orientation_covariance=np.zeros(9),
            angular_velocity=vector(x=0.0, y=0.0, z=-yaw_rate),
            angular_velocity_covariance=np.zeros(9),
            linear_acceleration=vector(x=0.0, y=0.0, z=9.81),
            linear_acceleration_covariance=np.zeros(9),
        )

    def twist(self, stamp: int, surge: float):
        t, vector = self.types, self.types["geometry_msgs/msg/Vector3"]
        twist = t["geometry_msgs/msg/Twist"](linear=vector(x=surge, y=0.0, z=0.0), angular=vector(x=0.0, y=0.0, z=0.0))
        return t["geometry_msgs/msg/TwistStamped"](header=self.header(stamp), twist=twist)

    def satellite(self, stamp: int, north: float, east: float, variance: float):
        t, (latitude, longitude) = self.types, to_geographic(north, east, ORIGIN)
        return t["sensor_msgs/msg/NavSatFix"](
            header=self.header(stamp),
            status=t["sensor_msgs/msg/NavSatStatus"](status=0, service=1),
            latitude=math.degrees(float(latitude)),
            longitude=math.degrees(float(longitude)),
            altitude=0.0,
            position_covariance=variance * np.eye(3).ravel(),
            position_covariance_type=2,
        )


def write(path: Path, generation: int, with_satellite: bool = False) -> Path:
    """The surface vehicle's readings as a bag."""
    store = get_typestore(Stores.ROS1_NOETIC if generation == 1 else Stores.ROS2_HUMBLE)
    writer = Writer1(path) if generation == 1 else Writer2(path, version=9, storage_plugin=StoragePlugin.MCAP)
    serialize = store.serialize_ros1 if generation == 1 else store.serialize_cdr
    pen, flown, truth = Pen(store, generation == 1), surface(), surface().believed.truth
    with writer:
        kinds = {
            "/fix": "sensor_msgs/msg/NavSatFix" if with_satellite else "geometry_msgs/msg/PoseWithCovarianceStamped",
            "/imu": "sensor_msgs/msg/Imu",
            "/dvl": "geometry_msgs/msg/TwistStamped",
            "/truth": "geometry_msgs/msg/PoseWithCovarianceStamped",
        }
        topics = {topic: writer.add_connection(topic, kind, typestore=store) for topic, kind in kinds.items()}
        for k, r in enumerate(flown.readings):
            stamp = BEGAN + round(r.time * 1e9)
            messages = [
                ("/imu", pen.imu(stamp, r.heading, r.yaw_rate)),
                ("/dvl", pen.twist(stamp, r.surge)),
                ("/truth", pen.pose(stamp, *truth[k].tolist(), 0.0)),
            ]
            if math.isfinite(r.north):
                told = stamp - round(r.age * 1e9), r.north, r.east, r.variance
                messages.append(("/fix", pen.satellite(*told) if with_satellite else pen.pose(*told)))
            for topic, message in messages:
                writer.write(topics[topic], stamp, serialize(message, kinds[topic]))
    return path


@pytest.mark.parametrize("generation", [1, 2])
def test_a_flight_in_a_bag_gives_the_flights_own_track(tmp_path: Path, generation: int) -> None:
    flown, path = surface(), write(tmp_path / ("flight.bag" if generation == 1 else "flight"), generation)
    found = replay(Request(path=path, options=Options(topics=ROLES), start=read_start(flown.start)))
    (part,) = found.parts
    assert found.kind == "bag"
    assert part.score.fixes == sum(math.isfinite(r.north) for r in flown.readings)
    assert apart(part.believed, flown.believed) < 1e-7  # quaternions and whole nanoseconds
    assert part.score.position_error_rms < 0.5


def test_satellite_fixes_are_latitudes(tmp_path: Path) -> None:
    flown, path = surface(), write(tmp_path / "flight", 2, with_satellite=True)
    roles = tuple(role for role in ROLES if role[0] != "truth")
    first = next(r for r in flown.readings if math.isfinite(r.north))
    north, east = flown.believed.before[0, :2].tolist()
    start = (north - first.north, east - first.east)  # the axes begin at the first fix
    found = replay(Request(path=path, options=Options(topics=roles), start=start))
    (part,) = found.parts
    size = min(len(part.believed.times), len(flown.believed.times))
    moved = part.believed.position[:size] + [first.north, first.east]
    assert np.hypot(*(moved - flown.believed.position[:size]).T).max() < 1e-3
    assert [math.degrees(x) for x in found.origin] == pytest.approx([38.7, -9.1], abs=1e-3)


def test_a_bag_of_another_library(tmp_path: Path) -> None:
    """Our MCAP of a flight, which mcap-ros2 wrote: believed poses in it taken for fixes, true ones for the truth."""
    path = tmp_path / "flight.mcap"
    path.write_bytes(mcap_of(surface().log.flight))
    topics = (("fix", "/surface/pose_estimate"), ("truth", "/surface/pose"), ("heading", "/surface/pose"))
    (part,) = replay(Request(path=path, options=Options(topics=topics), position={"law": "direct"})).parts
    flight = surface().log.flight
    assert part.score.fixes == len(flight.times)
    rows = np.round(flight.times / 0.1).astype(int)
    assert part.believed.position[rows, 0] == pytest.approx(flight.channels["north_estimate"][:, 0], abs=1e-9)
    assert part.believed.truth[rows, 1] == pytest.approx(flight.channels["east"][:, 0], abs=1e-9)


def test_what_a_bag_has_is_said(tmp_path: Path) -> None:
    path = write(tmp_path / "flight", 2)
    for topics, message in (
        ((), r"say which topic holds fixes, with --topic fix=/...; It has /dvl \(TwistStamped\)"),
        ((("fix", "/fux"),), r"no such topic.*'/fix'"),
        ((("fixes", "/fix"),), r"no such role.*'fix'"),
        ((("fix", "/imu"),), r"is Imu; as fix these are read: NavSatFix"),
    ):
        with pytest.raises(InputError, match=message):
            replay(Request(path=path, options=Options(topics=topics)))


def test_a_bag_that_is_damaged_further_on_gives_what_was_read(tmp_path: Path) -> None:
    path = write(tmp_path / "flight.bag", 1)
    data = bytearray(path.read_bytes())
    place = data.rindex(b"map", 0, len(data) // 2)  # in a header of the first half
    data[place - 4 : place] = (2**31 - 1).to_bytes(4, "little")  # its text is longer than the bag
    path.write_bytes(bytes(data))
    found = replay(Request(path=path, options=Options(topics=ROLES)))
    assert any("damaged after" in note for note in found.notes)
    assert 5 < found.parts[0].score.fixes < 55


def test_what_is_no_bag_is_refused(tmp_path: Path) -> None:
    whole = write(tmp_path / "flight.bag", 1).read_bytes()
    draw, path, said = np.random.default_rng(14), tmp_path / "torn.bag", list[str]()
    for _ in range(25):
        torn = bytearray(whole[: draw.integers(1, len(whole))])
        torn[draw.integers(len(torn))] = draw.integers(256)
        path.write_bytes(bytes(torn))
        try:
            replay(Request(path=path, options=Options(topics=ROLES)))
        except InputError as problem:
            said.append(str(problem))
    assert len(said) > 15
    assert all("torn.bag" in text for text in said)
    assert any("mended by rosbag reindex" in text for text in said)
    (tmp_path / "empty").mkdir()
    with pytest.raises(DataError, match=r"without log\.nc or metadata\.yaml"):
        replay(Request(path=tmp_path / "empty"))
