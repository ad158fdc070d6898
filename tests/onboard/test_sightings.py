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


SELDOM_SEEN = """
cardume: 1
name: seldom-seen
duration: 200 s
path: {type: lawnmower, leg: 30 m, legs: 2, spacing: 20 m}
formation: {speed: 0.5 m/s}
model: kinematic
vehicles:
  - name: head
    start: {speed: 0.5 m/s}
    sensors: {gnss: {sigma: 0 m}, usbl: {range_sigma: 0 m, angle_sigma: 0 deg, period: 140 s}, ahrs: {},
      thruster_speed: {}}
  - {name: diver, depth: 5 m, offset: {starboard: 3 m}, start: {speed: 0.5 m/s}, messaging: none}
guidance: {law: line_of_sight, lookahead: 5 m}
coordination: {law: laplacian_tanh, gain: 0 m/s, topology: complete}
end: continue
"""


def test_a_diver_that_rounded_a_bend_unseen_is_found_on_its_leg() -> None:
    """Seen at 0 s on the first leg and at 140 s on the next, 20 m beside it: its foot is on the leg where it is."""
    flight = fly_text(SELDOM_SEEN)
    true, believed = flight.channels["coordination_state"][:, 1], flight.neighbor_state_estimate[:, 0, 1]
    rows = flight.times >= 142.0
    assert true[rows].min() > 30.0 + 10.0 * np.pi + 5.0
    assert np.abs(believed - true)[rows].max() < 1.0
