"""`cardume run`: what it says and keeps, with a stand-in for the engine."""

import json
import os
import re
import shlex
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cardume.cli.main import cli
from cardume.missions.log import read_log
from cardume.missions.mission import Requirement
from cli.stand_ins import Result, Stage
from report.synthetic import make_flight, without_settling

Cardume = Callable[..., Result]
FILES = {"log.nc", "mission.yaml", "report.html", "summary.json", "figures"}


def require(metric: str, limit: float, vehicle: str | None = None) -> Requirement:
    return Requirement(metric=metric, limit=limit, unit="m", vehicle=vehicle)


def flowing(out: str) -> str:
    """Text without its line ends."""
    return " ".join(out.split())


def test_a_run_says_what_came_out_and_where_it_is(stage: Stage, cardume: Cardume) -> None:
    stage.mission.require = (require("cross_track_rms", 0.5), require("separation_min", 2.0))
    code, out, err = cardume("run", "paper/figure-5")
    assert (code, err) == (0, "")
    for text in ("figure-5, seed 7", "surface", "port", "starboard", "fleet", "wanted at most 0.5 m", "met"):
        assert text in out
    assert "All that was required is met." in flowing(out)
    assert "Written to runs/figure-5/001" in out
    assert set(os.listdir("runs/figure-5/001")) == FILES
    assert sorted(os.listdir("runs/figure-5/001/figures")) == ["errors.png", "errors.svg", "plan.png", "plan.svg"]
    assert out.isascii()
    resolved = Path("runs/figure-5/001/mission.yaml").read_text(encoding="utf-8")
    assert resolved.startswith("# As flown by cardume ")
    assert resolved.endswith(stage.mission.to_yaml())
    assert read_log(Path("runs/figure-5/001/log.nc")).mission == resolved


