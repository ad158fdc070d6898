"""Every metric, computed a second time in plain numpy from what was logged and watched at every tick."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.missions.flying import flight_of
from cardume.missions.planning import Planned
from cardume.signals import VesselState
from cardume.simulation.flight import METRICS, Flight, Metrics
from cardume.simulation.fly import Flown
from cardume.simulation.results import metrics_of, percentile
from cardume.simulation.score import BINS
from properties.flown import plan_of
from simulation.ticks import Watched, watch

TEXT = """
cardume: 1
name: measured
seed: 5
duration: 150 s
log_period: 0.1 s
path:
  type: segments
  start: {north: 3 m, east: -2 m, course: 25 deg}
  segments: [{line: 21 m}, {arc: 9 m, turn: port, angle: 120 deg}, {line: 27 m}]
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.08 m/s, towards: 60 deg, variation_sigma: 0.02 m/s}
model: medusa
swath: 3 m
transient: {threshold: 0.6 m, hold: 8 s}
bathymetry: {type: flat, depth: 30 m}
limits: {depth: 20 m, geofence: {radius: 500 m}}
compensation: {law: crab}
current_observer: {law: complementary}
position: {law: reset_compensated}
coordination: {law: laplacian_tanh, topology: complete}
messaging: {schedule: periodic, period: 1 s}
acoustics: {channel: bernoulli, loss: 0.2, delay: 0.37 s}
vehicles:
  - {name: zoe, offset: {ahead: 1 m}, start: {cross_track: 2 m, speed: 0.2 m/s},
     sensors: {gnss: {sigma: 0.3 m}, ahrs: {}, depth: {}, thruster_speed: {}}}
  - {name: amy, depth: 2 m, offset: {starboard: -3 m}, start: {along_track: -1 m, cross_track: -1 m},
     sensors: {gnss: {sigma: 0.3 m, deepest: 9 m}, ahrs: {}, depth: {}, thruster_speed: {}}}
