"""Errata (5), (51), (52): how far along its path a vehicle takes itself to be, flown."""

import math

import numpy as np
import pytest

from cardume.simulation.flight import Flight
from flying import series, value_at
from oracles.kinematic import Quantity, Scene, assert_converges, circle, flown

PARALLEL = "law: 'aids:parallel', reference_point: "
TURNS = pytest.mark.parametrize("turn", ["starboard", "port"])


def abeam(radius: float, rho: float, turn: str, reference_point: str, u: float = 0.5) -> Scene:
    """A circle flown at a distance from its center, which stays the same as the tick vanishes."""
    e0 = (radius - rho) * (1.0 if turn == "starboard" else -1.0)
    return Scene(circle(radius, turn), PARALLEL + reference_point, f"cross_track: {e0!r}", 10.0, u)


def way(channel: str, u: float = 0.5) -> Quantity:
    """Mean rate of a coordination state, in units of the speed."""
    return lambda flight: (value_at(flight, channel, 10.0) - value_at(flight, channel, 0.0)) / (10.0 * u)


@pytest.mark.parametrize(("mixed", "printed"), [(0, 0.96), (1, 1.04347826)])
def test_5_at_the_printed_parameters(mixed: int, printed: float) -> None:
    """Erratum (5): R = 12, rho = 12.5: ds/dt = 0.96 u with the e to starboard, 1.04347826 u with that of (19)."""
    assert (0.96, 24.0 / 23.0)[mixed] == pytest.approx(printed, abs=1e-8)
    scene = abeam(12.0, 12.5, "starboard", f"'printed_paths:odometer_of_5', mixed: {mixed}")
    assert_converges(scene, way("coordination_state_estimate"), (0.96, 24.0 / 23.0)[mixed])
    assert_converges(scene, way("coordination_state"), 0.96)  # what it truly does


@pytest.mark.parametrize("mixed", [0, 1])
def test_5_on_a_turn_to_port(mixed: int) -> None:
    """Errata (5), (19): there both errors are the same, and right."""
    scene = abeam(12.0, 12.5, "port", f"'printed_paths:odometer_of_5', mixed: {mixed}")
    assert_converges(scene, way("coordination_state_estimate"), 0.96)


@TURNS
@pytest.mark.parametrize("seed", range(4))
def test_5_at_random(seed: int, turn: str) -> None:
    """Row A2, (5): ds/dt = u / (1 - c e) = u R / rho, inside and outside, R, rho and u drawn."""
    random = np.random.default_rng([10, seed])
    radius, share, u = (float(v) for v in random.uniform([8.0, 0.4, 0.2], [40.0, 1.6, 1.0]))
    scene = abeam(radius, share * radius, turn, "'printed_paths:odometer_of_5', mixed: 0", u)
    assert_converges(scene, way("coordination_state_estimate", u), 1.0 / share)
    ours = abeam(radius, share * radius, turn, "projection", u)
    assert_converges(ours, way("coordination_state_estimate", u), 1.0 / share)
    wrong = abeam(radius, share * radius, turn, "'printed_paths:odometer_of_5', mixed: 1", u)
    e_of_19 = (share - 1.0) * radius
    sigma = 1.0 if turn == "starboard" else -1.0
    assert_converges(wrong, way("coordination_state_estimate", u), 1.0 / (1.0 - sigma * e_of_19 / radius))


def most_of_a_circle(turn: str, reference_point: str) -> Flight:
    """A circle of 12 m, flown on the path for most of a lap."""
    law = f"law: line_of_sight, lookahead: 5, reference_point: {reference_point}"
    bearing = -0.5 * math.pi  # the bearing of the center's other side passes through pi on the way
    scene = Scene(circle(12.0, turn, bearing), law, "cross_track: 0", 130.0, log_period=0.1)
    return flown(scene, 0.1)


@TURNS
def test_51_as_printed_counts_radians(turn: str) -> None:
    """Erratum (51): half a circle of 12 m counts as 3.141593 and not as 37.699112 m; gamma jumps by 6.283185."""
    flight = most_of_a_circle(turn, "'printed_paths:polar_of_51_and_52', in_radians: 1")
    _, true = series(flight, "coordination_state")
    _, printed = series(flight, "coordination_state_estimate")
    half = np.interp(37.699112, true, np.unwrap(printed))
    sigma = 1.0 if turn == "starboard" else -1.0
    assert half == pytest.approx(sigma * 3.141593, abs=1e-6)  # and backwards to port
    steps = np.diff(printed)
    jump = steps[np.argmax(abs(steps))]
    assert jump == pytest.approx(-sigma * 6.283185, abs=0.01)
    assert jump - np.median(steps) == pytest.approx(-sigma * 6.283185, abs=1e-4)


@TURNS
def test_51_corrected_counts_meters(turn: str) -> None:
    """Erratum (51): ours is the true one, without a jump."""
    flight = most_of_a_circle(turn, "projection")
    _, true = series(flight, "coordination_state")
    _, believed = series(flight, "coordination_state_estimate")
    assert believed == pytest.approx(true, abs=1e-9)
    assert believed[-1] > 37.699112
    assert abs(np.diff(believed)).max() < 0.06


@TURNS
def test_52_as_printed_turns_a_vehicle_on_its_path(turn: str) -> None:
    """Erratum (52): without -R the error on the path is R, and the heading atan(R / d) = 67.38013505 deg off."""
    flight = most_of_a_circle(turn, "'printed_paths:polar_of_51_and_52', without_radius: 1")
    off = math.degrees(value_at(flight, "heading_desired", 0.0) - value_at(flight, "path_course", 0.0))
    assert value_at(flight, "cross_track", 0.0) == pytest.approx(0.0, abs=1e-9)
    assert value_at(flight, "cross_track_estimate", 0.0) == pytest.approx(12.0, abs=1e-9)
    assert math.remainder(off, 360.0) == pytest.approx(-67.38013505, abs=1e-8)
