"""The worked mission by ranges, flown 60 times in each way: its thresholds, and what its page prints."""

from types import ModuleType

import numpy as np
import pytest

from cardume.studies.statistics import paired_difference
from studies.worked import differences, example_of, printed

BEST, CIRCLE, ZIGZAG, MOWER, LINE, BEARINGS = range(6)  # arms of the example
LATE, SHORTER, LONGER, FAST = range(4)  # columns of what becomes of an arm

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3000)]


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """examples/ranging.py, which flies and draws it."""
    return example_of("ranging")


@pytest.fixture(scope="module")
def found(example: ModuleType) -> list[np.ndarray]:
    """(seed, column) of each arm."""
    return [example.outcomes(arm) for arm in example.ARMS]


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_ranges_alone_are_enough_where_the_surface_vehicle_moves(found: list[np.ndarray]) -> None:
    """At most 1.2 m after 300 s and 2.5 times as much as with bearings, at a speed that a MEDUSA can keep."""
    late = found[BEST][:, LATE]
    assert late.max() <= 1.2
    assert rms(late) <= 2.5 * rms(found[BEARINGS][:, LATE])
    assert found[BEST][:, FAST].max() <= 0.7


@pytest.mark.parametrize("other", [CIRCLE, ZIGZAG])
def test_the_maneuver_that_tells_most_is_better_than_a_fixed_one(found: list[np.ndarray], other: int) -> None:
    assert paired_difference(found[BEST][:, LATE], found[other][:, LATE]).high < 0.0


def test_a_rigid_formation_is_observed_in_bends_and_not_on_a_line(found: list[np.ndarray]) -> None:
    """The filter says so itself, and is right: what the initial current leaves on a line, it never learns."""
    on_line, on_mower = found[LINE], found[MOWER]
    assert np.median(on_line[:, LONGER]) > 80.0
    assert np.median(on_line[:, LATE]) > 20.0
    assert np.median(on_mower[:, LONGER]) < 3.0
    assert np.median(on_mower[:, LATE]) < 1.5


def test_the_page_prints_what_they_give(example: ModuleType) -> None:
    assert not differences(printed("by-range.md", "by-range"), example.table_rows())
