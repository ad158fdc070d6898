"""The projection gives back the (s, e) from which a point was built, wherever it lies."""

import math
from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from cardume.paths.along import arc_length_at, path_parameter_at
from cardume.paths.arc import arc
from cardume.paths.circle import Center, circle
from cardume.paths.lawnmower import lawnmower
from cardume.paths.line import line
from cardume.paths.offset import offset_path
from cardume.paths.projection import MOVES, point_at, project, projection
from cardume.paths.segment import ReferencePath, Segment, Start, chain, length_of, straight
from cardume.paths.table import (
    LENGTH_OWN,
    PathPlace,
    start_at,
)
from cardume.signals import PathError, Place
from paths.scenes import Beside, beside, own_length, scenes

R = 12.0


def see(path: np.ndarray, north: float, east: float, memory: PathPlace = PathPlace()) -> PathError:
    return project(Place(north, east, path), memory)[0]


def walk(path: np.ndarray, places: Iterable[tuple[float, float]], memory: PathPlace = PathPlace()) -> list[PathError]:
    errors = []
    for north, east in places:
        error, memory = project(Place(north, east, path), memory)
        errors.append(error)
    return errors


def angle_between(one: float, other: float) -> float:
    return abs(math.remainder(one - other, 2.0 * math.pi))


# ---- a point built from (s, e) gives (s, e) --------------------------------------------------------------------------


@given(scenes(), st.floats(-8.0, 8.0))
def test_a_point_beside_the_path_is_seen_where_it_was_put(scene, ahead: float) -> None:
    reference, offset, gamma, e = scene
    path = offset_path(reference, offset, ahead, speed=0.5)
    here = beside(reference, gamma, offset + e)
    s = own_length(reference, gamma, offset)
    error = see(path, here.north, here.east, start_at(path, s))
    assert error.cross_track == pytest.approx(e, abs=1e-9)
    assert error.arc_length == pytest.approx(s, abs=1e-9)
    assert error.path_parameter == pytest.approx(gamma - ahead, abs=1e-9)
    assert angle_between(error.path_course, here.course) < 1e-10
    assert -math.pi < error.path_course <= math.pi
    assert error.along_track == 0.0
    assert error.path is path


@given(scenes())
def test_curvature_and_stretch_are_those_of_the_own_path(scene) -> None:
    reference, offset, gamma, e = scene
    starts = np.cumsum([0.0, *(s.length for s in reference)])
    assume(np.abs(starts - gamma).min() > 1e-6)
    here, path = beside(reference, gamma, offset + e), offset_path(reference, offset, speed=0.5)
    error = see(path, here.north, here.east, start_at(path, own_length(reference, gamma, offset)))
    c = reference[here.segment].curvature
    assert error.stretch == pytest.approx(1.0 - c * offset)
    assert error.curvature == pytest.approx(c / (1.0 - c * offset))


@pytest.mark.parametrize("turn", ["starboard", "port"])
@pytest.mark.parametrize("rho", [0.5, 6.0, 12.0, 12.5, 30.0])
def test_eq_52_corrected(turn: str, rho: float) -> None:
    """e = sigma (R - rho), > 0 to starboard, and gamma in meters."""
    sigma = 1.0 if turn == "starboard" else -1.0
    path = offset_path(arc(Start(), R, turn, math.pi))
    error = see(path, rho * math.sin(1.0), sigma * (R - rho * math.cos(1.0)))
    assert error.cross_track == pytest.approx(sigma * (R - rho))
    assert error.path_parameter == pytest.approx(R * 1.0)
    assert error.path_course == pytest.approx(sigma * 1.0)
    assert error.curvature == pytest.approx(sigma / R)


@given(scenes(), st.integers(0, 4), st.floats(-1.0, 1.0), st.sampled_from([-1, 1]))
def test_it_moves_over_to_the_next_segment_and_back(scene, joint: int, beyond: float, step: int) -> None:
    reference, offset, _, e = scene
    assume(joint + 1 < len(reference))
    edge = sum(s.length for s in reference[: joint + 1])
    shortest = min(s.length for s in reference)
    gamma = edge + beyond * min(1.0, 0.5 * shortest)
    here, path = beside(reference, gamma, offset + e), offset_path(reference, offset)
    was = PathPlace(float(joint if step > 0 else joint + 1), own_length(reference, edge, offset))
    error = see(path, here.north, here.east, was)
    assert error.arc_length == pytest.approx(own_length(reference, gamma, offset), abs=1e-9)
    assert error.cross_track == pytest.approx(e, abs=1e-9)


