"""`cardume study` with the real engine: what it says, what it leaves, how it exits and how it continues."""

import errno
import json
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray

import cardume as package
from cardume.studies import beginning, distributing, forecast
from cli.stand_ins import Result
from studies.missions import NOISY

Command = Callable[..., Result]
VARIED = NOISY.replace("40 s", "12 s").replace("0.1 m/s", "{uniform: [0 m/s, 0.1 m/s]}")
PROGRAM = [sys.executable, "-c", "from cardume.cli.main import main; main()"]
# A study cut small, so that it can be interrupted between portions.
SMALL = "from cardume.studies import layout; layout.PORTION_WORK, layout.SMALLEST_PORTION = 1.0, 4; "
SMALL_PROGRAM = [sys.executable, "-c", SMALL + PROGRAM[2]]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a mission to study."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    (tmp_path / "line.yaml").write_text(VARIED + "require: {cross_track_iae: 25 m s}\n")
    return tmp_path


def test_it_says_what_it_will_take_and_what_came_out(here: Path, cardume: Command) -> None:
    ended = cardume("study", "line.yaml", "--runs", "12", "--no-figures")
    assert ended.code == 0, ended.err
    assert "12 missions, " in ended.err
    assert "that are free there" in ended.err
    assert "cross_track_iae <= 25 m s" in ended.out
    assert "Written to runs/line-study/001" in ended.out
    directory = here / "runs/line-study/001"
    assert {path.name for path in directory.iterdir()} >= {"study.zarr", "ledger.txt", "mission.yaml", "summary.json"}
    found = xarray.open_zarr(directory / "study.zarr")  # as any program would
    assert found.sizes == {"run": 12, "vehicle": 1, "requirement": 1}
    summary = json.loads((directory / "summary.json").read_text())
    assert summary["cases"][0]["flown"] == 12
    assert package.load(directory / "mission.yaml").to_yaml() == found.attrs["mission"]
    assert found.attrs["command"].startswith("cardume")


def test_json_is_all_that_goes_to_stdout(here: Path, cardume: Command) -> None:
    ended = cardume(
        "study", "line.yaml", "--runs", "4", "--json", "--no-figures", "--set", "guidance.lookahead={sweep: [2, 4]}"
    )
    assert ended.code == 0
    told = json.loads(ended.out)
    assert [case["options"]["guidance.lookahead"] for case in told["cases"]] == [2.0, 4.0]
    assert ended.err == ""


def test_quiet_is_quiet(here: Path, cardume: Command) -> None:
    ended = cardume("study", "line.yaml", "--runs", "4", "-q", "--no-figures", "-o", "it")
    assert (ended.code, ended.out, ended.err) == (0, "", "")
    again = cardume("study", "line.yaml", "--resume", "-o", "it", "--no-figures")
    assert again.code == 0
    assert "All was flown before" in again.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "say how many runs each case is flown with, as --runs 1000"),
        (["--runs", "0"], "--runs 0: give at least 1"),
        (["--runs", "-1"], "--runs -1: give at least 1"),
        (["--runs", "1e6"], "not a valid integer"),
        (["--runs", "1000000000000"], "more missions than a study may have"),
        (["--runs", "4", "--workers", "2", "--scheduler", "tcp://here:1"], "give one of them"),
        (["--runs", "4", "--workers", "0"], "--workers 0: give a whole number from 1"),
        (["--runs", "4", "--sampling", "halton"], "'monte_carlo', 'latin_hypercube', 'sobol'"),
        (["--runs", "4", "--set", "current.speed=0", "--set", "vehicles.a.sensors=ideal"], "nothing varies"),
        (["--runs", "4", "-o", "line.yaml"], "-o line.yaml: is a file"),
        (["--runs", "4", "-o", "."], "is not empty, and holds no study"),
        (["--runs", "4", "-o", "line.yaml/below"], "is a file, so no results fit below it"),
        (["--resume"], "there is no study in runs/line-study to continue"),
        (["--resume", "-o", "nowhere"], "nowhere does not exist"),
        (["--runs", "4", "--set", "current.speed={uniform: [1]}"], "uniform needs [low, high]"),
    ],
)
def test_bad_input_is_told_and_leaves_nothing(here: Path, cardume: Command, arguments: list[str], said: str) -> None:
    ended = cardume("study", "line.yaml", *arguments)
    assert ended.code == 2, ended.err
    assert said in ended.err
    assert [path.name for path in here.iterdir()] == ["line.yaml"]


def test_only_plain_digits_number_a_study(here: Path, cardume: Command) -> None:
    """Python calls superscript two a digit, and makes no number of it."""
    (here / "runs/line-study/\u00b2").mkdir(parents=True)
    assert "there is no study in runs/line-study" in cardume("study", "line.yaml", "--resume").err
    assert cardume("study", "line.yaml", "--runs", "2", "-q", "--no-figures").code == 0
    assert (here / "runs/line-study/001/study.zarr").is_dir()


