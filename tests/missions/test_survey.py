"""The survey of Hung et al. flown again: its vehicle, path and gains, and the integrals of |e| that it prints."""

import pytest

from cardume.missions.flying import fly_mission
from cardume.missions.library import names
from cardume.missions.opening import open_mission
from cardume.simulation.flight import Flight

# Printed; our flights differ by 1.3e-4, 9.5e-4, 5.6e-6 and 7.9e-4 of it.  Methods 2 and 4 differ because our virtual
# target follows its pull exactly where theirs takes an Euler step, and method 1 because the speed that the survey's
# vehicle asks for is that of the next step.
PRINTED = {
    "survey/micaelli-samson": 213.058779,
    "survey/lapierre": 212.321180,
    "survey/line-of-sight": 269.490208,
    "survey/line-of-sight-rabbit": 232.111802,
}


def flown(name: str) -> Flight:
    flight = fly_mission(open_mission(name))
    assert flight.reason == "completed", flight.failure
    return flight


def integral(flight: Flight) -> float:
    return flight.metrics.vehicles["alone"]["cross_track_iae"]


@pytest.mark.parametrize("name", PRINTED)
def test_the_printed_integrals_of_the_absolute_error(name: str) -> None:
    """Required within 0.5 %; they come within 0.1 %."""
    assert integral(flown(name)) == pytest.approx(PRINTED[name], rel=1e-3)


def test_the_error_is_that_of_the_point_abeam_at_every_tick_of_400_seconds() -> None:
    """Of the virtual target's own e it would be 179.5 m s for Lapierre and 195.9 for line of sight."""
    flight = flown("survey/line-of-sight-rabbit")
    assert integral(flight) > 1.15 * 195.86
    assert flight.flown == pytest.approx(400.0)


def test_aguiar_hespanha_is_reported() -> None:
    """No number is printed for it. The toolbox's own code, integrated independently, gives 124.21 m s.

    Its limits are of the path's parameter, ours in meters: its target may speed up by 0.005 1/s^2, which is 0.07 to
    0.10 m/s^2 along this path.
    """
    assert integral(flown("survey/aguiar-hespanha")) == pytest.approx(124.21, rel=0.025)


def test_all_are_there() -> None:
    assert {name for name in names() if name.startswith("survey/")} == {*PRINTED, "survey/aguiar-hespanha"}


def test_the_yaw_rate_is_limited_to_what_the_survey_allows() -> None:
    for name in ("survey/micaelli-samson", "survey/lapierre", "survey/aguiar-hespanha"):
        assert abs(flown(name).channels["yaw_rate"]).max() == pytest.approx(0.2, abs=1e-9)
