"""What Rerun reads in our recordings is what was flown."""

import importlib.util
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cardume.cli import main as program
from cardume.missions.exports.rerun import DRIFT, TIMELINE, rrd_of
from cardume.simulation.flight import CHANNELS, Flight
from report.runs import HOSTILE, kept_run
from report.synthetic import make_flight

needs_rerun = pytest.mark.skipif(
    importlib.util.find_spec("rerun") is None,
    reason="rerun-sdk takes 490 MB and is an extra of its own: pip install 'cardume[rerun]'",
)


def flown() -> Flight:
    """A flight in which nobody knows where port is, at first, and the altitude is never known."""
    flight = make_flight(num_rows=36)
    channels = {name: values.copy() for name, values in flight.channels.items()}
    channels["north_estimate"][:3, 1] = np.nan
    channels["altitude"][:] = np.nan
    return replace(flight, channels=channels)


FLIGHT = flown()


class Read:
    """A recording as Rerun's own reader gives it: entities to their tables, timed or still."""

    def __init__(self, path: Path) -> None:
        from rerun.chunk import RrdReader

        reader = RrdReader(str(path))
        assert [entry.kind for entry in (*reader.recordings(), *reader.blueprints())] == ["recording", "blueprint"]
        self.tables: dict[tuple[str, bool], Mapping[str, list[Any]]] = {}
        for chunk in reader.stream().to_chunks():
            key = str(chunk.entity_path), bool(chunk.is_static)
            assert key not in self.tables
            self.tables[key] = chunk.to_record_batch().to_pydict()

    def over_time(self, entity: str, column: str) -> tuple[np.ndarray, np.ndarray]:
        """Times [s] and values of one component."""
        table = self.tables[entity, False]
        times = np.array([np.timedelta64(t, "ns") / np.timedelta64(1, "s") for t in table[TIMELINE]])
        return times, np.array([row[0] for row in table[column]])

    def still(self, entity: str, column: str) -> list[Any]:
        """The only value of one component that does not change."""
        (row,) = self.tables[entity, True][column]
        return list(row)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `cardume convert` makes of a run."""
    folder = tmp_path_factory.mktemp("rerun")
    run, target = kept_run(folder / "run", FLIGHT), folder / "out.rrd"
    with pytest.raises(SystemExit) as left:
        program.main(["convert", str(run / "log.nc"), str(target), "-q"])
    assert left.value.code == 0
    assert sorted(path.name for path in folder.iterdir()) == ["out.rrd", "run"]  # nothing half written beside it
    return target


@needs_rerun
def test_every_channel_to_the_last_bit(recording: Path) -> None:
    read = Read(recording)
    for k, name in enumerate(FLIGHT.vehicle_names):
        for channel in CHANNELS:
            values = FLIGHT.channels[channel][:, k]
            known = np.isfinite(values)
            if not known.any():
                assert (f"/channels/{name}/{channel}", False) not in read.tables
                continue
            times, found = read.over_time(f"/channels/{name}/{channel}", "Scalars:scalars")
            np.testing.assert_allclose(times, FLIGHT.times[known], rtol=0.0, atol=1e-9)
            np.testing.assert_array_equal(found, values[known], err_msg=channel)
    states = FLIGHT.channels["coordination_state"]
    _, found = read.over_time("/channels/coordination_error", "Scalars:scalars")
    np.testing.assert_array_equal(found, states.max(axis=1) - states.min(axis=1))


@needs_rerun
def test_the_sea_is_what_was_flown(recording: Path) -> None:
    import rerun

    read = Read(recording)
    (axes,) = read.still("/world", "ViewCoordinates:xyz")
    names = rerun.components.ViewCoordinates.ViewDir
    assert list(axes) == [names.Forward.value, names.Right.value, names.Down.value]
    for k, name in enumerate(FLIGHT.vehicle_names):
        now = {channel: FLIGHT.channels[channel][:, k] for channel in CHANNELS}
        for kind, ending in (("true", ""), ("believed", "_estimate")):
            places = np.column_stack([now[f"north{ending}"], now[f"east{ending}"], now["depth"]])
            known = np.isfinite(places).all(axis=1)
            assert known.sum() == len(FLIGHT.times) - (3 if (name, kind) == ("port", "believed") else 0)
            bits = np.spacing(np.float32(np.abs(places[known]).max()))  # half a last bit of 32
            times, moved = read.over_time(f"/world/{name}/{kind}", "Transform3D:translation")
            np.testing.assert_allclose(times, FLIGHT.times[known], rtol=0.0, atol=1e-9)
            np.testing.assert_allclose(moved, places[known], rtol=0.0, atol=0.51 * bits)
            _, points = read.over_time(f"/world/{name}/track_{kind}", "Points3D:positions")
            np.testing.assert_array_equal(points, moved)
            x, y, z, w = read.over_time(f"/world/{name}/{kind}", "Transform3D:quaternion")[1].T
            ahead = np.column_stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
            heading = now["heading"][known]
            wanted = np.column_stack([np.cos(heading), np.sin(heading), 0.0 * heading])
            np.testing.assert_allclose(ahead, wanted, atol=1e-6)  # the bow, north and east of the vehicle
            _, arrows = read.over_time(f"/world/{name}/current{ending}", "Arrows3D:vectors")
            flows = np.column_stack([now[f"current_{axis}{ending}"][known] for axis in ("north", "east")])
            np.testing.assert_allclose(arrows[:, :2], DRIFT * flows, atol=1e-6)
        strip = np.array(read.still(f"/world/{name}/path", "LineStrips3D:strips")[0])
        np.testing.assert_allclose(strip[:, :2], FLIGHT.own_paths[k], atol=1e-5)


@needs_rerun
def test_messages_are_lines_of_text(recording: Path) -> None:
    times, texts = Read(recording).over_time("/messages", "TextLog:text")
    np.testing.assert_allclose(times, np.sort(FLIGHT.messages["time_sent"]), rtol=0.0, atol=1e-9)
    assert sum(text.endswith("report, lost") for text in texts) == np.sum(FLIGHT.messages["lost"] > 0.5) > 0
    first = {column: FLIGHT.messages[column][0] for column in ("sender", "receiver")}
    ends = [FLIGHT.vehicle_names[int(first[end])] for end in ("sender", "receiver")]
    assert texts[0].startswith(f"{ends[0]} to {ends[1]}: report, ")


@needs_rerun
def test_what_the_layout_shows_is_in_the_recording_in_the_colors_of_the_tracks(recording: Path) -> None:
    from rerun.chunk import RrdReader

    reader, shown = RrdReader(str(recording)), []
    for chunk in reader.stream(store=reader.blueprints()[0]).to_chunks():
        batch = chunk.to_record_batch()
        shown += [
            row for name in batch.schema.names if name.endswith(":query") for row in batch.column(name).to_pylist()
        ]
    read = Read(recording)
    entities = {entity for entity, _ in read.tables}
    named = [place for rows in shown for place in rows if not place.startswith("$origin")]
    assert len(named) == len(FLIGHT.vehicle_names) + 1
    assert set(named) <= entities
    for name in FLIGHT.vehicle_names:
        assert read.still(f"/channels/{name}/cross_track", "SeriesLines:names") == [name]
        (line,) = read.still(f"/channels/{name}/cross_track", "SeriesLines:colors")
        (arrow,) = read.still(f"/world/{name}/true/shape", "Arrows3D:colors")
        assert line == arrow


@needs_rerun
def test_reruns_own_program_finds_no_fault(recording: Path, tmp_path: Path) -> None:
    hostile = tmp_path / "hostile.rrd"
    hostile.write_bytes(rrd_of(make_flight(num_rows=3, names=(*HOSTILE[:2], "a/b"))))
    tool = [sys.executable, "-m", "rerun", "rrd", "verify", str(recording), str(hostile)]
    done = subprocess.run(tool, capture_output=True, text=True, env=os.environ | {"RERUN": "on"}, check=False)
    assert done.returncode == 0, done.stderr
    assert "2 files verified without error" in done.stdout + done.stderr


@needs_rerun
def test_one_vehicle_has_no_coordination_error(tmp_path: Path) -> None:
    target = tmp_path / "out.rrd"
    run = kept_run(tmp_path / "run", FLIGHT)
    with pytest.raises(SystemExit) as left:
        program.main(["convert", str(run), str(target), "-q", "--vehicle", "port"])
    assert left.value.code == 0
    entities = {entity for entity, _ in Read(target).tables}
    assert "/world/port/true" in entities
    assert not any("surface" in entity or "coordination_error" in entity for entity in entities)


@needs_rerun
def test_switched_off_it_says_so(tmp_path: Path) -> None:
    run = kept_run(tmp_path / "run", make_flight(num_rows=3))
    start = "from cardume.cli.main import main; main()"
    command = [sys.executable, "-c", start, "convert", str(run), str(tmp_path / "out.rrd")]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"RERUN": "off"}, check=False)
    assert done.returncode == 2
    assert "RERUN switches recording off" in done.stderr
    assert not (tmp_path / "out.rrd").exists()


def test_without_the_extra_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    run = kept_run(tmp_path / "run", make_flight(num_rows=3))
    with pytest.raises(SystemExit) as left:
        program.main(["convert", str(run), str(tmp_path / "out.rrd")])
    assert left.value.code == 2
    assert "pip install 'cardume[rerun]'" in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "out.rrd").exists()
