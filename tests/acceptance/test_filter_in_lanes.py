"""The position filter flies eight missions in lanes with the bits of each alone, also where bearings are lost."""

import pytest

from cardume.onboard.estimation.current import from_position
from cardume.onboard.estimation.position import kalman_replay
from cardume.simulation.fly import fly, fly_batch
from properties.flown import different_tables, plan_of

TEXT = """
cardume: 1
name: filtered
duration: 60 s
path: {type: lawnmower, leg: 15 m, legs: 3, spacing: 20 m, turn: port}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
vehicles:
  - name: surface
    sensors: {gnss: {sigma: 0.3 m}, usbl: {bearing_loss: 0.4}, ahrs: {}, depth: {}, thruster_speed: {}}
  - {name: diver, depth: 8 m, offset: {starboard: 5 m}}
guidance: {law: line_of_sight, lookahead: 5 m}
compensation: {law: crab}
current_observer: {law: from_position}
position: {law: kalman_replay, scale_sigma: 0.1, heading_sigma: 0.02, sway_time: 0.9 s, current_fading: 0.001, gate: 4}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, topology: star}
messaging: {schedule: periodic, period: 1 s, offset: 0.1 s}
acoustics: {channel: bernoulli, loss: 0.3, delay: 0.8 s}
"""


def test_laws_compile_for_lanes():
    """Called once for all eight, not one after the other."""
    assert kalman_replay.handle(lanes=True) > 0
    assert from_position.handle(lanes=True) > 0


@pytest.mark.slow
def test_bits_in_lanes():
    """Every table, bit for bit; each mission has its own losses, so that fixes come in different ticks."""
    plans = [plan_of(TEXT, [f"acoustics.loss={0.1 * k}"], seed) for k, seed in enumerate(range(9))]
    for plan, wide in zip(plans, fly_batch(plans, lanes=True), strict=True):
        assert not different_tables(fly(plan).tables, wide.tables)
