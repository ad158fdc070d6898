"""`cardume replay` on the command line: what it says, what it leaves, how it exits."""

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml

from cardume.cli import main as program, replay as command
from cardume.missions.log import read_log
from cardume.missions.recordings.reading import KINDS, MEANINGS
from recordings.flown import fly_to


@pytest.fixture
def cardume(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., tuple]:
    """Run a command in this process, in an empty folder: its exit code, what it says, what it complains of."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")

    def run(*arguments: str) -> tuple[int, str, str]:
        capsys.readouterr()
        with pytest.raises(SystemExit) as exit_:
            program.main(list(arguments))
        said = capsys.readouterr()
        return int(exit_.value.code or 0), said.out, said.err

    return run


def boat(path: Path) -> Path:
    """A boat on a circle with a fix each second, as CSV with latitudes."""
    draw = np.random.default_rng(2)
    rows = ["time,heading_deg,surge,fix_latitude_deg,fix_longitude_deg,fix_sigma,truth_north,truth_east"]
    north = east = 0.0
    for k in range(400):
        heading = 0.9 * k
        fix = ",,"
        if k % 10 == 0:
            noisy = [north + 0.3 * draw.normal(), east + 0.3 * draw.normal()] if k else [0.0, 0.0]
            latitude, longitude = 38.7 + noisy[0] / 111_018.0, -9.1 + noisy[1] / 86_990.0
            fix = f"{latitude!r},{longitude!r},0.3"
        rows.append(f"{0.1 * k!r},{heading!r},0.5,{fix},{north!r},{east!r}")
        north, east = north + 0.05 * math.cos(math.radians(heading)), east + 0.05 * math.sin(math.radians(heading))
    path.write_text("\n".join(rows) + "\n")
    return path


def test_what_a_replay_leaves(cardume, tmp_path: Path) -> None:
    boat(tmp_path / "Boat 7.csv")
    code, said, _ = cardume("replay", "Boat 7.csv", "--smooth")
    folder = tmp_path / "runs/replay-boat-7/001"
    assert code == 0
    assert "replay-boat-7, csv" in said
    assert "from the truth (RMS)" in said
    summary = json.loads((folder / "summary.json").read_text())
    found = summary["replay"]["vehicles"]["vehicle"]
    assert summary["vehicles"]["vehicle"]["position_error_rms"] == found["position_error_rms"] < 0.3
    assert found["fixes"] == 40
    assert found["position_law"] == "kalman_replay"
    assert found["smoothed_position_error_rms"] < found["position_error_rms"]
    assert {*summary["files"]} == {
        *(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    }
    log = read_log(folder / "log.nc").flight
    assert log.vehicle_names == ("vehicle",)
    assert log.channels["north"][10, 0] == pytest.approx(log.channels["north_estimate"][10, 0], abs=1.0)
    with (folder / "innovations.csv").open() as file:
        assert len([*csv.DictReader(file)]) == 40
    with (folder / "smoothed.csv").open() as file:
        assert float([*csv.DictReader(file)][-1]["time"]) == pytest.approx(39.9, abs=1.0)
    assert yaml.safe_load((folder / "mission.yaml").read_text())["name"] == "replay-boat-7"


def test_its_log_is_taken_by_other_commands(cardume, tmp_path: Path) -> None:
    boat(tmp_path / "boat.csv")
    assert cardume("replay", "boat.csv", "-q", "--no-figures")[:2] == (0, "")
    assert not (tmp_path / "runs/replay-boat/001/figures").exists()
    assert cardume("convert", "runs/replay-boat/001/log.nc", "track.geojson")[0] == 0  # its origin is known
    lines = json.loads((tmp_path / "track.geojson").read_text())["features"]
    longitude, latitude = lines[0]["geometry"]["coordinates"][0][:2]
    assert (len(lines), latitude, longitude) == (2, pytest.approx(38.7, abs=1e-4), pytest.approx(-9.1, abs=1e-4))
    assert cardume("report", "runs/replay-boat/001", "--figure", "plan")[0] == 0
    code, _, complaint = cardume("report", "runs/replay-boat/001")
    assert (code, "this is a replay" in complaint) == (2, True)
    code, _, complaint = cardume("replay", "runs/replay-boat/001")
    assert (code, "the log of a replay" in complaint) == (2, True)


def test_json_is_the_summary(cardume, tmp_path: Path) -> None:
    boat(tmp_path / "boat.csv")
    code, said, _ = cardume("replay", "boat.csv", "--json", "--no-figures", "--position", "reset", "-o", "here")
    assert code == 0
    assert json.loads(said) == json.loads((tmp_path / "here/summary.json").read_text())
    assert json.loads(said)["replay"]["vehicles"]["vehicle"]["anees"] is None


def test_a_run_replayed_with_another_law(cardume, tmp_path: Path) -> None:
    (tmp_path / "runs/line/001").mkdir(parents=True)
    fly_to(tmp_path / "runs/line/001", overrides=("duration=30 s",))
    code, said, _ = cardume("replay", "runs/line/001", "--position", "law=kalman_replay,gate=9", "--vehicle", "port")
    assert code == 0
    assert "replay-line-001, log" in said
    assert "kalman_replay" in said
    assert "surface" not in said


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["nothing.csv"], "nothing.csv cannot be read"),
        (["boat.csv", "--position", "law=kalman"], "--position law=kalman: no such law"),
        (["boat.csv", "--position", "law=kalman_replay,gait=9"], "gate"),
        (["boat.csv", "--position", "law="], "cannot be read; write --position"),
        (["boat.csv", "--position", "law=range_filter"], "has no ranges"),
        (["boat.csv", "--position", "law=range_filter,rage=3"], "no parameter 'rage'"),
        (["boat.csv", "--start", "here"], "NORTH,EAST"),
        (["boat.csv", "--vehicle", "vehicel"], "'vehicle'"),
        (["boat.csv", "--format", "nmea"], "no position in GGA"),
        (["boat.csv", "--format", "evologics"], "has no USBLLONG"),
        (["boat.csv", "--format", "plaza"], "damaged, or no MATLAB file"),
        (["boat.csv", "--format", "bag", "--topic", "fix=/fix"], "cannot be read as a bag"),
        (["boat.csv", "--format", "log"], "is not a NetCDF-4 file"),
        (["boat.csv", "--topic", "/fix"], "write ROLE=/TOPIC"),
        (["boat.csv", "--tick", "0.00001"], "--tick"),
    ],
)
def test_what_cannot_be_done_is_said(cardume, tmp_path: Path, arguments: list[str], complaint: str) -> None:
    boat(tmp_path / "boat.csv")
    code, said, complained = cardume("replay", *arguments)
    assert (code, said) == (2, "")
    assert complaint in complained
    assert "bug" not in complained
    assert not (tmp_path / "runs").exists()


def test_the_formats_are_the_same_everywhere() -> None:
    assert command.KINDS == KINDS == tuple(MEANINGS)


def test_a_scale_that_was_found_is_shown_and_a_bias_that_was_not_sought_is_not(cardume, tmp_path: Path) -> None:
    rows = ["time,heading_deg,surge,range,source_north,source_east,truth_north,truth_east"]
    rows += [f"{k},90,0.5,{1.05 * math.hypot(30.0, 0.5 * k)!r},30,0,0,{0.5 * k}" for k in range(80)]
    (tmp_path / "ranges.csv").write_text("\n".join(rows) + "\n")
    code, said, _ = cardume("replay", "ranges.csv", "--no-figures", "--position", "law=range_filter")
    assert code == 0
    assert "range scale" in said
    assert "range bias" not in said
