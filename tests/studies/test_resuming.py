"""A study that was killed, damaged or stopped ends with the bits of one that never was."""

import errno
import os
import random
import re
import resource
import shutil
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray

import cardume
from cardume.errors import DataError, InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.results import ResultsError
from cardume.studies import beginning, layout, store
from cardume.studies.ledger import read_ledger
from studies import killing
from studies.missions import NOISY

CHUNKS = killing.RUNS // killing.PORTION * 2


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The study, never interrupted."""
    before = layout.PORTION_WORK, layout.SMALLEST_PORTION
    directory = tmp_path_factory.mktemp("studies") / "whole"
    killing.fly(directory)
    yield directory
    layout.PORTION_WORK, layout.SMALLEST_PORTION = before


@pytest.fixture
def copy(whole: Path, tmp_path: Path) -> Path:
    """A copy of it, to be damaged."""
    return Path(shutil.copytree(whole, tmp_path / "copy"))


def assert_same(one: Path, other: Path) -> None:
    """Every array, attribute and file of both stores is the same."""
    xarray.testing.assert_identical(cardume.open_study(one).load(), cardume.open_study(other).load())
    files = [sorted(p.relative_to(d) for p in (d / store.STORE_NAME).rglob("*") if p.is_file()) for d in (one, other)]
    assert files[0] == files[1]
    for file in (one / store.STORE_NAME).rglob("*"):
        if file.is_file():
            assert file.read_bytes() == (other / file.relative_to(one)).read_bytes(), file
    assert dict(sorted(read_ledger(one)[1].items())) == dict(sorted(read_ledger(other)[1].items()))


def resumed(directory: Path) -> tuple[int, tuple[str, ...]]:
    """Continue; how many missions that took, and what was noted."""
    told = []
    killing.fly(directory, resume=True, announce=told.append)
    return told[0].missions, told[0].notes


@pytest.mark.parametrize(("kills", "runs"), [(3, 12), pytest.param(10, 60, marks=pytest.mark.slow)])
def test_kills_at_random_moments_change_nothing(tmp_path: Path, kills: int, runs: int) -> None:
    whole, directory, chance = tmp_path / "whole", tmp_path / "killed", random.Random(kills)
    began = time.perf_counter()
    killing.fly(whole, runs=runs, threads=1)
    longest = 1.5 * (time.perf_counter() - began) / kills
    midway = 0
    for kill in range(kills):
        child = killing.fly_in_a_fork(directory, (directory / store.STORE_NAME).exists(), runs)
        while kill % 2 and not (directory / store.STORE_NAME).exists():
            time.sleep(0.01)  # every other one comes when it flies
        time.sleep(chance.uniform(0.0, 1.0) * longest)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
        assert os.WIFSIGNALED(status) or os.WEXITSTATUS(status) == 0
        midway += 0 < len(read_ledger(directory)[1]) < 2 * runs // killing.PORTION
    killing.fly(directory, (directory / store.STORE_NAME).exists(), runs)
    assert_same(whole, directory)
    assert not list(tmp_path.rglob("*.partial"))
    assert midway >= kills // 4  # of a study that was never caught in the act nothing is proved


def chunk_of(directory: Path, name: str = "fleet_cross_track_iae") -> Path:
    """The file of the last portion of the first case."""
    place = directory / store.STORE_NAME / name / "c" / "0" / "2"
    return place / "0" if place.is_dir() else place


def truncate(file: Path) -> None:
    os.truncate(file, file.stat().st_size // 2)


def corrupt(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def empty(file: Path) -> None:
    file.write_bytes(b"")


@pytest.mark.parametrize(
    ("name", "damage"),
    [
        ("fleet_cross_track_iae", truncate),
        ("fleet_cross_track_iae", corrupt),
        ("failure", empty),
        ("status", Path.unlink),
        ("met", corrupt),
    ],
)
def test_a_damaged_chunk_is_found_and_flown_again(
    whole: Path, copy: Path, name: str, damage: Callable[[Path], None]
) -> None:
    damage(chunk_of(copy, name))
    missions, notes = resumed(copy)
    assert missions == killing.PORTION
    assert f"1 of {CHUNKS} portions were damaged" in notes[0]
    assert_same(whole, copy)


def test_two_damaged_chunks_of_one_portion_cost_it_once(whole: Path, copy: Path) -> None:
    truncate(chunk_of(copy))
    corrupt(chunk_of(copy, "got"))
    assert resumed(copy)[0] == killing.PORTION
    assert_same(whole, copy)


def test_an_interrupted_mending_is_not_told_as_complete(whole: Path, copy: Path) -> None:
    corrupt(chunk_of(copy, "got"))
    killing.fly(copy, resume=True, should_stop=lambda: True)
    assert int((cardume.open_study(copy)["status"] == layout.NOT_FLOWN).sum()) == killing.PORTION
    assert resumed(copy)[0] == killing.PORTION
    assert_same(whole, copy)


def test_a_corrupted_chunk_is_not_read_as_numbers(copy: Path) -> None:
    corrupt(chunk_of(copy))
    with pytest.raises(ValueError, match=r"(?i)crc|checksum"):
        cardume.open_study(copy)["fleet_cross_track_iae"].load()


def test_a_complete_study_flies_nothing(whole: Path, copy: Path) -> None:
    assert resumed(copy) == (0, ())
    assert_same(whole, copy)


def cut_short(ledger: bytes) -> bytes:
    return ledger[: -len(ledger) // 3]


def garbled(ledger: bytes) -> bytes:
    return ledger.replace(b"\n1 ", b"\n1 f00", 1).replace(b"\n4 ", b"\n\xff\x00 ", 1)


def foreign(ledger: bytes) -> bytes:
    """Every portion vouched for with the checksum of the first."""
    lines = ledger.splitlines()
    digest = lines[1].split()[1]
    return b"\n".join([lines[0], *(line.split()[0] + b" " + digest for line in lines[1:])])


def headless(ledger: bytes) -> bytes:
    return b"x" + ledger


@pytest.mark.parametrize("change", [cut_short, garbled, foreign, headless, lambda ledger: b""])
def test_a_damaged_ledger_costs_what_it_cannot_vouch_for(
    whole: Path, copy: Path, change: Callable[[bytes], bytes]
) -> None:
    ledger = copy / "ledger.txt"
    ledger.write_bytes(change(ledger.read_bytes()))
    resumed(copy)
    assert_same(whole, copy)


def test_a_lost_ledger_costs_all(whole: Path, copy: Path) -> None:
    (copy / "ledger.txt").unlink()
    missions, notes = resumed(copy)
    assert missions == CHUNKS * killing.PORTION
    assert "ledger was damaged" in notes[0]
    assert_same(whole, copy)


def test_the_ledger_never_vouches_for_numbers_of_another_study(copy: Path) -> None:
    """A chunk that is whole, but is another one's."""
    shutil.copy(chunk_of(copy), chunk_of(copy).with_name("1"))
    assert resumed(copy)[0] == killing.PORTION


