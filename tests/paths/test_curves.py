"""Curves: their arc length, their bends, the foot of a vehicle and the parallel path, against other means."""

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import ellipk

from cardume.paths.along import arc_length_at, path_parameter_at
from cardume.paths.circle import Center
from cardume.paths.lemniscate import lemniscate
from cardume.paths.offset import offset_path
from cardume.paths.projection import point_at, point_of_formation, project
from cardume.paths.segment import GeometryError, end_of, length_of
from cardume.paths.table import LENGTH_OWN, LENGTH_REFERENCE, start_at
from cardume.signals import PathError, Place

A, CENTER, AXIS = 20.0, (30.0, -12.0), 0.6
EIGHT = lemniscate(Center(*CENTER), A, AXIS, "port", start_parameter=0.1)
LENGTH = 4.0 * A * float(ellipk(-1.0))


def at(t: float) -> np.ndarray:
    """North and east of the lemniscate at its parameter, by its equation; to port: y to port."""
    x, y = A * math.cos(t) / (1.0 + math.sin(t) ** 2), A * math.sin(t) * math.cos(t) / (1.0 + math.sin(t) ** 2)
    return np.array(CENTER) + [
        x * math.cos(AXIS) + y * math.sin(AXIS),
        x * math.sin(AXIS) - y * math.cos(AXIS),
    ]


def arc_length(t: float) -> float:
    """From the start of the path, by quadrature."""
    return float(quad(lambda u: A / math.sqrt(1.0 + math.sin(u) ** 2), 0.1, t, epsabs=1e-13, epsrel=1e-13)[0])


def curvature(t: float) -> float:
    """Of the lemniscate, > 0 to starboard."""
    return -3.0 * math.cos(t) / (A * math.sqrt(1.0 + math.sin(t) ** 2))


def course(t: float) -> float:
    """Of the tangent, by its equation."""
    s = math.sin(t)
    forward, aside = s * (s * s - 3.0), 1.0 - 3.0 * s * s
    return AXIS + math.atan2(-aside, forward)


def beside(t: float, e: float) -> tuple[float, float]:
    """The point e to starboard of the lemniscate."""
    north, east = at(t)
    return north - e * math.sin(course(t)), east + e * math.cos(course(t))


def see(path: np.ndarray, t: float, e: float, guess: float) -> PathError:
    """What a vehicle at e to starboard sees, that was last `guess` meters along."""
    return project(Place(*beside(t, e), path), start_at(path, guess))[0]


def test_length_of_a_lemniscate() -> None:
    assert length_of(EIGHT) == pytest.approx(LENGTH, rel=1e-14)
    assert length_of(lemniscate(Center(), A, laps=3)) == pytest.approx(3.0 * LENGTH, rel=1e-14)


def test_a_lemniscate_is_continuous_in_place_course_and_curvature() -> None:
    for before, after in zip(EIGHT, EIGHT[1:], strict=False):
        end = end_of(before)
        assert math.hypot(end.north - after.north, end.east - after.east) < 1e-12
        assert abs(math.remainder(end.course - after.course, 2.0 * math.pi)) < 1e-13
        assert before.curve is not None
        assert after.curve is not None
        bend = sum(k * c for k, c in enumerate(before.curve.turned, 1)) / before.length
        assert bend == pytest.approx(after.curve.turned[0] / after.length, abs=1e-10)


@given(st.floats(0.11, 6.3), st.floats(-1.0, 1.0), st.floats(-4.0, 4.0), st.floats(-6.0, 6.0))
def test_foot_curvature_and_gamma_on_a_lemniscate(t: float, share: float, offset: float, guess: float) -> None:
    """Within the radius of curvature the foot is found; on offset paths e, c, h follow exactly."""
    path = offset_path(EIGHT, offset, ahead=3.0, speed=0.5)
    e = share * 0.8 * A / 3.0
    error = see(path, t, e, arc_length_at(path, arc_length(t) - 3.0) + guess * (1.0 - abs(share)))
    c = curvature(t)
    assert error.cross_track == pytest.approx(e - offset, abs=1e-10)
    assert error.path_parameter == pytest.approx(arc_length(t) - 3.0, abs=1e-9)
    assert error.curvature == pytest.approx(c / (1.0 - c * offset), abs=1e-8)
    assert error.stretch == pytest.approx(1.0 - c * offset, abs=1e-9)
    assert math.remainder(error.path_course - course(t), 2.0 * math.pi) == pytest.approx(0.0, abs=1e-10)


