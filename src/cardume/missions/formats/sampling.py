"""A path as points on the Earth, for formats that know no arcs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cardume.errors import InputError
from cardume.missions.formats.plan import Fence, Plan
from cardume.missions.geodesy import to_geographic
from cardume.paths.segment import Segment, point_on

TOLERANCE = 0.05  # [m]
DIGITS = 10  # decimals of a degree: 11 micrometers


class Place(NamedTuple):
    """A point of a path to be written."""

    latitude: float  # [rad]
    longitude: float  # [rad]

    @property
    def degrees(self) -> tuple[float, float]:
        """Latitude and longitude [deg], to a hundredth of a millimeter, longitude in [-180, 180]."""
        longitude = math.remainder(math.degrees(self.longitude), 360.0)
        return round(math.degrees(self.latitude), DIGITS), round(longitude, DIGITS) + 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Course:
    """A polyline with speeds, to be written.

    Attributes:
        name: what the path is called.
        points: at least two.
        speeds: [m/s] of the leg that ends at each point, the first one's as the second's; None: not known.
        depth: [m] at which it is flown; None: not known, or not one.
        fences: areas to be written with it.
        arcs: how many arcs of the path became straight legs.
    """

    name: str
    points: tuple[Place, ...]
    speeds: tuple[float | None, ...]
    depth: float | None = None
    fences: tuple[Fence, ...] = ()
    arcs: int = 0


def to_course(plan: Plan, name: str, tolerance: float = TOLERANCE, most: int = 100_000) -> Course:
    """The path as points: the ends of its lines, and of its arcs so many that no chord is far from its arc.

    Args:
        plan: the path.
        name: what to call it.
        tolerance: [m] > 0, the largest distance of a chord from its arc.
        most: how many points there may be.

    Raises:
        InputError: there are more.
    """
    north_east, speeds = [(plan.segments[0].north, plan.segments[0].east)], [plan.segments[0].speed]
    for segment in plan.segments:
        for point in samples(segment, tolerance):
            north_east.append(point)
            speeds.append(segment.speed)
            if len(speeds) > most:
                raise InputError(
                    f"the path needs more than {most:,} points at a tolerance of {tolerance:g} m; give a larger"
                    " --tolerance"
                )
    north, east = np.array(north_east).T
    places = np.column_stack(to_geographic(north, east, plan.origin))
    depths = {member.depth for member in plan.members}
    return Course(
        name=name,
        points=tuple(Place(float(latitude), float(longitude)) for latitude, longitude in places),
        speeds=tuple(speeds),
        depth=depths.pop() if len(depths) == 1 else None,
        fences=plan.fences,
        arcs=sum(segment.curvature != 0.0 for segment in plan.segments),
    )


def samples(segment: Segment, tolerance: float) -> Iterator[tuple[float, float]]:
    """Points north, east [m] behind the start of a segment, its end the last.

    The sagitta of a chord that turns by a on an arc of radius R is R (1 - cos(a / 2)).

    Args:
        segment: line or arc.
        tolerance: [m] > 0.
    """
    count = 1
    if segment.curvature:
        most_turned = 2.0 * math.acos(max(1.0 - tolerance * abs(segment.curvature), 0.0))  # at most a half circle
        count = pieces(segment, most_turned)
    for k in range(1, count + 1):
        point = point_on(segment, segment.length * k / count)
        yield point.north, point.east


def pieces(arc: Segment, most_turned: float) -> int:
    """How many equal parts an arc has, none of which turns by more than an angle.

    Args:
        arc: with a curvature.
        most_turned: [rad] > 0.
    """
    return max(1, math.ceil(arc.length * abs(arc.curvature) / most_turned - 1e-9))
