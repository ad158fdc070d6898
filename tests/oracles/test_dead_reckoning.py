"""Dead reckoning (49) of a vehicle that turns: the lag of Euler's rule as printed, and the midpoint's."""

import cmath
import math

import numpy as np
import pytest

from flying import fly_text, limit

MISSION = """
cardume: 1
name: turning
duration: {duration!r} s
tick: {tick!r} s
plant_step: {tick!r} s
log_period: {tick!r} s
path: {{type: line, length: 10 m}}
formation: {{speed: 0.5 m/s}}
vehicles:
  - name: alone
    model: {{law: 'turning:turning', speed: {speed!r}, yaw_rate: {yaw_rate!r}}}
    start: {{north: 3 m, east: -2 m, heading: {heading!r} rad, speed: {speed!r}}}
    sensors:
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg, period: {tick!r} s}}
      dvl: {{sigma: 0 m/s, period: {tick!r} s}}
      gnss: none
      depth: none
      thruster_speed: none
guidance: {{law: line_of_sight}}
position: {{law: {position}}}
"""
EULER, MIDPOINT = "'printed_dead_reckoning:euler'", "reset"


def drift(position, speed, yaw_rate, tick, ticks, heading=0.7):
    """How far the believed position strays from the true one in so many ticks of the turn."""
    # The yaw rate is measured from the first tick on: before it the vehicle had none.
    text = MISSION.format(
        duration=(ticks + 2) * tick,
        tick=tick,
        speed=speed,
        yaw_rate=yaw_rate,
        heading=heading,
        position=position,
    )
    channels = fly_text(text).channels
    errors = np.hstack([channels[f"{axis}_estimate"] - channels[axis] for axis in ("north", "east")])
    return float(np.linalg.norm(errors[ticks + 1] - errors[1]))


def exact(midpoint, speed, yaw_rate, tick, ticks):
    """|sum of the steps - integral|, in closed form: with x = r dt and theta = n x both are geometric series."""
    x = yaw_rate * tick
    turned = cmath.exp(1j * ticks * x) - 1.0
    steps = cmath.exp(0.5j * x if midpoint else 0.0) / (cmath.exp(1j * x) - 1.0)
    return speed * tick * abs(turned * (steps - 1.0 / (1j * x)))


def test_half_circle_at_the_printed_numbers():
    """Row U: u = .5, R = 12, half a circle: Euler .05 m at dt = .1 s, .49999485 m at 1 s, midpoint .0017 m."""
    half = math.floor(math.pi * 12.0 / 0.5)  # 75 whole ticks
    assert drift(EULER, 0.5, 0.5 / 12.0, 1.0, half) == pytest.approx(0.49999485, abs=5e-9)
    assert drift(EULER, 0.5, 0.5 / 12.0, 0.1, 10 * half) == pytest.approx(0.05, abs=5e-6)
    assert drift(MIDPOINT, 0.5, 0.5 / 12.0, 1.0, half) == pytest.approx(0.0017, abs=5e-5)
    assert drift(MIDPOINT, 0.5, 0.5 / 12.0, 1.0, half) == pytest.approx(0.0017361393, abs=1e-10)


@pytest.mark.parametrize("seed", range(4))
def test_every_turn_at_random_speeds_rates_and_ticks(seed):
    """Row U: to the last digits, turns to both sides, of any angle."""
    draw = np.random.default_rng(seed)
    speed, rate = draw.uniform(0.2, 1.5), float(draw.choice([-1.0, 1.0])) * draw.uniform(0.01, 0.2)
    tick, ticks = round(draw.uniform(0.05, 1.0), 3), int(draw.integers(20, 200))
    heading = draw.uniform(0.0, 6.0)
    for position, midpoint in ((EULER, False), (MIDPOINT, True)):
        found = drift(position, speed, rate, tick, ticks, heading)
        assert found == pytest.approx(exact(midpoint, speed, rate, tick, ticks), rel=1e-8, abs=1e-11)


@pytest.mark.parametrize(("radius", "angle"), [(12.0, math.pi), (20.0, 1.3), (7.0, 5.0)])
def test_limit_of_small_ticks(radius, angle):
    """Row U: Euler's lag is u dt |sin(theta / 2)|, to first order; the midpoint's is u dt^2 |r sin(theta / 2)| / 12."""
    speed, rate = 0.5, 0.5 / radius
    ticks = tuple(angle / rate / count for count in (100, 200, 400))

    def per_tick(position, power):
        return lambda tick: drift(position, speed, rate, tick, round(angle / rate / tick)) / tick**power

    lag, _ = limit(per_tick(EULER, 1), ticks)
    assert lag == pytest.approx(speed * abs(math.sin(angle / 2.0)), rel=1e-6)
    _, order = limit(lambda tick: tick * per_tick(EULER, 1)(tick), ticks)
    assert order == pytest.approx(1.0, abs=0.01)
    lag, _ = limit(per_tick(MIDPOINT, 2), ticks)
    assert lag == pytest.approx(speed * abs(rate * math.sin(angle / 2.0)) / 12.0, rel=1e-5)
    _, order = limit(lambda tick: tick**2 * per_tick(MIDPOINT, 2)(tick), ticks)
    assert order == pytest.approx(2.0, abs=0.01)
