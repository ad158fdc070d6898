"""Closed form W: what the angles of a USBL reading become in north and east, seen in what a diver is told."""

import math

import numpy as np
import pytest
from scipy.stats import chi2

from flying import fly_text

MISSION = """
cardume: 1
name: fixes
seed: {seed}
duration: {count} s
log_period: 1 s
path: {{type: line, start: {{course: {course!r} rad}}, length: 100 m}}
formation: {{speed: 0.5 m/s}}
model: kinematic
vehicles:
  - name: surface
    start: {{speed: 0.5}}
    sensors:
      gnss: {{sigma: 0, period: 0.1 s}}
      ahrs: {{heading_sigma: {heading!r} deg, heading_bias: {bias!r} deg, yaw_rate_sigma: 0, attitude_sigma: 0}}
      thruster_speed: {{sigma: 0, reader: proportional}}
      usbl: {{range_sigma: {range_sigma!r} m, angle_sigma: {angle!r} deg, period: 1 s, latency: {latency!r} s}}
  - name: diver
    depth: {depth!r} m
    offset: {{starboard: {aside!r} m, ahead: {ahead!r} m}}
    start: {{speed: 0.5}}
    sensors:
      gnss: none
      ahrs: {{heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0}}
      thruster_speed: {{sigma: 0, reader: proportional}}
guidance: {{law: 'aids:parallel'}}
position: {{law: reset_compensated}}
coordination: {{law: laplacian_tanh, gain: 0 m/s, topology: star}}
messaging: {{schedule: periodic, period: 1 s, offset: {offset!r} s}}
acoustics: {{channel: bernoulli, loss: 0, delay: {delay!r} s}}
end: continue
"""


def fix_errors(course: float = 0.4, count: int = 3000, seed: int = 5, **numbers: float) -> np.ndarray:
    """(fix, 2) [m] errors of the diver's fixes ahead and to starboard of the course.

    The diver's own dead reckoning is exact, so what it believes is wrong by the last fix's error.
    """
    defaults = {"heading": 0.0, "bias": 0.0, "range_sigma": 0.0, "angle": 0.0, "latency": 0.0, "depth": 0.0}
    chosen = {**defaults, "aside": 50.0, "ahead": 0.0, "delay": 0.0, "offset": 0.0, **numbers}
    flight = fly_text(MISSION.format(course=course, count=count + 3, seed=seed, **chosen))
    assert flight.reason == "completed", flight.failure
    north, east = (flight.channels[f"{a}_estimate"][3:, 1] - flight.channels[a][3:, 1] for a in ("north", "east"))
    return np.column_stack(
        [math.cos(course) * north + math.sin(course) * east, math.cos(course) * east - math.sin(course) * north]
    )


def assert_rms(errors: np.ndarray, wanted: float) -> None:
    """The root mean square of so many normal numbers is the wanted one, at a confidence of 0.9998."""
    low, high = (math.sqrt(chi2.ppf(p, errors.size) / errors.size) for p in (1e-4, 1.0 - 1e-4))
    found = float(np.sqrt(np.mean(np.square(errors))))
    print(f"{found:.5f} m, wanted {wanted:.5f}; to {100.0 * (high - 1.0):.1f} %")
    assert low * wanted < found < high * wanted


PRINTED = 50.0 * math.radians(1.0)


def test_across_at_the_printed_numbers() -> None:
    """Row W: r sigma_b at 50 m and 1 deg: .87266463 m across the line of sight, and nothing along it."""
    assert pytest.approx(0.87266463, abs=5e-9) == PRINTED
    errors = fix_errors(angle=1.0)
    assert_rms(errors[:, 0], PRINTED)  # the diver lies to starboard: ahead is across the line of sight
    # Chords: along the line of sight a wrong angle matters at second order only, r sigma^2 / 2.
    assert abs(errors[:, 1]).max() < 20.0 * PRINTED * math.radians(1.0)


def test_a_wrong_heading_adds_the_same() -> None:
    """Row W: the surface vehicle's heading, white by 1 deg, does as much as the head's angles."""
    assert_rms(fix_errors(heading=1.0)[:, 0], PRINTED)
    assert_rms(fix_errors(heading=1.0, angle=1.0)[:, 0], math.sqrt(2.0) * PRINTED)


def test_a_bias_of_the_heading_moves_every_fix() -> None:
    """Row W: a heading that reads 1 deg too far clockwise places a diver to starboard 2 r sin(0.5 deg) too far aft."""
    errors = fix_errors(bias=1.0, count=20)
    assert errors[:, 0] == pytest.approx(np.full(20, -50.0 * math.sin(math.radians(1.0))), abs=1e-9)
    assert np.hypot(*errors.T) == pytest.approx(np.full(20, 100.0 * math.sin(math.radians(0.5))), abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_at_random(seed: int) -> None:
    """Row W with the angles' noise, distance and depth drawn: across r sigma; along hypot(sigma_r r / rho, z sigma)."""
    draw = np.random.default_rng([71, seed])
    level, depth, angle, of_range = (float(x) for x in draw.uniform([20, 5, 0.2, 0.02], [100, 30, 2.0, 0.3]))
    errors = fix_errors(seed=seed, angle=angle, range_sigma=of_range, depth=depth, aside=level)
    slant, sigma = math.hypot(level, depth), math.radians(angle)
    assert_rms(errors[:, 0], level * sigma * math.exp(-(sigma**2) / 2.0))
    assert_rms(errors[:, 1], math.hypot(of_range * level / slant, depth * sigma))


@pytest.mark.parametrize("seed", range(4))
def test_4_1_without_noise_a_fix_is_the_truth(seed: int) -> None:
    """Text 4.1: p_j = p_1 + R_1 r, late or not, on any course and in any direction."""
    draw = np.random.default_rng([72, seed])
    aside, ahead, depth = (float(x) for x in draw.uniform([-40, -40, 0], [40, 40, 20]))
    late = {"latency": 0.1 * int(draw.integers(0, 4)), "delay": draw.uniform(0.0, 0.9), "offset": 0.1}
    errors = fix_errors(draw.uniform(0.0, 6.2), 40, seed, aside=aside, ahead=ahead, depth=depth, **late)
    assert np.abs(errors).max() < 1e-9
