"""v_L that changes with time: gamma(t) is the integral of the profile, and a coordinated fleet stays together."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipk

from cardume.paths.table import LENGTH_REFERENCE, SPEED, rows_on_path
from flying import fly_text, limit, value_at
from properties.flown import plan_of

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
  - {{name: ahead, offset: {{starboard: -2 m, ahead: 3 m}}, start: {{along_track: {lead} m, speed: 0.3 m/s}}}}
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
CIRCLE = "{type: circle, centre: {north: 0, east: 0}, radius: 15 m}"  # no joint within a tick


def mission(tick: float, points: list[tuple[float, float]], path: str) -> str:
    written = [[f"{t!r} s", f"{v!r} m/s"] for t, v in points]
    return MISSION.format(tick=tick, points=str(written).replace("'", ""), path=path, lead=lead(path))


def lead(path: str) -> float:
    """3 m ahead on the reference path, on the own path 2 m outside it."""
    return 3.0 * 17.0 / 15.0 if path == CIRCLE else 3.0


def state_at(tick: float, points: list[tuple[float, float]], path: str, vehicle: int) -> float:
    return value_at(fly_text(mission(tick, points, path)), "coordination_state", 50.0, vehicle)


@pytest.mark.parametrize("path", [LINE, CIRCLE])
@pytest.mark.parametrize("points", [POINTS, [(0.0, 0.5)], [(-10.0, 0.2), (60.0, 0.55)], [(10.0, 0.4), (20.0, 0.4)]])
def test_gamma_is_the_integral_of_the_profile(points: list[tuple[float, float]], path: str) -> None:
    for vehicle in (0, 1):
        found, _ = limit(lambda tick, k=vehicle: state_at(tick, points, path, k), (0.1, 0.05, 0.025))
        assert found == pytest.approx(integral(points, 50.0), rel=1e-5)


def spread(text: str) -> float:
    """The largest difference of two coordination states."""
    states = fly_text(text).channels["coordination_state"]
    assert np.ptp(np.diff(states[:, 0])) > 0.1  # the speed did change
    return float(np.ptp(states, axis=1).max())


def test_vehicles_that_start_together_stay_together() -> None:
    """What is left is a report's path speed, which is that of the tick before: in proportion to the tick."""
    coarse, fine = (spread(mission(tick, POINTS, LINE)) for tick in (0.1, 0.05))
    assert coarse < 2e-4
    assert fine < 0.6 * coarse or coarse < 1e-9
    assert spread(mission(0.1, POINTS, "{type: lawnmower, leg: 8 m, legs: 3, spacing: 12 m}")) < 0.01


# ---- v_L along the path ----------------------------------------------------------------------------------------------

ALONG = [(4.0, 0.3), (13.0, 0.6), (19.0, 0.35)]


def time_at(gamma: float, points: list[tuple[float, float]]) -> float:
    """t = integral of d gamma / v(gamma): ln(v_2 / v_1) / slope where v is a straight line."""
    places, values = zip(*points, strict=True)
    knots = np.unique([0.0, gamma, *(p for p in places if 0.0 < p < gamma)])
    v = np.interp(knots, places, values)
    total = 0.0
    for g1, g2, v1, v2 in zip(knots, knots[1:], v, v[1:], strict=False):
        slope = (v2 - v1) / (g2 - g1)
        total += np.log(v2 / v1) / slope if slope else (g2 - g1) / v1
    return float(total)


def gamma_at(time: float, points: list[tuple[float, float]]) -> float:
    return float(brentq(lambda gamma: time_at(gamma, points) - time, 0.0, 100.0, xtol=1e-12))


def along(tick: float, points: list[tuple[float, float]], path: str) -> str:
    written = [[f"{g!r} m", f"{v!r} m/s"] for g, v in points]
    text = MISSION.format(tick=tick, points=str(written).replace("'", ""), path=path, lead=lead(path))
    return text.replace("profile: time", "profile: path")


@pytest.mark.parametrize("path", [LINE, CIRCLE])
@pytest.mark.parametrize(
    "points", [ALONG, [(2.0, 0.5), (25.0, 0.25)], [(0.0, 0.4)]], ids=["up and down", "slower", "constant"]
)
def test_along_the_path_gamma_solves_its_own_equation(points: list[tuple[float, float]], path: str) -> None:
    def state(tick: float) -> float:
        return value_at(fly_text(along(tick, points, path)), "coordination_state", 50.0, 1)

    found, _ = limit(state, (0.1, 0.05, 0.025))
    assert found == pytest.approx(gamma_at(50.0, points), rel=2e-5)


def test_the_mean_of_a_profile_along_a_closed_path_is_that_of_its_laps() -> None:
    """The pieces by which a closed path goes on beyond its ends are not flown, and do not count."""
    points = [(0.0, 0.3), (60.0, 0.6)]
    eight = "{type: lemniscate, centre: {north: 0, east: 0}, half_width: 10 m}"
    path = plan_of(along(0.1, points, eight)).vehicles[0].path
    lap = path[LENGTH_REFERENCE]
    assert lap == pytest.approx(4.0 * 10.0 * ellipk(-1.0), rel=1e-12)
    assert rows_on_path(path)[:, SPEED] == pytest.approx(integral(points, lap) / lap, rel=1e-12)


def test_all_read_v_l_at_the_formations_point() -> None:
    flight = fly_text(along(0.1, ALONG, LINE))
    states = flight.channels["coordination_state"]
    assert np.ptp(states, axis=1).max() < 1e-9  # also the one that is 3 m ahead on the path


def test_a_neighbor_elsewhere_is_predicted_with_v_l_there() -> None:
    """The one is 12 m ahead, where v_L is twice as large; it is heard every 12 s, and nothing brings them together."""
    text = along(0.1, [(6.0, 0.3), (6.5, 0.6)], LINE).replace("period: 1 s", "period: 12 s")
    text = text.replace("gain: 0.15 m/s", "gain: 1e-9 m/s").replace("ahead: 3 m", "ahead: 0 m")
    flight = fly_text(text.replace("along_track: 3 m", "along_track: 12 m"))
    heard = flight.times > 1.0
    believed = flight.neighbor_state_estimate[heard, 0, 2]
    assert abs(believed - flight.channels["coordination_state"][heard, 2]).max() < 0.1
