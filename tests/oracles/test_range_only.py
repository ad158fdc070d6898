"""Ranges without bearings: rows HH, what a rigid formation can and cannot observe, by information and by the filter."""

import math

import numpy as np
import pytest
from scipy.stats import t as student

from cardume.missions.ranging.information import (
    condition_number,
    log_determinant,
    mission_information,
    range_information,
    usbl_information,
)
from flying import fly_text
from oracles.aboard import plan_of
from oracles.shaken import channel, errors_of, flights, late_half, nees_of

# ---- row HH ----------------------------------------------------------------------------------------------------------


def least_trace(bearings, sigma):
    return np.trace(np.linalg.inv(range_information(bearings, sigma)))


def test_cramer_rao_at_the_printed_numbers():
    """Row HH: 8 uniform ranges of 1 m: 4 / 8 m^2; within 20 deg 9.7752 m^2, 20 times worse."""
    assert least_trace(np.arange(8) * math.tau / 8, 1.0) == pytest.approx(0.5, abs=1e-12)
    assert least_trace(np.radians(np.linspace(-10.0, 10.0, 8)), 1.0) == pytest.approx(9.77520656, abs=5e-9)


@pytest.mark.parametrize("seed", range(4))
def test_cramer_rao_at_random(seed):
    """Row HH: 4 sigma^2 / N for any N > 2, and least squares from many noisy ranges attain it."""
    draw = np.random.default_rng([41, seed])
    count, sigma, far = int(draw.integers(3, 20)), draw.uniform(0.1, 2.0), 500.0
    bearings = draw.uniform(0, 6) + np.arange(count) * math.tau / count
    assert least_trace(bearings, sigma) == pytest.approx(4.0 * sigma**2 / count, rel=1e-12)
    lines = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
    sources, found = -far * lines, []
    for _ in range(4000):
        ranges, place = far + sigma * draw.normal(size=count), np.zeros(2)
        for _ in range(3):  # Gauss and Newton
            apart = place - sources
            distance = np.hypot(*apart.T)
            place = place + np.linalg.lstsq(apart / distance[:, None], ranges - distance, rcond=None)[0]
        found.append(place)
    assert np.mean(np.sum(np.square(found), axis=1)) == pytest.approx(4.0 * sigma**2 / count, rel=0.06)


@pytest.mark.parametrize("seed", range(3))
def test_one_usbl_reading(seed):
    """Row HH: u u' / s_r^2 + n n' / (r s_t)^2 is the inverse of row W's covariance."""
    draw = np.random.default_rng([42, seed])
    bearing, distance, of_range, angle = draw.uniform([0, 10, 0.05, 0.005], [6, 90, 1, 0.03])
    turn = np.array([[math.cos(bearing), -math.sin(bearing)], [math.sin(bearing), math.cos(bearing)]])
    spread = turn @ np.diag([of_range**2, (distance * angle) ** 2]) @ turn.T
    assert usbl_information(bearing, distance, of_range, angle) @ spread == pytest.approx(np.eye(2), abs=1e-9)


# ---- a rigid formation -----------------------------------------------------------------------------------------------

LINE = "{type: line, start: {course: 30 deg}, length: 400 m}"
MOWER = "{type: lawnmower, start: {course: 30 deg}, leg: 30 m, legs: 6, spacing: 24 m, turn: port}"
MISSION = """
cardume: 1
name: by-range
duration: {duration!r} s
plant_step: 0.1 s
log_period: 1 s
path: {path}
formation: {{speed: 0.5 m/s}}
model: kinematic
current: {{type: 'row_two:shaking', north: {current!r}, east: {current!r}, velocity_noise: 1e-3, current_noise: 1e-6}}
vehicles:
  - name: surface
    start: {{speed: 0.5}}
    sensors:
      gnss: {{sigma: 0.1 m}}
      ahrs: {{heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0}}
      thruster_speed: {{sigma: 0, reader: proportional}}
      usbl: {{range_sigma: 0.3 m, bearing_loss: {bearing_loss!r}}}
  - name: diver
    depth: 8 m
    offset: {{starboard: {aside!r} m}}
    start: {{speed: 0.5}}
    position: {{law: kalman_replay, initial_sigma: 0.5, current_sigma: {doubt!r}, velocity_noise: 1e-3, gate: 1e9}}
    sensors:
      gnss: none
      ahrs: {{heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0}}
      depth: {{sigma: 0.01 m}}
      thruster_speed: {{sigma: 0, reader: proportional}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
compensation: {{law: crab}}
current_observer: {{law: from_position}}
position: {{law: reset_compensated}}
coordination: {{law: laplacian_tanh, gain: 0 m/s, topology: star}}
messaging: {{schedule: periodic, period: 1 s, offset: 0.2 s}}
acoustics: {{channel: bernoulli, loss: 0.2, delay: 0.3 s}}
end: continue
"""


