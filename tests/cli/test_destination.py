"""Where a run's results go, and what is refused before anything flies."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.stand_ins import Result, Stage, tree

Cardume = Callable[..., Result]
RUN = ("run", "paper/figure-5", "--no-figures", "-q")


def test_every_run_gets_a_directory_of_its_own(stage: Stage, cardume: Cardume) -> None:
    assert cardume(*RUN).code == 0
    first = tree()
    assert cardume(*RUN).code == 0
    assert sorted(os.listdir("runs/figure-5")) == ["001", "002"]
    assert first.items() <= tree().items()
    os.rename("runs/figure-5/002", "runs/figure-5/041")
    assert cardume(*RUN).code == 0
    assert sorted(os.listdir("runs/figure-5")) == ["001", "041", "042"]


def test_a_number_taken_meanwhile_is_not_overwritten(stage: Stage, cardume: Cardume) -> None:
    def somebody_else(*_: object) -> None:
        os.makedirs("runs/figure-5/001")
        Path("runs/figure-5/001/theirs").touch()

    stage.flying = somebody_else
    assert cardume(*RUN).code == 0
    assert os.listdir("runs/figure-5/001") == ["theirs"]
    assert sorted(os.listdir("runs/figure-5/002")) == ["log.nc", "mission.yaml", "summary.json"]
    assert sorted(os.listdir("runs/figure-5")) == ["001", "002"]


def test_a_file_that_appears_meanwhile_is_not_overwritten(stage: Stage, cardume: Cardume) -> None:
    os.mkdir("here")
    stage.flying = lambda *_: Path("here/log.nc").write_text("theirs") and None
    code, _, err = cardume(*RUN, "-o", "here")
    assert code == 3
    assert "log.nc appeared there meanwhile" in err
    assert tree() == {"here/log.nc": b"theirs"}


def test_a_directory_given_may_be_new_or_empty(stage: Stage, cardume: Cardume) -> None:
    assert cardume(*RUN, "-o", "deep/down/here").code == 0
    assert sorted(os.listdir("deep/down")) == ["here"]
    os.mkdir("empty")
    before = os.stat("empty").st_ino
    assert cardume(*RUN, "-o", "empty").code == 0
    assert os.stat("empty").st_ino == before  # a mount point, or somebody's current directory
    assert sorted(os.listdir("empty")) == ["log.nc", "mission.yaml", "summary.json"]


def test_an_earlier_run_is_replaced_whole(stage: Stage, cardume: Cardume) -> None:
    assert cardume("run", "paper/figure-5", "-q", "-o", "here").code == 0
    assert os.path.isdir("here/figures")
    assert cardume(*RUN, "-o", "here").code == 0
    assert sorted(os.listdir("here")) == ["log.nc", "mission.yaml", "summary.json"]


def spoil(how: str) -> None:
    path = Path("here")
    if how == "file":
        path.write_text("mine")
        return
    path.mkdir()
    if how == "foreign":
        (path / "thesis.tex").write_text("mine")
    elif how == "foreign summary":
        (path / "summary.json").write_text("{}")
    elif how == "damaged summary":
        (path / "summary.json").write_bytes(b"\xff\xfe{")
    elif how == "deep summary":
        (path / "summary.json").write_text("[" * 100_000)
    elif how == "summary of nothing":
        (path / "summary.json").write_text('{"cardume_summary": 1, "files": 5}')


@pytest.mark.parametrize(
    ("how", "complaint"),
    [
        ("file", "is a file"),
        ("foreign", "is not empty, and not a run of cardume"),
        ("foreign summary", "is not empty, and not a run of cardume"),
        ("damaged summary", "is not empty, and not a run of cardume"),
        ("deep summary", "is not empty, and not a run of cardume"),
        ("summary of nothing", "is not empty, and not a run of cardume"),
    ],
)
def test_what_is_somebody_s_is_left_alone(stage: Stage, cardume: Cardume, how: str, complaint: str) -> None:
    spoil(how)
    before = tree()
    stage.flying = lambda *_: pytest.fail("flew before it looked where the results can go")
    code, out, err = cardume(*RUN, "-o", "here")
    assert (code, out) == (2, "")
    assert complaint in err
    assert "here" in err
    assert "give a new directory" in err
    assert tree() == before


def test_notes_in_an_earlier_run_are_left_alone(stage: Stage, cardume: Cardume) -> None:
    cardume("run", "paper/figure-5", "-q", "-o", "here")
    Path("here/figures/mine.png").write_text("mine")
    before = tree()
    code, _, err = cardume(*RUN, "-o", "here")
    assert code == 2
    assert "holds figures/mine.png, which cardume did not write there" in err
    assert tree() == before


def test_a_place_below_a_file_is_refused(stage: Stage, cardume: Cardume) -> None:
    Path("notes").write_text("mine")
    code, _, err = cardume(*RUN, "-o", "notes/here")
    assert code == 2
    assert "notes is a file" in err


@pytest.mark.skipif(os.name != "posix" or os.getuid() == 0, reason="root may write anywhere")
def test_a_place_without_permission_is_refused(stage: Stage, cardume: Cardume) -> None:
    os.mkdir("locked", mode=0o555)
    code, _, err = cardume(*RUN, "-o", "locked/here")
    assert code == 2
    assert "no permission to write in locked" in err


def test_permission_is_asked_before_the_flight(stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same for root, who is never refused."""
    monkeypatch.setattr(os, "access", lambda *_: False)
    stage.flying = lambda *_: pytest.fail("flew before it looked where the results can go")
    code, _, err = cardume(*RUN)
    assert code == 2
    assert "no permission to write in" in err
    assert tree() == {}
