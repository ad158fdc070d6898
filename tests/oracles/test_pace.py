"""v_L that changes with time: gamma(t) is the integral of the profile, and a coordinated fleet stays together."""

from __future__ import annotations

import numpy as np
import pytest

from flying import fly_text, limit, value_at

POINTS = [(5.0, 0.3), (25.0, 0.62), (40.0, 0.2)]  # no corner at the mission's ends
MISSION = """
cardume: 1
name: pace
duration: 50.5 s
tick: {tick} s
plant_step: {tick} s
log_period: 0.5 s
path: {{type: lawnmower, leg: 8 m, legs: 3, spacing: 12 m}}
formation: {{speed: {{profile: time, points: {points}}}}}
vehicles:
  - {{name: middle, start: {{speed: 0.3 m/s}}}}
  - {{name: inner, offset: {{starboard: 2 m}}, start: {{speed: 0.3 m/s}}}}
  - {{name: ahead, offset: {{starboard: -2 m, ahead: 3 m}}, start: {{along_track: 3 m, speed: 0.3 m/s}}}}
model: kinematic
sensors: ideal
coordination: {{law: laplacian_tanh, gain: 0.15 m/s, topology: star}}
messaging: {{schedule: periodic, period: 1 s}}
"""


def integral(points: list[tuple[float, float]], end: float) -> float:
    """Exact, by trapezoids between the corners."""
    times, values = zip(*points, strict=True)
    knots = np.unique([0.0, end, *(t for t in times if 0.0 < t < end)])
    return float(np.trapezoid(np.interp(knots, times, values), knots))


def state_at(tick: float, points: list[tuple[float, float]], time: float, vehicle: int) -> float:
    written = [[f"{t!r} s", f"{v!r} m/s"] for t, v in points]
    text = MISSION.format(tick=tick, points=str(written).replace("'", ""))
    return value_at(fly_text(text), "coordination_state", time, vehicle)


@pytest.mark.parametrize("points", [POINTS, [(0.0, 0.5)], [(-10.0, 0.2), (60.0, 0.55)], [(10.0, 0.4), (20.0, 0.4)]])
def test_gamma_is_the_integral_of_the_profile(points: list[tuple[float, float]]) -> None:
    for vehicle in (0, 1):
        found, _ = limit(lambda tick, k=vehicle: state_at(tick, points, 50.0, k), (0.1, 0.05, 0.025))
        assert found == pytest.approx(integral(points, 50.0), rel=1e-6)


def test_vehicles_that_start_together_stay_together() -> None:
    written = [[f"{t!r} s", f"{v!r} m/s"] for t, v in POINTS]
    flight = fly_text(MISSION.format(tick=0.1, points=str(written).replace("'", "")))
    states = flight.channels["coordination_state"]
    assert np.ptp(states, axis=1).max() < 1e-9
    assert abs(flight.channels["speed_correction"]).max() < 1e-9
    assert np.ptp(np.diff(states[:, 0])) > 0.1  # it did change
