"""The C programs of the reference workload do the same work as cardume: the same log, messages and metrics."""

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numba import config

from benchmarks.calibration import Calibration
from benchmarks.reference import native, users_laws
from benchmarks.reference.fleets import fleet_plans
from benchmarks.reference.numpy_across import Missions
from benchmarks.reference.workload import reference_plans
from benchmarks.timing import Effort
from cardume.simulation.flight import Metrics
from cardume.simulation.fly import Flown, fly, fly_batch
from cardume.simulation.plan import Plan
from cardume.simulation.recording import CHANNELS, MESSAGES
from cardume.simulation.results import metrics_of
from cardume.simulation.score import FLEET_SCORES, SCORES, FleetScore, Formation, Score, Talk

SAME = 1e-9
MISSIONS = 9  # one more than fit side by side
needs_c = pytest.mark.skipif(native.why_not() is not None, reason=str(native.why_not()))
programs = pytest.mark.parametrize("program", [native.SCALAR, native.VECTOR_256], ids=lambda p: p.source)


class Whole(Effort):
    """The missions at their full length; shorter ones where nothing is compiled."""

    def mission_seconds(self) -> float:
        return 600.0 if not config.DISABLE_JIT else 12.0


@cache
def plans() -> list[Plan]:
    return reference_plans(MISSIONS, Whole(Calibration(1)))


@cache
def flown(which: int) -> Flown:
    return fly(plans()[which])


@cache
def in_c(program: native.Program) -> native.Flying:
    flying = native.Flying(program, plans())
    flying.fly(threads=2)
    return flying


def assert_same(ours: np.ndarray, theirs: np.ndarray) -> None:
    assert (np.isnan(ours) == np.isnan(theirs)).all()
    np.testing.assert_allclose(theirs, ours, rtol=0.0, atol=SAME)


@needs_c
@programs
@pytest.mark.parametrize("which", [0, 5, 8])
def test_the_whole_log_is_the_same(program: native.Program, which: int) -> None:
    theirs, size = in_c(program)["log"][which], len(plans()[which].vehicles)
    ours = flown(which).tables.log.reshape(-1, size, len(CHANNELS))[: len(theirs)]
    for channel, name in enumerate(CHANNELS):
        if name in native.LOG:
            same = theirs[..., native.LOG.index(name)]
            np.testing.assert_allclose(same, ours[..., channel], rtol=0.0, atol=SAME, err_msg=name)
        else:
            assert np.isnan(ours[..., channel]).all(), f"{name} says something in this mission, and C does not log it"
    assert_same(
        flown(which).tables.predictions.reshape(-1, size, size)[: len(theirs)], in_c(program)["predictions"][which]
    )


@needs_c
@programs
@pytest.mark.parametrize("which", [0, 5, 8])
def test_every_message_is_the_same(program: native.Program, which: int) -> None:
    tables = flown(which).tables
    count = int(tables.counts[MESSAGES])
    ours, theirs = tables.messages.reshape(-1, native.MESSAGE_COLUMNS)[:count], in_c(program)["messages"][which]
    assert count > 10
    assert_same(ours, theirs[:count])
    assert np.isnan(theirs[count:]).all()


def metrics_in_c(program: native.Program, which: int) -> Metrics:
    """Our metrics, made from the sums of the C program."""
    flying, ours = in_c(program), flown(which)
    rows = ours.tables.scores.reshape(len(ours.plan.vehicles), -1).copy()
    for row, sums in zip(rows, flying["vehicles"][which], strict=True):
        named = dict(zip(native.VEHICLE_SUMS, sums, strict=True))
        for record in (Score, Formation, Talk):
            put(row, SCORES.offsets[record], record, named)
    fleet = ours.tables.fleet_score.copy()
    put(
        fleet,
        FLEET_SCORES.offsets[FleetScore],
        FleetScore,
        dict(zip(native.FLEET_SUMS, flying["fleet"][which], strict=True)),
    )
    histograms = flying["histograms"][which].ravel()
    return metrics_of(
        replace(ours, tables=ours.tables._replace(scores=rows.ravel(), fleet_score=fleet, histograms=histograms))
    )