@pytest.mark.parametrize("columns", [40, 80, 100, 140])
def test_nothing_is_wider_than_the_terminal(
    stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    names = ("surface", "a-vehicle-with-a-very-long-name-indeed", "starboard")
    stage.flight = make_flight(num_rows=71, names=names)
    stage.mission.require = (require("cross_track_rms", 0.5), require("cross_track_rms_lines", 0.1, names[1]))
    out = cardume("run", "missions/some-mission.yaml", "--no-figures").out
    prose = [line for line in out.splitlines() if not line.lstrip().startswith("cardume ")]  # commands are not broken
    assert max(len(line) for line in prose) <= columns


def test_what_to_type_next_can_be_typed(stage: Stage, cardume: Cardume) -> None:
    out = cardume("run", "a mission.yaml", "--set", "vehicles.port.depth=5 m", "--no-figures").out
    steps = [line.strip() for line in out.partition("\nNext\n")[2].splitlines() if line.strip().startswith("cardume ")]
    assert len(steps) == 3
    for step in steps:
        words = shlex.split(re.split(r"  +", step)[0])
        assert words[2:5] == ["a mission.yaml", "--set", "vehicles.port.depth=5 m"]
        cli.commands[words[1]].make_context(words[1], words[2:])  # raises where an option does not exist
    assert "--set current.speed=0.2" in out


def test_options_reach_the_mission(stage: Stage, cardume: Cardume, tmp_path: Path) -> None:
    given = ["--seed", "9", "--set", "a=1", "--set", "b=2", "--allow-code", str(tmp_path), "--no-figures", "-q"]
    assert cardume("run", "paper/figure-5", *given) == Result(0, "", "")
    assert stage.opened == [("paper/figure-5", ["a=1", "b=2"], 9, [tmp_path])]
    assert set(os.listdir("runs/figure-5/001")) == FILES - {"figures", "report.html"}


def test_json_is_the_summary_and_nothing_else(stage: Stage, cardume: Cardume) -> None:
    stage.flight = without_settling(stage.flight, "port")
    code, out, err = cardume("run", "paper/figure-5", "--json", "-o", "here")
    assert (code, err) == (0, "")
    assert out == Path("here/summary.json").read_text(encoding="utf-8")

    def refuse(text: str) -> None:
        raise AssertionError(text)

    summary = json.loads(out, parse_constant=refuse)
    assert summary["vehicles"]["port"]["cross_track_rms"] is None
    assert summary["files"] == sorted(
        [
            "log.nc",
            "mission.yaml",
            "report.html",
            "summary.json",
            *(f"figures/{n}.{e}" for n in ("errors", "plan") for e in ("png", "svg")),
        ]
    )


def test_requirements_missed_exit_1(stage: Stage, cardume: Cardume) -> None:
    stage.mission.require = (require("cross_track_rms", 0.25), require("settling_time", 60.0, "port"))
    code, out, err = cardume("run", "paper/figure-5", "--no-figures")
    assert (code, err) == (1, "")
    assert re.search(r"cross_track_rms +wanted at most 0.25 m +got 0.2835 m \(port\) +MISSED", out)
    assert "Missed: cross_track_rms, of 2 required." in flowing(out)
    assert cardume("run", "paper/figure-5", "-q", "--no-figures") == Result(1, "", "")


def test_a_vehicle_that_never_settles_misses_what_is_required(stage: Stage, cardume: Cardume) -> None:
    stage.flight = without_settling(stage.flight, "port")
    stage.mission.require = (require("cross_track_rms", 100.0),)
    code, out, _ = cardume("run", "paper/figure-5", "--no-figures")
    assert code == 1
    assert "got no value (port)" in out
    assert "port never stayed within 0.5 m" in flowing(out)


def test_a_failed_flight_is_kept_and_exits_3(stage: Stage, cardume: Cardume) -> None:
    failure = "the state of vehicle port was no number at 312 s"
    stage.flight = replace(stage.flight, reason="failed", failure=failure, flown=312.0)
    stage.mission.require = (require("cross_track_rms", 0.5),)
    code, out, err = cardume("run", "paper/figure-5", "--no-figures")
    assert code == 3
    assert err == f"error: the mission failed: {failure}; what was flown is in runs/figure-5/001\n"
    assert "cannot be judged" in flowing(out)
    log = read_log(Path("runs/figure-5/001/log.nc")).flight
    assert (log.reason, log.failure) == ("failed", failure)
    summary = json.loads(Path("runs/figure-5/001/summary.json").read_text())
    assert (summary["reason"], summary["requirements_met"]) == ("failed", None)


def test_a_figure_that_cannot_be_drawn_does_not_lose_the_flight(
    stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(*_: object) -> None:
        raise ValueError("no such color")

    monkeypatch.setattr("cardume.report.figures.save_figures", fail)
    code, out, err = cardume("run", "paper/figure-5")
    assert code == 4
    assert "Written to runs/figure-5/001" in out
    assert "figures or report could not be drawn" in err
    assert "Traceback" not in out + err
    kept = next((tmp_path / "state" / "cardume").glob("bug-*.txt"))
    assert str(kept) in err
    assert "no such color" in kept.read_text()
    assert read_log(Path("runs/figure-5/001/log.nc")).flight.reason == "completed"


def test_one_vehicle_alone(stage: Stage, cardume: Cardume) -> None:
    flight = make_flight(num_rows=71, names=("alone",))
    stage.flight = replace(flight, metrics=replace(flight.metrics, fleet={}))
    out = cardume("run", "paper/figure-5", "--no-figures").out
    assert "The vehicle reached its path" in flowing(out)
    assert "fleet" not in out


def test_a_large_fleet_shows_its_worst(stage: Stage, cardume: Cardume) -> None:
    names = tuple(f"v{k:02d}" for k in range(40))
    stage.flight = make_flight(num_rows=11, names=names)
    worst = {**stage.flight.metrics.vehicles["v33"], "cross_track_rms": np.nan}
    metrics = replace(stage.flight.metrics, vehicles={**stage.flight.metrics.vehicles, "v33": worst})
    stage.flight = replace(stage.flight, metrics=metrics)
    out = cardume("run", "paper/figure-5", "--no-figures").out
    rows = [line.split()[0] for line in out.splitlines() if re.match(r"v\d\d ", line)]
    assert len(rows) == 20
    assert "v33" in rows
    assert "20 vehicles with smaller errors are not shown" in flowing(out)


def test_without_the_library_of_the_report_it_says_so_in_a_line(
    stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in [name for name in sys.modules if name.partition(".")[0] == "plotly"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "plotly", None)
    code, out, err = cardume("run", "paper/figure-5")
    assert (code, err) == (0, "\nnote: report.html needs plotly: pip install 'cardume[report]'\n")
    assert set(os.listdir("runs/figure-5/001")) == FILES - {"report.html"}
    assert "report.html" not in out
    assert cardume("run", "paper/figure-5", "-q") == Result(0, "", "")
    assert cardume("report", "runs/figure-5/001").code == 2