def test_it_agrees_with_a_search_over_all_points_of_the_path() -> None:
    path = offset_path(lawnmower(Start(3.0, -4.0, 0.7), 30.0, 3, 24.0), -2.0)
    s = np.linspace(0.0, path[LENGTH_OWN], 20001)
    points = np.array([point_at(path, x)[:2] for x in s])
    generator = np.random.default_rng(1)
    for place in generator.uniform(0.0, path[LENGTH_OWN], 300):
        there = point_at(path, place)
        north, east = there.north + generator.uniform(-4.0, 4.0), there.east + generator.uniform(-4.0, 4.0)
        distance = np.hypot(points[:, 0] - north, points[:, 1] - east)
        error = see(path, north, east, start_at(path, place))
        if 0.0 < error.arc_length < path[LENGTH_OWN]:
            assert abs(error.cross_track) == pytest.approx(distance.min(), abs=4e-3)
            assert abs(error.arc_length - s[distance.argmin()]) < 0.02


# ---- before the start, past the end, far away, at the center ---------------------------------------------------------


@pytest.mark.parametrize("turn", ["starboard", "port"])
@pytest.mark.parametrize("gamma", [-10.0, -0.1, 25.0, 40.0])
def test_arcs_go_on_as_their_circle_beyond_both_ends(turn: str, gamma: float) -> None:
    reference = arc(Start(1.0, 2.0, 3.0), R, turn, 2.0)
    here, path = beside(reference, gamma, 1.5), offset_path(reference)
    error = see(path, here.north, here.east, start_at(path, min(max(gamma, 0.0), 24.0)))
    assert error.path_parameter == pytest.approx(gamma)
    assert error.cross_track == pytest.approx(1.5)
    assert error.finished == (1.0 if gamma > 24.0 else 0.0)


def test_lines_go_straight_on_beyond_both_ends() -> None:
    path = offset_path(line(Start(), 50.0), 1.0, ahead=3.0)
    assert see(path, -20.0, 4.0)[2:5] == pytest.approx((3.0, 0.0, -23.0))
    assert see(path, 70.0, -4.0)[2:5] == pytest.approx((-5.0, 0.0, 67.0))
    assert [see(path, n, 0.0).finished for n in (-1.0, 49.9, 50.1)] == [0.0, 0.0, 1.0]


@given(st.floats(0.0, 6.28), st.sampled_from(["starboard", "port"]), st.booleans())
def test_a_million_meters_away(bearing: float, turn: str, is_line: bool) -> None:
    sigma = 1.0 if turn == "starboard" else -1.0
    reference = line(Start(), 50.0) if is_line else arc(Start(), R, turn, math.pi)
    north, east = 1e6 * math.cos(bearing), 1e6 * math.sin(bearing)
    error = see(offset_path(reference, speed=0.5), north, east if is_line else east + sigma * R)
    expected = east if is_line else sigma * (R - 1e6)
    assert error.cross_track == pytest.approx(expected, abs=1e-8)
    assert all(math.isfinite(x) for x in error._replace(path_speed=0.0)[:-1])


@pytest.mark.parametrize("turn", ["starboard", "port"])
@pytest.mark.parametrize("was", [0.0, 7.0, 37.0])
def test_at_the_center_of_an_arc_the_angle_stays_as_it_was(turn: str, was: float) -> None:
    sigma = 1.0 if turn == "starboard" else -1.0
    path = offset_path(arc(Start(), R, turn, math.pi))
    error, memory = project(Place(0.0, sigma * R, path), PathPlace(0.0, was))
    assert error.arc_length == pytest.approx(was)
    assert memory.arc_length == pytest.approx(was)
    assert error.cross_track == pytest.approx(sigma * R)
    assert angle_between(error.path_course, sigma * was / R) < 1e-12


def test_a_position_that_is_no_number_is_not_remembered() -> None:
    path = offset_path(lawnmower(Start(), 30.0, 2, 24.0))
    for memory in (PathPlace(0.0, 11.0), PathPlace(1.0, 40.0)):
        error, after = project(Place(math.nan, math.nan, path), memory)
        assert math.isnan(error.cross_track)
        assert after == memory


# ---- gamma never wraps and never jumps -------------------------------------------------------------------------------