"""
THRESHOLD, HOLD, DT, SWATH = 0.6, 8.0, 0.1, 3.0
LINE, RADIUS, ANGLE, LAST = 21.0, 9.0, math.radians(120.0), 27.0
LENGTH = LINE + RADIUS * ANGLE + LAST
OFFSETS = {"zoe": (0.0, 1.0), "amy": (-3.0, 0.0)}  # starboard, ahead


@pytest.fixture(scope="module")
def seen() -> Watched:
    return watch(plan_of(TEXT))


@pytest.fixture(scope="module")
def flight(seen: Watched) -> Flight:
    planned = Planned(seen.plan, seen.plan.vehicles[0].path)
    return flight_of("measured", planned, Flown(seen.plan, seen.tables, seen.plan.num_ticks))


@pytest.fixture(scope="module")
def metrics(flight: Flight) -> Metrics:
    return flight.metrics


def column(flight: Flight, channel: str, name: str) -> np.ndarray:
    """One channel of one vehicle, a number per tick that was flown."""
    return flight.channels[channel][: round(flight.flown / DT), flight.vehicle_names.index(name)]


def first_settled(flight: Flight, name: str) -> int:
    """The tick in which the transient of a vehicle is over: the error has been small for the hold time."""
    below, ticks = 0, round(HOLD / DT)
    for k, error in enumerate(np.abs(column(flight, "cross_track", name))):
        below = below + 1 if error < THRESHOLD else 0
        if below >= ticks:
            return k
    raise AssertionError("never settles")


def counted(flight: Flight, name: str) -> np.ndarray:
    """Which ticks count for a vehicle: after its transient, before the end of its path."""
    under_way = on_the_way(flight, name)
    return (np.arange(len(under_way)) >= first_settled(flight, name)) & under_way


def on_the_way(flight: Flight, name: str) -> np.ndarray:
    """In which ticks a vehicle has not yet been at the end of its path."""
    gamma = column(flight, "coordination_state", name) + OFFSETS[name][1]
    return ~np.logical_or.accumulate(gamma >= LENGTH)


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def bin_width(error: float) -> float:
    return (1.0 + error) ** 2 / BINS


@pytest.mark.parametrize("name", OFFSETS)
def test_cross_track(flight: Flight, metrics: Metrics, name: str) -> None:
    found, counts = metrics.vehicles[name], counted(flight, name)
    error, curved = column(flight, "cross_track", name), column(flight, "curvature", name) != 0.0
    assert 100 < counts.sum() < len(counts) - 100
    assert 100 < (counts & curved).sum()
    assert found["cross_track_rms"] == pytest.approx(rms(error[counts]), rel=1e-12)
    assert found["cross_track_rms_lines"] == pytest.approx(rms(error[counts & ~curved]), rel=1e-12)
    assert found["cross_track_rms_arcs"] == pytest.approx(rms(error[counts & curved]), rel=1e-12)
    assert found["cross_track_max"] == np.abs(error[counts]).max()
    exact = float(np.quantile(np.abs(error[counts]), 0.95))
    assert found["cross_track_p95"] == pytest.approx(exact, abs=1.5 * bin_width(exact))
    assert found["settling_time"] == pytest.approx((first_settled(flight, name) + 1) * DT - HOLD, abs=1e-9)


@pytest.mark.parametrize("name", OFFSETS)
def test_integral_of_the_absolute_error(flight: Flight, metrics: Metrics, name: str) -> None:
    """From the start on, with the transient, in rectangles, to the end of the path."""
    error = np.abs(column(flight, "cross_track", name))[on_the_way(flight, name)]
    assert error[0] > 0.5  # there is a transient
    assert metrics.vehicles[name]["cross_track_iae"] == pytest.approx(DT * error.sum(), rel=1e-12)


@pytest.mark.parametrize("name", OFFSETS)
def test_beliefs(flight: Flight, metrics: Metrics, name: str) -> None:
    def apart(what: str, unit: str) -> np.ndarray:
        parts = [
            column(flight, f"{unit}{axis}_estimate", name) - column(flight, f"{unit}{axis}", name)
            for axis in what.split()
        ]
        return np.hypot(*parts)

    found = metrics.vehicles[name]
    assert found["position_error_rms"] == pytest.approx(rms(apart("north east", "")), rel=1e-12)
    assert found["current_error_rms"] == pytest.approx(rms(apart("north east", "current_")), rel=1e-12)


@pytest.mark.parametrize("name", OFFSETS)
def test_motion(flight: Flight, seen: Watched, metrics: Metrics, name: str) -> None:
    found, counts = metrics.vehicles[name], np.flatnonzero(counted(flight, name))
    gamma = column(flight, "coordination_state", name)
    rate = (gamma[counts[-1]] - gamma[counts[0]]) / ((len(counts) - 1) * DT)
    assert found["path_speed_mean"] == pytest.approx(rate, rel=1e-12)
    assert found["path_speed_mean"] == pytest.approx(0.5, abs=0.03)
    yaw_rate = column(flight, "yaw_rate", name)
    assert found["yaw_effort"] == pytest.approx((np.diff(yaw_rate, prepend=0.0) ** 2).sum() / DT, rel=1e-12)
    power = seen.at_start(VesselState, "power")[:, seen.names.index(name)]
    assert power.max() > 1.0
    assert found["energy"] == pytest.approx(power.sum() * DT, rel=1e-12)


@pytest.mark.parametrize("name", OFFSETS)
def test_swath(flight: Flight, metrics: Metrics, name: str) -> None:
    """Only what lies between the farthest point so far and the vehicle is new."""
    gamma, error = column(flight, "coordination_state", name), column(flight, "cross_track", name)
    farthest = np.maximum.accumulate(np.concatenate([[max(0.0, gamma[0])], gamma]))  # none of it before the start
    swept = (np.diff(farthest) * np.clip(1.0 - np.abs(error) / SWATH, 0.0, 1.0)).sum()
    assert metrics.vehicles[name]["swath_coverage"] == pytest.approx(100.0 * min(1.0, swept / LENGTH), rel=1e-9)


def test_a_path_begun_in_the_middle_is_not_swept_from_its_start() -> None:
    override = ["vehicles.zoe.start.along_track=20 m", "vehicles.zoe.start.cross_track=0 m", "duration=10 s"]
    found = metrics_of(flown(override)).vehicles["zoe"]["swath_coverage"]
    assert 0.0 < found < 100.0 * 8.0 / LENGTH


def test_coordination_and_separation(flight: Flight, seen: Watched, metrics: Metrics) -> None:
    both = counted(flight, "zoe") & counted(flight, "amy")
    apart = np.abs(column(flight, "coordination_state", "zoe") - column(flight, "coordination_state", "amy"))[both]
    assert metrics.fleet["coordination_error_rms"] == pytest.approx(rms(apart), rel=1e-12)
    assert metrics.fleet["coordination_error_max"] == apart.max()
    parts = [np.diff(seen.at_start(VesselState, axis), axis=1)[:, 0] for axis in ("north", "east", "depth")]
    distance = np.sqrt(sum(part**2 for part in parts))
    assert metrics.fleet["separation_min"] == pytest.approx(distance.min(), rel=1e-12)


def place_on_path(gamma: np.ndarray, starboard: float) -> np.ndarray:
    """(tick, 2) the point of an offset path at a coordination state, by plain geometry."""
    course_0 = math.radians(25.0)
    turned = -np.clip((gamma - LINE) / RADIUS, 0.0, ANGLE)  # to port
    course = course_0 + turned
    line = np.minimum(gamma, LINE)
    points = np.stack([3.0 + line * math.cos(course_0), -2.0 + line * math.sin(course_0)], axis=1)
    side = np.stack([-np.sin(course), np.cos(course)], axis=1)  # to starboard
    side_0 = np.array([-math.sin(course_0), math.cos(course_0)])
    points += RADIUS * (side - side_0)  # the centre lies to port: p = centre + R side
    last = np.maximum(gamma - LINE - RADIUS * ANGLE, 0.0)
    points += last[:, None] * np.stack([np.cos(course), np.sin(course)], axis=1)
    return points + starboard * side


def test_formation(flight: Flight, metrics: Metrics) -> None:
    both = counted(flight, "zoe") & counted(flight, "amy")
    mean = 0.5 * (column(flight, "coordination_state", "zoe") + column(flight, "coordination_state", "amy"))
    away = {}
    for name, (starboard, ahead) in OFFSETS.items():
        here = np.stack([column(flight, "north", name), column(flight, "east", name)], axis=1)
        away[name] = (here - place_on_path(mean + ahead, starboard))[both]
    common = 0.5 * (away["zoe"] + away["amy"])
    for name in OFFSETS:
        found, distance = metrics.vehicles[name], np.hypot(*away[name].T)
        assert found["formation_error_rms"] == pytest.approx(rms(distance), rel=1e-9)
        assert found["formation_error_rms_relative"] == pytest.approx(rms(np.hypot(*(away[name] - common).T)), rel=1e-9)
        exact = float(np.quantile(distance, 0.95))
        assert found["formation_error_p95"] == pytest.approx(exact, abs=1.5 * bin_width(exact))


@pytest.mark.parametrize("name", OFFSETS)
def test_messages(flight: Flight, metrics: Metrics, name: str) -> None:
    found, messages, me = metrics.vehicles[name], flight.messages, flight.vehicle_names.index(name)
    sent = messages["sender"] == me
    assert found["messages_sent"] == len(np.unique(messages["time_sent"][sent])) == 150
    ticks = np.ceil(messages["time_received"] / DT - 1e-9)
    heard = (messages["receiver"] == me) & ~messages["lost"] & (ticks < flight.flown / DT - 0.5)
    ages = ticks[heard] * DT - messages["time_of_validity"][heard]
    assert 90 < heard.sum() < 140
    assert found["messages_delivered"] == heard.sum()
    assert found["information_age_mean"] == pytest.approx(ages.mean(), rel=1e-9)
    assert found["information_age_max"] == pytest.approx(ages.max(), rel=1e-9)


def test_every_metric_is_there_and_listed(metrics: Metrics) -> None:
    of_vehicles = {name for name, metric in METRICS.items() if not metric.of_fleet_only}
    assert {frozenset(v) for v in metrics.vehicles.values()} == {frozenset(of_vehicles)}
    assert set(metrics.fleet) == set(METRICS) - of_vehicles
    assert list(metrics.vehicles) == ["zoe", "amy"]  # as in the file


def flown(overrides: list[str]) -> Flown:
    seen = watch(plan_of(TEXT, overrides))
    return Flown(seen.plan, seen.tables, seen.plan.num_ticks)


def test_before_the_transient_is_over_only_the_rest_counts() -> None:
    found = metrics_of(flown(["duration=7 s"]))
    for metrics in found.vehicles.values():
        missing = {name for name, value in metrics.items() if math.isnan(value)}
        assert {"cross_track_rms", "cross_track_p95", "cross_track_max", "settling_time", "path_speed_mean"} <= missing
        assert {"formation_error_rms", "formation_error_p95", "formation_error_rms_relative"} <= missing
        assert not {"energy", "messages_sent", "position_error_rms", "yaw_effort", "swath_coverage"} & missing
    assert math.isnan(found.fleet["coordination_error_rms"])
    assert found.fleet["separation_min"] > 1.0


@given(
    st.lists(st.floats(0.0, 50.0), min_size=30, max_size=400),
    st.sampled_from([0.5, 0.9, 0.95, 0.99, 1.0]),
)
def test_percentiles_of_a_histogram_lie_within_a_bin_of_those_of_the_numbers(values: list[float], share: float) -> None:
    errors = np.array(values)
    bins = np.zeros(BINS)
    np.add.at(bins, np.minimum(BINS * errors / (1.0 + errors), BINS - 1).astype(int), 1.0)
    exact = float(np.quantile(errors, share, method="inverted_cdf"))
    assert percentile(bins, share) == pytest.approx(exact, abs=1.01 * bin_width(exact + bin_width(exact)))


def test_a_percentile_of_nothing_is_nothing() -> None:
    assert math.isnan(percentile(np.zeros(BINS), 0.95))
    everything = np.zeros(BINS)
    everything[-1] = 3.0
    assert percentile(everything, 0.5) > BINS - 2.0
