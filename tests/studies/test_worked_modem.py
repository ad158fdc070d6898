"""The worked missions through a modem, flown 200 times: their thresholds, and what their pages print."""

import re
import sys
from importlib import util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from cardume.studies.statistics import paired_difference

ROOT = Path(__file__).parents[2]
SPEED = 0.5  # [m/s] of the formation

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3000)]


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """examples/modem.py, which flies and draws them."""
    spec = util.spec_from_file_location("modem_example", ROOT / "examples" / "modem.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def printed(page: str, table: str) -> list[str]:
    """The rows of a table that a comment names."""
    text = (ROOT / "docs" / "tutorials" / page).read_text(encoding="utf-8")
    return text.partition(f"<!-- table: {table} -->\n")[2].partition("\n\n")[0].splitlines()[2:]


def same_numbers(rows: list[str], wanted: list[str]) -> bool:
    """Whether two tables say the same, but for one in the last digit."""
    if len(rows) != len(wanted):
        return False
    for row, other in zip(rows, wanted, strict=True):
        ours, theirs = (re.findall(r"\d+(?:\.\d+)?", line) for line in (row, other))
        digits = [10.0 ** -len(number.partition(".")[2]) for number in theirs]
        if [re.sub(r"\d+(?:\.\d+)?", "", line) for line in (row, other)].count(re.sub(r"\d+(?:\.\d+)?", "", row)) != 2:
            return False
        if np.any(np.abs(np.array(ours, float) - np.array(theirs, float)) > 1.01 * np.array(digits)):
            return False
    return True


@pytest.mark.parametrize("case", ["as in the file", "GNSS errors slow", "a current from anywhere"])
def test_the_filter_holds_the_formation_through_a_modem(example: ModuleType, case: str) -> None:
    """0.9 m RMS, 1.2 m in 95 % of 200 missions, the wanted speed, and 1.6 times as good as the paper's."""
    found = example.compared(case)
    paper, ours = found.values(example.CASES[case][1])
    assert not found.failures(0) + found.failures(1)
    assert len(ours) == 200
    assert example.rms(ours) <= 0.9
    assert np.mean(ours <= 1.2) >= 0.95
    assert found.values("path_speed_mean")[1].mean() == pytest.approx(SPEED, rel=0.05)
    assert example.rms(paper) >= 1.6 * example.rms(ours)
    assert paired_difference(1.6 * ours, paper).high < 0.0


def test_a_silence_is_bounded_by_the_filter_s_own_covariance(example: ModuleType) -> None:
    """Three sigma along the longer axis: in 99 % of all long silences, and in the longest of nearly every mission."""
    missions = example.all_silences()
    every = np.array([silence for mission in missions for silence in mission])
    longest = np.array([max(mission) for mission in missions])
    assert np.mean(every[:, 1] <= every[:, 2]) > 0.99
    assert np.mean(longest[:, 1] <= longest[:, 2]) > 0.99
    assert longest[:, 0].max() > 60.0
    assert np.median(longest[:, 1] / longest[:, 2]) > 0.1  # a bound that says something


def test_the_page_prints_what_they_give(example: ModuleType) -> None:
    page = "through-a-modem.md"
    wanted = example.lines_of(list(example.CASES), example.s2c_rows(), example.S2C_FORMATS)
    assert same_numbers(printed(page, "s2c"), wanted), wanted
    wanted = example.lines_of(example.span_names(), example.silence_rows(), example.SILENCE_FORMATS)
    assert same_numbers(printed(page, "silences"), wanted), wanted