@given(scenes(), st.floats(-8.0, 8.0), st.booleans())
def test_gamma_follows_a_vehicle_along_and_across_all_joints(scene, ahead: float, is_backward: bool) -> None:
    reference, offset, _, e = scene
    path = offset_path(reference, offset, ahead, speed=0.5)
    gammas = np.linspace(-2.0, length_of(reference) + 2.0, 150)
    places: list[Beside] = [beside(reference, g, offset + e * math.sin(g / 9.0)) for g in gammas]
    # a tick moves a vehicle by less than an arc's length; short pieces are passed several at a time
    assume(len(reference) <= MOVES)
    if is_backward:
        places, gammas = places[::-1], gammas[::-1]
    start = start_at(path, own_length(reference, gammas[0], offset))
    seen = walk(path, [(p.north, p.east) for p in places], start)
    assert [x.path_parameter for x in seen] == pytest.approx(gammas - ahead, abs=1e-9)
    assert [x.cross_track for x in seen] == pytest.approx(e * np.sin(gammas / 9.0), abs=1e-9)


@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_gamma_grows_from_lap_to_lap_and_shrinks_again(turn: str) -> None:
    (lap,) = circle(Center(4.0, 5.0), 8.0, turn, start_bearing=2.0)
    path = offset_path((lap,), -3.0 if turn == "starboard" else 3.0)
    there = np.linspace(-3.0, 12.0 * 2.0 * math.pi * 8.0, 400)
    gammas = np.concatenate([there, there[::-1]])
    seen = walk(path, [beside((lap,), g, 1.0)[:2] for g in gammas])
    assert [x.path_parameter for x in seen] == pytest.approx(gammas, abs=1e-9)
    assert {x.finished for x in seen} == {0.0}


def test_a_thousand_laps_later_it_is_as_exact() -> None:
    (lap,) = circle(Center(), 8.0)
    path = offset_path((lap,))
    gamma = 9000.3 * 2.0 * math.pi * 8.0
    here = beside((lap,), 0.3 * 2.0 * math.pi * 8.0, 0.5)
    error = see(path, here.north, here.east, start_at(path, gamma))
    assert error.path_parameter == pytest.approx(gamma, abs=1e-7)
    assert error.cross_track == pytest.approx(0.5, abs=1e-12)


def test_a_vehicle_pushed_back_returns_to_the_segment_before() -> None:
    path = offset_path(lawnmower(Start(), 10.0, 4, 4.0))
    forth, back = np.arange(0.0, 40.0, 0.5), np.arange(40.0, 2.0, -0.5)
    seen = walk(path, [point_at(path, s)[:2] for s in [*forth, *back]])
    assert [x.arc_length for x in seen] == pytest.approx([*forth, *back], abs=1e-9)


def test_a_leap_over_many_segments_takes_a_bounded_number_of_moves_a_tick() -> None:
    path = offset_path(chain(Start(), [straight(1.0)] * 20))
    seen = walk(path, [(15.5, 0.0)] * 5)
    assert [x.arc_length for x in seen] == pytest.approx([5.0, 9.0, 13.0, 15.5, 15.5])
    assert {x.finished for x in seen} == {0.0}


def test_a_leap_back_over_more_than_a_lap_of_an_arc_finds_the_arc() -> None:
    """A fix may move a vehicle from 40 m beyond a turn of 4 m radius back into it."""
    path = offset_path(lawnmower(Start(), 60.0, 3, 8.0))
    there = point_at(path, 60.0 + 4.0)
    assert see(path, there.north, there.east, PathPlace(2.0, 60.0 + 4.0 * math.pi + 40.0)).arc_length == pytest.approx(
        64.0
    )


@pytest.mark.parametrize("angle", [0.7, -0.7, 2.0])
def test_outside_a_sharp_corner_gamma_waits_and_then_goes_on(angle: float) -> None:
    first = Segment(north=0.0, east=0.0, course=0.0, curvature=0.0, length=20.0)
    second = Segment(north=20.0, east=0.0, course=angle, curvature=0.0, length=20.0)
    path = offset_path((first, second))
    side = -math.copysign(3.0, angle)
    bend = np.linspace(0.0, angle, 20)
    places = [(float(n), side) for n in np.arange(10.0, 20.1, 0.5)]
    places += [(20.0 - side * math.sin(a), side * math.cos(a)) for a in bend]
    places += [beside((first, second), g, side)[:2] for g in np.arange(20.1, 30.0, 0.5)]
    errors = walk(path, places)
    seen = [x.arc_length for x in errors]
    assert errors[25].path_course == pytest.approx(angle)
    assert np.diff(seen).min() > -1e-9
    assert np.diff(seen).max() < 0.5 + 1e-9
    assert seen[25] == pytest.approx(20.0, abs=1e-9)


# ---- symmetry --------------------------------------------------------------------------------------------------------


