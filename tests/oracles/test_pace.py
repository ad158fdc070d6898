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
path: {path}
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


LINE = "{type: line, length: 200 m}"
CIRCLE = (
    "{type: circle, centre: {north: 0, east: 0}, radius: 15 m}"  # no joint within a tick
)


def mission(tick: float, points: list[tuple[float, float]], path: str) -> str:
    written = [[f"{t!r} s", f"{v!r} m/s"] for t, v in points]
    return MISSION.format(tick=tick, points=str(written).replace("'", ""), path=path)


def state_at(tick: float, points: list[tuple[float, float]], path: str, vehicle: int) -> float:
    return value_at(fly_text(mission(tick, points, path)), "coordination_state", 50.0, vehicle)


@pytest.mark.parametrize("path", [LINE, CIRCLE])
@pytest.mark.parametrize("points", [POINTS, [(0.0, 0.5)], [(-10.0, 0.2), (60.0, 0.55)], [(10.0, 0.4), (20.0, 0.4)]])
def test_gamma_is_the_integral_of_the_profile(points: list[tuple[float, float]], path: str) -> None:
    for vehicle in (0, 1):
        found, _ = limit(lambda tick, k=vehicle: state_at(tick, points, path, k), (0.1, 0.05, 0.025))
        assert found == pytest.approx(integral(points, 50.0), rel=1e-5)


@pytest.mark.parametrize(
    ("path", "apart"), [(LINE, 1e-9), ("{type: lawnmower, leg: 8 m, legs: 3, spacing: 12 m}", 0.01)]
)
def test_vehicles_that_start_together_stay_together(path: str, apart: float) -> None:
    flight = fly_text(mission(0.1, POINTS, path))
    states = flight.channels["coordination_state"]
    assert np.ptp(states, axis=1).max() < apart
    assert abs(flight.channels["speed_correction"]).max() < apart
    assert np.ptp(np.diff(states[:, 0])) > 0.1  # it did change
