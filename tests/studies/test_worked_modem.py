"""The worked missions through a modem, flown 200 times: their thresholds, and what their pages print."""

from types import ModuleType

import numpy as np
import pytest

from cardume.studies.statistics import paired_difference
from studies.worked import differences, example_of, printed

SPEED = 0.5  # [m/s] of the formation

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3000)]


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """examples/modem.py, which flies and draws them."""
    return example_of("modem")


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
    assert not differences(printed(page, "s2c"), wanted)
    wanted = example.lines_of(example.span_names(), example.silence_rows(), example.SILENCE_FORMATS)
    assert not differences(printed(page, "silences"), wanted)
