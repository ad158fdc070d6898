"""When sensors read, what they see, and how long it is believed: exactly, to the tick."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from cardume.laws import Law, Number
from cardume.maths.random import normals, random_key
from cardume.signals import (
    AhrsReading,
    Baseline,
    DvlReading,
    GnssReading,
    Noise,
    Sampling,
    UsblReading,
    VesselState,
    Water,
)
from cardume.simulation.fleet import Held, Satellite
from cardume.simulation.plan import Choice, Plan
from cardume.world.sensors import (
    ahrs_sensor,
    depth_sensor,
    dvl_sensor,
    gnss_sensor,
    thruster_speed_sensor,
    usbl_sensor,
)
from properties.flown import plan_of
from simulation.ticks import Watched, watch

TEXT = """
cardume: 1
name: sensed
seed: 21
duration: 40 s
path: {type: circle, centre: {north: 0 m, east: 0 m}, radius: 12 m}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 1 rad, variation_sigma: 0.02 m/s}
model: medusa
vehicles:
  - {name: upper, start: {speed: 0.3 m/s},
     sensors: {gnss: {}, usbl: {}, ahrs: {}, depth: {}, dvl: {}, thruster_speed: {}}}
  - {name: lower, depth: 6 m, offset: {starboard: 4 m}, sensors: {ahrs: {}, depth: {}, thruster_speed: {}}}
"""
TIMINGS = [(0.1, 0.0), (0.7, 0.0), (0.1, 0.3), (0.7, 0.3), (0.5, 2.3), (4.0, 0.0)]  # period, latency


# Sensors that tell the time and the truth they see, so that both can be read off the tables.


@gnss_sensor(period=1.0)
def clock(truth: VesselState, sampling: Sampling) -> GnssReading:
    """North and the time of validity. Source: this test."""
    return GnssReading(truth.north, sampling.time)


@ahrs_sensor(period=0.1)
def compass(truth: VesselState, sampling: Sampling, noise: Noise) -> AhrsReading:
    """Heading, elapsed time, two draws. Source: this test."""
    return AhrsReading(truth.heading, sampling.elapsed, noise.a, noise.d)


@depth_sensor(period=0.2)
def sounder(truth: VesselState, water: Water) -> float:
    """The east part of the current, in the place of a depth. Source: this test."""
    return 6.0 + water.east + 0.0 * truth.depth


@dvl_sensor(period=0.5)
def log(truth: VesselState, noise: Noise) -> DvlReading:
    """Surge, and a draw. Source: this test."""
    return DvlReading(truth.surge, 0.001 * noise.b)


@thruster_speed_sensor(period=0.1)
def counter(truth: VesselState) -> float:
    """The shafts. Source: this test."""
    return truth.shaft_speed


class Count(NamedTuple):
    """How often it was asked."""

    readings: float = 0.0  # [-]


@usbl_sensor(period=1.0, latency=0.1)
def head(
    baseline: Baseline, noise: Noise, sampling: Sampling, memory: Count, unused: Number = 0.0
) -> tuple[UsblReading, Count]:
    """The baseline itself, and how often this target was heard. Source: this test."""
    return UsblReading(baseline.ahead, baseline.starboard, memory.readings), Count(memory.readings + 1.0)


def with_sensor(law: Law, period: float, latency: float, name: str = "upper") -> Plan:
    plan = plan_of(TEXT)
    choice = Choice(law, {"period": period, "latency": latency})
    vehicles = [replace(v, laws=v.laws | {law.family: choice}) if v.name == name else v for v in plan.vehicles]
    return replace(plan, vehicles=tuple(vehicles))


def delivered(seen: Watched, period: float, latency: float) -> np.ndarray:
    """The ticks in which a reading is delivered: the first is valid at the start of the mission."""
    return np.arange(round(latency / 0.1), len(seen.times), round(period / 0.1))


def held(readings: np.ndarray, ticks: np.ndarray, count: int) -> np.ndarray:
    """A reading per delivery, held until the next one; NaN before the first."""
    latest = np.searchsorted(ticks, np.arange(count), side="right") - 1
    return np.where(latest >= 0, readings[np.maximum(latest, 0)], np.nan)


def upper(values: np.ndarray) -> np.ndarray:
    """Of the vehicle `upper`, the second in the engine's order."""
    return values[:, 1]


def same(one: np.ndarray, other: np.ndarray) -> bool:
    return np.array_equal(one, other, equal_nan=True)


def nearly(one: np.ndarray, other: np.ndarray) -> bool:
    """Noise drawn by plain Python, which rounds a product before it adds it."""
    return np.allclose(one, other, rtol=1e-12, atol=1e-15, equal_nan=True)


@pytest.mark.parametrize(("period", "latency"), TIMINGS)
def test_a_fix_is_there_in_the_tick_of_its_delivery_and_in_no_other(period: float, latency: float) -> None:
    seen = watch(with_sensor(clock, period, latency))
    ticks, late = delivered(seen, period, latency), round(latency / 0.1)
    expected = np.full((3, len(seen.times)), np.nan)
    expected[0, ticks] = upper(seen.at_start(VesselState, "north"))[ticks - late]
    expected[1, ticks] = (ticks - late) * 0.1
    expected[2, ticks] = late * 0.1
    for field, values in zip(Satellite._fields, expected, strict=True):
        assert same(upper(seen.in_tick(Satellite, field)), values), field


