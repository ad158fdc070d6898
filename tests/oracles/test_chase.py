"""Speed and yaw-rate laws that chase a point: closed forms, and their equations written anew and integrated."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pytest

from cardume.onboard.guidance import body_frame_target
from cardume.onboard.guidance.body_frame_target import Target
from cardume.paths import line as paths
from cardume.paths.offset import offset_path
from cardume.paths.segment import Start
from cardume.signals import Motion, Pace, PathError
from cardume.simulation.flight import Flight
from flying import fly_text, series, value_at
from oracles.closed_forms import integrate
from oracles.kinematic import FINE, Scene, assert_converges, at, circle, flown, line, water

COURSE, BEARING = 0.5, 0.7
FREE = "speed_max: 50, yaw_rate_max: 50"


class Way(NamedTuple):
    """A path of the mission, and the same by plain geometry."""

    text: str
    place: Callable[[float], tuple[float, float, float]]  # arc length to north, east, course


def straight() -> Way:
    c, s = math.cos(COURSE), math.sin(COURSE)
    return Way(line(COURSE), lambda x: (3.0 + x * c, -2.0 + x * s, COURSE))


def round_about(radius: float, turn: str) -> Way:
    sigma = 1.0 if turn == "starboard" else -1.0

    def place(x: float) -> tuple[float, float, float]:
        angle = BEARING + sigma * x / radius
        return radius * math.cos(angle), radius * math.sin(angle), angle + sigma * math.pi / 2.0

    return Way(circle(radius, turn, BEARING), place)


WAYS = [straight(), round_about(18.0, "starboard"), round_about(18.0, "port")]


def start_of(way: Way, e0: float, heading_error: float) -> list[float]:
    """North, east and heading of a vehicle that starts beside the path's start."""
    north, east, course = way.place(0.0)
    return [north - e0 * math.sin(course), east + e0 * math.cos(course), course + heading_error]


def error_at(place: tuple[float, float, float], state: Sequence[float], arm: float) -> tuple[float, float, float]:
    """e_B ahead and to starboard, and the path's direction in body axes, as an angle."""
    north, east, psi = state[0] - place[0], state[1] - place[1], state[2]
    c, s = math.cos(psi), math.sin(psi)
    return c * north + s * east + arm, c * east - s * north, place[2] - psi


def hand_error(way: Way, arm: float, speed: float, time: float) -> Callable[[Flight], float]:
    """Distance of the point ahead of the vehicle from one that has gone along the path at a speed [m/s]."""

    def quantity(flight: Flight) -> float:
        state = [value_at(flight, channel, time) for channel in ("north", "east", "heading")]
        ahead, starboard, _ = error_at(way.place(speed * time), state, arm)
        return math.hypot(ahead, starboard)

    return quantity


@pytest.mark.parametrize("way", WAYS, ids=["line", "starboard", "port"])
@pytest.mark.parametrize(("e0", "off", "current"), [(1.5, 0.3, 0.0), (-1.2, 0.5, 0.0), (1.0, 0.2, 0.12)])
def test_equal_gains_let_the_error_die_out_exponentially(way: Way, e0: float, off: float, current: float) -> None:
    """|e_B| = |e_B(0)| exp(-K t) under `trajectory_tracking`, on any path, in any known current."""
    arm, k = 1.0, 0.3
    law = f"law: trajectory_tracking, arm: {arm}, gain_ahead: {k}, gain_starboard: {k}, correction_max: 1000, {FREE}"
    extra = water(current, 2.1)
    scene = Scene(way.text, law, f"cross_track: {e0}, heading_error: {off}", 9.0, extra=extra)
    ahead, starboard, _ = error_at(way.place(0.0), start_of(way, e0, off), arm)
    expected = math.hypot(ahead, starboard) * math.exp(-k * 9.0)
    assert_converges(scene, hand_error(way, arm, 0.5, 9.0), expected, FINE)