@pytest.mark.parametrize("name", ["zarr.json", "run/c/0", "chance.current.speed/c/0", "got/zarr.json"])
def test_a_damaged_description_is_told(copy: Path, name: str) -> None:
    file = copy / store.STORE_NAME / name
    corrupt(file)
    with pytest.raises(DataError, match=r"is damaged.*fly it again in a new directory"):
        resumed(copy)


def test_another_version_is_told(copy: Path) -> None:
    file = copy / store.STORE_NAME / "zarr.json"
    file.write_text(file.read_text().replace('"cardume_study": 1', '"cardume_study": 2'))
    for use in (resumed, cardume.open_study):
        with pytest.raises(DataError, match=r"has format 2; this cardume reads format 1.*version that wrote it, 0"):
            use(copy)


def test_another_cardume_is_told(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cardume.studies.resuming.stamp", lambda: "0123")
    with pytest.raises(InputError, match=r"begun by another cardume .*begin a new study"):
        resumed(copy)


def test_another_mission_is_told_with_the_difference(copy: Path) -> None:
    mission = parse_mission(NOISY, catalog(), [*killing.OVERRIDES, "current.towards=91 deg"])
    with pytest.raises(InputError) as caught:
        cardume.study(mission, directory=copy, resume=True)
    said = str(caught.value)
    assert "--- as it was begun" in said
    assert re.search(r"^-.*towards: 90 deg", said, re.MULTILINE)
    assert re.search(r"^\+.*towards: 91 deg", said, re.MULTILINE)
    assert "vehicles" not in said


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"runs": 30}, "has 12 runs, and --runs 30"),
        ({"sampling": "monte_carlo"}, "is sampled by sobol"),
        ({"directory": None}, "say which with -o DIR"),
        ({"directory": Path("nowhere")}, "nowhere does not exist"),
        ({"directory": Path(__file__)}, "is a file"),
        ({"directory": Path(__file__).parent}, "holds no study"),
    ],
)
def test_what_cannot_be_continued_is_told(copy: Path, given: dict[str, object], said: str) -> None:
    mission = parse_mission(NOISY, catalog(), killing.OVERRIDES)
    with pytest.raises(InputError, match=said):
        cardume.study(mission, **({"directory": copy, "resume": True} | given))