@pytest.mark.parametrize(("period", "latency"), [t for t in TIMINGS if not t[1]])
def test_attitude_is_held_and_its_noise_is_named_after_the_tick(period: float, latency: float) -> None:
    seen = watch(with_sensor(compass, period, latency))
    ticks, count = delivered(seen, period, latency), len(seen.times)
    key = random_key(21, "ahrs", "upper")
    noise = [normals(key, float(k)) for k in ticks]
    wanted = {
        "heading": upper(seen.at_start(VesselState, "heading"))[ticks],
        "yaw_rate": np.full(len(ticks), round(period / 0.1) * 0.1),
        "roll": np.array([n.a for n in noise]),
        "pitch": np.array([n.d for n in noise]),
    }
    for field, readings in wanted.items():
        assert nearly(upper(seen.in_tick(Held, field)), held(readings, ticks, count)), field


@pytest.mark.parametrize(("period", "latency"), TIMINGS)
def test_what_a_late_sensor_sees_is_the_truth_of_then(period: float, latency: float) -> None:
    late = round(latency / 0.1)
    for law, field, record, what in [
        (sounder, "depth", Water, "east"),
        (counter, "shaft_speed", VesselState, "shaft_speed"),
        (log, "dvl_surge", VesselState, "surge"),
    ]:
        seen = watch(with_sensor(law, period, latency))
        ticks = delivered(seen, period, latency)
        # the water of a tick is found in the tick, the state is there when it begins
        truth = upper(seen.in_tick(record, what) if record is Water else seen.at_start(record, what))[ticks - late]
        readings = 6.0 + truth if law is sounder else truth
        assert same(upper(seen.in_tick(Held, field)), held(readings, ticks, len(seen.times))), field


def test_late_noise_is_named_after_the_tick_in_which_it_was_valid() -> None:
    seen = watch(with_sensor(log, 0.5, 2.3))
    ticks, key = delivered(seen, 0.5, 2.3), random_key(21, "dvl", "upper")
    noise = np.array([0.001 * normals(key, float(k - 23)).b for k in ticks])
    assert nearly(upper(seen.in_tick(Held, "dvl_sway")), held(noise, ticks, len(seen.times)))


@pytest.mark.parametrize(("period", "latency"), [(1.0, 0.1), (0.3, 0.0), (2.0, 1.4)])
def test_a_usbl_reading_compares_two_places_of_the_same_moment(period: float, latency: float) -> None:
    seen = watch(with_sensor(head, period, latency))
    ticks, late = delivered(seen, period, latency), round(latency / 0.1)
    north, east, heading = (seen.at_start(VesselState, f)[ticks - late] for f in ("north", "east", "heading"))
    away = np.stack([north[:, 0] - north[:, 1], east[:, 0] - east[:, 1]])
    s, c = np.sin(heading[:, 1]), np.cos(heading[:, 1])
    reading = seen.usbl[:, 1, 0]  # what `upper` hears of `lower`
    assert reading[ticks, 0] == pytest.approx(c * away[0] + s * away[1], abs=1e-12)
    assert reading[ticks, 1] == pytest.approx(c * away[1] - s * away[0], abs=1e-12)
    assert reading[ticks, 2].tolist() == list(range(len(ticks)))  # one memory for each target
    ages = np.full(len(seen.times), np.nan)
    ages[ticks] = late * 0.1
    assert same(reading[:, 3], ages)
    assert np.isnan(seen.usbl[:, 1, 1, 3]).all()  # it does not hear itself
    assert np.isnan(seen.usbl[:, 0, :, 3]).all()  # and `lower` has no head


def test_a_vehicle_without_a_sensor_reads_nothing() -> None:
    seen = watch(plan_of(TEXT))
    lower = {f: seen.in_tick(Held, f)[:, 0] for f in Held._fields}
    assert np.isnan(lower["dvl_surge"]).all()
    assert np.isnan(lower["dvl_sway"]).all()
    assert np.isnan(seen.in_tick(Satellite, "north")[:, 0]).all()
    assert all(np.isfinite(lower[f]).all() for f in ("heading", "yaw_rate", "depth", "shaft_speed"))


def test_ideal_sensors_read_the_truth_in_every_tick() -> None:
    seen = watch(plan_of(TEXT, ["vehicles.upper.sensors=ideal", "vehicles.lower.sensors=ideal"]))
    for record, fields in (
        (Held, {"heading": "heading", "yaw_rate": "yaw_rate", "depth": "depth", "shaft_speed": "shaft_speed"}),
        (Held, {"dvl_surge": "surge", "dvl_sway": "sway"}),
        (Satellite, {"north": "north", "east": "east"}),
    ):
        for field, truth in fields.items():
            assert same(seen.in_tick(record, field), seen.at_start(VesselState, truth)), field
    assert (seen.in_tick(Satellite, "age") == 0.0).all()
