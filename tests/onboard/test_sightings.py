"""A vehicle with a USBL head goes by what it sees, also where the other never speaks."""

import math

import numpy as np
import pytest

from cardume.onboard.navigation import _fix_told
from cardume.signals import Sighting
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


@pytest.mark.parametrize(("level", "below"), [(30.0, 0.0), (12.0, 9.0), (5.0, 20.0), (40.0, -9.0)])
def test_a_slant_range_that_is_made_level_errs_by_its_slope(level: float, below: float) -> None:
    """dh = (r / h) dr: the spread of the level range over many noisy readings is the variance that is told."""
    sigma, head, own = 0.02, 3.0, 0.25
    slant = math.hypot(level, below)
    draws = slant + sigma * np.random.default_rng(9).normal(size=20_000)
    found = []
    for reading in draws:
        seen = Sighting(1.0, 2.0, 10.0, north_variance=own, covariance=0.1, east_variance=2.0 * own)
        seen = seen._replace(range=reading, range_variance=sigma * sigma, depth=head)
        fix = _fix_told(seen, head + below, 11.0)
        found.append(fix.level_range)
    assert fix.age == 1.0
    assert np.mean(found) == pytest.approx(level, rel=1e-3)
    told = fix.north_variance - own
    assert math.sqrt(told) == pytest.approx(np.std(found), rel=0.03)
    assert fix.east_variance - 2.0 * own == pytest.approx(told)
    assert fix.covariance == 0.1


def test_a_position_is_told_as_it_is() -> None:
    seen = Sighting(1.0, 2.0, 10.0, 5.0, 0.5, 10.0, 4.0, 0.3, 0.1, 0.4)
    fix = _fix_told(seen, 7.0, 10.5)
    assert fix[:6] == (1.0, 2.0, 0.5, 0.3, 0.1, 0.4)
    assert math.isnan(fix.level_range)
