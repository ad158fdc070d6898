"""From lines and arcs written in a file, rounded, to a chain that is exactly continuous.

A file written to the centimeter has gaps and kinks of that size at its joints.  Kept, every offset
path would get a corner at each of them.  So the chain is made continuous in position, and in course
wherever the joint is meant to be smooth (`traverse.py`).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cardume.paths.segment import GeometryError, ReferencePath, Segment, end_of
from cardume.paths.table import MAX_SEGMENTS
from cardume.paths.traverse import Point, adjust_chain

ROUNDING = 0.05  # [m] what a joint may be off and still be meant to be smooth
SHARPEST_SMOOTH = math.radians(10.0)  # no kink above this is taken for rounding, however short its sides


@dataclass(frozen=True, kw_only=True, slots=True)
class Section:
    """A line or arc as a file gives it.

    Attributes:
        start, end: [m] north, east.
        center: [m] north, east; None for a line.
        sense: 1 to starboard, -1 to port; 0 for a line.
        speed: [m/s] v_L; None: the formation's.
        label: where it was given, such as "line 7".
    """

    start: Point
    end: Point
    center: Point | None = None
    sense: float = 0.0
    speed: float | None = None
    label: str = ""


def join(sections: Sequence[Section], rounding: float = ROUNDING) -> ReferencePath:
    """Join sections into a reference path, absorbing gaps and kinks of rounding size.

    Args:
        sections: in the order in which they are flown.
        rounding: [m] the largest shift of any point that counts as rounding.

    Returns:
        The reference path; joints that are no rounding stay corners.

    Raises:
        GeometryError: a gap, an arc whose points do not lie on a circle, or sections of no length.
    """
    if not 0 < len(sections) <= MAX_SEGMENTS:
        raise GeometryError(f"the path has {len(sections)} lines and arcs; it needs 1 to {MAX_SEGMENTS}")
    rough = [_as_segment(section, rounding) for section in sections]
    for before, after, section in zip(rough, rough[1:], sections[1:], strict=False):
        gap = _distance((end_of(before).north, end_of(before).east), section.start)
        if gap > 2.0 * rounding:
            raise GeometryError(
                f"{after.label} starts {gap:.6g} m from where {before.label} ends;"
                f" at most {2.0 * rounding:g} m is taken for rounding: let it start there, or add a line between",
                after.label,
            )
    joints = list(zip(rough, rough[1:], strict=False))
    corners = [_corner(before, after, rounding) for before, after in joints]
    fitted, problem = _fit(rough, corners, sections, rounding)
    if problem:  # many short lines, each within rounding of the next, may still draw a curve
        corners = [_corner(*joint, 0.0 if _are_lines(*joint) else rounding) for joint in joints]
        fitted, problem = _fit(rough, corners, sections, rounding)
    if problem:
        raise problem
    return tuple(fitted)


def _fit(
    rough: list[Segment], corners: list[float], sections: Sequence[Section], rounding: float
) -> tuple[list[Segment], GeometryError | None]:
    """The adjusted chain, and what keeps it from passing near enough to the points of the file."""
    try:
        fitted = adjust_chain(rough, corners, [_given(section) for section in sections])
    except np.linalg.LinAlgError:
        return [], GeometryError("the lines and arcs cannot be joined: check that each starts where the last one ends")
    for segment, section in zip(fitted, sections, strict=True):
        shift = max(_distance(a, b) for a, b in zip(_marks(segment), _given(section), strict=True))
        if not shift <= 2.0 * rounding:
            return fitted, GeometryError(
                f"{section.label} does not meet its neighbors smoothly: it had to be moved by {shift:.3g} m,"
                f" and at most {2.0 * rounding:g} m is taken for rounding: check its points",
                section.label,
            )
    return fitted, None


def _are_lines(before: Segment, after: Segment) -> bool:
    return before.curvature == 0.0 and after.curvature == 0.0


def _as_segment(section: Section, rounding: float) -> Segment:
    """A section by itself, from its first point."""
    (north, east), (end_north, end_east) = section.start, section.end
    if section.center is None:
        length = _distance(section.start, section.end)
        if length <= rounding:
            raise GeometryError(
                f"{section.label} is a line of {length:.3g} m; it needs a length above {rounding:g} m", section.label
            )
        course = math.atan2(end_east - east, end_north - north)
        return _segment(section, course, 0.0, length)
    radius = _distance(section.start, section.center)
    to_end = _distance(section.end, section.center)
    if min(radius, to_end) <= rounding or abs(radius - to_end) > 2.0 * rounding:
        raise GeometryError(
            f"{section.label}: the arc starts {radius:.6g} m from its center and ends {to_end:.6g} m from it;"
            f" both must be the same radius, above {rounding:g} m",
            section.label,
        )
    if _distance(section.start, section.end) <= 2.0 * rounding:
        raise GeometryError(
            f"{section.label}: the arc ends where it starts; write a full circle as two arcs", section.label
        )
    out = math.atan2(east - section.center[1], north - section.center[0])
    out_end = math.atan2(end_east - section.center[1], end_north - section.center[0])
    angle = (section.sense * (out_end - out)) % (2.0 * math.pi)
    return _segment(section, out + section.sense * 0.5 * math.pi, section.sense / radius, radius * angle)


def _segment(section: Section, course: float, curvature: float, length: float) -> Segment:
    return Segment(
        north=section.start[0],
        east=section.start[1],
        course=course,
        curvature=curvature,
        length=length,
        speed=section.speed,
        label=section.label,
    )


def _corner(before: Segment, after: Segment, rounding: float) -> float:
    """The angle at a joint that is a corner; 0 where rounding of the points explains it."""
    angle = math.remainder(after.course - end_of(before).course, 2.0 * math.pi)
    scale = min(min(s.length, 1.0 / abs(s.curvature) if s.curvature else math.inf) for s in (before, after))
    return 0.0 if abs(angle) <= min(rounding / scale, SHARPEST_SMOOTH) else angle


def _distance(one: Point, other: Point) -> float:
    return math.hypot(one[0] - other[0], one[1] - other[1])


def _given(section: Section) -> list[Point]:
    return [section.start, section.end, *([section.center] if section.center else [])]


def _marks(segment: Segment) -> list[Point]:
    """The points of a segment that a file gives: start, end, center."""
    end = end_of(segment)
    marks = [(segment.north, segment.east), (end.north, end.east)]
    if segment.curvature:
        radius = 1.0 / segment.curvature
        marks.append(
            (segment.north - radius * math.sin(segment.course), segment.east + radius * math.cos(segment.course))
        )
    return marks
