"""The command line with a stand-in for the engine: what it says, what it leaves, how it exits."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from cardume.cli import main as program
from cli.stand_ins import Result, Stage


def module(name: str, **contents: Any) -> ModuleType:
    """A module of that name, with that in it."""
    made = ModuleType(name)
    made.__dict__.update(contents)
    return made


@pytest.fixture
def stage(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Stage:
    """An empty folder to work in, and stand-ins for what reads, checks and flies missions."""
    made = Stage()
    for name, contents in (
        ("opening", {"open_mission": made.open_mission}),
        ("flying", {"fly_mission": made.fly_mission}),
        ("checks", {"check_mission": lambda mission, allow_code=(): list(made.findings)}),
    ):
        full = f"cardume.missions.{name}"
        monkeypatch.setitem(sys.modules, full, module(full, **contents))
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("COLUMNS", "80")
    return made


@pytest.fixture
def cardume(capsys: pytest.CaptureFixture[str]) -> Callable[..., Result]:
    """Run a command in this process."""

    def run(*arguments: str) -> Result:
        capsys.readouterr()
        with pytest.raises(SystemExit) as exit_:
            program.main(list(arguments))
        said = capsys.readouterr()
        return Result(int(exit_.value.code or 0), said.out, said.err)

    return run