def test_one_process_at_a_time_flies_a_study(copy: Path) -> None:
    from cardume.studies.ledger import Ledger

    with Ledger(copy), pytest.raises(InputError, match="being flown by another process"):
        resumed(copy)
    assert resumed(copy)[0] == 0


@pytest.mark.parametrize("content", ["study", "file", "other"])
def test_a_place_that_is_taken_is_refused(copy: Path, content: str) -> None:
    place = copy
    if content == "file":
        place = copy / "mission.yaml"
    elif content == "other":
        shutil.rmtree(copy / store.STORE_NAME)
    said = {"study": "holds a study already; continue it with --resume", "file": "is a file", "other": "is not empty"}
    with pytest.raises(InputError, match=said[content]):
        killing.fly(place)


def test_an_empty_directory_will_do(whole: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    killing.fly(tmp_path / "empty")
    assert_same(whole, tmp_path / "empty")


def test_a_disk_that_fills_up_keeps_what_was_flown(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, written = beginning.write_block, []

    def write(*given: object) -> None:
        if len(written) == 2:
            raise OSError(errno.ENOSPC, "No space left on device")
        written.append(before(*given))

    directory = tmp_path / "full"
    monkeypatch.setattr(beginning, "write_block", write)
    with pytest.raises(ResultsError, match=r"disk of .* is full.*what was flown is kept.*--resume"):
        killing.fly(directory)
    assert int((cardume.open_study(directory)["status"] == layout.FLOWN).sum()) == 2 * killing.PORTION
    monkeypatch.undo()
    killing.cut_small()
    assert resumed(directory)[0] == (CHUNKS - 2) * killing.PORTION
    assert_same(whole, directory)


def test_a_file_size_limit_is_told_and_leaves_whole_portions(whole: Path, tmp_path: Path) -> None:
    """The kernel refuses to write beyond the limit, in the middle of a file, as a quota does."""
    directory = tmp_path / "limited"
    killing.fly(directory, should_stop=lambda: True)
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (30, 30))
        try:
            killing.fly(directory, resume=True, threads=1)
        except ResultsError as problem:
            os._exit(7 if "is full" in str(problem) else 8)
        os._exit(9)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    assert not np.any(cardume.open_study(directory)["status"].values)
    killing.fly(directory, resume=True)
    assert_same(whole, directory)


def test_whatever_stands_beside_a_study_does_not_stop_it(copy: Path) -> None:
    """Folders that look half-written: of no number, of one that no process has, and of this process."""
    places = [copy.parent / f".{copy.name}.{number}.partial" for number in ("\u00b2", "9" * 30, str(os.getpid()))]
    for place in places:
        place.mkdir()
    assert resumed(copy) == (0, ())
    assert [place.exists() for place in places] == [True, False, True]