def put(row: np.ndarray, start: int, record: Any, named: dict[str, float]) -> None:
    for place, name in enumerate(record._fields):
        if name in named:
            row[start + place] = named[name]


@needs_c
@programs
@pytest.mark.parametrize("which", [0, 5, 8])
def test_every_metric_is_the_same(program: native.Program, which: int) -> None:
    ours, theirs = metrics_of(flown(which)), metrics_in_c(program, which)
    pairs = [(ours.fleet, theirs.fleet), *((ours.vehicles[v], theirs.vehicles[v]) for v in ours.vehicles)]
    for mine, other in pairs:
        for name, value in mine.items():
            assert other[name] == pytest.approx(value, rel=SAME, abs=SAME, nan_ok=True), name
    if not config.DISABLE_JIT:
        assert sum(math.isfinite(v) for mine, _ in pairs for v in mine.values()) > 50


@needs_c
def test_numpy_does_the_same_work() -> None:
    begun = [replace(plan, duration=min(plan.duration, 40.0)) for plan in plans()]
    flying, missions = native.Flying(native.SCALAR, begun), Missions(begun)
    flying.fly(threads=2)
    missions.fly()
    assert_same(flying["log"], np.moveaxis(missions.log, -1, 0))
    assert np.array_equal(flying["histograms"], np.moveaxis(missions.histograms, -1, 0))
    for place, name in enumerate(native.VEHICLE_SUMS):
        if name not in ("north", "east", "heading"):
            assert_same(flying["vehicles"][..., place], missions.sums[name].T)
    for place, name in enumerate(native.FLEET_SUMS[:-1]):
        assert_same(flying["fleet"][:, place], missions.fleet[name])
    received = np.array([row[1] for row in missions.messages]).T
    assert_same(flying["messages"][:, : received.shape[1], 1], received)


@needs_c
@programs
def test_a_number_that_is_none_stops_the_timing(program: native.Program) -> None:
    laws = {**plans()[0].vehicles[0].laws}
    laws["current"] = replace(laws["current"], parameters={**laws["current"].parameters, "speed": math.nan})
    ill = replace(plans()[0], vehicles=(replace(plans()[0].vehicles[0], laws=laws), *plans()[0].vehicles[1:]))
    with pytest.raises(RuntimeError, match="failed"):
        native.Flying(program, [ill]).fly(threads=1)


def test_missions_differ_in_what_is_drawn() -> None:
    drawn = native.missions_of(plans())
    for name in drawn.dtype.names or ():
        assert len(set(drawn[name].tolist())) == MISSIONS, name


def test_one_users_law_has_lanes_and_the_other_is_called_for_each() -> None:
    if config.DISABLE_JIT:
        pytest.skip("nothing is compiled")
    assert users_laws.for_lanes.handle(lanes=True) > 0
    assert users_laws.with_an_if.handle(lanes=True) < 0


@pytest.mark.parametrize("size", [3, 10, 60])
def test_a_fleet_of_any_size_hears_two_each(size: int) -> None:
    (plan,) = fleet_plans(size, 1, Whole(Calibration(1)))
    hears = np.asarray(plan.hears)
    assert len(plan.vehicles) == size
    assert hears.sum(1).tolist() == [1, *[2] * (size - 2), 1]
    assert set(plan.vehicles[0].laws) == set(plan.vehicles[-1].laws)


@pytest.mark.slow
@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_lanes_fly_it_to_the_last_bit() -> None:
    for which, ours in enumerate(fly_batch(plans()[:8], lanes=True)):
        assert np.array_equal(ours.tables.log, flown(which).tables.log, equal_nan=True)
        assert np.array_equal(ours.tables.histograms, flown(which).tables.histograms)