def test_a_study_that_lacks_what_it_says_of_itself_is_told(here: Path, cardume: Command) -> None:
    assert cardume("study", "line.yaml", "--runs", "2", "-q", "--no-figures", "-o", "it").code == 0
    file = here / "it/study.zarr/zarr.json"
    whole = json.loads(file.read_text())
    for key, value in {"mission": 3, "runs": "many", "files": [], "sampling": None, "seed": 1.5, "swept": "x"}.items():
        changed = json.loads(file.read_text()) | {"attributes": whole["attributes"] | {key: value}}
        file.write_text(json.dumps(changed))
        for command in (["study", "line.yaml", "--resume", "-o", "it"], ["report", "it"]):
            ended = cardume(*command)
            assert ended.code == 2, ended.err
            assert f"is damaged (its {key} is" in ended.err
    changed = whole | {"attributes": whole["attributes"] | {"mission": whole["attributes"]["mission"] + "# mine\n"}}
    file.write_text(json.dumps(changed))
    assert "is damaged (its mission is not the one of its mission_hash)" in cardume("report", "it").err


@pytest.mark.parametrize("address", ["nonsense", "http://127.0.0.1:9", "tls://127.0.0.1:9", "inproc://x", "tcp://a:b"])
def test_no_address_leaves_a_client_behind(here: Path, address: str) -> None:
    """One that could not read its address is heard of again when the program ends, with a traceback."""
    command = [*PROGRAM, "study", "line.yaml", "--runs", "4", "--scheduler", address]
    done = subprocess.run(command, cwd=here, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "no Dask scheduler answers there" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_wrong_scheduler_is_told_before_anything_flies(
    here: Path, cardume: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(distributing, "PATIENCE", 0.5)
    monkeypatch.setattr(forecast, "fly_seeds", lambda *given, **named: pytest.fail("flown"))
    ended = cardume("study", "line.yaml", "--runs", "4", "--scheduler", "tcp://127.0.0.1:9")
    assert ended.code == 2
    assert "no Dask scheduler answers there" in ended.err
    assert [path.name for path in here.iterdir()] == ["line.yaml"]


def test_a_place_that_refuses_to_be_made_is_no_bug(
    here: Path, cardume: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_given: object) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(beginning, "create_study", refuse)
    ended = cardume("study", "line.yaml", "--runs", "4", "-o", "it")
    assert ended.code == 3
    assert "could not be written to it: Input/output error; nothing was kept there: choose another place" in ended.err


def test_an_empty_directory_of_the_users_survives_an_error(here: Path, cardume: Command) -> None:
    (here / "mine").mkdir()
    assert cardume("study", "line.yaml", "--runs", "0", "-o", "mine").code == 2
    assert (here / "mine").is_dir()


def test_another_mission_is_not_continued(here: Path, cardume: Command) -> None:
    assert cardume("study", "line.yaml", "--runs", "4", "-q", "--no-figures", "-o", "it").code == 0
    ended = cardume("study", "line.yaml", "--resume", "-o", "it", "--set", "guidance.lookahead=7 m")
    assert ended.code == 2
    assert "+guidance: {law: line_of_sight, lookahead: 7 m" in ended.err
    assert cardume("study", "line.yaml", "--runs", "8", "--resume", "-o", "it").code == 2
    assert "holds a study already" in cardume("study", "line.yaml", "--runs", "4", "-o", "it").err


def test_a_full_disk_is_no_bug(here: Path, cardume: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_given: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(beginning, "write_block", refuse)
    ended = cardume("study", "line.yaml", "--runs", "4", "-o", "it")
    assert ended.code == 3
    assert "the disk of it is full" in ended.err
    assert "--resume -o it" in ended.err
    monkeypatch.undo()
    monkeypatch.chdir(here)
    assert cardume("study", "line.yaml", "--resume", "-o", "it", "-q", "--no-figures").code == 0


def test_too_small_a_disk_is_told_before(here: Path, cardume: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(beginning, "bytes_free", lambda place: 50_000)
    ended = cardume("study", "line.yaml", "--runs", "4")
    assert ended.code == 2
    assert "50 kB are free" in ended.err
    assert not list((here / "runs").rglob("*"))


@pytest.mark.parametrize("how", [[], pytest.param(["--workers", "2"], marks=pytest.mark.slow)])
def test_ctrl_c_ends_it_and_says_how_to_continue(here: Path, cardume: Command, how: list[str]) -> None:
    """As the terminal sends it: to the whole group of processes, workers included."""
    command = [*SMALL_PROGRAM, "study", "line.yaml", "--runs", "400", "-o", "it", "--no-figures", *how]
    flying = subprocess.Popen(
        command, start_new_session=True, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    ledger = here / "it" / "ledger.txt"
    while flying.poll() is None and (not ledger.exists() or len(ledger.read_text().splitlines()) < 3):
        time.sleep(0.05)
    os.killpg(flying.pid, signal.SIGINT)
    out, err = flying.communicate(timeout=120)
    assert flying.returncode == 130, err
    assert out == ""
    assert "Traceback" not in err
    assert "missions are kept in it; continue with" in err
    again = shlex.split(err.strip().splitlines()[-1])
    assert again == ["cardume", "study", "line.yaml", "--resume", "-o", "it"]
    status = package.open_study(here / "it")["status"].values
    assert 0 < (status == 1).sum() < 400
