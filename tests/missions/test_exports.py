"""What other programs read in our exports is what was flown."""

import csv
import io
import json
import math
from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import gpxpy
import numpy as np
import pytest
import shapely.geometry
from pyarrow import parquet
from pyproj import Geod

from cardume.cli import main as program
from cardume.missions.exports.from_log import convert_log
from cardume.missions.exports.kml import EXTENSION, SCHEMA
from cardume.missions.exports.ros import mcap_of, topics_of
from cardume.missions.exports.tables import csv_of
from cardume.missions.exports.tracks import moments, tracks_of
from cardume.missions.geodesy import GeoPoint
from cardume.missions.results import choose_destination, write_results
from cardume.simulation.flight import CHANNELS, Flight
from report.runs import HOSTILE
from report.synthetic import make_flight

LATITUDE, LONGITUDE = 36.8, -7.24
ORIGIN = GeoPoint(math.radians(LATITUDE), math.radians(LONGITUDE))
WITH_ORIGIN = f"cardume: 1\nname: figure-5\norigin: {{latitude: {LATITUDE} deg, longitude: {LONGITUDE} deg}}\n"


def flown() -> Flight:
    """A flight in which nobody knows where port is, at first."""
    flight = make_flight(num_rows=36)
    believed = flight.channels["north_estimate"].copy()
    believed[:3, 1] = np.nan
    return replace(flight, channels={**flight.channels, "north_estimate": believed})


