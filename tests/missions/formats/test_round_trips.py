"""What is written reads back: places to a millimeter, speeds and depths exactly, arcs where the format has them."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st

from cardume.errors import InputError
from cardume.missions.formats import parse_plan
from cardume.missions.formats.content import FORMATS
from cardume.missions.formats.plan import Fence, Member, Plan
from cardume.missions.formats.writing import Written, write_plan
from cardume.missions.geodesy import GeoPoint
from cardume.paths.joining import ROUNDING
from cardume.paths.lawnmower import lawnmower
from cardume.paths.segment import ReferencePath, Segment, Start, end_of, length_of, point_on

GEOGRAPHIC = [name for name in FORMATS if name != "medusa"]
MILLIMETER = 1e-3
ORIGINS = [(38.7, -9.1), (-16.7, 179.999), (69.65, 18.95), (-54.8, -68.3), (0.0, 0.1), (1.2, -179.9999)]


def place(latitude: float, longitude: float) -> GeoPoint:
    return GeoPoint(math.radians(latitude), math.radians(longitude))


def polyline(points: list[tuple[float, float]], speeds: list[float | None]) -> ReferencePath:
    """Straight legs; speeds[k] is that of the leg to point k + 1."""
    legs = []
    for (north, east), (north_end, east_end), speed in zip(points, points[1:], speeds, strict=False):
        step = (north_end - north, east_end - east)
        legs.append(
            Segment(
                north=north,
                east=east,
                course=math.atan2(step[1], step[0]),
                curvature=0.0,
                length=math.hypot(*step),
                speed=speed,
            )
        )
    return tuple(legs)


def plan(segments: ReferencePath, origin: tuple[float, float] = ORIGINS[0], *members: Member) -> Plan:
    return Plan(source="x", origin=place(*origin), segments=segments, members=members or (Member(id=1),))


def written(given: Plan, kind: str, tolerance: float = 0.05) -> tuple[Plan, Written]:
    """A plan written and read again, about the same origin."""
    result = write_plan(given, kind, "round trip", tolerance)
    again = parse_plan(result.content.decode(), "again", named=kind, origin=None if kind == "medusa" else given.origin)
    return again, result


def corners(path: ReferencePath) -> np.ndarray:
    """[m] (n, 2)"""
    return np.array([(s.north, s.east) for s in path] + [end_of(path[-1])[:2]])


meters = st.floats(-3000.0, 3000.0).map(lambda x: round(x, 3))
speeds = st.sampled_from([None, 0.3, 0.5, 1.25, 1 / 3, 0.7000000000000001])
origins = st.sampled_from(ORIGINS)


@st.composite
def polylines(draw: st.DrawFn, speed: st.SearchStrategy[float | None] = speeds) -> ReferencePath:
    """Legs of at least 10 cm."""
    points = draw(st.lists(st.tuples(meters, meters), min_size=2, max_size=12))
    kept = [points[0]]
    for point in points[1:]:
        if math.dist(kept[-1], point) > 0.1:
            kept.append(point)
    if len(kept) < 2:
        kept.append((kept[0][0] + 5.0, kept[0][1]))
    return polyline(kept, draw(st.lists(speed, min_size=len(kept), max_size=len(kept))))


@pytest.mark.parametrize("kind", GEOGRAPHIC)
@given(polylines(), origins, st.sampled_from([None, 0.0, 2.5, 40.0]))
@settings(max_examples=40)
def test_straight_legs_come_back(
    kind: str, path: ReferencePath, origin: tuple[float, float], depth: float | None
) -> None:
    again, _ = written(plan(path, origin, Member(id=1, depth=depth)), kind)
    found = corners(again.segments)
    if found.shape == corners(path).shape:
        assert np.abs(found - corners(path)).max() < MILLIMETER
        assert [s.speed for s in again.segments] == [s.speed for s in path]
    else:  # a leg that crosses the antimeridian is cut there
        assert kind == "geojson"
        assert length_of(again.segments) == pytest.approx(length_of(path), abs=MILLIMETER * len(found))
        assert beside(corners(path), again.segments) < MILLIMETER
        assert {s.speed for s in again.segments} == {s.speed for s in path}
    assert again.members[0].depth == (depth or None)
    assert not [note for note in again.notes if "home" not in note]


def beside(points: np.ndarray, path: ReferencePath) -> float:
    """[m] the largest distance of points (n, 2) from a path of straight legs."""
    ends = corners(path)
    starts, along = ends[:-1], np.diff(ends, axis=0)
    gaps = points[:, None] - starts
    share = np.clip((gaps * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
    off = gaps - share[:, :, None] * along
    return float(np.hypot(off[:, :, 0], off[:, :, 1]).min(axis=1).max())


@st.composite
def smooth_paths(draw: st.DrawFn) -> ReferencePath:
    """A lawnmower of legs and half circles, anywhere."""
    start = Start(draw(meters), draw(meters), draw(st.floats(-3.0, 3.0)))
    leg, spacing = draw(st.floats(5.0, 300.0)), draw(st.floats(2.0, 60.0))
    path = lawnmower(start, leg, draw(st.integers(1, 6)), spacing, draw(st.sampled_from(["port", "starboard"])))
    return tuple(replace(segment, speed=draw(st.sampled_from([0.3, 0.5, 1 / 3]))) for segment in path)


@given(smooth_paths(), st.sampled_from(ORIGINS[:4]))
@settings(max_examples=30)
def test_medusa_text_keeps_lines_as_lines_and_arcs_as_arcs(path: ReferencePath, origin: tuple[float, float]) -> None:
    members = (Member(id=1, ahead=-2.5, starboard=3.0, depth=0.0), Member(id=2, starboard=-3.25, depth=4.5))
    again, result = written(plan(path, origin, *members), "medusa")
    assert again.members == members
    assert result.lost == ()
    assert len(again.segments) == len(path) == result.points
    for one, other in zip(again.segments, path, strict=True):
        assert one.speed == pytest.approx(other.speed, rel=1e-12)
        assert one.length == pytest.approx(other.length, abs=MILLIMETER)
        assert (one.curvature == 0.0) == (other.curvature == 0.0)
        for share in (0.0, 0.3, 1.0):
            there = point_on(one, share * one.length)[:2]
            assert there == pytest.approx(point_on(other, share * other.length)[:2], abs=MILLIMETER)
    assert math.degrees(again.origin.latitude) == pytest.approx(origin[0], abs=1e-8)


def is_of_rounding_size(before: Segment, after: Segment) -> bool:
    """Whether a kink may come from writing points to the centimeter: no corner then, see `joining.py`."""
    kink = math.remainder(after.course - before.course, 2.0 * math.pi)
    return abs(kink) * min(before.length, after.length) <= 1.01 * ROUNDING


@given(polylines(st.sampled_from([0.3, 0.5])), st.sampled_from(ORIGINS[:4]))
@settings(max_examples=30)
def test_medusa_text_keeps_corners(path: ReferencePath, origin: tuple[float, float]) -> None:
    assume(not any(is_of_rounding_size(*joint) for joint in zip(path, path[1:], strict=False)))
    again, _ = written(plan(path, origin), "medusa")
    assert corners(again.segments) == pytest.approx(corners(path), abs=MILLIMETER)
    assert [s.speed for s in again.segments] == [s.speed for s in path]


@pytest.mark.parametrize("kind", GEOGRAPHIC)
@given(smooth_paths(), st.sampled_from([0.005, 0.05, 0.5]))
@settings(max_examples=15)
def test_legs_stay_within_the_tolerance_of_arcs(kind: str, path: ReferencePath, tolerance: float) -> None:
    again, result = written(plan(path), kind, tolerance)
    assert result.points == len(again.segments) + 1
    arcs = [segment for segment in path if segment.curvature]
    if arcs:
        shares = np.linspace(0.0, 1.0, 201)
        points = np.array([point_on(arc, share * arc.length)[:2] for arc in arcs for share in shares])
        deepest = beside(points, again.segments)
        assert deepest < tolerance + MILLIMETER
        coarsest = min(tolerance, min(1.0 / abs(arc.curvature) for arc in arcs))
        assert deepest > 0.2 * coarsest  # not much finer than was asked for
        assert f"straight legs, nowhere more than {tolerance:g} m beside the path" in result.lost[0]


def test_a_full_circle_and_more() -> None:
    """An ARC must not end where it starts."""
    loop = Segment(north=5.0, east=0.0, course=0.5, curvature=-1 / 20, length=2.5 * 2 * math.pi * 20.0, speed=0.5)
    again, result = written(plan((loop,)), "medusa")
    assert result.points == 5
    assert length_of(again.segments) == pytest.approx(loop.length, abs=5 * MILLIMETER)
    assert end_of(again.segments[-1])[:2] == pytest.approx(end_of(loop)[:2], abs=MILLIMETER)


def test_the_fence_comes_back_in_a_plan_and_nowhere_else() -> None:
    fences = (
        Fence(corners=tuple(place(38.7 + k * 1e-3, -9.1 + k * k * 1e-3) for k in range(3)), is_inclusion=False),
        Fence(corners=(place(38.7, -9.1),), radius=250.0),
    )
    given_plan = replace(plan(polyline([(0.0, 0.0), (50.0, 0.0)], [0.5])), fences=fences)
    again, result = written(given_plan, "plan")
    assert [(f.radius, f.is_inclusion) for f in again.fences] == [(0.0, False), (250.0, True)]
    found = np.array([corner for fence in again.fences for corner in fence.corners])
    assert found == pytest.approx(np.array([c for f in fences for c in f.corners]), abs=1e-11)
    assert not result.lost
    for kind in FORMATS:
        assert ("the geofence" in written(given_plan, kind)[1].lost) == (kind != "plan")


@pytest.mark.parametrize("kind", GEOGRAPHIC)
def test_what_is_lost_is_said(kind: str) -> None:
    path = tuple(replace(s, speed=0.5) for s in lawnmower(Start(), 30.0, 2, 20.0, "port"))
    members = (Member(id=1, depth=0.0), Member(id=2, starboard=3.0, depth=5.0))
    _, result = written(plan(path, ORIGINS[0], *members), kind)
    said = " ".join(result.lost)
    assert "1 arc became straight legs" in said
    assert "the formation: the file has one path, not 2 vehicles" in said
    assert "the depths, for they differ from vehicle to vehicle" in said
    assert ("speeds, for other programs" in said) == (kind == "gpx")


@pytest.mark.parametrize("kind", ["plan", "wpl"])
def test_where_equator_and_meridian_meet(kind: str) -> None:
    """0, 0 means "here" in a command: the waypoint there is written a centimeter beside it."""
    path = polyline([(-50.0, 0.0), (0.0, 0.0), (0.0, 50.0)], [0.5, 0.5])
    again, _ = written(plan(path, (0.0, 0.0)), kind)
    assert corners(again.segments) == pytest.approx(corners(path), abs=0.012)


def test_a_medusa_text_without_speed_is_refused() -> None:
    with pytest.raises(InputError, match=r"needs a speed on every line and arc, .* give --speed"):
        write_plan(plan(polyline([(0.0, 0.0), (5.0, 0.0)], [None])), "medusa", "x")


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("tolerance", [0.0, -1.0, 1e-9, math.nan, 1e9])
def test_an_impossible_tolerance_is_refused(kind: str, tolerance: float) -> None:
    with pytest.raises(InputError, match=r"the tolerance is .*; it lies between 0.001 and 100 m"):
        write_plan(plan(polyline([(0.0, 0.0), (5.0, 0.0)], [1.0])), kind, "x", tolerance)


def test_a_path_of_too_many_points_is_refused() -> None:
    loop = Segment(north=0.0, east=0.0, course=0.0, curvature=0.01, length=2e6, speed=0.5)
    with pytest.raises(InputError, match=r"more than 20,000 points .* give a larger --tolerance"):
        write_plan(plan((loop,)), "gpx", "x", 0.001)


def test_medusa_text_ends_where_utm_does() -> None:
    with pytest.raises(InputError, match="UTM covers 80 deg south to 84 deg north"):
        write_plan(plan(polyline([(0.0, 0.0), (5.0, 0.0)], [1.0]), (85.0, 10.0)), "medusa", "x")


def test_geojson_is_cut_at_the_antimeridian() -> None:
    """RFC 7946, section 3.1.9."""
    across = polyline([(0.0, -400.0), (100.0, 600.0)], [0.5])
    result = write_plan(plan(across, (10.0, 180.0)), "geojson", "x")
    (feature,) = json.loads(result.content)["features"]
    assert feature["geometry"]["type"] == "MultiLineString"
    (_, cut), (after, _) = feature["geometry"]["coordinates"]
    assert (cut[0], after[0]) == (180.0, -180.0)
    assert cut[1] == after[1]


def test_names_that_are_no_xml() -> None:
    path = polyline([(0.0, 0.0), (5.0, 0.0)], [0.5])
    again = parse_plan(write_plan(plan(path), "gpx", 'a < b & "c"\x01').content.decode(), "x", named="gpx")
    assert again.name == 'a < b & "c"\\x01'
