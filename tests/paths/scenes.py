"""Random paths, and points beside them built without the code under test."""

import math
from typing import NamedTuple

from hypothesis import strategies as st

from cardume.paths.segment import ReferencePath, Segment, Start, Turn, bend, chain, length_of, point_on, straight

TURNS: tuple[Turn, Turn] = ("starboard", "port")

numbers = st.floats(-200.0, 200.0)
starts = st.builds(Start, numbers, numbers, st.floats(-7.0, 7.0))
lines = st.builds(straight, st.floats(1.0, 60.0))
arcs = st.builds(bend, st.floats(4.0, 60.0), st.sampled_from(TURNS), st.floats(0.1, 3.1))
pieces = st.lists(st.one_of(lines, arcs), min_size=1, max_size=6)
paths = st.builds(chain, starts, pieces)


class Beside(NamedTuple):
    """A point that lies e to starboard of the own path, abeam of gamma on the reference path."""

    north: float
    east: float
    course: float
    segment: int


def locate(path: ReferencePath, gamma: float) -> tuple[Segment, int, float]:
    """The segment on which gamma lies, its number, and how far from its start; the ends go on."""
    for number, segment in enumerate(path):
        if gamma <= segment.length or number == len(path) - 1:
            return segment, number, gamma
        gamma -= segment.length
    raise AssertionError("unreachable")


def beside(path: ReferencePath, gamma: float, starboard: float) -> Beside:
    """The point at `starboard` of the reference path at gamma."""
    segment, number, along = locate(path, gamma)
    place = point_on(segment, along)
    return Beside(
        place.north - starboard * math.sin(place.course),
        place.east + starboard * math.cos(place.course),
        place.course,
        number,
    )


def own_length(path: ReferencePath, gamma: float, offset: float) -> float:
    """Arc length on the path offset to starboard, where the reference path has gamma."""
    segment, number, along = locate(path, gamma)
    before = sum(s.length * (1.0 - s.curvature * offset) for s in path[:number])
    return before + along * (1.0 - segment.curvature * offset)


@st.composite
def scenes(draw: st.DrawFn) -> tuple[ReferencePath, float, float, float]:
    """A path, an offset that fits, a gamma on it or beyond its ends, and a cross-track error short of any center."""
    path = draw(paths)
    tightest = max((abs(s.curvature) for s in path), default=0.0)
    room = min(0.9 / tightest if tightest else 50.0, 50.0)
    offset = draw(st.floats(-0.6, 0.6)) * room
    gamma = draw(st.floats(-3.0, length_of(path) + 3.0))
    error = draw(st.floats(-1.0, 1.0)) * (room - abs(offset))
    return path, offset, gamma, error