def chasing(way: Way, gains: dict[str, float], v: float, current: tuple[float, float], waits: bool) -> Callable:
    """Rates of north, east, heading, s and s', from the laws' docstrings and the vehicle's kinematics."""
    a, b = gains["correction_max"], gains["arm"]

    def rates(_: float, y: np.ndarray) -> list[float]:
        ahead, starboard, tangent = error_at(way.place(y[3]), y, b)
        c, s = math.cos(y[2]), math.sin(y[2])
        in_body = c * current[0] + s * current[1], c * current[1] - s * current[0]
        u = -a * math.tanh(gains["gain_ahead"] * ahead / a) + math.cos(tangent) * v - in_body[0]
        u = min(max(u, 0.0), gains["speed_max"])
        r = (-a * math.tanh(gains["gain_starboard"] * starboard / a) + math.sin(tangent) * v - in_body[1]) / b
        r = min(max(r, -gains["yaw_rate_max"]), gains["yaw_rate_max"])
        along = ahead * math.cos(tangent) + starboard * math.sin(tangent)
        pulled = gains["target_pull"] * along - gains["target_damping"] * (y[4] - v)
        limit = gains["target_acceleration_max"]
        return [
            u * c + current[0],
            u * s + current[1],
            r,
            y[4] if waits else v,
            min(max(pulled, -limit), limit) if waits else 0.0,
        ]

    return rates


LOW = [0.3, 0.5, 0.1, 0.1, 0.3, 0.5, 0.3, 0.05, 0.7, 0.2]
HIGH = [0.7, 2.0, 0.5, 0.5, 0.8, 2.0, 2.0, 0.4, 1.2, 0.6]
NAMES = [
    "arm",
    "gain_ahead",
    "gain_starboard",
    "correction_max",
    "target_damping",
    "target_pull",
    "target_acceleration_max",
    "speed_max",
    "yaw_rate_max",
]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("law", ["body_frame_target", "trajectory_tracking"])
def test_against_an_independent_integration(law: str, seed: int) -> None:
    """Gains, limits, path and current drawn: where the vehicle is after 20 s, without a tick."""
    random = np.random.default_rng([35, seed])
    v, *drawn = (float(x) for x in random.uniform(LOW, HIGH))
    gains = dict(zip(NAMES, drawn, strict=True))
    e0, off, speed, towards = (float(x) for x in random.uniform([-4, -1, 0.0, -3], [4, 1, 0.15, 3]))
    way, waits = WAYS[seed % 3], law == "body_frame_target"
    used = {k: g for k, g in gains.items() if waits or not k.startswith("target")}
    used |= {"target_speed_min": -50.0, "target_speed_max": 50.0} if waits else {}
    text = ", ".join([f"law: {law}", *(f"{k}: {g!r}" for k, g in used.items())])
    scene = Scene(way.text, text, f"cross_track: {e0!r}, heading_error: {off!r}", 20.0, v, extra=water(speed, towards))
    current = speed * math.cos(towards), speed * math.sin(towards)
    start = [*start_of(way, e0, off), 0.0, 0.0 if waits else v]
    north, east, psi = integrate(chasing(way, gains, v, current, waits), start, 20.0)[:3]
    assert_close(scene, [north, east, psi])


def assert_close(scene: Scene, wanted: Sequence[float]) -> None:
    """The limit of no tick is the wanted place; limits that set in amid a tick leave an error of second order."""
    for channel, value in zip(("north", "east", "heading"), wanted, strict=True):
        coarse, middle, fine = (at(channel, 20.0)(flown(scene, tick)) for tick in FINE)
        found = (4.0 * (2.0 * fine - middle) - (2.0 * middle - coarse)) / 3.0
        assert found == pytest.approx(value, abs=1e-4), channel
        assert abs(fine - value) < 0.62 * abs(middle - value) + 1e-5, channel  # first order