@given(scenes(), st.floats(-500.0, 500.0), st.floats(-500.0, 500.0), st.floats(-math.pi, math.pi))
def test_rotating_and_shifting_the_scene_changes_only_the_course(scene, north: float, east: float, turn: float) -> None:
    reference, offset, gamma, e = scene
    first = reference[0]
    start = Start(
        north + first.north * math.cos(turn) - first.east * math.sin(turn),
        east + first.north * math.sin(turn) + first.east * math.cos(turn),
        first.course + turn,
    )
    one, other = compare(reference, chain(start, reference), offset, offset, gamma, e, e)
    at_the_end = abs(one.arc_length - one.path[LENGTH_OWN]) < 1e-9  # there rounding says which side of it
    for name in set(PathError._fields) - {"path_course", "path"} - ({"finished"} if at_the_end else set()):
        assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-9, nan_ok=True), name
    assert angle_between(one.path_course + turn, other.path_course) < 1e-9


@given(scenes())
def test_mirroring_the_scene_changes_only_the_signs(scene) -> None:
    reference, offset, gamma, e = scene
    mirrored: ReferencePath = tuple(
        Segment(north=s.north, east=-s.east, course=-s.course, curvature=-s.curvature, length=s.length)
        for s in reference
    )
    one, other = compare(reference, mirrored, offset, -offset, gamma, e, -e)
    at_the_end = abs(one.arc_length - one.path[LENGTH_OWN]) < 1e-9  # there rounding says which side of it
    for name in ("path_parameter", "arc_length", "stretch", *(() if at_the_end else ("finished",))):
        assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-9)
    for name in ("cross_track", "curvature"):
        assert getattr(one, name) == pytest.approx(-getattr(other, name), abs=1e-9)
    assert angle_between(one.path_course, -other.path_course) < 1e-9


def compare(
    one: ReferencePath, other: ReferencePath, offset_1: float, offset_2: float, gamma: float, e_1: float, e_2: float
) -> list[PathError]:
    seen = []
    for reference, offset, e in ((one, offset_1, e_1), (other, offset_2, e_2)):
        here, path = beside(reference, gamma, offset + e), offset_path(reference, offset, speed=0.5)
        seen.append(see(path, here.north, here.east, start_at(path, own_length(one, gamma, offset_1))))
    return seen


# ---- places along the path -------------------------------------------------------------------------------------------


@given(scenes())
def test_point_at_is_the_inverse_of_the_projection(scene) -> None:
    reference, offset, gamma, _ = scene
    path, s = offset_path(reference, offset), own_length(reference, gamma, offset)
    here, there = beside(reference, gamma, offset), point_at(path, s)
    assert there[:2] == pytest.approx(here[:2], abs=1e-9)
    assert angle_between(there.course, here.course) < 1e-10
    assert (there.sin_course, there.cos_course) == pytest.approx((math.sin(there.course), math.cos(there.course)))


@given(scenes(), st.floats(-8.0, 8.0))
def test_arc_length_and_path_parameter_are_inverse(scene, ahead: float) -> None:
    reference, offset, gamma, _ = scene
    path = offset_path(reference, offset, ahead, speed=0.5)
    s = arc_length_at(path, gamma - ahead)
    assert s == pytest.approx(own_length(reference, gamma, offset), abs=1e-9)
    assert path_parameter_at(path, s) == pytest.approx(gamma - ahead, abs=1e-9)


def test_the_speed_is_that_of_the_place_where_the_formation_is() -> None:
    reference = tuple(
        Segment(north=20.0 * k, east=0.0, course=0.0, curvature=0.0, length=20.0, speed=v)
        for k, v in enumerate((0.3, 0.5, 0.4))
    )
    for ahead in (0.0, 5.0, -5.0):
        path = offset_path(reference, 1.0, ahead)
        speeds = [see(path, north, 0.0, start_at(path, north)).speed_profile for north in np.arange(-10.0, 70.0, 2.0)]
        states = np.arange(-10.0, 70.0, 2.0) - ahead
        assert speeds == [0.3 if g < 20.0 else 0.5 if g < 40.0 else 0.4 for g in states]


def test_the_law_is_the_projection() -> None:
    path = offset_path(lawnmower(Start(), 30.0, 2, 24.0), 2.0, speed=0.5)
    law, function = (found(Place(40.0, 5.0, path), PathPlace()) for found in (projection, project))
    assert law[0][:-1] == pytest.approx(function[0][:-1], rel=0.0, abs=0.0, nan_ok=True)
    assert law[1] == function[1]
    assert projection.parameters == ()
