"""Paths through points: splines, waypoints with turns of arcs and of clothoids, clothoids as pieces."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import assume, given, reject, settings, strategies as st
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.special import fresnel

from cardume.paths.circle import Center
from cardume.paths.offset import offset_path
from cardume.paths.projection import point_at
from cardume.paths.segment import GeometryError, ReferencePath, Segment, Start, bends_of, end_of, length_of
from cardume.paths.segments import ArcPiece, ClothoidPiece, LinePiece, segments
from cardume.paths.spline import spline
from cardume.paths.tracing import clothoid
from cardume.paths.waypoints import waypoints

POINTS = [Center(0.0, 0.0), Center(30.0, 20.0), Center(60.0, -10.0), Center(90.0, 30.0), Center(40.0, 60.0)]
coordinates = st.floats(-80.0, 80.0)
points = st.lists(st.builds(Center, coordinates, coordinates), min_size=3, max_size=6)


def interpolant(places: Sequence[Center], closed: bool) -> tuple[CubicSpline, np.ndarray]:
    """The same spline by scipy, and the parameter at its knots."""
    knots = np.array([*places, *places[: int(closed)]])
    times = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))])
    return CubicSpline(times, knots, bc_type="periodic" if closed else "natural"), times


def bend_at_ends(segment: Segment) -> tuple[float, float]:
    """Curvature at the start and the end of a segment."""
    if segment.curve is None:
        return segment.curvature, segment.curvature
    rates = [k * c / segment.length for k, c in enumerate(segment.curve.turned, 1)]
    return rates[0], math.fsum(rates)


def largest_gap(path: ReferencePath) -> tuple[float, float, float]:
    """Of place [m], course [rad] and curvature [1/m], over all joints."""
    gaps = []
    for before, after in zip(path, path[1:], strict=False):
        end = end_of(before)
        place = math.hypot(end.north - after.north, end.east - after.east)
        course = abs(math.remainder(end.course - after.course, 2.0 * math.pi))
        gaps.append((place, course, abs(bend_at_ends(before)[1] - bend_at_ends(after)[0])))
    return tuple(max(column) for column in zip(*gaps, strict=True))


@pytest.mark.parametrize("closed", [False, True])
def test_spline_is_scipys(closed: bool) -> None:
    """Place at arc lengths found by quadrature of scipy's spline; the length of the whole."""
    curve, times = interpolant(POINTS, closed)
    slope = curve.derivative()
    path = [s for s in spline(POINTS, closed=closed) if not s.beyond]
    table = offset_path(path)

    def arc_length(t: float) -> float:
        inner = [x for x in times if 0.0 < x < t]
        return float(quad(lambda u: float(np.hypot(*slope(u))), 0.0, t, points=inner, epsabs=1e-12, limit=200)[0])

    assert length_of(path) == pytest.approx(arc_length(times[-1]), rel=1e-11)
    for t in np.linspace(0.0, times[-1], 37):
        place = point_at(table, arc_length(float(t)))
        assert (place.north, place.east) == pytest.approx(tuple(curve(t)), abs=1e-9)
        assert math.remainder(place.course - math.atan2(*slope(t)[::-1]), 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


@settings(max_examples=8)
@given(points, st.booleans())
def test_splines_at_random_are_smooth(places: list[Center], closed: bool) -> None:
    ring = [*places, *places[: int(closed)]]
    assume(all(math.dist(a, b) > 5.0 for a, b in zip(ring, ring[1:], strict=False)))
    try:
        path = spline(places, closed=closed)
    except GeometryError:  # points that double back
        reject()
    place, course, curvature = largest_gap(path)
    tightest = max(max(map(abs, bends_of(s))) for s in path)
    assert place < 1e-9
    assert course < 1e-10
    assert curvature < 1e-7 * max(1.0, tightest * tightest * 1e3)


@pytest.mark.parametrize("east", [6.0, 7.9924655180042805, 20.0])
def test_a_spline_that_turns_back_on_itself_is_refused(east: float) -> None:
    there = Center(0.0, east)
    with pytest.raises(GeometryError, match=f"turns too sharply near north 0 m, east {east:.6g} m"):
        spline([Center(0.0, 0.0), there, Center(0.0, 0.0)])


def test_closed_spline_goes_round() -> None:
    path = spline(POINTS, closed=True, laps=3)
    assert length_of(path) == pytest.approx(3.0 * length_of(spline(POINTS, closed=True)), rel=1e-13)
    assert largest_gap(path)[0] < 1e-10


@pytest.mark.parametrize("end", [0.05, -0.3])
def test_clothoid_is_fresnels(end: float) -> None:
    """From straight to a curvature c over L: x = sqrt(pi L / c) C(sqrt(c L / pi)), by scipy."""
    length = 30.0
    last = end_of(segments(Start(), [ClothoidPiece(clothoid=length, radius=1.0 / abs(end), turn=side(end))])[-1])
    scale = math.sqrt(math.pi * length / abs(end))
    sine, cosine = fresnel(length / scale)
    assert last.north == pytest.approx(scale * cosine, abs=1e-10)
    assert last.east == pytest.approx(math.copysign(scale * sine, end), abs=1e-10)
    assert last.course == pytest.approx(0.5 * end * length, abs=1e-12)


def side(curvature: float) -> str:
    return "starboard" if curvature > 0.0 else "port"


def test_pieces_take_over_the_curvature_of_the_one_before() -> None:
    path = segments(
        Start(1.0, 2.0, 0.3),
        [
            LinePiece(line=20.0),
            ClothoidPiece(clothoid=8.0, radius=12.0, turn="port", speed=0.4),
            ArcPiece(arc=12.0, turn="port", angle=1.0),
            ClothoidPiece(clothoid=10.0, radius=15.0),
            ClothoidPiece(clothoid=10.0),
            LinePiece(line=5.0),
        ],
    )
    assert largest_gap(path) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert {s.label: s.speed for s in path}["segment 2"] == 0.4


@settings(max_examples=15)
@given(points, st.floats(0.3, 0.99), st.sampled_from(["arc", "clothoid"]))
def test_rounded_waypoints_touch_their_legs(places: list[Center], share: float, joint: str) -> None:
    """As large a turn as fits, or a share of it: smooth, on the legs, no nearer to the end than the points."""
    assume(all(math.dist(a, b) > 5.0 for a, b in zip(places, places[1:], strict=False)))
    courses = [math.atan2(b.east - a.east, b.north - a.north) for a, b in zip(places, places[1:], strict=False)]
    turns = [abs(math.remainder(b - a, 2.0 * math.pi)) for a, b in zip(courses, courses[1:], strict=False)]
    assume(max(turns) < 3.0 and min(turns) > 1e-3)
    with pytest.raises(GeometryError, match="the largest radius that fits is") as refused:
        waypoints(places, 1e6, joint)
    largest = float(str(refused.value).split("fits is ")[1].split(" m")[0])
    assume(largest > 0.01)
    with pytest.raises(GeometryError):
        waypoints(places, largest + 0.002, joint)
    path = waypoints(places, largest * share, joint)
    place, course, curvature = largest_gap(path)
    assert place < 1e-9
    assert course < 1e-9
    if joint == "clothoid":
        assert curvature < 1e-9 / largest
    tightest = max(max(map(abs, bends_of(s))) for s in path)
    assert tightest == pytest.approx(1.0 / (largest * share), rel=1e-9)
    assert (path[0].north, path[0].east) == pytest.approx(places[0])
    assert end_of(path[-1])[:2] == pytest.approx(places[-1], abs=1e-8)


def test_waypoints_without_a_radius_have_corners() -> None:
    path = waypoints(POINTS)
    assert [s.curvature for s in path] == [0.0] * 4
    assert [(s.north, s.east) for s in path] == POINTS[:-1]


def test_a_point_on_a_leg_needs_no_turn() -> None:
    path = waypoints([Center(), Center(10.0, 0.0), Center(30.0, 0.0)], 500.0)
    assert length_of(path) == pytest.approx(30.0)


def test_clothoid_in_several_segments_is_one_curve() -> None:
    path = clothoid(0.0, 0.5, 20.0)
    assert len(path) > 3
    assert sum(s.curve.whole_turn for s in path if s.curve) == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: spline(POINTS[:2]), r"spline with 2 points; it needs 3 or more"),
        (
            lambda: spline([*POINTS[:2], POINTS[1]]),
            r"points 2 and 3 are 0 m apart, at north 30 m, east 20 m; leave one",
        ),
        (lambda: spline([*POINTS[:2], Center(math.nan, 1.0)]), r"point 3 is \(nan, 1\) m; it must be two finite"),
        (lambda: spline([*POINTS[:3], POINTS[0]], closed=True), r"the last point is the first"),
        (lambda: spline(POINTS, laps=2), r"laps is 2, and a spline that is not closed has one"),
        (lambda: spline(POINTS, closed=True, laps=4000), r"laps is 4000; at most \d+ of this path fit"),
        (lambda: waypoints(POINTS[:1]), r"waypoints with 1 points; it needs 2 or more"),
        (lambda: waypoints(POINTS, 60.0), r"turn_radius is 60 m, and the leg from point \d to point \d"),
        (lambda: waypoints([Center(), Center(9.0, 0.0), Center(1.0, 0.0)], 1.0), r"turns straight back at point 2"),
        (lambda: waypoints(POINTS, 3.0, "spiral"), r"joint is 'spiral'; it is arc or clothoid"),  # type: ignore[arg-type]
        (
            lambda: segments(Start(), [ClothoidPiece(clothoid=-3.0)]),
            r"clothoid is -3 m; it must be a finite number > 0",
        ),
        (lambda: segments(Start(), [ClothoidPiece(clothoid=3.0, radius=0.0)]), r"radius is 0 m; it must be a finite"),
    ],
)
def test_points_that_make_no_path(build: object, said: str) -> None:
    with pytest.raises(GeometryError, match=said):
        build()  # type: ignore[operator]


def test_a_spline_straight_back_has_a_cusp_and_is_refused_in_words_alone(recwarn: pytest.WarningsRecorder) -> None:
    with pytest.raises(GeometryError, match="turns too sharply near north 10 m"):
        spline([Center(0.0, 0.0), Center(10.0, 0.0), Center(0.0, 0.0)])
    assert not recwarn.list


def test_huge_coordinates_still_make_a_path() -> None:
    far = [Center(1e6 + p.north, -2e6 + p.east) for p in POINTS]
    assert length_of(spline(far)) == pytest.approx(length_of(spline(POINTS)), rel=1e-9)
