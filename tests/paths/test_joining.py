"""Sections written with rounded numbers become a chain that is exactly continuous."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.paths.joining import Section, join
from cardume.paths.lawnmower import lawnmower
from cardume.paths.offset import offset_path
from cardume.paths.segment import GeometryError, ReferencePath, Start, end_of
from cardume.paths.table import HEADER_WIDTH, SEGMENT_WIDTH
from paths.scenes import paths


def as_written(path: ReferencePath, digits: int) -> list[Section]:
    """Start, center and end of every segment, rounded as a file has them."""

    def rounded(*point: float) -> tuple[float, float]:
        return round(point[0], digits), round(point[1], digits)

    sections = []
    for number, s in enumerate(path, 1):
        end, radius = end_of(s), 1.0 / s.curvature if s.curvature else 0.0
        center = rounded(s.north - radius * math.sin(s.course), s.east + radius * math.cos(s.course))
        sections.append(
            Section(
                start=rounded(s.north, s.east),
                end=rounded(*end[:2]),
                center=center if radius else None,
                sense=math.copysign(1.0, radius) if radius else 0.0,
                speed=0.3,
                label=f"line {number}",
            )
        )
    return sections


def is_smooth(path: ReferencePath) -> bool:
    ends = [end_of(s) for s in path[:-1]]
    gaps = [math.hypot(a.north - b.north, a.east - b.east) for a, b in zip(ends, path[1:], strict=True)]
    kinks = [abs(math.remainder(a.course - b.course, 2.0 * math.pi)) for a, b in zip(ends, path[1:], strict=True)]
    return max(gaps, default=0.0) < 1e-9 and max(kinks, default=0.0) < 1e-12


@pytest.mark.parametrize("turn", ["starboard", "port"])
@pytest.mark.parametrize("legs", [1, 5, 70])
def test_a_lawnmower_written_to_the_centimeter_comes_back(legs: int, turn: str) -> None:
    path = lawnmower(Start(3.127, -4.318, 0.7), 60.0, legs, 24.0, turn)
    joined = join(as_written(path, 2))
    assert is_smooth(joined)
    shifts = [math.hypot(a.north - b.north, a.east - b.east) for a, b in zip(joined, path, strict=True)]
    assert max(shifts) < 0.01
    assert [s.length for s in joined] == pytest.approx([s.length for s in path], abs=0.03)
    assert {s.speed for s in joined} == {0.3}
    # no corner was made: an offset path has as many segments as the reference path
    own = offset_path(joined, 5.0)
    assert len(own) == HEADER_WIDTH + SEGMENT_WIDTH * len(path)


@given(paths)
def test_unrounded_sections_come_back_unchanged(path: ReferencePath) -> None:
    joined = join(as_written(path, 12))
    assert is_smooth(joined)
    for a, b in zip(joined, path, strict=True):
        assert (a.north, a.east, a.length) == pytest.approx((b.north, b.east, b.length), abs=1e-7)
        assert a.curvature == pytest.approx(b.curvature, abs=1e-7)


@given(st.integers(0, 2**32 - 1))
def test_random_noise_of_rounding_size_is_absorbed(seed: int) -> None:
    noise = np.random.default_rng(seed).uniform(-0.005, 0.005, (9, 6))
    path = lawnmower(Start(course=1.0), 40.0, 5, 20.0)
    sections = [
        Section(
            start=(s.start[0] + n[0], s.start[1] + n[1]),
            end=(s.end[0] + n[2], s.end[1] + n[3]),
            center=(s.center[0] + n[4], s.center[1] + n[5]) if s.center else None,
            sense=s.sense,
        )
        for s, n in zip(as_written(path, 12), noise, strict=True)
    ]
    joined = join(sections)
    assert is_smooth(joined)
    assert max(math.hypot(a.north - b.north, a.east - b.east) for a, b in zip(joined, path, strict=True)) < 0.02


def test_corners_stay_corners() -> None:
    points = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.01), (-10.0, 40.0)]
    joined = join([Section(start=a, end=b) for a, b in zip(points, points[1:], strict=False)])
    ends = [(s.north, s.east) for s in joined] + [end_of(joined[-1])[:2]]
    assert np.array(ends) == pytest.approx(np.array(points), abs=1e-6)
    turns = [b.course - a.course for a, b in zip(joined, joined[1:], strict=False)]
    assert [round(math.degrees(math.remainder(t, 2.0 * math.pi))) for t in turns] == [90, 90, -63]


def test_a_curve_drawn_with_short_lines_keeps_its_corners() -> None:
    """Each kink of 0.5 deg over 1 m is within rounding, but forty of them are not."""
    points = [(114.59 * math.sin(a), 114.59 * (1.0 - math.cos(a))) for a in np.radians(0.5 * np.arange(41))]
    joined = join([Section(start=a, end=b) for a, b in zip(points, points[1:], strict=False)])
    assert end_of(joined[-1])[:2] == pytest.approx(points[-1], abs=1e-6)


def test_a_line_in_two_collinear_parts_has_no_corner() -> None:
    joined = join([Section(start=(0.0, 0.0), end=(20.0, 0.01)), Section(start=(20.0, 0.01), end=(50.0, 0.02))])
    assert joined[0].course == joined[1].course


def test_corners_stay_where_one_window_ends_and_the_next_begins() -> None:
    points = [(10.0 * k, 4.0 * (k % 2)) for k in range(230)]
    joined = join([Section(start=a, end=b) for a, b in zip(points, points[1:], strict=False)])
    assert [(s.north, s.east) for s in joined] == [pytest.approx(p, abs=1e-6) for p in points[:-1]]


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ([], "has 0 lines and arcs"),
        ([Section(start=(0.0, 0.0), end=(0.0, 0.01), label="line 4")], "line 4 is a line of 0.01 m"),
        (
            [
                Section(start=(0.0, 0.0), end=(9.0, 0.0), label="line 4"),
                Section(start=(9.5, 0.0), end=(20.0, 0.0), label="line 5"),
            ],
            "line 5 starts 0.5 m from where line 4 ends",
        ),
        (
            [Section(start=(0.0, 0.0), end=(10.0, 10.0), center=(0.0, 7.0), sense=1.0, label="line 4")],
            "line 4: the arc starts 7 m from its center and ends 10.4403 m",
        ),
        (
            [Section(start=(0.0, 0.0), end=(0.0, 0.0), center=(0.0, 7.0), sense=1.0, label="line 4")],
            "line 4: the arc ends where it starts",
        ),
    ],
)
def test_what_is_no_rounding_is_refused(sections: list[Section], said: str) -> None:
    with pytest.raises(GeometryError) as refusal:
        join(sections)
    assert said in str(refusal.value)
    if sections:
        assert refusal.value.label == sections[-1].label
