"""Each kind of path has the shape that its parameters say."""

import math

import pytest

from cardume.paths.arc import arc
from cardume.paths.circle import Center, circle
from cardume.paths.lawnmower import lawnmower
from cardume.paths.line import line
from cardume.paths.segment import GeometryError, ReferencePath, Start, end_of, length_of
from cardume.paths.segments import ArcPiece, LinePiece, segments

EAST = 0.5 * math.pi


def joints_are_smooth(path: ReferencePath) -> bool:
    ends = [end_of(segment) for segment in path[:-1]]
    return all(
        math.isclose(a.north, b.north, abs_tol=1e-12)
        and math.isclose(a.east, b.east, abs_tol=1e-12)
        and a.course == b.course
        for a, b in zip(ends, path[1:], strict=True)
    )


def test_line() -> None:
    end = end_of(line(Start(1.0, 2.0, EAST), 10.0)[-1])
    assert end == pytest.approx((1.0, 12.0, EAST))


@pytest.mark.parametrize(("turn", "sigma"), [("starboard", 1.0), ("port", -1.0)])
def test_arc_turns_to_its_side(turn: str, sigma: float) -> None:
    end = end_of(arc(Start(), 12.0, turn, EAST)[-1])
    assert end == pytest.approx((12.0, sigma * 12.0, sigma * EAST))


@pytest.mark.parametrize(("turn", "sigma"), [("starboard", 1.0), ("port", -1.0)])
def test_circle_starts_at_its_bearing_and_stays_at_its_radius(turn: str, sigma: float) -> None:
    (lap,) = circle(Center(5.0, -3.0), 7.0, turn, start_bearing=EAST)
    assert (lap.north, lap.east) == pytest.approx((5.0, 4.0))
    # east of the center a clockwise vehicle goes south
    assert math.cos(lap.course) == pytest.approx(-sigma)
    assert lap.length > 1000.0 * 2.0 * math.pi * 7.0
    assert end_of(arc(Start(lap.north, lap.east, lap.course), 7.0, turn, math.pi)[0])[:2] == pytest.approx((5.0, -10.0))


def test_lawnmower_of_the_paper() -> None:
    path = lawnmower(Start(), 60.0, 4, 24.0)
    assert len(path) == 7
    assert length_of(path) == pytest.approx(4 * 60.0 + 3 * 12.0 * math.pi)
    assert joints_are_smooth(path)
    assert [(s.north, s.east) for s in path[::2]] == [
        pytest.approx(p, abs=1e-12) for p in [(0.0, 0.0), (60.0, 24.0), (0.0, 48.0), (60.0, 72.0)]
    ]
    assert [math.copysign(1.0, s.curvature) for s in path[1::2]] == [1.0, -1.0, 1.0]


def test_lawnmower_to_port_is_its_mirror_image() -> None:
    one, other = lawnmower(Start(), 30.0, 3, 10.0), lawnmower(Start(), 30.0, 3, 10.0, "port")
    assert [(s.north, -s.east, -s.curvature) for s in other] == [(s.north, s.east, s.curvature) for s in one]


def test_segments_go_on_from_one_another_with_speeds_of_their_own() -> None:
    path = segments(
        Start(course=EAST), [LinePiece(line=30.0), ArcPiece(arc=12.0, turn="port", angle=math.pi, speed=0.3)]
    )
    assert end_of(path[-1]) == pytest.approx((24.0, 30.0, -EAST))
    assert [s.speed for s in path] == [None, 0.3]
    assert joints_are_smooth(path)


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: line(Start(), 0.0), "length is 0 m"),
        (lambda: line(Start(), math.nan), "length is nan m"),
        (lambda: line(Start(math.inf), 5.0), "must be finite"),
        (lambda: arc(Start(), -1.0, "port", 1.0), "radius is -1 m"),
        (lambda: arc(Start(), 1.0, "left", 1.0), "starboard or port"),
        (lambda: arc(Start(), 1.0, "port", 0.0), "angle is 0 rad"),
        (lambda: circle(Center(), 5.0, laps=1e6), "laps is 1e+06"),
        (lambda: lawnmower(Start(), 10.0, 0, 5.0), "legs is 0"),
        (lambda: lawnmower(Start(), 10.0, 2, -5.0), "spacing is -5 m"),
        (lambda: segments(Start(), []), "segments is empty"),
    ],
)
def test_impossible_shapes_are_refused(build, said: str) -> None:
    with pytest.raises(GeometryError, match=said.replace("+", r"\+")):
        build()
