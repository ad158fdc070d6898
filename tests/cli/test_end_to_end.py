"""The command line with the real engine: what a user's first hour looks like."""

import json
import os
import pty
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
import xarray

from cardume.cli.new import KINDS
from cardume.missions.log import read_log
from cli.stand_ins import Result, command

Cardume = Callable[..., Result]


@pytest.fixture
def desk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_mission_flies_and_meets_what_it_requires(desk: Path, cardume: Cardume, kind: str) -> None:
    assert cardume("new", "survey.yaml", "--kind", kind).code == 0
    code, out, _ = cardume("run", "survey.yaml", "-o", "out")
    assert code == 0, out
    assert " met" in out
    again = cardume(
        "run", "out/mission.yaml", "-o", "again", "--no-figures", "-q"
    )  # the resolved mission flies the same
    assert again.code == 0
    first, second = (read_log(Path(folder, "log.nc")).flight for folder in ("out", "again"))
    for name, values in first.channels.items():
        np.testing.assert_array_equal(values, second.channels[name], err_msg=name)


def test_the_same_mission_gives_the_same_bytes_in_another_process(desk: Path, cardume: Cardume) -> None:
    assert cardume("run", "kinematic/line", "-o", "one", "-q").code == 0
    assert subprocess.run(command("run", "kinematic/line", "-o", "two", "-q"), cwd=desk).returncode == 0
    for name in ("log.nc", "mission.yaml", "figures/plan.svg", "figures/errors.png"):
        assert (desk / "one" / name).read_bytes() == (desk / "two" / name).read_bytes(), name


def test_log_and_summary_agree(desk: Path, cardume: Cardume) -> None:
    given = ["--set", "duration=150", "--json", "-o", "out", "--no-figures"]
    summary = json.loads(cardume("run", "paper/figure-5", *given).out)
    with xarray.open_dataset("out/log.nc") as log:
        for name, found in summary["vehicles"].items():
            own = log.sel(vehicle=name)
            settled = own.where(own.time >= found["settling_time"] + 10.0, drop=True)  # numbers count once it has held
            rms = float(np.sqrt((settled.cross_track**2).mean()))
            assert rms == pytest.approx(found["cross_track_rms"], rel=0.05)  # rows of 1 s against ticks of 0.1 s
        assert float(log.speed.isel(time=slice(60, None)).mean()) == pytest.approx(0.5, abs=0.05)
        assert log.attrs["seed"] == summary["seed"] == 7


def fly_until_seen(desk: Path, number: int) -> tuple[int, str]:
    """Start a long flight on a terminal, and send it a signal once it shows that it flies."""
    leader, follower = pty.openpty()
    options = ["--set", "duration=400 h", "--set", "log_period=60 s", "--no-figures", "-o", "out"]
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "100"}
    process = subprocess.Popen(
        command("run", "paper/figure-5", *options),
        cwd=desk,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=follower,
        text=True,
    )
    os.close(follower)
    shown = b""
    while b"flying" not in shown:
        shown += os.read(leader, 4096)
    started = time.monotonic()
    process.send_signal(number)
    with suppress(OSError):  # the terminal's other end closes
        while os.read(leader, 4096):
            pass
    process.wait()
    assert time.monotonic() - started < 10.0
    os.close(leader)
    return process.returncode, process.stdout.read() if process.stdout else ""


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_flight_is_kept_complete(desk: Path, number: int, code: int) -> None:
    found, out = fly_until_seen(desk, number)
    assert found == code
    assert "Interrupted at" in out
    assert sorted(os.listdir(desk)) == ["out"]
    flight = read_log(desk / "out" / "log.nc").flight
    summary = json.loads((desk / "out" / "summary.json").read_text())
    assert flight.reason == summary["reason"] == "interrupted"
    assert 0.0 < flight.flown == summary["flown"] < 400 * 3600
    assert np.isfinite(flight.channels["north"]).all()
    assert flight.times[-1] <= flight.flown < flight.times[-1] + 60.5


def test_every_law_is_listed_with_its_equation_and_source(desk: Path, cardume: Cardume) -> None:
    families = json.loads(cardume("list", "--json").out)
    assert {"guidance", "coordination", "model", "current", "gnss"} <= {family["name"] for family in families}
    for family in families:
        assert family["summary"], family
        for law in json.loads(cardume("list", family["name"], "--json").out):
            assert law["summary"], law
            assert law["source"], law
            assert all(parameter["name"] for parameter in law["parameters"])


def test_every_built_in_mission_is_described(desk: Path, cardume: Cardume) -> None:
    missions = json.loads(cardume("list", "missions", "--json").out)
    assert {"paper/figure-5", "kinematic/line", "cadiz"} <= {mission["name"] for mission in missions}
    assert all(mission["summary"] for mission in missions)


def test_the_paper_s_mission_passes_the_check(desk: Path, cardume: Cardume) -> None:
    code, out, err = cardume("check", "paper/figure-5")
    assert (code, err) == (0, "")
    assert out
    assert os.listdir() == []


def test_a_bad_mission_says_where_and_leaves_nothing(desk: Path, cardume: Cardume) -> None:
    (desk / "bad.yaml").write_text("cardume: 1\nname: bad\nduraton: 60 s\n")
    code, out, err = cardume("run", "bad.yaml")
    assert (code, out) == (2, "")
    assert "bad.yaml:3:duraton" in err
    assert "duration" in err
    assert os.listdir() == ["bad.yaml"]


def test_each_family_of_sensors_says_what_it_is(desk: Path, cardume: Cardume) -> None:
    families = {family["name"]: family["summary"] for family in json.loads(cardume("list", "--json").out)}
    sensors = [summary for name, summary in families.items() if name in ("gnss", "ahrs", "depth", "usbl", "dvl")]
    assert all(sensors)
    assert len(set(sensors)) == 5