def test_the_target_that_waits_comes_to_rest_with_the_vehicle_behind_it() -> None:
    """On a line the vehicle ends b behind its target; the target goes at the wanted speed."""
    law = "law: body_frame_target, arm: 0.8"
    flight = flown(Scene(line(COURSE), law, "cross_track: 6", 240.0), 0.1)
    assert value_at(flight, "cross_track", 240.0) == pytest.approx(0.0, abs=1e-6)
    gamma = [value_at(flight, "coordination_state", t) for t in (230.0, 240.0)]
    assert gamma[1] - gamma[0] == pytest.approx(5.0, abs=1e-6)


@pytest.mark.parametrize("law", ["body_frame_target", "trajectory_tracking"])
def test_in_a_current_the_point_ahead_is_on_the_path_and_the_vehicle_beside_it(law: str) -> None:
    """e = b Vperp / hypot(v - Vpar, Vperp): the vehicle heads into the current, and the arm keeps it off."""
    speed, towards, arm = 0.15, COURSE + 1.1, 0.8
    along, across = speed * math.cos(1.1), speed * math.sin(1.1)
    scene = Scene(line(COURSE), f"law: {law}, arm: {arm}", "cross_track: 2", 300.0, extra=water(speed, towards))
    wanted = arm * across / math.hypot(0.5 - along, across)
    assert value_at(flown(scene, 0.1), "cross_track", 300.0) == pytest.approx(wanted, abs=1e-6)
    # nothing of it is changed by a compensation that stands beside it
    crab = Scene(
        scene.path, scene.guidance, scene.start, 300.0, extra=water(speed, towards, "crab", reference="ground")
    )
    assert np.array_equal(series(flown(scene, 0.1), "north")[1], series(flown(crab, 0.1), "north")[1])


def test_the_limits_hold() -> None:
    law = "law: body_frame_target, arm: 0.3, gain_ahead: 1, gain_starboard: 1, speed_max: 0.6, yaw_rate_max: 0.07"
    flight = flown(Scene(line(COURSE), law, "cross_track: -15, heading_error: -2", 120.0), 0.1)
    rate, surge = series(flight, "yaw_rate")[1], series(flight, "surge")[1]
    assert np.abs(rate).max() == pytest.approx(0.07, abs=1e-9)
    assert (surge.min(), surge.max()) == (0.0, 0.6)
    assert abs(value_at(flight, "cross_track", 120.0)) < 0.1


def test_the_target_runs_neither_back_nor_ahead_faster_than_it_may() -> None:
    path = offset_path(paths.line(Start(), 100.0), 0.0, 0.0, 0.5)
    far = [PathError(along_track=s1, path=path) for s1 in (-40.0, 40.0)]
    motion = Motion(0.0, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0)
    limits = {"target_speed_min": -0.2, "target_speed_max": 0.7}
    for error, speed in zip(far, (-0.2, 0.7), strict=True):
        target = Target(1.0, 0.0, 0.0)
        for _ in range(200):
            _, target = body_frame_target(error, motion, Pace(0.5), target._replace(arc_length=0.0), 0.1, **limits)
        assert target.speed == speed


def test_a_target_takes_the_correction_of_coordination() -> None:
    """Two vehicles, one 4 m behind: the targets run at v_L plus the correction, and the vehicles meet."""
    flight = fly_text(
        """
cardume: 1
name: pair
duration: 120 s
path: {type: line, length: 200 m}
formation: {speed: 0.5 m/s}
model: kinematic
sensors: ideal
guidance: {law: body_frame_target}
coordination: {law: laplacian_tanh, gain: 0.15 m/s}
vehicles:
  - {name: a, start: {speed: 0.5 m/s}}
  - {name: b, offset: {starboard: 5 m}, start: {along_track: -4 m, speed: 0.5 m/s}}
"""
    )
    gamma = flight.channels["coordination_state"]
    assert gamma[0, 0] - gamma[0, 1] == pytest.approx(4.0)
    assert abs(gamma[-1, 0] - gamma[-1, 1]) < 0.05
