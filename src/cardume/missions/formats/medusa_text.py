"""A path and its formation as MEDUSA / Farol text, which keeps lines as lines and arcs as arcs.

The inverse of `medusa_plan.py`: local axes are turned by the convergence of the UTM grid and scaled to it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from cardume.errors import InputError
from cardume.missions.formats.medusa import FARTHEST
from cardume.missions.formats.plan import Member, Plan
from cardume.missions.formats.sampling import TOLERANCE, pieces, samples
from cardume.missions.geodesy import GridScale, geographic_to_utm, grid_scale
from cardume.paths.segment import PathPoint, Segment, point_on
from cardume.units import printable

SHORTEST = 0.05  # [m] what is shorter is taken for rounding where the file is read
MOST_TURNED = math.pi  # [rad] of one ARC, whose end must not be its start


def write_medusa(plan: Plan, name: str, tolerance: float = TOLERANCE) -> bytes:
    """The text of a mission: reference, FORMATION, DEPTH, then LINE and ARC.

    Args:
        plan: every segment with its speed.
        name: what to call it, in a comment.
        tolerance: [m] of what is neither line nor arc.

    Raises:
        InputError: a place that UTM does not cover, or a path too long for the format.
    """
    reference = geographic_to_utm(plan.origin)
    grid = grid_scale(reference)
    lines = [
        f"# {printable(name)}",
        "3",
        f"{reference.easting:.4f} {reference.northing:.4f} {reference.zone}{reference.band}",
        *_formation(plan.members),
    ]
    for segment in plan.segments:
        if segment.length > SHORTEST:
            lines += _sections(segment, grid, tolerance)
    return ("\n".join(lines) + "\n").encode()


def _formation(members: Sequence[Member]) -> Iterator[str]:
    """Who flies where, y to the left; at which depth."""
    if len(members) > 1 or any(member.ahead or member.starboard for member in members):
        places = (f"{m.id} {_meters(m.ahead)} {_meters(0.0 - m.starboard)}" for m in members)
        yield f"FORMATION {' '.join(places)}"
    for member in members:
        if member.depth is not None:
            yield f"DEPTH {_meters(member.depth)} -1 {member.id if len(members) > 1 else -1}"


def _sections(segment: Segment, grid: GridScale, tolerance: float) -> Iterator[str]:
    """A segment as LINE or ARC."""
    if segment.curvature == 0.0:
        start = (segment.north, segment.east)
        for end, speed in samples(segment, tolerance):
            yield f"LINE {_xy(start, grid)} {_xy(end, grid)} {speed!r} -1"
            start = end
        return
    radius, count = 1.0 / abs(segment.curvature), pieces(segment, MOST_TURNED)
    direction = -1 if segment.curvature > 0.0 else 1  # -1 is clockwise, a turn to starboard
    center = _center(segment)
    marks = [point_on(segment, segment.length * k / count) for k in range(count + 1)]
    for begin, finish in pairwise(marks):
        xy = " ".join(_xy(point, grid) for point in (begin[:2], center, finish[:2]))
        yield f"ARC {xy} {segment.speed!r} {direction} {_meters(radius * grid.scale)} -1"


def _center(segment: Segment) -> tuple[float, float]:
    radius = 1.0 / segment.curvature
    start = PathPoint(segment.north, segment.east, segment.course)
    return start.north - radius * math.sin(start.course), start.east + radius * math.cos(start.course)


def _xy(point: tuple[float, float], grid: GridScale) -> str:
    """Local north, east to grid x (east), y (north)."""
    north, east = point
    cos_turn, sin_turn = math.cos(grid.convergence) * grid.scale, math.sin(grid.convergence) * grid.scale
    x, y = east * cos_turn - north * sin_turn, north * cos_turn + east * sin_turn
    if max(abs(x), abs(y)) > FARTHEST:
        raise InputError(f"a point lies {max(abs(x), abs(y)) / 1000.0:,.0f} km from the origin; MEDUSA text ends there")
    return f"{_meters(x)} {_meters(y)}"


def _meters(value: float) -> str:
    """To a tenth of a millimeter, without a minus before zero."""
    return f"{round(value, 4) + 0.0:.4f}"