FLIGHT = flown()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a run whose mission has an origin."""
    mission: Any = SimpleNamespace(name="figure-5", duration=700.0, require=(), to_yaml=lambda directory: WITH_ORIGIN)
    folder = tmp_path_factory.mktemp("exports") / "run"
    return write_results(choose_destination("figure-5", folder), mission, FLIGHT, version="1.2.3")[0]


@pytest.fixture
def converted(run: Path, tmp_path: Path) -> Callable[..., bytes]:
    """What `cardume convert` makes of the run."""

    def convert(ending: str, *options: str) -> bytes:
        target = tmp_path / f"out.{ending}"
        with pytest.raises(SystemExit) as left:
            program.main(["convert", str(run), str(target), "-q", *options])
        assert left.value.code == 0
        return target.read_bytes()

    return convert


def local(latitude: Any, longitude: Any) -> tuple[np.ndarray, np.ndarray]:
    """North and east [m] of places, by the geodesic back from them."""
    start = np.full(len(latitude), LONGITUDE), np.full(len(latitude), LATITUDE)
    azimuth, _, distance = Geod(ellps="WGS84").inv(*start, longitude, latitude)
    return distance * np.cos(np.radians(azimuth)), distance * np.sin(np.radians(azimuth))


def wanted(vehicle: str, kind: str) -> tuple[np.ndarray, ...]:
    """Times, north, east and depth where all are known."""
    k, ending = FLIGHT.vehicle_names.index(vehicle), {"true": "", "believed": "_estimate"}[kind]
    columns = [FLIGHT.channels[name][:, k] for name in (f"north{ending}", f"east{ending}", "depth")]
    known = np.isfinite(columns).all(axis=0)
    return FLIGHT.times[known], *(column[known] for column in columns)


def same_places(latitude: Any, longitude: Any, height: Any, vehicle: str, kind: str) -> None:
    _, north, east, depth = wanted(vehicle, kind)
    found = local(np.array(latitude, float), np.array(longitude, float))
    np.testing.assert_allclose(found[0], north, atol=2e-4)  # nine digits of a degree are 0.1 mm
    np.testing.assert_allclose(found[1], east, atol=2e-4)
    np.testing.assert_allclose(np.array(height, float), -depth, atol=6e-4)


def test_gpx_as_gpxpy_reads_it(converted: Callable[..., bytes]) -> None:
    gpx = gpxpy.parse(converted("gpx").decode())
    assert [(track.name, track.type) for track in gpx.tracks] == [
        (name, kind) for name in FLIGHT.vehicle_names for kind in ("true", "believed")
    ]
    for track in gpx.tracks:
        points = track.segments[0].points
        same_places(
            *zip(*((p.latitude, p.longitude, p.elevation) for p in points), strict=True), track.name, track.type
        )
        times = np.array([point.time.timestamp() for point in points])
        np.testing.assert_allclose(times, wanted(track.name, track.type)[0], atol=6e-4)
    assert len(gpx.tracks[3].segments[0].points) == len(FLIGHT.times) - 3  # where port did not know, there is nothing


def test_geojson_as_shapely_reads_it(converted: Callable[..., bytes]) -> None:
    features = json.loads(converted("geojson"))["features"]
    assert len(features) == 6
    for feature in features:
        line, about = shapely.geometry.shape(feature["geometry"]), feature["properties"]
        longitude, latitude, height = np.array(line.coords).T
        same_places(latitude, longitude, height, about["vehicle"], about["kind"])
        np.testing.assert_allclose(about["times"], wanted(about["vehicle"], about["kind"])[0], atol=1e-6)
        assert line.is_valid


def test_kml_tracks_have_a_moment_for_each_place(converted: Callable[..., bytes]) -> None:
    root = ElementTree.fromstring(converted("kml"))
    marks = root.findall(f"{{{SCHEMA}}}Document/{{{SCHEMA}}}Placemark")
    assert [mark.findtext(f"{{{SCHEMA}}}name") for mark in marks][:2] == ["surface", "surface (believed)"]
    for mark, track in zip(marks, tracks_of(FLIGHT, ORIGIN), strict=True):
        coords = [c.text.split() for c in mark.iter(f"{{{EXTENSION}}}coord") if c.text]
        longitude, latitude, height = np.array(coords, float).T
        same_places(latitude, longitude, height, track.vehicle, track.kind)
        assert [when.text for when in mark.iter(f"{{{SCHEMA}}}when")] == moments(track.times)


def test_csv_has_every_channel_to_the_last_bit(converted: Callable[..., bytes]) -> None:
    rows = list(csv.DictReader(io.StringIO(converted("csv").decode())))
    assert len(rows) == len(FLIGHT.times) * 3
    for k, name in enumerate(FLIGHT.vehicle_names):
        own = [row for row in rows if row["vehicle"] == name]
        assert [float(row["time"]) for row in own] == FLIGHT.times.tolist()
        for channel in CHANNELS:
            found = np.array([float(row[channel] or "nan") for row in own])
            np.testing.assert_array_equal(found, FLIGHT.channels[channel][:, k], err_msg=channel)
        places = [[float(row[f"{what}_deg"]) for row in own] for what in ("latitude", "longitude")]
        found_north, _ = local(*map(np.array, places))
        np.testing.assert_allclose(found_north, FLIGHT.channels["north"][:, k], atol=1e-6)
    assert b"latitude_deg" not in csv_of(FLIGHT)


def test_parquet_says_the_units_too(converted: Callable[..., bytes]) -> None:
    table = parquet.read_table(io.BytesIO(converted("parquet")))
    for channel in CHANNELS:
        found = np.array(table[channel].to_pylist(), float).reshape(-1, 3)
        np.testing.assert_array_equal(found, FLIGHT.channels[channel], err_msg=channel)
    assert table.schema.field("yaw_rate").metadata[b"units"] == b"rad/s"
    assert table["vehicle"].to_pylist()[:3] == list(FLIGHT.vehicle_names)


def read_by_mcap(path: Path) -> dict[str, list[tuple[int, Any]]]:
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    found = defaultdict(list)
    with path.open("rb") as file:
        for _, channel, message, contents in make_reader(
            file, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages():
            found[channel.topic].append((message.log_time, contents))
    return found


def read_by_rosbags(path: Path) -> dict[str, list[tuple[int, Any]]]:
    from rosbags.rosbag2 import Reader
    from rosbags.typesys import Stores, get_typestore

    found, store = defaultdict(list), get_typestore(Stores.ROS2_HUMBLE)
    with Reader(path) as reader:
        for connection, time, raw in reader.messages():
            found[connection.topic].append((time, store.deserialize_cdr(raw, connection.msgtype)))
    return found


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The flight as a bag."""
    path = tmp_path_factory.mktemp("bag") / "out.mcap"
    path.write_bytes(mcap_of(FLIGHT))
    return path


