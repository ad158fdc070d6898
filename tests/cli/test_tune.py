"""`cardume tune` with the real engine: how it ends, also by Ctrl-C, and how it continues."""

import json
import shlex
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import cardume as package
from cli.stand_ins import Result
from studies.missions import NOISY

Command = Callable[..., Result]
WORDS = ["--for", "cross_track_iae", "--vary", "guidance.lookahead=1..10", "--runs", "2", "--evaluations", "10"]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a mission to tune."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    (tmp_path / "line.yaml").write_text(NOISY.replace("40 s", "12 s"))
    return tmp_path


def interrupted(stage: str, done: int, number: int, *words: str) -> subprocess.CompletedProcess[str]:
    """A tuning whose process gets a signal when it has come so far."""
    script = (
        "import os, signal, sys\nfrom cardume.cli import progress\nfrom cardume.cli.main import main\n"
        "call = progress.Progress.__call__\n"
        "def note(self, stage, done, total):\n"
        "    call(self, stage, done, total)\n"
        f"    if stage == {stage!r} and done >= {done}: os.kill(os.getpid(), {number})\n"
        "progress.Progress.__call__ = note\n"
        "main(sys.argv[1:])\n"
    )
    command = [sys.executable, "-c", script, "tune", "line.yaml", *WORDS, "--no-figures", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=250)


def test_a_killed_tuning_continues_from_the_tries_that_it_made(here: Path, cardume: Command) -> None:
    """Twice killed, then finished: without a file of its own that it could be told by, nothing would be known."""
    (here / "out").mkdir()
    assert interrupted("tune", 4, int(signal.SIGKILL), "-o", "out").returncode == -signal.SIGKILL
    assert len((here / "out/tries.csv").read_text().splitlines()) == 1 + 4
    assert sorted(path.name for path in (here / "out").iterdir()) == ["summary.json", "tries.csv"]
    assert interrupted("tune", 6, int(signal.SIGKILL), "--resume", "out").returncode == -signal.SIGKILL
    assert len((here / "out/tries.csv").read_text().splitlines()) == 1 + 6
    continued = cardume("tune", "line.yaml", *WORDS, "--no-figures", "--json", "--resume", "out")
    assert continued.code == 0, continued.err
    whole = cardume("tune", "line.yaml", *WORDS, "--no-figures", "--json", "-o", "whole")
    assert json.loads(continued.out) == json.loads(whole.out)
    assert sorted(path.name for path in here.iterdir()) == ["line.yaml", "out", "whole"]
    assert sorted(path.name for path in (here / "out").iterdir()) == ["mission.yaml", "summary.json", "tries.csv"]


@pytest.mark.parametrize(("stage", "done"), [("tune", 3), ("compare", 100)])
def test_ctrl_c_keeps_the_best_and_says_how_to_continue(here: Path, cardume: Command, stage: str, done: int) -> None:
    """While it searches, and while it proves what it found; continued, it ends as if it had never been stopped."""
    ended = interrupted(stage, done, int(signal.SIGINT))
    assert ended.returncode == 130, ended.stderr
    assert "Traceback" not in ended.stderr
    assert "bug" not in ended.stderr
    assert "is in runs/line-tuned/001; continue with" in ended.stderr
    told = json.loads((here / "runs/line-tuned/001/summary.json").read_text())
    assert told["interrupted"]
    best = package.load(here / "runs/line-tuned/001/mission.yaml").vehicles[0].guidance.law.parameters["lookahead"]
    assert best == told["best"]["values"]["guidance.lookahead"]
    program, *again = shlex.split(ended.stderr.strip().splitlines()[-1])
    assert program == "cardume"
    continued = cardume(*again, "--no-figures", "--json")
    assert continued.code == 0, continued.err
    whole = cardume("tune", "line.yaml", *WORDS, "--no-figures", "--json", "-o", "whole")
    assert json.loads(continued.out) == json.loads(whole.out)
    assert sorted(path.name for path in (here / "runs/line-tuned").iterdir()) == ["001"]
