"""The Plaza records through the command's own way: as near as the filter's own tests, and as the issue asks."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from cardume.errors import DataError
from cardume.missions.recordings import plaza
from cardume.missions.recordings.asking import Request
from cardume.missions.recordings.base import Options
from cardume.missions.recordings.replaying import replay

FOUND = importlib.util.find_spec("gtsam")
DATA = Path(FOUND.origin).parent / "Data" if FOUND and FOUND.origin else Path("nowhere")
has_data = pytest.mark.skipif(not (DATA / "Plaza1_.mat").is_file(), reason="gtsam, with its data, is not installed")


@has_data
@pytest.mark.parametrize("which", [1, 2])
def test_with_a_scale_of_the_ranges(which: int) -> None:
    """At most 0.6 m RMS by the law that is taken of itself, and the scale comes out at 7 %."""
    (part,) = replay(Request(path=DATA / f"Plaza{which}_.mat")).parts
    print(f"Plaza {which}: {part.score.position_error_rms:.3f} m")
    assert part.position == "range_filter"
    assert part.score.position_error_rms <= 0.6
    assert part.found is not None
    assert part.found["range_scale"] == pytest.approx(0.07, abs=0.01)


@has_data
@pytest.mark.slow
@pytest.mark.parametrize("which", [1, 2])
def test_from_an_unknown_start(which: int) -> None:
    (part,) = replay(Request(path=DATA / f"Plaza{which}_.mat", start="unknown")).parts
    away = np.hypot(*(part.believed.position - part.believed.truth).T)
    settled = part.believed.times > 30.0
    assert away[settled].max() < 2.0


@has_data
def test_by_a_law_of_the_engine() -> None:
    """kalman_replay takes the ranges too, but knows nothing of their scale."""
    law = {"law": "kalman_replay", "fix_sigma": "3 m"}
    (part,) = replay(Request(path=DATA / "Plaza1_.mat", position=law)).parts
    assert part.score.fixes > 3000
    assert 1.0 < part.score.position_error_rms < 6.0


TABLES = {
    "DR": np.array([[1.0, 0.1, 0.0], [2.0, 0.1, 0.1]]),
    "TD": np.array([[1.5, 1.0, 4.0, 5.0]]),
    "TL": np.array([[4.0, 3.0, 4.0]]),
    "GT": np.array([[0.5, 0.0, 0.0, 0.0], [2.0, 0.2, 0.0, 0.0]]),
}


def test_axes_of_a_record(tmp_path: Path) -> None:
    """x is east, y north, angles counter-clockwise from x: a vehicle that heads along x heads east."""
    savemat(tmp_path / "a.mat", TABLES)
    (mower,) = plaza.read(tmp_path / "a.mat", Options()).vehicles
    (fix,) = mower.sighted
    assert (fix.north, fix.east, fix.range, fix.source, fix.valid) == (4.0, 3.0, 5.0, "beacon-4", 1.0)
    assert mower.start_heading == pytest.approx(np.pi / 2.0)
    assert [way.turned for way in mower.ways] == [0.0, -0.1]
    assert mower.truth.values[-1] == pytest.approx([0.0, 0.2])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"DR": None}, "no table DR"),
        ({"GT": np.zeros((2, 3))}, "no table GT"),
        ({"TD": np.array([[1.0, np.nan, 4.0, 5.0]])}, "TD: holds numbers that are none, at row 1"),
        ({"DR": np.array([[1.0, 0.1, 0.0], [1.0, 0.1, 0.1]])}, "DR: times must increase, and do not at row 2"),
    ],
)
def test_what_is_no_record_is_refused(tmp_path: Path, change: dict, message: str) -> None:
    savemat(tmp_path / "a.mat", {k: v for k, v in (TABLES | change).items() if v is not None})
    with pytest.raises(DataError, match=message):
        plaza.read(tmp_path / "a.mat", Options())


def test_a_damaged_file_is_named(tmp_path: Path) -> None:
    savemat(tmp_path / "a.mat", TABLES)
    data = (tmp_path / "a.mat").read_bytes()
    draw, said = np.random.default_rng(5), []
    for _ in range(60):
        torn = bytearray(data[: draw.integers(1, len(data))])
        torn[draw.integers(len(torn))] = draw.integers(256)
        (tmp_path / "b.mat").write_bytes(bytes(torn))
        try:
            plaza.read(tmp_path / "b.mat", Options())
        except DataError as problem:
            said.append(str(problem))
    assert len(said) > 40
    assert all("b.mat" in text for text in said)
