"""Phases, profiles, altitude and limits: eight missions in lanes have the bits of each alone."""

from __future__ import annotations

import numpy as np
import pytest

from acceptance.test_bits import assert_same
from cardume.onboard.mind import OWN, Journal
from cardume.simulation.fly import fly, fly_batch
from properties.flown import plan_of

TEXT = """
cardume: 1
name: lanes
duration: 70 s
path: {type: lawnmower, leg: 15 m, legs: 2, spacing: 8 m}
formation: {speed: {profile: PACE, points: [[2, 0.4], [12, 0.6], [30, 0.3]]}}
bathymetry: {type: slope, depth: 9 m, gradient: 0.05}
vehicles:
  - {name: hub, start: {along_track: -2 m}}
  - name: low
    depth: 3 m
    altitude: 4 m
    offset: {starboard: 2 m}
    sensors: {altimeter: {range: 9.4 m}}
    limits: {depth: 6 m, altitude: 1 m, geofence: {polygon: [{north: -30, east: -9}, {north: -30, east: 30}, {north: 30,
      east: 9}]}}
  - {name: mid, depth: {profile: path, points: [[0, 2], [9, 4]]}, limits: {geofence: {radius: 30 m}}}
model: medusa
coordination: {law: laplacian_tanh, gain: 0.15 m/s, topology: star}
messaging: {schedule: periodic, period: 1 s}
acoustics: {channel: bernoulli, loss: 0.2, delay: 0.2 s}
phases: {dive: {timeout: 20 s}, gather: {timeout: 30 s}, hold: 5 s, circle: 3 m}
abort: {to: surface, silence: 20 s}
end: surface
require: {separation_min: 3 m}
"""


@pytest.mark.parametrize("pace", ["time", "path"])
def test_lanes_give_the_bits_of_one_mission(pace: str) -> None:
    plans = [
        plan_of(
            TEXT.replace("PACE", pace),
            [
                f"vehicles.low.start.cross_track={0.5 * k} m",
                f"vehicles.low.limits.depth={4.5 + 0.3 * k} m",
                f"acoustics.loss={0.12 * k}",
                f"vehicles.mid.limits.geofence.radius={12 + 4 * k} m",
                f"abort.silence={6 + 3 * k} s",
            ],
            seed=k,
        )
        for k in range(8)
    ]
    alone = [fly(plan) for plan in plans]
    journals = {flown.tables.minds.reshape(3, OWN.width)[:, OWN.offsets[Journal] :].tobytes() for flown in alone}
    assert len(journals) == len(plans)
    ends = [flown.tables.minds.reshape(3, OWN.width)[:, OWN.offsets[Journal] + 7] for flown in alone]
    assert 0 < np.isfinite(ends).sum() < 24  # some gave up
    assert_same(alone, fly_batch(plans, lanes=True))
