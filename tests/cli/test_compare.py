"""`cardume compare` as it is typed: what it shows at 80 and 120 columns, what it leaves, how it ends."""

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

from cardume.cli import main as program
from cardume.cli.progress import pace
from cli.stand_ins import Result, command
from studies.missions import LINE, NOISY

Cardume = Callable[..., Result]


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """An empty folder to work in, with two missions in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    (tmp_path / "line.yaml").write_text(LINE, encoding="utf-8")
    (tmp_path / "noisy.yaml").write_text(NOISY, encoding="utf-8")
    return tmp_path


COMPILING = "compiling the engine, once per installation ...\n"
LAWS = ("--vary", "guidance.law=line_of_sight,arcsine")


@pytest.mark.parametrize("width", [80, 120])
def test_a_table_that_fits_sentences_files_and_what_to_do_next(
    folder: Path, cardume: Cardume, monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    code, out, err = cardume("compare", "noisy.yaml", *LAWS, "--runs", "8")
    assert (code, err.replace(COMPILING, "")) == (0, "")
    table, _, rest = out.partition("\nWritten to ")
    assert table.isascii()
    assert max(map(len, table.splitlines())) <= width
    assert "noisy.yaml, guidance.law varied; seeds 1 to 8, the same for all" in table
    assert "difference to line_of_sight" in table
    assert "cross_track_rms [m]\n  line_of_sight  " in table
    assert ("change" in table) == (width == 120)
    assert "arcsine against line_of_sight: really " in table
    files = "compare.csv, compare.json, compare.png, compare.svg"
    assert rest.startswith(f"runs/noisy-compared/001\n  {files}\n\nNext\n")
    assert "cardume run noisy.yaml --seed 1 --set guidance.law=arcsine" in rest
    assert sorted(os.listdir("runs/noisy-compared/001")) == files.split(", ")


def test_what_is_suggested_next_works(folder: Path, cardume: Cardume) -> None:
    alike = (*LAWS, "--for", "position_error_rms")  # which these two do not change much
    out = cardume("compare", "noisy.yaml", *alike, "--runs", "2", "--no-figures").out
    typed = [shlex.split(line) for line in out.splitlines() if line.startswith("  cardume ")]
    assert ["cardume", "compare", "noisy.yaml", *alike, "--runs", "8"] in typed
    for _, *words in typed:
        assert cardume(*words, "--no-figures").code == 0


def test_json_says_the_same(folder: Path, cardume: Cardume) -> None:
    code, out, err = cardume(
        "compare", "line.yaml", *LAWS, "--seeds", "3,5-6", "--for", "a.cross_track_rms", "-o", "out", "--json"
    )
    assert (code, err.replace(COMPILING, "")) == (0, "")
    told = json.loads(out)
    assert told == json.loads(Path("out/compare.json").read_text())
    assert told["seeds"] == [3, 5, 6]
    assert list(told["units"]) == ["a.cross_track_rms"]
    assert told["arms"][1]["changes"] == ["guidance.law=arcsine"]


def test_quiet_says_nothing_and_writes_all(folder: Path, cardume: Cardume) -> None:
    assert cardume("compare", "line.yaml", *LAWS, "--runs", "1", "-o", "out", "-q") == Result(0, "", "")
    assert "compare.csv" in os.listdir("out")


def test_what_has_no_influence_and_what_is_not_random_is_said(folder: Path, cardume: Cardume) -> None:
    out = " ".join(cardume("compare", "line.yaml", "--vary", "seed=1,2", "--runs", "2", "--no-figures").out.split())
    assert "All arms flew alike: seed has no influence on any of these numbers." in out
    out = " ".join(cardume("compare", "line.yaml", *LAWS, "--runs", "2", "--no-figures").out.split())
    assert "arcsine did not settle on its path in 2 of 2 missions: most numbers are missing there." in out
    assert "Every seed gave the same: nothing in these missions is random" in out
    assert "exact" in out
    out = " ".join(cardume("compare", "noisy.yaml", *LAWS, "--runs", "1", "--no-figures").out.split())
    assert "for intervals add --runs 20" in out


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["line.yaml"], "there is one arm only"),
        (["line.yaml", "--vary", "guidance.law=line_of_sight"], "there is one arm only"),
        (["line.yaml", "--vary", "guidance.law"], "write key=value,value"),
        (["line.yaml", "--vary", "guidance.lw=a,b"], "--vary guidance.lw=a: there is no key 'lw' in guidance."),
        (["line.yaml", "--vary", "guidance.law=a,b"], "there is no guidance law 'a'"),
        (["lin.yaml", *LAWS], "lin.yaml"),
        ([], "Missing argument 'MISSION...'"),
        (["line.yaml", *LAWS, "--runs", "0"], "0 is not in the range"),
        (["line.yaml", *LAWS, "--runs", "many"], "--runs"),
        (["line.yaml", *LAWS, "--seeds", "9-1"], "'9-1' counts backwards; write 1-9"),
        (["line.yaml", *LAWS, "--seeds", ""], "'' is no seed"),
        (["line.yaml", *LAWS, "--seeds", "1,one"], "'one' is no seed"),
        (["line.yaml", *LAWS, "--seeds", "1-999999999"], "more than 100000 seeds"),
        (["line.yaml", *LAWS, "--seeds", "1,2,1"], "the seed 1 is given twice"),
        (["line.yaml", *LAWS, "--seeds", "9999999999999999999"], "is no seed"),
        (["line.yaml", *LAWS, "--seeds", "1", "--runs", "2"], "give one of them"),
        (["line.yaml", *LAWS, "--for", "cross_track_rm"], "Did you mean 'cross_track_rms'?"),
        (["line.yaml", *LAWS, "--for", "b.energy"], "no vehicle is called 'b'"),
        (["line.yaml", *LAWS, "-o", "line.yaml"], "is a file"),
        (["line.yaml", *LAWS, "-o", "."], "is not empty"),
    ],
)
def test_a_slip_is_told_before_anything_flies(
    folder: Path, cardume: Cardume, arguments: list[str], complaint: str
) -> None:
    before = sorted(os.listdir())
    code, out, err = cardume("compare", *arguments)
    assert (code, out) == (2, "")
    assert complaint in " ".join(err.split())
    assert sorted(os.listdir()) == before


def test_an_arm_that_fails_altogether_ends_with_3(folder: Path, cardume: Cardume) -> None:
    (folder / "lost_law.py").write_text(
        "from cardume.maths import sqrt\nfrom cardume.onboard.guidance import guidance_law\n"
        "from cardume.signals import PathError\n\n@guidance_law\ndef lost(error: PathError) -> float:\n"
        '    """Lost.\n\n    Source: own.\n    """\n    return sqrt(2.9 - error.cross_track)\n'
    )
    laws = "guidance.law=line_of_sight,lost_law:lost"
    code, out, _ = cardume("compare", "line.yaml", "--vary", laws, "--runs", "2", "--allow-code", ".")
    assert code in (2, 3)
    if code == 3:
        assert "lost_law:lost failed in 2 of 2 missions" in " ".join(out.split())


def test_a_figure_that_cannot_be_drawn_loses_no_comparison(
    folder: Path, cardume: Cardume, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(folder / "state"))
    monkeypatch.setattr("cardume.report.comparison_figure.draw_comparison", lambda comparison: 1 / 0)
    code, _, err = cardume("compare", "line.yaml", *LAWS, "--runs", "1", "-o", "out")
    assert code == 4
    assert "the figure could not be drawn" in err
    assert sorted(os.listdir("out")) == ["compare.csv", "compare.json"]


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interruption_keeps_what_all_arms_flew(folder: Path, number: int, code: int) -> None:
    """A script that has the signal sent once some missions of every arm have flown, in lanes 16 at a time too."""
    script = (
        "import os, signal, sys\nfrom cardume.cli import progress\nfrom cardume.cli.main import main\n"
        "call = progress.Progress.__call__\n"
        "def note(self, stage, done, total):\n"
        "    call(self, stage, done, total)\n"
        f"    if stage == 'compare' and done >= 40: os.kill(os.getpid(), {int(number)})\n"
        "progress.Progress.__call__ = note\n"
        "main(sys.argv[1:])\n"
    )
    words = ["compare", "noisy.yaml", *LAWS, "--runs", "100000", "-o", "out"]
    done = subprocess.run([sys.executable, "-c", script, *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == code, done.stderr
    assert "interrupted; what all arms flew" in done.stderr
    told = json.loads(Path("out/compare.json").read_text())
    assert told["interrupted"]
    assert 4 <= len(told["seeds"]) < 1000
    assert not [name for name in os.listdir() if "partial" in name]
    assert "Interrupted: all arms were flown with" in done.stdout


def test_an_interruption_before_anything_flew_keeps_nothing(folder: Path) -> None:
    script = (
        "import os, signal, sys\nfrom cardume.cli.main import main\nfrom cardume.studies import comparing\n"
        "comparing.make_arms = lambda *given: os.kill(os.getpid(), signal.SIGINT)\n"
        "main(sys.argv[1:])\n"
    )
    words = ["compare", "noisy.yaml", *LAWS, "-o", "out"]
    done = subprocess.run([sys.executable, "-c", script, *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == 130
    assert "nothing was kept" in done.stderr
    assert not Path("out").exists()


def test_an_interruption_before_all_arms_flew_a_seed_keeps_nothing(folder: Path) -> None:
    """The signal comes when the first arm has flown and the second has not."""
    script = (
        "import os, signal, sys\nfrom cardume.cli.main import main\nfrom cardume.studies import comparing\n"
        "real = comparing.fly_all\n"
        "def cut(*given, progress, **named):\n"
        "    progress('compare', 1, 2)\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    return [table.first(0) for table in real(*given, progress=progress, **named)]\n"
        "comparing.fly_all = cut\n"
        "main(sys.argv[1:])\n"
    )
    words = ["compare", "noisy.yaml", *LAWS, "--runs", "4", "-o", "out"]
    done = subprocess.run([sys.executable, "-c", script, *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == 130, done.stderr
    assert "nothing was kept" in done.stderr
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("done", "total", "seconds", "words"),
    [
        (10, 40, 1.0, "10 per second, 3 s left"),
        (1, 3, 100.0, "0.6 per minute, 3 min left"),
        (1, 1000, 60.0, "1 per minute, 16.6 h left"),
    ],
)
def test_rate_and_time_left(done: int, total: int, seconds: float, words: str) -> None:
    assert pace(done, total, seconds) == words


def test_the_module_is_found_by_its_command() -> None:
    """The command line imports nothing heavy for it."""
    begin = time.monotonic()
    done = subprocess.run(command("compare", "--help"), capture_output=True, text=True)
    assert done.returncode == 0
    assert "compared; 2: bad input" in done.stdout
    assert time.monotonic() - begin < 30.0
    assert program.cli.commands["compare"] is not None
