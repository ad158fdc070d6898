"""Closed form H: the current that heading and speed can beat, and what they must be to do so."""

import math

import numpy as np
import pytest

from flying import series, value_at
from oracles.closed_forms import line_of_sight
from oracles.kinematic import Scene, assert_converges, at, circle, flown, line, water

COURSE = 0.5
PARALLEL = "law: 'aids:parallel'"
SIGHT = "law: line_of_sight, lookahead: 5"


def crab(along: float, across: float, reference: str) -> str:
    """A current by its parts [m/s] along and to starboard of COURSE, known aboard, and a crab against it."""
    towards = (COURSE + math.atan2(across, along)) % (2.0 * math.pi)
    return water(math.hypot(along, across), towards, "crab", reference=reference)


def on_line(along: float, across: float, u: float, reference: str, guidance: str = PARALLEL, e0: float = 0.0) -> Scene:
    """A line flown against that current."""
    extra = crab(along, across, reference)
    return Scene(line(COURSE), guidance, f"cross_track: {e0!r}", 60.0, u, extra=extra)


def rate(scene: Scene, channel: str) -> float:
    """Mean rate of a channel once the first ticks, in which the current was unknown, are over."""
    flight = flown(scene, 0.1)
    return (value_at(flight, channel, 60.0) - value_at(flight, channel, 10.0)) / 50.0


def test_h_speed_and_heading_that_hold_the_printed_case() -> None:
    """Row H: v_L = 0.5, Vpar = -0.1, Vperp = 0.15: u = 0.6184658438 m/s, 14.03624347 deg into the current."""
    scene = on_line(-0.1, 0.15, 0.5, "ground")
    flight = flown(scene, 0.1)
    assert value_at(flight, "surge", 60.0) == pytest.approx(0.6184658438, abs=1e-10)
    assert math.degrees(value_at(flight, "heading", 60.0) - COURSE) == pytest.approx(-14.03624347, abs=1e-8)
    assert rate(scene, "coordination_state") == pytest.approx(0.5, abs=1e-12)
    assert rate(scene, "cross_track") == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_h_speed_and_heading_at_random(seed: int) -> None:
    """Row H: u = hypot(v_L - Vpar, Vperp), psi = chi + atan2(-Vperp, v_L - Vpar), currents from all sides."""
    random = np.random.default_rng([9, seed])
    v, along, across = (float(x) for x in random.uniform([0.4, -0.6, -0.6], [1.2, 0.3, 0.6]))
    scene = on_line(along, across, v, "ground")
    flight = flown(scene, 0.1)
    assert value_at(flight, "surge", 60.0) == pytest.approx(math.hypot(v - along, across), rel=1e-10)
    assert value_at(flight, "heading", 60.0) - COURSE == pytest.approx(math.atan2(-across, v - along), abs=1e-10)
    assert rate(scene, "coordination_state") == pytest.approx(v, rel=1e-10)


@pytest.mark.parametrize("seed", range(12, 18))
def test_h_held_over_ground_the_current_is_gone(seed: int) -> None:
    """Rows H, A: with heading and speed chosen so, the error decays as without current, u being v_L."""
    random = np.random.default_rng([9, seed])
    v, along, across = (float(x) for x in random.uniform([0.4, -0.3, -0.3], [1.0, 0.2, 0.3]))
    scene = on_line(along, across, v, "ground", SIGHT, 8.0)
    assert_converges(scene, at("cross_track", 30.0), line_of_sight(8.0, v, 5.0, 30.0))


@pytest.mark.parametrize(
    ("u", "along", "across", "printed"),
    [(0.5, 0.1, 0.15, 0.57696960), (0.3, -0.2, 0.25, None), (0.3, -0.31, 0.0, None)],
)
def test_h_way_along_the_path_at_a_speed_through_the_water(
    u: float, along: float, across: float, printed: float | None
) -> None:
    """Row H, (36), (53): sqrt(u^2 - Vperp^2) + Vpar is left along the course; the second and third go backwards."""
    expected = math.sqrt(u * u - across * across) + along
    assert printed is None or expected == pytest.approx(printed, abs=1e-8)
    scene = on_line(along, across, u, "water")
    assert rate(scene, "coordination_state") == pytest.approx(expected, abs=1e-12)
    assert rate(scene, "cross_track") == pytest.approx(0.0, abs=1e-12)
    assert (expected > 0.0) == (printed is not None)


@pytest.mark.parametrize("across", [0.29, -0.29, 0.31, -0.35])
def test_h_across_the_course_at_most_the_own_speed(across: float) -> None:
    """Row H: |Vperp| <= u = u_p - k = 0.3 m/s; beyond, the vehicle is swept away (our crab stays 0.98 u square)."""
    swept = rate(on_line(0.0, across, 0.5 - 0.2, "water"), "cross_track")
    if abs(across) < 0.3:
        assert swept == pytest.approx(0.0, abs=1e-12)
    else:
        assert swept == pytest.approx(across - math.copysign(0.98 * 0.3, across), abs=1e-12)


@pytest.mark.parametrize("turn", ["starboard", "port"])
@pytest.mark.parametrize("speed", [0.28, 0.35])
def test_h_every_heading_if_the_current_is_slower(turn: str, speed: float) -> None:
    """Row H: a circle needs every course; with u = 0.3 m/s it can be held in 0.28 m/s, not in 0.35 m/s."""
    extra = crab(speed, 0.0, "water")
    scene = Scene(circle(15.0, turn), SIGHT, "cross_track: 0", 2000.0, 0.3, extra=extra)
    worst = [abs(series(flown(scene, tick), "cross_track")[1]).max() for tick in (0.1, 0.05)]
    _, gamma = series(flown(scene, 0.1), "coordination_state")
    if speed < 0.3:
        assert worst[0] < 0.05
        assert worst[0] / worst[1] == pytest.approx(2.0, rel=0.02)  # all of it is the tick's
        assert gamma[-1] > 2.0 * math.pi * 15.0  # once round, slowly against the current
    else:
        assert min(worst) > 10.0
