"""Closed form C, text 2.3: where lines join arcs, law (18) has to change its distance from the path."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from cardume.simulation.flight import Flight
from flying import series
from oracles.kinematic import FINE, Quantity, Scene, assert_converges, at_time, converged, flown, when

LEG, RADIUS, LOOKAHEAD, SPEED = 60.0, 12.0, 5.0, 0.5
ARC = math.pi * RADIUS


def lawnmower(law: str, log_period: float = 0.1) -> Scene:
    """Two legs and the half circle between them, flown from the path's start."""
    path = f"type: lawnmower, leg: {LEG}, legs: 2, spacing: {2.0 * RADIUS}, start: {{course: 0}}"
    return Scene(path, f"law: {law}, lookahead: {LOOKAHEAD}", "cross_track: 0", 220.0, log_period=log_period)


def point(s: float) -> np.ndarray:
    """North and east of the path at an arc length."""
    if s < LEG:
        return np.array([s, 0.0])
    if s > LEG + ARC:
        return np.array([LEG - (s - LEG - ARC), 2.0 * RADIUS])
    angle = (s - LEG) / RADIUS
    return np.array([LEG + RADIUS * math.sin(angle), RADIUS - RADIUS * math.cos(angle)])


def place(p: np.ndarray) -> tuple[float, float]:
    """Arc length and distance to starboard of the nearest point of the path."""
    north, east = p[0] - LEG, p[1] - RADIUS
    if north > 0.0:
        return LEG + RADIUS * math.atan2(north, -east), RADIUS - math.hypot(north, east)
    return (LEG + north, east + RADIUS) if east < 0.0 else (LEG + ARC - north, RADIUS - east)


def pursuit() -> tuple[float, float]:
    """Error where line and arc join, and the largest: the pursuit of the point ahead, integrated."""

    def velocity(_: float, p: np.ndarray) -> np.ndarray:
        to_aim = point(place(p)[0] + LOOKAHEAD) - p
        return SPEED * to_aim / math.hypot(*to_aim)

    way = solve_ivp(velocity, (0.0, 220.0), [0.0, 0.0], rtol=1e-10, atol=1e-11, max_step=0.1, dense_output=True).sol
    joint = brentq(lambda t: place(way(t))[0] - LEG, 110.0, 130.0, xtol=1e-12)
    errors = [abs(place(way(t))[1]) for t in np.arange(150.0, 210.0, 0.01)]
    return place(way(joint))[1], max(errors)


def largest(flight: Flight) -> float:
    """Largest error of a flight [m], between ticks too."""
    times, e = series(flight, "cross_track")
    top = int(np.argmax(abs(e)))
    near = slice(top - 4, top + 5)
    return float(abs(CubicSpline(times[near], e[near])(np.linspace(times[top - 1], times[top + 1], 2001))).max())


def at_joint() -> Quantity:
    """Error [m] abeam of the joint."""
    return at_time("cross_track", when("coordination_state", LEG))


def test_2_3_does_not_hold_for_18() -> None:
    """Erratum, text 2.3: (18) errs by 0.276031 m where the line joins the arc, and by 1.025230 m at most in it."""
    joint, most = pursuit()
    assert (joint, most) == pytest.approx((0.276031, 1.025230), abs=1e-6)
    each_tick = lawnmower("along_path", log_period=0.0)  # a spline over longer spans would round the joint
    assert_converges(each_tick, at_joint(), joint, FINE)
    value, _ = converged(lawnmower("along_path"), largest, FINE)
    assert value == pytest.approx(most, rel=1e-5)


def test_2_3_numbers_of_the_table() -> None:
    """Erratum, text 2.3: the table's 1.02413 m and 0.27606 m are those of a step of 0.01 s, 0.1 % from the limit."""
    times, e = series(flown(lawnmower("along_path", 0.01), 0.01), "cross_track")
    _, gamma = series(flown(lawnmower("along_path", 0.01), 0.01), "coordination_state")
    assert times[1] == pytest.approx(0.01)
    assert abs(e).max() == pytest.approx(1.02413, abs=5e-6)
    assert e[np.argmax(gamma > LEG)] == pytest.approx(0.27606, abs=5e-6)


def test_2_3_holds_for_line_of_sight() -> None:
    """Erratum, text 2.3: on the tangent nothing changes at a joint; what is left is the tick's, and falls with it."""
    errors = [abs(series(flown(lawnmower("line_of_sight"), tick), "cross_track")[1]).max() for tick in FINE]
    assert errors[2] < 1e-3
    assert errors[0] / errors[2] == pytest.approx(4.0, rel=0.05)
