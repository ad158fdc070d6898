"""Row W inside `kalman_replay`: what a fix by USBL says of its own errors, and that the filter's are as it says."""

import math

import numpy as np
import pytest
from scipy.stats import t as student

from cardume.onboard.estimation.position.past_fixes import KEPT, SLOT
from cardume.signals import Fix
from oracles.aboard import fly_plan, memory_of, plan_of, vessel_of
from oracles.shaken import flights, late_half, nees_of

MISSION = """
cardume: 1
name: stretched
duration: {duration!r} s
plant_step: 0.1 s
log_period: 1 s
path: {{type: line, start: {{course: {course!r} rad}}, length: 500 m}}
formation: {{speed: 0.5 m/s}}
model: kinematic
current: {{type: 'row_two:shaking'}}
vehicles:
  - name: surface
    start: {{speed: 0.5}}
    sensors:
      gnss: {{sigma: {gnss!r} m}}
      ahrs: {{heading_sigma: {heading!r} rad, yaw_rate_sigma: 0, attitude_sigma: {attitude!r} rad}}
      thruster_speed: {{sigma: 0, reader: proportional}}
      usbl: {{range_sigma: {range!r} m, angle_sigma: {angle!r} rad, period: {period!r} s}}
  - name: diver
    depth: {depth!r} m
    offset: {{starboard: {aside!r} m, ahead: {ahead!r} m}}
    start: {{speed: 0.5}}
    position: {{law: kalman_replay, initial_sigma: 1 m, current_sigma: 0.2 m/s, velocity_noise: 1e-3, gate: 1e9}}
    sensors:
      gnss: none
      ahrs: {{heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0}}
      thruster_speed: {{sigma: 0, reader: proportional}}
guidance: {{law: line_of_sight, lookahead: 1e5 m}}
position: {{law: {surface}}}
coordination: {{law: laplacian_tanh, gain: 0 m/s, topology: star}}
messaging: {{schedule: periodic, period: {period!r} s, offset: 0.2 s}}
acoustics: {{channel: bernoulli, loss: 0.2, delay: 0.3 s}}
speed_reference: water
end: continue
"""
NUMBERS = {
    "duration": 20.0,
    "course": 0.4,
    "gnss": 0.5,
    "heading": 0.005,
    "attitude": 0.005,
    "range": 0.1,
    "angle": 0.0175,
    "period": 1.0,
    "depth": 10.0,
    "aside": 40.0,
    "ahead": 20.0,
    "surface": "reset",
}


def fix_of(flown):
    """The newest fix that the diver worked in."""
    first = memory_of(flown, "position")[-(KEPT + 1) * SLOT.width :]
    start = SLOT.offsets[Fix]
    return Fix(*first[start : start + len(Fix._fields)])


def level(values):
    """North and east of a target by range, azimuth, elevation, heading, pitch and roll, rotations written out."""
    r, azimuth, elevation, heading, pitch, roll = values
    body = r * np.array(
        [math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)]
    )
    c, s = math.cos, math.sin
    about_z = np.array([[c(heading), -s(heading), 0], [s(heading), c(heading), 0], [0, 0, 1]])
    about_y = np.array([[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]])
    about_x = np.array([[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]])
    return (about_z @ about_y @ about_x @ body)[:2]


def propagated(numbers, flown):
    """Covariance by derivatives, of the reading without noise; the two go side by side all the time."""
    diver, surface = (vessel_of(flown, k) for k in (0, 1))
    north, east, depth = diver.north - surface.north, diver.east - surface.east, diver.depth
    flat, heading = math.hypot(north, east), surface.heading
    point = np.array(
        [math.hypot(flat, depth), math.atan2(east, north) - heading, math.atan2(depth, flat), heading, 0.0, 0.0]
    )
    names = ("range", "angle", "angle", "heading", "attitude", "attitude")
    step, found = 1e-6, numbers["gnss"] ** 2 * np.eye(2)
    for axis, name in zip(np.eye(6), names, strict=True):
        slope = (level(point + step * axis) - level(point - step * axis)) / (2.0 * step)
        found += numbers[name] ** 2 * np.outer(slope, slope)
    return found


@pytest.mark.parametrize("seed", [None, 0, 1, 2])
def test_a_fix_says_how_it_errs(seed):
    """Stretched across the line of sight, by what propagation of all six errors gives."""
    numbers = dict(NUMBERS)
    if seed is not None:
        draw = np.random.default_rng([33, seed])
        numbers |= {"course": draw.uniform(0, 6), "gnss": draw.uniform(0.1, 1), "heading": draw.uniform(0, 0.02)}
        numbers |= {"attitude": draw.uniform(0, 0.02), "range": draw.uniform(0.05, 0.3), "angle": draw.uniform(0, 0.02)}
        numbers |= {"depth": draw.uniform(5, 40), "aside": float(draw.choice([-1, 1]) * draw.uniform(20, 50))}
    flown = fly_plan(MISSION.format(**numbers))
    fix = fix_of(flown)
    told = np.array([[fix.north_variance, fix.covariance], [fix.covariance, fix.east_variance]])
    wanted = propagated(numbers, flown)
    assert np.abs(told - wanted).max() < 0.07 * np.abs(wanted).max()  # told from a reading with noise
    assert np.linalg.eigvalsh(told)[0] > 0.0


@pytest.mark.parametrize(
    ("runs", "period"),
    [(60, 1.0), pytest.param(300, 1.0, marks=pytest.mark.slow), pytest.param(300, 5.0, marks=pytest.mark.slow)],
)
def test_covariance_of_a_diver_is_that_of_its_errors(runs, period):
    """The whole chain: GNSS, USBL, a message of which a fifth is lost, 0.3 s of sound: ANEES is 1."""
    plan = plan_of(MISSION.format(**NUMBERS | {"duration": 300.0, "period": period}))
    diver = [v.name for v in plan.vehicles].index("diver")
    place = plan.order.index(diver)
    found = np.array([late_half(nees_of(flown, place)).mean() for flown in flights(plan, range(runs))])
    limit = student.ppf(0.999, runs - 1) * found.std(ddof=1) / math.sqrt(runs)
    print(f"ANEES {found.mean():.4f} of 1 +- {limit:.4f}")
    assert abs(found.mean() - 1.0) < limit
    assert limit < 0.2


def test_a_surface_vehicle_that_filters_says_so():
    """With `kalman_replay` its own covariance, below that of GNSS, is what its sightings start from."""
    plain, filtered = (
        fix_of(fly_plan(MISSION.format(**NUMBERS | {"surface": law}))) for law in ("reset", "kalman_replay")
    )
    assert 0.0 < plain.north_variance - filtered.north_variance < 0.25
