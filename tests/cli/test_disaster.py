"""Signals, full disks, bugs: the flown part is kept complete, or nothing is; never a traceback on the screen."""

import errno
import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from cardume.errors import FlightError, InputError, MissionError, Position, Problem
from cardume.missions.log import read_log
from cli.stand_ins import Result, Stage, command, tree

Cardume = Callable[..., Result]
RUN = ("run", "paper/figure-5", "--no-figures")


def send(*numbers: int) -> Callable[..., None]:
    """Send signals to this process, from within the flight."""

    def act(*_: object) -> None:
        for number in numbers:
            os.kill(os.getpid(), number)

    return act


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_signal_in_flight_keeps_what_was_flown(stage: Stage, cardume: Cardume, number: int, code: int) -> None:
    before = signal.getsignal(number)
    stage.flying = send(number)
    found, out, err = cardume("run", "paper/figure-5")
    assert found == code
    assert "Interrupted at 312 s of 700 s" in out
    assert err == "interrupted at 312 s; what was flown is in runs/figure-5/001\n"
    assert sorted(os.listdir("runs/figure-5/001")) == [
        "log.nc",
        "mission.yaml",
        "summary.json",
    ]  # nobody waits for figures
    assert read_log(Path("runs/figure-5/001/log.nc")).flight.reason == "interrupted"
    assert signal.getsignal(number) is before


def test_an_impatient_second_signal_does_not_break_the_writing(stage: Stage, cardume: Cardume) -> None:
    stage.flying = send(signal.SIGINT, signal.SIGTERM)
    assert cardume(*RUN).code == 130
    assert read_log(Path("runs/figure-5/001/log.nc")).flight.reason == "interrupted"


def test_the_third_signal_ends_it_and_leaves_nothing(stage: Stage, cardume: Cardume) -> None:
    stage.mission.to_yaml = lambda _directory: send(*[signal.SIGINT] * 3)() or ""
    code, _, err = cardume(*RUN)
    assert code == 130
    assert "nothing was kept" in err
    assert os.listdir() == []


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_before_the_flight_leaves_nothing(stage: Stage, cardume: Cardume, number: int, code: int) -> None:
    stage.opening = send(number)
    found, out, err = cardume(*RUN)
    assert (found, out) == (code, "")
    assert "nothing was kept" in err
    assert os.listdir() == []


def test_an_ignored_signal_stays_ignored(stage: Stage, cardume: Cardume) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        stage.flying = send(signal.SIGHUP)
        assert cardume(*RUN).code == 0
    finally:
        signal.signal(signal.SIGHUP, before)


# ---- the disk --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("moment", ["reserve", "fsync", "mission", "figures", "rename"])
def test_a_full_disk_leaves_nothing_and_still_shows_the_numbers(
    stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    if moment == "mission":
        stage.mission.to_yaml = full
    names = {"reserve": "os.posix_fallocate", "fsync": "os.fsync", "rename": "os.rename"}
    monkeypatch.setattr(names.get(moment, "cardume.report.figures.save_figures"), full)
    code, out, err = cardume("run", "paper/figure-5")
    assert code == 3
    assert "surface" in out
    assert "Written" not in out
    assert "the disk of runs/figure-5/001 is full (No space left on device); nothing was kept there" in err
    assert os.listdir() == []


@pytest.mark.parametrize("moment", ["os.fsync", "os.rename"])
def test_a_full_disk_leaves_the_earlier_run(
    stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    cardume(*RUN, "-q", "-o", "here")
    before, real, calls = tree(), getattr(os, moment.removeprefix("os.")), []

    def full_at_third(*arguments: object) -> object:
        calls.append(arguments)
        if moment == "os.fsync" or len(calls) == 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        return real(*arguments)

    monkeypatch.setattr(moment, full_at_third)
    assert cardume(*RUN, "-q", "-o", "here").code == 3
    assert tree() == before


def test_another_refusal_of_the_disk_is_named(stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "fsync", refuse)
    code, _, err = cardume(*RUN)
    assert code == 3
    assert "could not be written to runs/figure-5/001: Read-only file system" in err


@pytest.fixture
def tiny_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 64 kB."""
    folder = tmp_path / "tiny"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(folder)]
    with suppress(OSError):
        if subprocess.run(mount, capture_output=True).returncode == 0:
            yield folder
            subprocess.run(["umount", str(folder)], check=True)
            return
    pytest.skip("only root may mount a small disk")


def test_a_disk_that_is_really_full(stage: Stage, cardume: Cardume, tiny_disk: Path) -> None:
    code, out, err = cardume("run", "paper/figure-5", "-o", str(tiny_disk / "here"))
    assert code == 3
    assert "surface" in out
    assert "is full" in err
    assert os.listdir(tiny_disk) == []


# ---- what is raised --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("problem", "code"),
    [
        (InputError("no vehicles; give one"), 2),
        (MissionError([Problem(Position("a.yaml", 3, "path.leg"), "given '5 kg', a length is needed")]), 2),
        (FlightError("it diverged", "port", "surge", 3.0), 3),
        (MemoryError(), 3),
    ],
)
def test_what_is_raised_on_purpose_is_one_message(
    stage: Stage, cardume: Cardume, problem: Exception, code: int
) -> None:
    def fail() -> None:
        raise problem

    stage.opening = fail
    found, out, err = cardume(*RUN)
    assert (found, out) == (code, "")
    assert err.startswith("error: ")
    assert str(problem) in err
    assert "Traceback" not in err
    assert os.listdir() == []


@pytest.mark.parametrize("problem", [KeyError("surge"), RecursionError("too deep"), OSError(errno.EIO, "I/O error")])
def test_a_bug_says_where_its_traceback_is(stage: Stage, cardume: Cardume, tmp_path: Path, problem: Exception) -> None:
    def fail() -> None:
        raise problem

    stage.opening = fail
    code, out, err = cardume(*RUN)
    assert (code, out) == (4, "")
    assert "Traceback" not in err
    assert err.count("\n") == 1
    kept = next((tmp_path / "state" / "cardume").iterdir())
    assert str(kept) in err
    assert f"{type(problem).__name__}: {problem}" in kept.read_text()
    assert os.listdir() == []


def test_old_tracebacks_are_forgotten(stage: Stage, cardume: Cardume, tmp_path: Path) -> None:
    folder = tmp_path / "state" / "cardume"
    folder.mkdir(parents=True)
    for k in range(30):
        (folder / f"bug-20200101-0000{k:02d}-1.txt").touch()

    def fail() -> None:
        raise KeyError

    stage.opening = fail
    cardume(*RUN)
    kept = sorted(path.name for path in folder.iterdir())
    assert len(kept) == 20
    assert not kept[-1].startswith("bug-2020")


def test_a_bug_whose_traceback_cannot_be_saved(stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    def fail() -> None:
        raise KeyError

    monkeypatch.setattr(Path, "write_text", refuse)
    stage.opening = fail
    code, _, err = cardume(*RUN)
    assert code == 4
    assert "could not be saved" in err


# ---- whoever reads the output ----------------------------------------------------------------------------------------


def test_a_reader_that_leaves_is_no_bug() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(command("--help"), stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_behind_stdout_is_no_bug() -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(command("--help"), stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 3
    assert done.stderr == "error: cannot write: No space left on device; make room and run again\n"