@pytest.mark.parametrize("read", [read_by_mcap, read_by_rosbags])
def test_a_bag_as_two_readers_read_it(bag: Path, read: Callable[[Path], Any]) -> None:
    found = read(bag)
    for k, name in enumerate(FLIGHT.vehicle_names):
        for topic, ending in (("pose", ""), ("pose_estimate", "_estimate")):
            rows = np.flatnonzero(np.isfinite(FLIGHT.channels[f"north{ending}"][:, k]))
            messages = found[f"/{name}/{topic}"]
            assert [time for time, _ in messages] == [round(t * 1e9) for t in FLIGHT.times[rows]]
            for row, (_, message) in zip(rows, messages, strict=True):
                stamp, position = message.header.stamp, message.pose.position
                assert stamp.sec + 1e-9 * stamp.nanosec == pytest.approx(FLIGHT.times[row], abs=1e-9)
                assert position.x == FLIGHT.channels[f"east{ending}"][row, k]  # ROS: x east, y north, z up
                assert position.y == FLIGHT.channels[f"north{ending}"][row, k]
                assert position.z == -FLIGHT.channels["depth"][row, k]
                turn = message.pose.orientation
                yaw = 2.0 * math.atan2(turn.z, turn.w)
                heading = FLIGHT.channels["heading"][row, k]
                assert math.cos(yaw) == pytest.approx(math.sin(heading), abs=1e-12)  # counterclockwise from east
                assert math.sin(yaw) == pytest.approx(math.cos(heading), abs=1e-12)
        path = found[f"/{name}/path"][0][1]
        line = np.array([[pose.pose.position.y, pose.pose.position.x] for pose in path.poses])
        np.testing.assert_array_equal(line, FLIGHT.own_paths[k])
    last = found["/diagnostics"][-1][1].status[2]
    values = {entry.key: float(entry.value) for entry in last.values}
    assert last.name == "starboard"
    assert values["cross_track [m]"] == FLIGHT.channels["cross_track"][-1, 2]
    transform = found["/tf"][5][1].transforms[0]
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "surface")
    assert transform.transform.translation.x == FLIGHT.channels["east"][5, 0]
    ends = [len(m.points) for _, array in found["/markers"] for m in array.markers if m.ns.startswith("messages")]
    assert sum(ends) == 2 * int(np.sum(FLIGHT.messages["time_sent"] <= FLIGHT.times[-1]))


def test_names_become_topics() -> None:
    assert topics_of(("a-b", "a_b", "3rd", "!", "ok")) == {
        "a-b": "a_b",
        "a_b": "a_b_2",
        "3rd": "v3rd",
        "!": "vehicle",
        "ok": "ok",
    }


def test_markup_in_names_stays_text(tmp_path: Path) -> None:
    from cardume.missions.exports.gpx import gpx_of
    from cardume.missions.exports.kml import kml_of

    hostile = make_flight(num_rows=3, names=(*HOSTILE[:2], "control\x00\x1b"))
    tracks = tracks_of(hostile, ORIGIN)
    assert gpxpy.parse(gpx_of(tracks, HOSTILE[0]).decode()).tracks[0].name == HOSTILE[0]
    names = [e.text for e in ElementTree.fromstring(kml_of(tracks, HOSTILE[0])).iter(f"{{{SCHEMA}}}name")]
    assert names[:2] == [HOSTILE[0], HOSTILE[0]]
    assert "control\\x00\\x1b" in names


def test_one_vehicle_alone(converted: Callable[..., bytes]) -> None:
    features = json.loads(converted("geojson", "--vehicle", "port"))["features"]
    assert {feature["properties"]["vehicle"] for feature in features} == {"port"}


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (
            ["out.plan"],
            "no way from log to plan; from log there are csv, geojson, gpx, kml, mcap, parquet, rrd",
        ),
        (["out.gpx", "--vehicle", "prot"], "--vehicle prot: no such vehicle"),
    ],
)
def test_what_cannot_be_is_refused(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], complaint: str
) -> None:
    with pytest.raises(SystemExit) as left:
        program.main(["convert", str(run), str(tmp_path / options[0]), *options[1:]])
    assert left.value.code == 2
    assert complaint in " ".join(capsys.readouterr().err.split())


def test_without_an_origin_tracks_are_refused_and_tables_are_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from report.runs import kept_run

    bare = kept_run(tmp_path / "run", make_flight(num_rows=5))
    for ending, code in (("kml", 2), ("csv", 0)):
        with pytest.raises(SystemExit) as left:
            program.main(["convert", str(bare / "log.nc"), str(tmp_path / f"out.{ending}"), "-q"])
        assert left.value.code == code
    assert "--origin LATITUDE,LONGITUDE" in capsys.readouterr().err


def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch, run: Path) -> None:
    import sys

    from cardume.errors import InputError
    from cardume.missions.converting import Request

    needed = {"parquet": ("pyarrow", "parquet"), "mcap": ("mcap_ros2.writer", "ros"), "rrd": ("rerun", "rerun")}
    for kind, (module, extra) in needed.items():
        monkeypatch.setitem(sys.modules, module, None)
        with pytest.raises(InputError, match=rf"pip install 'cardume\[{extra}\]'"):
            convert_log(Request(source=str(run), target=Path(f"out.{kind}"), target_kind=kind))
