"""Must show 2: three MEDUSAs on a real mission file in a real current, over twenty seeds."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from functools import cache

import pytest

from cardume.missions import library
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.simulation.flight import Metrics
from cardume.simulation.fly import fly_batch
from cardume.simulation.results import metrics_of

SEEDS = range(1, 21)
NAMES = ("surface", "port", "starboard")
IDEAL = tuple(f"{key}sensors=ideal" for key in ("", *(f"vehicles.{name}." for name in NAMES)))
SLOW_GNSS = tuple(
    f"vehicles.surface.sensors.gnss.{value}"
    for value in ("sigma=0 m", "correlated_sigma=0.5 m", "correlation_time=100 s")
)
MEDUSA = "lawnmower.medusa.txt"  # the one that the package ships
HAS_DATA = library.data_file(library.RADAR) is not None and library.data_file(library.LAWNMOWER) is not None
FIELDS = [
    pytest.param("real", marks=pytest.mark.skipif(not HAS_DATA, reason="the radar's file is not here")),
    "synthetic",
]


@cache
def flights(field: str, overrides: Sequence[str] = ()) -> tuple[Metrics, ...]:
    """The metrics of every seed: with the radar's field and the real file, or with what stands in for them."""
    given = list(overrides)
    if field == "synthetic":
        given += [f"current.file='{library.synthetic_radar()}'", f"path.file='{library.path('cadiz').parent}/{MEDUSA}'"]
    missions = [open_mission("cadiz", given, seed) for seed in SEEDS]
    plans = [make_plan(draw(mission), catalog()).plan for mission in missions]
    assert {plan.num_ticks for plan in plans} == {9000}
    flown = fly_batch(plans, threads=2)
    assert [f.trouble for f in flown] == [None] * len(plans)
    return tuple(metrics_of(f) for f in flown)


def worst(found: Sequence[Metrics], metric: str) -> Mapping[str, float]:
    """The worst seed of each vehicle."""
    return {name: max(m.vehicles[name][metric] for m in found) for name in NAMES}


@pytest.mark.parametrize("field", FIELDS)
def test_every_vehicle_keeps_to_its_path_with_every_seed(field: str) -> None:
    found = flights(field)
    assert len(found) == 20
    assert all(value <= 0.4 for value in worst(found, "cross_track_rms").values()), worst(found, "cross_track_rms")
    assert all(m.fleet["coordination_error_rms"] <= 0.4 for m in found)
    assert all(m.fleet["coordination_error_max"] <= 1.2 for m in found)


@pytest.mark.parametrize("field", FIELDS)
def test_the_mission_is_flown_to_its_end_in_a_current_and_with_losses(field: str) -> None:
    """What would make the numbers above worth nothing does not happen."""
    for metrics in flights(field):
        for vehicle in metrics.vehicles.values():
            assert vehicle["settling_time"] < 100.0
            assert 0.25 < vehicle["path_speed_mean"] < 0.4  # the files' own: 0.3 and 0.4 m/s
            assert vehicle["position_error_rms"] == pytest.approx(0.7, abs=0.1)  # 0.5 m on each of two axes
            assert 0.005 < vehicle["current_error_rms"] < 0.1
            assert vehicle["messages_delivered"] < 0.95 * 900 * (2 if vehicle is metrics.vehicles["surface"] else 1)


@pytest.mark.parametrize("field", FIELDS)
def test_with_ideal_sensors_the_path_is_kept_more_closely(field: str) -> None:
    found = flights(field, IDEAL)
    assert all(value <= 0.25 for value in worst(found, "cross_track_rms").values()), worst(found, "cross_track_rms")


@pytest.mark.parametrize("field", FIELDS)
def test_a_gnss_error_that_all_share_does_not_deform_the_formation(field: str) -> None:
    """0.5 m, but slow: the fleet is displaced as a whole, and its shape is as good as with a white error."""
    white, slow = flights(field), flights(field, SLOW_GNSS)

    def typical(found: Sequence[Metrics], metric: str) -> float:
        values = [m.vehicles[name][metric] ** 2 for m in found for name in NAMES]
        return math.sqrt(statistics.fmean(values))

    one, other = typical(white, "formation_error_rms_relative"), typical(slow, "formation_error_rms_relative")
    assert other == pytest.approx(one, rel=0.25)
    assert typical(slow, "formation_error_rms") > typical(white, "formation_error_rms")  # but it is displaced
