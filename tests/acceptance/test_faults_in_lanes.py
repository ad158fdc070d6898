"""Every fault gives the same bits in one mission and in eight in lanes, and the same to 1e-12 in plain Python."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from acceptance.test_bits import digest, fly_plainly
from cardume.missions.faults import FAULTS
from cardume.simulation.fly import fly, fly_batch
from properties.flown import LOCAL, different_tables, plan_of

TEXT = """
cardume: 1
name: everything-at-once
duration: 40 s
path: {type: lawnmower, leg: 15 m, legs: 3, spacing: 20 m, turn: port}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
bathymetry: {type: flat, depth: 20 m}
vehicles:
  - name: surface
    sensors: {gnss: {sigma: 0.3 m}, usbl: {bearing_loss: 0.1}, ahrs: {}, depth: {}, thruster_speed: {}}
  - {name: diver, depth: 8 m, offset: {starboard: 5 m}, sensors: {dvl: {}, altimeter: {}}}
  - {name: third, depth: 8 m, offset: {starboard: -5 m}}
guidance: {law: line_of_sight, lookahead: 5 m}
compensation: {law: crab}
current_observer: {law: from_position}
position: {law: kalman_replay}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, topology: star, silence: {after: 6 s, do: slow_down}}
messaging: {schedule: periodic, period: 1 s, offset: 0.1 s}
acoustics: {channel: bernoulli, loss: 0.3, delay: 0.8 s}
abort: {to: hold, silence: 30 s}
faults:
  - {kind: modem_silent, vehicle: diver, from: 3 s, to: 12 s}
  - {kind: gnss_lost, vehicle: surface, from: 1 s, lasts: 2 s}
  - {kind: usbl_outlier, vehicle: surface, from: 0 s, probability: 0.5}
  - {kind: sensor_frozen, vehicle: third, sensor: ahrs, from: 2 s, lasts: 10 s}
  - {kind: sensor_frozen, vehicle: surface, sensor: gnss, from: 4 s, lasts: 4 s}
  - {kind: sensor_frozen, vehicle: surface, sensor: usbl, from: 4 s, lasts: 4 s}
  - {kind: sensor_frozen, vehicle: diver, sensor: altimeter, from: 4 s}
  - {kind: sensor_frozen, vehicle: diver, sensor: depth, from: 14 s}
  - {kind: sensor_biased, vehicle: diver, sensor: depth, depth: 1 m, from: 2 s}
  - {kind: sensor_biased, vehicle: surface, sensor: gnss, north: 1 m, east: -2 m, from: 20 s}
  - {kind: sensor_biased, vehicle: surface, sensor: usbl, range: 1 m, azimuth: 5 deg, from: 20 s}
  - {kind: sensor_nan, vehicle: surface, sensor: usbl, from: 25 s, lasts: 3 s}
  - {kind: sensor_nan, vehicle: diver, sensor: dvl, from: 1 s}
  - {kind: sensor_nan, vehicle: diver, sensor: thruster_speed, from: 2 s, lasts: 10 s}
  - {kind: sensor_nan, vehicle: diver, sensor: ahrs, from: 13 s, to: 16 s}
  - {kind: thruster_weak, vehicle: diver, thruster: port, efficiency: 0.5, from: 1 s}
  - {kind: vehicle_lost, vehicle: third, from: 24.5 s}
  - {kind: clock_offset, vehicle: diver, offset: 3 s, from: 1 s, to: 5 s}
  - {kind: clock_drift, vehicle: third, drift: 0.01, from: 1 s, to: 9 s}
  - {kind: current_step, speed: 0.1 m/s, towards: 90 deg, from: 1 s}
  - {kind: forged_packets, vehicle: surface, from: 1 s, lasts: 5 s}
  - {kind: replayed_packets, vehicle: surface, from: 12.5 s}
"""
# where messages stand, which lanes share: a vehicle whose modem is silent in one of them sends in the others
PLACES = ("outbox", "sent", "messages", "counts")


def test_every_kind_is_in_the_mission() -> None:
    assert all(f"kind: {kind}," in TEXT for kind in FAULTS)


def test_lanes_give_the_bits_of_one_mission() -> None:
    plans = [
        plan_of(
            TEXT,
            [
                f"faults.0.from={2 + k} s",
                f"faults.2.probability={0.1 * k}",
                f"faults.3.lasts={3 + k} s",
                f"faults.8.depth={0.2 * k} m",
                f"faults.15.efficiency={0.1 * k}",
                f"faults.16.from={12 + 2 * k} s",
                f"faults.20.size={3 * k} m",
                f"coordination.silence.after={2 + k} s",
            ],
            seed=k,
        )
        for k in range(8)
    ]
    alone = [fly(plan) for plan in plans]
    assert len({digest(flown) for flown in alone}) == len(plans)
    assert all(flown.trouble is None and np.isfinite(flown.tables.vehicles).any() for flown in alone)
    for one, other in zip(alone, fly_batch(plans, lanes=True), strict=True):
        assert (one.ticks, one.trouble) == (other.ticks, other.trouble)
        assert different_tables(one.tables, other.tables, (*LOCAL, *PLACES)) == []


def test_plain_python_agrees_with_compiled_code(tmp_path: Path) -> None:
    assert fly_plainly(TEXT, "duration=8 s", tmp_path) == []
