"""`cardume report`: a run read back as it was flown, its page and its figures, and what is refused."""

import json
import shutil
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cardume.missions.runs import Run, read_run
from cardume.simulation.flight import Flight
from cli.stand_ins import Result
from report.runs import kept_run
from report.synthetic import make_flight, with_faults, without_settling

Cardume = Callable[..., Result]


@pytest.fixture
def run_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The directory of a run, beside an empty folder to work in."""
    directory = kept_run(tmp_path / "run", make_flight(num_rows=71))
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    return directory


def same(first: Any, second: Any) -> bool:
    if isinstance(first, np.ndarray):
        return np.array_equal(first, second, equal_nan=first.dtype.kind == "f")
    if isinstance(first, dict):
        return set(first) == set(second) and all(same(first[key], second[key]) for key in first)
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    return bool(first == second or (first != first and second != second))


@pytest.mark.parametrize(
    "flight", [make_flight(num_rows=71), without_settling(make_flight(num_rows=11), "port"), with_faults()]
)
def test_a_run_read_back_equals_what_was_flown(tmp_path: Path, flight: Flight) -> None:
    found = read_run(kept_run(tmp_path / "run", flight)).flight
    for field in fields(Flight):
        if field.name not in ("metrics", "messages"):
            assert same(getattr(found, field.name), getattr(flight, field.name)), field.name
    assert same(dict(found.metrics.fleet), dict(flight.metrics.fleet))
    assert same(dict(found.metrics.vehicles), dict(flight.metrics.vehicles))
    assert same({k: np.asarray(v, float) for k, v in found.messages.items()}, dict(flight.messages))


def test_a_summary_without_events_or_ends_of_them_is_read(tmp_path: Path) -> None:
    directory = kept_run(tmp_path / "run", with_faults())
    file = directory / "summary.json"
    summary = json.loads(file.read_text())
    for event in summary["events"]:
        del event["until"]
    file.write_text(json.dumps(summary))
    assert [event.what for event in read_run(directory).flight.events] == [event.what for event in with_faults().events]
    del summary["events"]
    file.write_text(json.dumps(summary))
    assert read_run(directory).flight.events == ()


def test_the_page_goes_into_the_run_and_is_listed_there(run_folder: Path, cardume: Cardume) -> None:
    code, out, err = cardume("report", str(run_folder))
    assert (code, err) == (0, "")
    assert out == f"Written: {run_folder / 'report.html'}\n"
    listed = json.loads((run_folder / "summary.json").read_text())["files"]
    assert "report.html" in listed
    assert (run_folder / "report.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_figures_in_the_formats_asked_for(run_folder: Path, cardume: Cardume) -> None:
    given = ["--figure", "plan", "--format", "pdf", "--format", "png", "--width", "88mm", "-o", "here", "--json"]
    code, out, err = cardume("report", str(run_folder), *given)
    assert (code, err) == (0, "")
    assert json.loads(out) == {"run": str(run_folder), "written": ["here/figures/plan.pdf", "here/figures/plan.png"]}
    content = Path("here/figures/plan.pdf").read_bytes()
    assert content.startswith(b"%PDF")
    width = float(content.partition(b"/MediaBox [ 0 0 ")[2].split()[0])  # [point]
    assert width / 72 * 25.4 == pytest.approx(88.0, abs=0.1)
    assert b"/Type3" not in content.replace(b" ", b"")
    assert "figures/plan.pdf" not in json.loads((run_folder / "summary.json").read_text())["files"]


def test_quiet_says_nothing(run_folder: Path, cardume: Cardume) -> None:
    assert cardume("report", str(run_folder / "log.nc"), "-q") == Result(0, "", "")


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--figure", "plam"], "--figure plam: no such figure. Did you mean 'plan'? Valid: plan, space, errors"),
        (["--figure", "plan", "--width", "88"], "--width '88' is no width; write a number with mm, cm or in, as 88mm"),
        (["--figure", "plan", "--width", "2mm"], "--width 2mm cannot be drawn; between"),
        (["--format", "pdf"], "--format and --width are about figures; add --figure NAME"),
        (["--figure", "plan", "--format", "gif"], "'gif' is not one of 'svg', 'pdf', 'png'"),
    ],
)
def test_what_cannot_be_is_refused(run_folder: Path, cardume: Cardume, arguments: list[str], complaint: str) -> None:
    code, out, err = cardume("report", str(run_folder), *arguments)
    assert (code, out) == (2, "")
    assert complaint in " ".join(err.split())


def damaged(folder: Path, how: str) -> Path:
    if how == "no directory":
        shutil.rmtree(folder)
    elif how == "a file":
        shutil.rmtree(folder)
        folder.write_text("x")
    elif how == "no log":
        (folder / "log.nc").unlink()
    elif how == "half a log":
        content = (folder / "log.nc").read_bytes()
        (folder / "log.nc").write_bytes(content[: len(content) // 2])
    elif how == "no summary":
        (folder / "summary.json").unlink()
    else:
        summary = json.loads((folder / "summary.json").read_text())
        del summary["vehicles"]
        (folder / "summary.json").write_text(json.dumps(summary))
    return folder


@pytest.mark.parametrize(
    ("how", "complaint"),
    [
        ("no directory", "does not exist; give the directory of a run"),
        ("a file", "is a file, not the directory of a run"),
        ("no log", "log.nc cannot be read: No such file or directory"),
        ("half a log", "log.nc is damaged"),
        ("no summary", "summary.json cannot be read"),
        ("less summary", "is damaged (KeyError: 'vehicles'); fly the mission again"),
    ],
)
def test_a_missing_or_damaged_run_is_named(run_folder: Path, cardume: Cardume, how: str, complaint: str) -> None:
    code, out, err = cardume("report", str(damaged(run_folder, how)))
    assert (code, out) == (2, "")
    assert complaint in " ".join(err.split())
    assert "Traceback" not in err


def test_a_place_that_cannot_be_written_to(run_folder: Path, cardume: Cardume) -> None:
    Path("taken").write_text("x")
    code, _, err = cardume("report", str(run_folder), "-o", "taken")
    assert code == 3
    assert "taken cannot be written to" in err


def test_a_mission_with_laws_that_are_not_here_is_still_reported(tmp_path: Path) -> None:
    found: Run = read_run(kept_run(tmp_path / "run", make_flight(num_rows=11)))
    assert found.mission is None  # the stand-in's text is no whole mission
    assert found.transient.threshold == 0.5
