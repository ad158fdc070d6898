"""Frames: signs by hand, inverses and lengths by property, the full rotation against its matrices."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.maths import HALF_PI, PI, to_body, to_body_3d, to_cartesian, to_ned, to_ned_3d, to_path, to_spherical
from maths.evaluate import IN_PYTHON, lanes, nearly, plain, same_bits, scalar

angles = st.floats(-20.0, 20.0)
parts = st.floats(-1000.0, 1000.0)
CLOSE = {"rel": 1e-14, "abs": 1e-12}


def R_ned_body(roll: float, pitch: float, heading: float) -> np.ndarray:
    """Three elementary rotations, multiplied: roll about the bow, pitch about starboard, heading about down."""
    c, s = np.cos([roll, pitch, heading]), np.sin([roll, pitch, heading])
    about_x = np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
    about_y = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    about_z = np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def test_signs_in_the_plane() -> None:
    """Heading east: forward is east, starboard is south."""
    assert to_ned(HALF_PI, 2.0, 0.0) == pytest.approx((0.0, 2.0), **CLOSE)
    assert to_ned(HALF_PI, 0.0, 1.0) == pytest.approx((-1.0, 0.0), **CLOSE)
    assert to_body(HALF_PI, 0.0, 2.0) == pytest.approx((2.0, 0.0), **CLOSE)
    # a path to the east, a vehicle 3 m north of it: 3 m to port
    assert to_path(HALF_PI, 3.0, 5.0) == pytest.approx((5.0, -3.0), **CLOSE)


def test_signs_in_space() -> None:
    assert to_ned_3d(0.0, 0.1, 0.0, 1.0, 0.0, 0.0)[2] < 0.0  # bow up: what lies ahead is higher
    assert to_ned_3d(0.1, 0.0, 0.0, 0.0, 1.0, 0.0)[2] > 0.0  # starboard side down: what lies there is deeper
    assert to_ned_3d(0.0, 0.0, HALF_PI, 1.0, 0.0, 0.0) == pytest.approx((0.0, 1.0, 0.0), **CLOSE)


def test_signs_of_a_sonar_head() -> None:
    assert to_spherical(0.0, 10.0, 0.0) == pytest.approx((10.0, HALF_PI, 0.0), **CLOSE)  # to starboard
    assert to_spherical(3.0, 0.0, 4.0) == pytest.approx((5.0, 0.0, np.arctan2(4.0, 3.0)), **CLOSE)  # below: positive
    assert to_spherical(0.0, 0.0, 7.0) == (7.0, 0.0, HALF_PI)
    assert to_spherical(0.0, 0.0, 0.0) == (0.0, 0.0, 0.0)
    assert to_spherical(-2.0, 0.0, 0.0) == (2.0, PI, 0.0)


@given(heading=angles, surge=parts, sway=parts)
def test_plane_rotations_invert_and_keep_lengths(heading: float, surge: float, sway: float) -> None:
    north, east = to_ned(heading, surge, sway)
    assert to_body(heading, north, east) == pytest.approx((surge, sway), **CLOSE)
    assert np.hypot(north, east) == pytest.approx(np.hypot(surge, sway), **CLOSE)


@given(roll=angles, pitch=angles, heading=angles, vector=st.tuples(parts, parts, parts))
def test_the_rotation_is_the_product_of_three(
    roll: float, pitch: float, heading: float, vector: tuple[float, float, float]
) -> None:
    rotation = R_ned_body(roll, pitch, heading)
    assert to_ned_3d(roll, pitch, heading, *vector) == pytest.approx(tuple(rotation @ vector), **CLOSE)
    assert to_body_3d(roll, pitch, heading, *vector) == pytest.approx(tuple(rotation.T @ vector), **CLOSE)


@given(heading=angles, surge=parts, sway=parts)
def test_a_level_vehicle_needs_the_plane_only(heading: float, surge: float, sway: float) -> None:
    assert to_ned_3d(0.0, 0.0, heading, surge, sway, 0.0) == (*to_ned(heading, surge, sway), 0.0)


@given(forward=parts, starboard=parts, down=parts)
def test_spherical_coordinates_invert(forward: float, starboard: float, down: float) -> None:
    distance, azimuth, elevation = to_spherical(forward, starboard, down)
    assert distance >= 0.0
    assert -PI <= azimuth <= PI
    assert -HALF_PI <= elevation <= HALF_PI
    assert to_cartesian(distance, azimuth, elevation) == pytest.approx((forward, starboard, down), **CLOSE)


def test_a_usbl_fix_with_measured_attitude() -> None:
    """A surface vehicle at (100, 200, 0) that rolls and pitches hears one at (80, 230, 12): there and back."""
    attitude = (0.07, -0.04, 2.1)
    offset = np.array([80.0, 230.0, 12.0]) - [100.0, 200.0, 0.0]
    seen = to_spherical(*to_body_3d(*attitude, *offset))
    assert np.array(to_ned_3d(*attitude, *to_cartesian(*seen))) == pytest.approx(offset, **CLOSE)
    # the error of one degree of heading is range times one degree, across (closed form W)
    wrong = to_ned_3d(*attitude[:2], attitude[2] + np.radians(1.0), *to_cartesian(*seen))
    level = np.hypot(offset[0], offset[1])
    assert np.linalg.norm(np.array(wrong) - offset) == pytest.approx(2.0 * level * np.sin(np.radians(0.5)), rel=1e-9)


@pytest.mark.skipif(IN_PYTHON, reason="there is nothing to compare with")
@pytest.mark.parametrize(
    ("function", "num_arguments", "num_results"),
    [
        (to_ned, 3, 2),
        (to_path, 3, 2),
        (to_ned_3d, 6, 3),
        (to_body_3d, 6, 3),
        (to_spherical, 3, 3),
        (to_cartesian, 3, 3),
    ],
)
def test_lanes_give_the_same_bits_and_plain_python_nearly(
    function: Callable[..., Any], num_arguments: int, num_results: int
) -> None:
    columns = np.random.default_rng(2).uniform(-10.0, 10.0, (num_arguments, 256))
    wanted = scalar(function, *columns, num_results=num_results)
    assert same_bits(wanted, lanes(function, *columns, num_results=num_results))
    assert nearly(wanted, plain(function, *columns, num_results=num_results))
