"""Angles: the interval's ends, whole turns of the true 2 pi, and the same bits in lanes."""

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.maths import ANGLE_LIMIT, PI, TWO_PI, angle_difference, sincos, unwrap_near, wrap_angle
from maths.evaluate import IN_PYTHON, lanes, nearly, plain, same_bits, scalar

angles = st.floats(-ANGLE_LIMIT, ANGLE_LIMIT)
directions = st.floats(-PI, PI, exclude_min=True)
AFTER_PI = np.nextafter(PI, 4.0)
PI_LACKS = -1.2246467991473532e-16  # PI - pi


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [
        (0.0, 0.0), (PI, PI), (-PI, PI), (np.nextafter(PI, 0.0), np.nextafter(PI, 0.0)),
        (np.nextafter(-PI, 0.0), np.nextafter(-PI, 0.0)), (5e-324, 5e-324), (TWO_PI, 2.0 * PI_LACKS),
    ],
)  # fmt: skip
def test_exact_values(angle: float, wrapped: float) -> None:
    assert wrap_angle(float(angle)) == pytest.approx(float(wrapped), rel=0.0, abs=1e-25)


@pytest.mark.parametrize("angle", [AFTER_PI, -AFTER_PI, 3.0 * PI, -3.0 * PI, 5.0 * PI, 101.0 * PI, -100001.0 * PI])
def test_near_the_ends_it_stays_inside(angle: float) -> None:
    assert -PI < wrap_angle(angle) <= PI
    assert abs(wrap_angle(angle)) == pytest.approx(PI, abs=abs(angle) * 2.3e-16)


@pytest.mark.parametrize("angle", [math.inf, -math.inf, math.nan, np.nextafter(ANGLE_LIMIT, math.inf), 1e300])
def test_beyond_the_limit_is_nan(angle: float) -> None:
    assert math.isnan(wrap_angle(angle))


@given(angle=angles)
def test_interval_and_idempotence(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -PI < wrapped <= PI
    assert wrap_angle(wrapped) == wrapped


@given(angle=directions)
def test_a_direction_comes_back_unchanged(angle: float) -> None:
    assert wrap_angle(angle) == angle


@given(angle=angles)
def test_turns_are_those_of_the_true_circle(angle: float) -> None:
    with mpmath.workdps(50):
        turn = 2 * mpmath.pi
        exact = mpmath.mpf(angle) - turn * mpmath.nint(mpmath.mpf(angle) / turn)
        error = abs(exact - mpmath.mpf(wrap_angle(angle)))
        assert min(error, abs(error - turn)) < 5e-16


@given(angle=angles)
def test_sine_and_cosine_do_not_see_it(angle: float) -> None:
    assert sincos(wrap_angle(angle)) == pytest.approx(sincos(angle), abs=7e-16)


@given(actual=st.floats(-1e4, 1e4), desired=st.floats(-1e4, 1e4))
def test_differences_are_the_shorter_way_round(actual: float, desired: float) -> None:
    difference = angle_difference(actual, desired)
    assert -PI < difference <= PI
    s, c = sincos(actual)
    s_d, c_d = sincos(desired)
    assert math.cos(difference) == pytest.approx(c * c_d + s * s_d, abs=1e-11)
    assert math.sin(difference) == pytest.approx(s * c_d - c * s_d, abs=1e-11)


def test_sign_of_a_difference() -> None:
    assert angle_difference(0.1, -0.1) == pytest.approx(0.2)
    assert angle_difference(-3.0, 3.0) == pytest.approx(TWO_PI - 6.0)  # clockwise, through south
    assert angle_difference(PI, 0.0) == PI
    assert angle_difference(0.0, PI) == PI


@given(angle=directions, reference=st.floats(-1e5, 1e5))
def test_unwrapping_keeps_the_direction_and_stays_near(angle: float, reference: float) -> None:
    near = unwrap_near(angle, reference)
    assert abs(near - reference) <= PI + 1e-10
    assert abs(angle_difference(near, angle)) == pytest.approx(0.0, abs=1e-10)


def test_unwrapping_follows_a_turning_vehicle() -> None:
    true = np.linspace(0.0, 40.0, 500)
    follow, followed = 0.0, []
    for heading in true:
        follow = unwrap_near(wrap_angle(float(heading)), follow)
        followed.append(follow)
    assert np.max(np.abs(np.array(followed) - true)) < 1e-13


@pytest.mark.skipif(IN_PYTHON, reason="there is nothing to compare with")
@pytest.mark.parametrize("function", [angle_difference, unwrap_near])
def test_lanes_give_the_same_bits_and_plain_python_nearly(function: Callable[..., Any]) -> None:
    special = [0.0, -0.0, PI, -PI, AFTER_PI, -AFTER_PI, TWO_PI, math.nan, math.inf, 1e7]
    x = np.concatenate([special, np.random.default_rng(1).uniform(-50.0, 50.0, 64 - len(special))])
    columns = np.repeat(x, 64), np.tile(x, 64)
    wanted = scalar(function, *columns)
    assert same_bits(wanted, lanes(function, *columns))
    assert nearly(wanted, plain(function, *columns))
