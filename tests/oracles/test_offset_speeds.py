"""Vehicles beside a turning path run at their own speeds, (R - sigma offset) / R of the formation's."""

import math

import numpy as np
import pytest

from flying import fly_text, limit

MISSION = """
cardume: 1
name: offsets
duration: {duration!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {path}
formation: {{speed: {speed!r} m/s}}
model: kinematic
sensors: ideal
vehicles:
  - {{name: middle, start: {{speed: {speed!r}}}}}
  - {{name: starboard, offset: {{starboard: {offset!r}}}, start: {{speed: {speed!r}}}}}
  - {{name: port, offset: {{starboard: {port!r}}}, start: {{speed: {speed!r}}}}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
coordination: none
"""


def fly_offsets(path, speed, offset, duration, tick, log_period):
    return fly_text(
        MISSION.format(
            path=path, speed=speed, offset=offset, port=-offset, duration=duration, tick=tick, log_period=log_period
        )
    )


def commanded(flight, begin, end):
    """The speeds that each vehicle commands between two states of the formation, away from the joints."""
    states = flight.channels["coordination_state"]
    inside = ((states > begin + 0.5) & (states < end - 0.5)).all(axis=1)
    return flight.channels["speed_desired"][inside]


def test_lawnmower_at_the_printed_numbers():
    """Row Q: R = 12, D = 3: .375 and .625 m/s in the arcs, the other way round in the other sense, .5 on the legs."""
    path = "{type: lawnmower, leg: 20 m, legs: 3, spacing: 24 m, turn: starboard}"
    flight = fly_offsets(path, 0.5, 3.0, 260.0, 0.1, 0.1)
    arc = 12.0 * math.pi
    for begin, length, speeds in (
        (0.0, 20.0, (0.5, 0.5, 0.5)),
        (20.0, arc, (0.5, 0.375, 0.625)),
        (20.0 + arc, 20.0, (0.5, 0.5, 0.5)),
        (40.0 + arc, arc, (0.5, 0.625, 0.375)),
    ):
        found = commanded(flight, begin, begin + length)
        assert len(found) > 300
        assert np.abs(found - speeds).max() < 1e-12


@pytest.mark.parametrize("seed", range(6))
def test_arcs_at_random(seed):
    """Row Q: v_L (R - sigma offset) / R for random speeds, radii, offsets and both senses."""
    draw = np.random.default_rng(seed)
    speed, radius, offset = draw.uniform(0.3, 1.0), draw.uniform(8.0, 30.0), draw.uniform(0.5, 6.0)
    turn, sigma = ("starboard", 1.0) if seed % 2 else ("port", -1.0)
    path = f"{{type: arc, start: {{course: 33 deg}}, radius: {radius!r}, turn: {turn}, angle: 150 deg}}"
    length = radius * math.radians(150.0)
    flight = fly_offsets(path, speed, offset, round(length / speed, 1), 0.1, 0.5)
    found = commanded(flight, 0.0, length)
    wanted = speed * (1.0 - sigma * np.array([0.0, offset, -offset]) / radius)
    assert len(found) > 20
    assert np.abs(found - wanted).max() < 1e-12


@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_nobody_falls_behind_in_an_arc(turn):
    """Row Q: at these speeds all keep the formation's state v_L t in the limit of small ticks, uncoordinated."""
    path = f"{{type: arc, radius: 12 m, turn: {turn}, angle: 200 deg}}"

    def states(tick):
        return fly_offsets(path, 0.5, 3.0, 60.0 + tick, tick, 60.0).channels["coordination_state"][-1]

    flown = {tick: states(tick) for tick in (0.1, 0.05, 0.025)}
    for k in range(3):
        found, _ = limit(lambda tick, k=k: float(flown[tick][k]), tuple(flown))
        assert found == pytest.approx(30.0, rel=1e-6)
