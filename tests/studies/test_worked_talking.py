"""The ways to talk of docs/tutorials/talk-by-events.md, flown 200 times each: thresholds, and what the page prints."""

from types import ModuleType

import numpy as np
import pytest

from studies.worked import differences, example_of, printed

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3000)]


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """examples/talking.py, which flies and draws them."""
    return example_of("talking")


def test_a_tenth_of_the_messages_costs_less_than_a_tenth_of_the_error(example: ModuleType) -> None:
    """At most 10 % of the traffic of everybody every second, and surely at most 10 % more coordination error."""
    assert len(example.flown(example.TENTH).sent) == 200
    assert np.isfinite(example.flown(example.TENTH).coordination).all()
    assert example.traffic(example.TENTH) <= 0.10
    assert example.costs(example.TENTH)[2] <= 0.10


def test_at_any_traffic_the_mixture_costs_least(example: ModuleType) -> None:
    """Pareto: the clock alone, and events alone, lie above the mixture's curve where their traffic is alike."""
    points = sorted((example.traffic(arm), example.costs(arm)[0]) for arm in example.MIXTURES)
    share, cost = np.array(points).T
    for arm in [*example.CLOCKS, *example.ALL_EVENTS]:
        if share[0] <= example.traffic(arm) <= share[-1]:
            assert example.costs(arm)[1] > np.interp(example.traffic(arm), share, cost), arm


def test_the_page_prints_what_they_give(example: ModuleType) -> None:
    assert not differences(printed("talk-by-events.md", "talking"), example.table_rows())
