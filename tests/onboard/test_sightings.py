"""A vehicle with a USBL head goes by what it sees, also where the other never speaks."""

import numpy as np

from flying import fly_text

SILENT = """
cardume: 1
name: silent-diver
duration: 40 s
path: {type: line, length: 200 m}
formation: {speed: 0.5 m/s}
model: kinematic
vehicles:
  - name: head
    start: {along_track: 0 m, speed: 0.5 m/s}
    sensors: {gnss: {sigma: 0 m}, usbl: {range_sigma: 0 m, angle_sigma: 0 deg}, ahrs: {}, thruster_speed: {}}
  - {name: diver, depth: 5 m, offset: {starboard: 3 m}, start: {along_track: 8 m, speed: 0.5 m/s}, messaging: none}
coordination: {law: laplacian_tanh, gain: 0.1 m/s, topology: complete}
"""


def test_the_head_knows_where_a_silent_diver_is_and_catches_up() -> None:
    flight = fly_text(SILENT)
    true = flight.channels["coordination_state"]
    believed = flight.neighbor_state_estimate[:, 0, 1]
    rows = flight.times >= 3.0
    assert np.abs(believed - true[:, 1])[rows].max() < 0.2
    assert abs(true[-1, 1] - true[-1, 0]) < 4.5 < abs(true[0, 1] - true[0, 0])
