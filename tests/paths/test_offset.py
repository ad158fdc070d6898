"""A vehicle's own path: the reference path offset to starboard."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.paths import table
from cardume.paths.along import arc_length_at
from cardume.paths.arc import arc
from cardume.paths.lawnmower import lawnmower
from cardume.paths.offset import offset_path
from cardume.paths.outline import outline
from cardume.paths.projection import point_at, project
from cardume.paths.segment import GeometryError, ReferencePath, Segment, Start, chain, straight
from cardume.signals import Place
from paths.scenes import beside, scenes


def rows(path: np.ndarray) -> np.ndarray:
    return path[table.HEADER_WIDTH :].reshape(-1, table.SEGMENT_WIDTH)


def corner(angle: float, legs: tuple[float, float] = (20.0, 20.0), speed: float | None = None) -> ReferencePath:
    """Two lines that meet at an angle, > 0 to starboard."""
    first = Segment(north=0.0, east=0.0, course=0.3, curvature=0.0, length=legs[0], speed=speed)
    end = chain(Start(0.0, 0.0, 0.3), [straight(legs[0]), straight(1.0)])[1]
    second = Segment(north=end.north, east=end.east, course=0.3 + angle, curvature=0.0, length=legs[1])
    return (first, second)


def place_of(segment: Segment) -> tuple[float, float]:
    return segment.north, segment.east


@pytest.mark.parametrize("offset", [3.0, -3.0, 0.0, 11.9, -40.0])
@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_an_arc_gets_the_radius_r_minus_sigma_times_offset(turn: str, offset: float) -> None:
    sigma = 1.0 if turn == "starboard" else -1.0
    if sigma * offset >= 12.0:
        return
    (row,) = rows(offset_path(arc(Start(), 12.0, turn, 2.0), offset))
    assert row[table.RADIUS] == pytest.approx(12.0 - sigma * offset)
    assert row[table.LENGTH] == pytest.approx(2.0 * (12.0 - sigma * offset))
    assert row[table.STRETCH] == pytest.approx((12.0 - sigma * offset) / 12.0)
    assert (row[table.CENTER_NORTH], row[table.CENTER_EAST]) == pytest.approx((0.0, sigma * 12.0), abs=1e-12)


def test_row_q_speed_ratio_of_offset_arcs() -> None:
    """Closed form Q: three meters off a 12 m arc at 0.5 m/s."""
    path = arc(Start(), 12.0, "starboard", 3.0)
    speeds = [0.5 * rows(offset_path(path, d))[0, table.STRETCH] for d in (3.0, -3.0)]
    assert speeds == pytest.approx([0.375, 0.625], abs=1e-12)


def test_header_and_speeds() -> None:
    path = offset_path(lawnmower(Start(), 60.0, 2, 24.0), -3.0, ahead=-5.0, speed=0.4)
    reference = 120.0 + 12.0 * math.pi
    assert path[:4] == pytest.approx([3, 120.0 + 15.0 * math.pi, reference, -5.0])
    assert set(rows(path)[:, table.SPEED]) == {0.4}
    assert rows(path)[:, table.REFERENCE_START] == pytest.approx([0.0, 60.0, 60.0 + 12.0 * math.pi])


def test_a_segment_keeps_its_own_speed() -> None:
    first, second = corner(0.5, speed=0.3)
    assert list(rows(offset_path((first, second), 0.0, speed=0.5))[:, table.SPEED]) == [0.3, 0.5]


@given(scenes())
def test_every_point_of_the_own_path_is_offset_from_the_reference_path(scene) -> None:
    reference, offset, gamma, _ = scene
    path = offset_path(reference, offset)
    here, there = beside(reference, gamma, offset), point_at(path, arc_length_at(path, gamma))
    assert there[:2] == pytest.approx(here[:2], abs=1e-9)
    assert math.cos(there.course - here.course) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ("path", "offset", "fits"),
    [
        (arc(Start(), 12.0, "starboard", 1.0), 12.0, "11.999"),
        (lawnmower(Start(), 60.0, 3, 24.0), -15.0, "11.999"),
        (corner(0.5 * math.pi), 25.0, "19.999"),
        (corner(-0.5 * math.pi, (8.0, 20.0)), -9.0, "7.999"),
        (corner(2.0, (20.0, 20.0)), 300.0, f"{math.floor(20.0 / math.tan(1.0) * 1000.0) / 1000.0}"),
    ],
)
def test_an_offset_that_does_not_fit_is_refused_with_the_largest_that_does(path, offset: float, fits: str) -> None:
    side = "starboard" if offset > 0.0 else "port"
    with pytest.raises(GeometryError) as refusal:
        offset_path(path, offset)
    text = str(refusal.value)
    assert f"an offset of {abs(offset):g} m to {side} does not fit" in text
    assert f"the largest offset to {side} that fits is {fits} m" in text
    offset_path(path, math.copysign(float(fits), offset))


def test_impossible_paths_are_refused() -> None:
    first, second = corner(0.5)
    with pytest.raises(GeometryError, match="no segment"):
        offset_path(())
    with pytest.raises(GeometryError, match="must meet"):
        offset_path((second, first), 2.0)
    with pytest.raises(GeometryError, match="finite"):
        offset_path((first,), math.nan)
    with pytest.raises(GeometryError, match="at most 4096"):
        offset_path(chain(Start(), [straight(1.0)] * 4097))


# ---- sharp corners ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [0.4, -0.4, 1.5, -2.6, 3.1])
def test_the_outer_side_of_a_corner_is_an_arc_about_it_on_which_gamma_waits(angle: float) -> None:
    offset = -math.copysign(4.0, angle)
    path = offset_path(corner(angle), offset)
    before, turn, after = rows(path)
    assert (turn[table.CENTER_NORTH], turn[table.CENTER_EAST]) == pytest.approx(place_of(corner(angle)[1]))
    assert (turn[table.RADIUS], turn[table.LENGTH]) == pytest.approx((4.0, 4.0 * abs(angle)))
    assert (turn[table.REFERENCE_LENGTH], turn[table.REFERENCE_RATE], turn[table.STRETCH]) == (0.0, 0.0, 1.0)
    assert before[table.LENGTH] == after[table.LENGTH] == 20.0
    memory = table.PathPlace()
    for s in np.arange(-2.0, path[table.LENGTH_OWN] + 2.0, 0.05):
        place = point_at(path, s)
        error, memory = project(Place(place.north, place.east, path), memory)
        assert error.arc_length == pytest.approx(s, abs=1e-9)
        assert error.cross_track == pytest.approx(0.0, abs=1e-9)
        assert error.path_parameter == pytest.approx(min(s, max(20.0, s - 4.0 * abs(angle))), abs=1e-9)


@pytest.mark.parametrize("angle", [0.4, -0.4, 1.5, -2.2])
def test_the_inner_side_of_a_corner_is_cut_back_to_the_crossing(angle: float) -> None:
    offset = math.copysign(4.0, angle)
    cut = 4.0 * math.tan(0.5 * abs(angle))
    before, after = rows(offset_path(corner(angle), offset))
    assert before[table.LENGTH] == pytest.approx(20.0 - cut)
    assert after[table.LENGTH] == pytest.approx(20.0 - cut)
    assert before[table.STRETCH] == pytest.approx((20.0 - cut) / 20.0)
    assert after[table.REFERENCE_START] == 20.0
    path = offset_path(corner(angle), offset)
    end, start = point_at(path, 20.0 - cut - 1e-9), point_at(path, 20.0 - cut + 1e-9)
    assert end[:2] == pytest.approx(start[:2], abs=1e-8)


@given(st.floats(5.0, 40.0), st.floats(-0.9, 0.9), st.floats(0.1, 3.0), st.booleans())
def test_a_corner_between_a_line_and_an_arc_is_cut_where_they_cross(
    radius: float, angle: float, offset: float, is_port: bool
) -> None:
    path = chain(Start(), [straight(30.0)])
    bend_ = arc(Start(30.0, 0.0, angle), radius, "port" if is_port else "starboard", 2.0)
    own = offset_path((*path, *bend_), offset)
    ends = [point_at(own, s)[:2] for s in np.cumsum(rows(own)[:-1, table.LENGTH])]
    befores = [point_at(own, s - 1e-7)[:2] for s in np.cumsum(rows(own)[:-1, table.LENGTH])]
    assert np.array(ends) == pytest.approx(np.array(befores), abs=1e-6)
    assert own[table.LENGTH_REFERENCE] == pytest.approx(30.0 + 2.0 * radius)


def test_no_offset_keeps_a_corner_sharp() -> None:
    assert len(rows(offset_path(corner(1.0), 0.0))) == 2


@pytest.mark.parametrize("offset", [4.0, -4.0])
def test_a_hairpin_is_rounded_on_either_side(offset: float) -> None:
    path = offset_path(corner(math.pi), offset)
    assert rows(path)[1, table.LENGTH] == pytest.approx(4.0 * math.pi)
    assert np.sign(rows(path)[1, table.CURVATURE]) == -np.sign(offset)


def test_outline_shows_every_joint_and_one_lap_of_a_circle() -> None:
    points = outline(offset_path(lawnmower(Start(), 60.0, 2, 24.0), 3.0), 2.0)
    assert np.hypot(*np.diff(points[:, 1:], axis=0).T).max() <= 2.0 + 1e-9
    assert points[-1] == pytest.approx([120.0 + 9.0 * math.pi, 0.0, 21.0], abs=1e-9)
    lap = outline(offset_path(arc(Start(), 5.0, "port", 100.0)), 1.0)
    assert lap[-1, 0] == pytest.approx(10.0 * math.pi)
