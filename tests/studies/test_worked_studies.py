"""The worked studies of docs/tutorials, flown whole: what their pages print."""

import re
import sys
from importlib import util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from cardume.studies.answers.regions import boundary, chance_maps
from cardume.studies.answers.results import Results

ROOT = Path(__file__).parents[2]
TUTORIALS = ROOT / "docs" / "tutorials"


def script() -> ModuleType:
    """examples/studies.py, which flies and draws them."""
    spec = util.spec_from_file_location("studies_example", ROOT / "examples" / "studies.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def rows(page: str, table: str) -> list[list[float]]:
    """The numbers in the rows of a table that a comment names."""
    text = (
        (TUTORIALS / page).read_text(encoding="utf-8").partition(f"<!-- table: {table} -->\n")[2].partition("\n\n")[0]
    )
    found = [re.findall(r"\d+(?:\.\d+)?", line.replace("1/s", "")) for line in text.splitlines()[2:]]
    return [[float(number) for number in numbers] for numbers in found]


def check_row_s(example: ModuleType, runs: object) -> None:
    """Every case as printed; nearly every interval holds the formula, and none is far from it."""
    outside = 0
    for period, loss, delay, middle, low, high, theory in rows("theory-by-study.md", "row-s"):
        found = example.measured(runs, period=period, loss=loss, delay=delay)
        np.testing.assert_allclose([middle, low, high], found, atol=6e-5)
        assert theory == pytest.approx(float(example.drift_rms(period, loss, delay)), abs=6e-5)
        assert found[0] == pytest.approx(theory, rel=0.06)
        outside += loss > 0.0 and not low <= theory <= high
    assert outside <= 4  # of 16, some of which share their losses


def check_row_k2(example: ModuleType, runs: object) -> None:
    """Limits as printed, and within two steps of theory's."""
    found = example.limits(runs)
    printed = rows("theory-by-study.md", "row-k2")
    assert len(printed) == len(found)
    for gain, last, first, theory in printed:
        np.testing.assert_allclose(found[gain], (last, first), atol=1e-6)
        assert theory == pytest.approx(example.largest_scale(gain), abs=6e-5)
        assert last - 0.026 <= theory <= first


def check_talk(example: ModuleType, runs: object) -> None:
    """The longest period at which the requirement holds in 95 % of the missions, for each current and loss."""
    results = Results(runs)
    maps = chance_maps(results, (example.LOSS, example.PERIOD))
    for printed, chances in zip(rows("how-often-to-talk.md", "talk"), maps, strict=True):
        (line,) = boundary(chances)["middle"]
        order = np.argsort(line[:, 0])
        at = np.interp(chances.x, line[order, 0], line[order, 1])
        np.testing.assert_allclose(printed[1:], at, atol=0.06)


CHECKS = {"row-s": check_row_s, "row-k2": check_row_k2, "how-often-to-talk": check_talk}


@pytest.mark.slow
@pytest.mark.timeout(3000)
@pytest.mark.parametrize("name", CHECKS)
def test_the_page_prints_what_the_whole_study_gives(name: str, tmp_path: Path) -> None:
    example = script()
    CHECKS[name](example, example.flown(name, tmp_path))