@given(st.floats(-5.0, 5.0), st.floats(0.0, 1.0))
def test_length_of_the_parallel_path(offset: float, share: float) -> None:
    """s_own = s - D (chi - chi_0), by quadrature of 1 - c D; and back."""
    path, t = offset_path(EIGHT, offset), 0.1 + share * 2.0 * math.pi
    own = quad(lambda u: (1.0 - curvature(u) * offset) * A / math.sqrt(1.0 + math.sin(u) ** 2), 0.1, t, epsabs=1e-12)[0]
    assert arc_length_at(path, arc_length(t)) == pytest.approx(own, abs=1e-9)
    assert path_parameter_at(path, own) == pytest.approx(arc_length(t), abs=1e-9)
    assert point_at(path, own)[:2] == pytest.approx(beside(t, offset), abs=1e-9)
    assert point_of_formation(path, arc_length(t), 0.0)[:2] == pytest.approx(beside(t, offset), abs=1e-9)


@settings(max_examples=30)
@given(st.floats(-60.0, 60.0), st.floats(-60.0, 60.0), st.floats(0.0, 1.0))
def test_the_foot_is_a_nearest_point(north: float, east: float, share: float) -> None:
    """From anywhere, also from centers of curvature: a local minimum of the distance, not a maximum."""
    path = offset_path(EIGHT)
    error, place = project(Place(north, east, path), start_at(path, share * LENGTH))
    for _ in range(3):
        error, place = project(Place(north, east, path), place)

    def distance(s: float) -> float:
        point = point_at(path, s)
        return math.hypot(point.north - north, point.east - east)

    here = distance(error.arc_length)
    assert abs(error.cross_track) == pytest.approx(here, abs=1e-9)
    near = minimize_scalar(
        distance, bounds=(error.arc_length - 0.3, error.arc_length + 0.3), method="bounded", options={"xatol": 1e-9}
    )
    assert near.fun > here - 1e-9


def test_the_vehicle_stays_on_its_branch_where_the_path_crosses_itself() -> None:
    path = offset_path(lemniscate(Center(*CENTER), A, AXIS, "port", start_parameter=0.1, laps=2), speed=0.5)
    place, before = start_at(path, 0.0), 0.0
    for t in np.arange(0.1, 0.1 + 4.0 * math.pi, 0.02):
        error, place = project(Place(*beside(float(t), 1.2 * math.sin(7.0 * t)), path), place)
        assert error.path_parameter == pytest.approx(arc_length(float(t)), abs=1e-8)
        assert error.path_parameter > before - 1e-9
        before = error.path_parameter
    assert path[LENGTH_REFERENCE] == pytest.approx(2.0 * LENGTH, rel=1e-13)


def test_beyond_its_ends_a_closed_path_goes_on() -> None:
    path = offset_path(EIGHT, 2.0, speed=0.5)
    early, late = see(path, -0.5, 3.0, 0.0), see(path, 0.1 + 2.0 * math.pi + 0.4, 3.0, path[LENGTH_OWN])
    assert early.path_parameter == pytest.approx(arc_length(-0.5), abs=1e-9)
    assert late.path_parameter == pytest.approx(LENGTH + arc_length(0.5), abs=1e-9)
    assert (early.cross_track, late.cross_track) == pytest.approx((1.0, 1.0), abs=1e-9)
    assert (early.finished, late.finished) == (0.0, 1.0)
    assert see(path, 6.0, 3.0, 90.0).finished == 0.0


def test_speed_by_the_rate_of_the_parameter() -> None:
    path = offset_path(lemniscate(Center(*CENTER), A, AXIS, "port", start_parameter=0.1, parameter_rate=0.02))
    for t in np.linspace(0.1, 6.3, 50):
        error = see(path, float(t), 0.5, arc_length(float(t)))
        assert error.speed_profile == pytest.approx(0.02 * A / math.sqrt(1.0 + math.sin(t) ** 2), abs=1e-10)


def test_an_offset_that_does_not_fit_names_the_largest_that_does() -> None:
    with pytest.raises(GeometryError, match=r"largest offset to port that fits is 6\.666 m"):
        offset_path(EIGHT, -6.7)
    assert np.isfinite(offset_path(EIGHT, -6.666, speed=0.5)).all()


def test_a_position_that_is_no_number_is_not_remembered() -> None:
    path = offset_path(EIGHT, speed=0.5)
    error, place = project(Place(math.nan, 1.0, path), start_at(path, 33.0))
    assert math.isnan(error.cross_track)
    assert place.arc_length == 33.0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"half_width": 0.0}, "half_width is 0 m; it must be a finite number > 0"),
        ({"half_width": math.nan}, "half_width is nan m"),
        ({"half_width": 5.0, "parameter_rate": -1.0}, "parameter_rate is -1 1/s"),
        ({"half_width": 5.0, "laps": 0}, "laps is 0; it is a whole number, 1 or more"),
        ({"half_width": 5.0, "laps": 10_000}, "laps is 10000; at most 168 of this path fit"),
    ],
)
def test_lemniscates_that_cannot_be(arguments: dict[str, float], said: str) -> None:
    with pytest.raises(GeometryError, match=said):
        lemniscate(Center(), **arguments)