def flown(path, runs, duration=300.0, bearing_loss=1.0, **numbers):
    """Flights, and which vehicle in them is the diver."""
    chosen = {"current": 0.04, "aside": 9.0, "doubt": 0.05} | numbers
    plan = plan_of(MISSION.format(path=path, duration=duration, bearing_loss=bearing_loss, **chosen))
    diver = plan.order.index([v.name for v in plan.vehicles].index("diver"))
    return flights(plan, range(runs)), diver


def sigmas(flight, diver):
    """(time, 2) [m] believed standard deviation: of the best and the worst direction."""
    nn, ne, ee = (channel(flight, c, diver) for c in ("north_variance", "north_east_covariance", "east_variance"))
    return np.sqrt(np.linalg.eigvalsh(np.stack([np.stack([nn, ne], -1), np.stack([ne, ee], -1)], -2)))


FORMATION = """
cardume: 1
name: rigid
duration: 300 s
path: {path}
formation: {{speed: 0.5 m/s}}
model: kinematic
vehicles:
  - {{name: surface, sensors: ideal, start: {{speed: 0.5}}}}
  - {{name: diver, sensors: ideal, start: {{speed: 0.5}}, offset: {{starboard: 9 m}}}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
"""


def information_of(path):
    """What a range a second tells in an ideal formation, without any prior; and its condition."""
    channels = fly_text(FORMATION.format(path=path)).channels
    apart = np.stack([channels[a][:, 1] - channels[a][:, 0] for a in ("north", "east")], axis=1)
    times = np.arange(len(apart)) * 1.0
    information = mission_information(times, apart, 0.3)
    return information, condition_number(information, times[-1])


def test_a_rigid_formation_on_a_line_cannot_be_observed():
    """The line of sight never turns: the information is singular, and across it the filter knows nothing new."""
    assert information_of(LINE)[1] > 1e9
    runs, diver = flown(LINE, 1, current=0.0, aside=60.0, doubt=1e-3)
    (flight,) = runs
    best, worst = sigmas(flight, diver)[-1]
    reckoned = 0.5**2 + (1e-3 * 300.0) ** 2 + 1e-3 * 300.0 + 1e-6 * 300.0**3 / 3.0
    assert best < 0.3
    assert worst == pytest.approx(math.sqrt(reckoned), rel=0.05)


def test_near_its_source_a_range_tells_more_than_its_slope():
    """9 m away a drift of x across makes the range x^2 / 18 m longer: a rigid line that is known to some 1.5 m."""
    runs, diver = flown(LINE, 1)
    (flight,) = runs
    assert sigmas(flight, diver)[-1, 1] < 3.0  # 15 m by dead reckoning
    assert np.hypot(*errors_of(flight, diver)[-1]) < 6.0


def test_a_rigid_lawnmower_can_be_observed():
    """In the arcs the line of sight turns: all four numbers are known, and the filter knows them."""
    information, condition = information_of(MOWER)
    assert condition < 100.0
    assert log_determinant(information) > 0.0
    runs, diver = flown(MOWER, 1)
    (flight,) = runs
    assert sigmas(flight, diver)[-1, 1] < 1.0
    assert np.hypot(*errors_of(flight, diver)[-1]) < 3.0


@pytest.mark.parametrize("bearing_loss", [1.0, 0.7])
def test_covariance_by_ranges_is_that_of_the_errors(bearing_loss):
    """A lawnmower by ranges only, or where most readings have lost their bearing: ANEES is 1.08 and 1.04.

    The head is 9 m beside and 8 m above: a variance that is not made level with its range would give 1.3.
    """
    runs, diver = flown(MOWER, 60, bearing_loss=bearing_loss)
    found = np.array([late_half(nees_of(flight, diver)).mean() for flight in runs])
    limit = student.ppf(0.999, len(found) - 1) * found.std(ddof=1) / math.sqrt(len(found))
    print(f"ANEES {found.mean():.3f} of 1 +- {limit:.3f}")
    assert abs(found.mean() - 1.0) < limit
    assert limit < 0.25
