"""Closed form R: how dead reckoning without sway drifts in a turn."""

import math

import numpy as np
import pytest

from flying import fly_text, limit, value_at

MISSION = """
cardume: 1
name: drift
duration: {duration!r} s
tick: {tick!r} s
plant_step: {tick!r} s
log_period: {until!r} s
path: {{type: line, length: 10 m}}
formation: {{speed: 0.5 m/s}}
vehicles:
  - name: alone
    model: {{law: 'turning:turning', speed: {speed!r}, yaw_rate: {yaw_rate!r}, sway: {sway!r}}}
    start: {{north: 0 m, east: 0 m, heading: {heading!r} rad, speed: {speed!r}}}
    sensors:
      gnss: none
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg, period: {tick!r} s}}
      thruster_speed: {{sigma: 0, reader: proportional, period: {tick!r} s}}
      depth: none
guidance: {{law: line_of_sight}}
end: continue
position: {{law: reset}}
"""


def drift(sway: float, yaw_rate: float, time: float, speed: float = 0.5, heading: float = 0.3) -> tuple[float, float]:
    """[m] distance of the believed from the true position after a time, and how wrong the tick makes it."""

    def at(tick: float) -> float:
        numbers = {"duration": time + tick, "until": time, "heading": heading}
        flight = fly_text(MISSION.format(speed=speed, yaw_rate=yaw_rate, sway=sway, tick=tick, **numbers))
        return math.hypot(
            *(value_at(flight, f"{a}_estimate", time) - value_at(flight, a, time) for a in ("north", "east"))
        )

    return limit(at, (time / 400.0, time / 800.0, time / 1600.0))


def chord(sway: float, yaw_rate: float, time: float) -> float:
    """Row R: |v| 2 sin(r t / 2) / r."""
    return abs(sway) * 2.0 * abs(math.sin(yaw_rate * time / 2.0) / yaw_rate)


SWAY = 0.0183035802  # row G with compensation: what a MEDUSA has on an arc of 12 m at .5 m/s
RATE = math.hypot(0.5, SWAY) / 12.0


@pytest.mark.parametrize(
    ("time", "printed"), [(1.0, 0.0183022544), (10.0, 0.1817128620), (math.pi / RATE, 0.8779837605)]
)
def test_drift_at_the_printed_numbers(time: float, printed: float) -> None:
    """Row R: .0183022544 m after 1 s, .1817128620 after 10 s, at most .8779837605, after half a circle."""
    assert chord(SWAY, RATE, time) == pytest.approx(printed, abs=5e-10)
    found, order = drift(SWAY, RATE, time)
    assert found == pytest.approx(printed, rel=1e-5)
    if time <= 10.0:
        assert order == pytest.approx(2.0, abs=0.1)  # the heading in the middle of each tick


def test_the_drift_of_a_whole_circle_is_nothing() -> None:
    """Row R: what is lost in one half of the circle is won in the other."""
    assert drift(SWAY, RATE, math.tau / RATE)[0] < 1e-5 * SWAY / RATE


@pytest.mark.parametrize("seed", range(4))
def test_drift_at_random(seed: int) -> None:
    """Row R with sway, yaw rate, speed and time drawn, turns to both sides."""
    draw = np.random.default_rng([61, seed])
    sway, rate = draw.uniform(-0.2, 0.2), (-1.0) ** seed * draw.uniform(0.02, 0.2)
    time, speed, heading = (float(x) for x in draw.uniform([2.0, 0.3, 0.0], [60.0, 1.0, 6.2]))
    assert drift(sway, rate, time, speed, heading)[0] == pytest.approx(chord(sway, rate, time), rel=1e-5)
