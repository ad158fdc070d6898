"""`cardume study` to its end, and `cardume report` of what it left."""

import json
from pathlib import Path

import numpy as np
import pytest

from cardume.cli.main import main
from cardume.studies.answers.again import fly_again
from cardume.studies.answers.results import Results
from cardume.studies.store import open_study
from studies.missions import NOISY

DRAWN = NOISY.replace("speed: 0.1 m/s, towards", "speed: {uniform: [0 m/s, 0.3 m/s]}, towards")
LAW = """
from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError

@guidance_law
def straight(error: PathError, lookahead: Positive[Meters] = 2.0) -> Radians:
    return error.path_course - atan(error.cross_track / lookahead)
"""
REQUIRED = f"{DRAWN}\nrequire: {{cross_track_rms: 0.5 m}}\n"


def typed(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """What a command line says, and how it ends."""
    with pytest.raises(SystemExit) as end:
        main(words)
    said = capsys.readouterr()
    return int(end.value.code or 0), said.out, said.err


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of 24 short missions."""
    folder = tmp_path_factory.mktemp("studies")
    (folder / "line.yaml").write_text(REQUIRED, encoding="utf-8")
    with pytest.raises(SystemExit) as end:
        main(["study", str(folder / "line.yaml"), "--runs", "24", "-o", str(folder / "out"), "--quiet"])
    assert not end.value.code
    return folder / "out"


def test_a_study_leaves_figures_page_and_conclusions(study: Path) -> None:
    assert (study / "report.html").stat().st_size > 1_000_000
    assert {path.stem for path in (study / "figures").iterdir()} == {
        *("distributions", "influences", "requirements", "worst"),
    }
    said = json.loads((study / "summary.json").read_text(encoding="utf-8"))["conclusions"]
    assert any(sentence.startswith("What is required holds in ") for sentence in said)


def test_any_of_its_runs_flies_again_bit_for_bit(study: Path) -> None:
    results = Results(open_study(study))
    for run in (0, 17):
        flight = fly_again(results, (), run)
        for metric in results.metrics:
            np.testing.assert_array_equal(flight.metrics.worst(metric)[0], results.values(metric)[run])


def test_figures_for_a_paper(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ("--figure", "influences", "--figure", "worst", "--format", "pdf", "--width", "88mm", "-o", str(tmp_path))
    code, said, _ = typed(capsys, "report", str(study), *out)
    assert code == 0
    assert said.count("Written: ") == 2
    assert (tmp_path / "figures" / "worst.pdf").read_bytes().startswith(b"%PDF")


def test_worst_runs_that_cannot_fly_here_are_told_and_leave_the_other_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A law of the mission's own that is not allowed here, or not there any more."""
    with_law = REQUIRED.replace("guidance: {law: line_of_sight", "guidance: {law: 'mine:straight'")
    assert with_law != REQUIRED
    (tmp_path / "mine.py").write_text(LAW, encoding="utf-8")
    (tmp_path / "line.yaml").write_text(with_law, encoding="utf-8")
    allowed, out = ("--allow-code", str(tmp_path)), tmp_path / "out"
    code, _, complaint = typed(
        capsys, "study", str(tmp_path / "line.yaml"), "--runs", "8", "-o", str(out), "-q", "--no-figures", *allowed
    )
    assert not code, complaint
    code, _, complaint = typed(capsys, "report", str(out), "--figure", "worst")
    assert code == 2
    assert "mine" in complaint
    assert "--allow-code" in complaint
    assert typed(capsys, "report", str(out), "--figure", "worst", *allowed)[0] == 0
    code, said, _ = typed(capsys, "report", str(out), "--figure", "all", "-o", str(tmp_path / "all"))
    assert code == 0
    assert "distributions.svg" in said
    assert "worst.svg" not in said


@pytest.mark.parametrize(
    ("figure", "message"),
    [("influence", "Did you mean 'influences'?"), ("map", "it takes two swept keys of numbers"), ("plan", "no such")],
)
def test_a_figure_that_a_study_has_not(
    study: Path, figure: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, _, complaint = typed(capsys, "report", str(study), "--figure", figure)
    assert code == 2
    assert message in complaint


def test_the_page_again(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert typed(capsys, "report", str(study), "-o", str(tmp_path), "--quiet")[:2] == (0, "")
    assert (tmp_path / "report.html").read_bytes() == (study / "report.html").read_bytes()
