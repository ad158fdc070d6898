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
        arcs, curves: how many pieces of the path became straight legs.
    """

    name: str
    points: tuple[Place, ...]
    speeds: tuple[float | None, ...]
    depth: float | None = None
    fences: tuple[Fence, ...] = ()
    arcs: int = 0
    curves: int = 0


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
    first = plan.segments[0]
    north_east, speeds = [(first.north, first.east)], [speed_on(first, 0.0)]
    for segment in plan.segments:
        for point, speed in samples(segment, tolerance):
            north_east.append(point)
            speeds.append(speed)
            if len(speeds) > most:
                raise InputError(
                    f"the path needs more than {most:,} points at a tolerance of {tolerance:g} m; give a larger"
                    " --tolerance"
                )
    speeds[0] = speeds[1]
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
        curves=sum(segment.curve is not None for segment in plan.segments),
    )


def samples(segment: Segment, tolerance: float) -> Iterator[tuple[tuple[float, float], float | None]]:
    """Points north, east [m] behind the start of a segment, its end the last, each with the speed on the way to it.

    The sagitta of a chord that turns by a on an arc of radius R is R (1 - cos(a / 2)).  A curve is taken
    for an arc of its tightest bend.

    Args:
        segment: line, arc or curve.
        tolerance: [m] > 0.
    """
    bend, count = tightest(segment), 1
    if bend > 0.0:
        most_turned = 2.0 * math.acos(max(1.0 - tolerance * bend, 0.0))  # at most a half circle
        count = pieces(segment, most_turned)
    for k in range(1, count + 1):
        point = point_on(segment, segment.length * k / count)
        yield (point.north, point.east), speed_on(segment, (k - 0.5) / count)


def pieces(segment: Segment, most_turned: float) -> int:
    """How many equal parts a segment has, none of which turns by more than an angle.

    Args:
        segment: an arc or a curve.
        most_turned: [rad] > 0.
    """
    return max(1, math.ceil(segment.length * tightest(segment) / most_turned - 1e-9))


def tightest(segment: Segment) -> float:
    """The greatest curvature [1/m] of a segment, to either side; 0 of a line."""
    if segment.curve is None:
        return abs(segment.curvature)
    return max(abs(bend / (1.0 - bend * segment.offset)) for bend in segment.curve.bends)  # of the parallel curve


def speed_on(segment: Segment, share: float) -> float | None:
    """v_L [m/s] where this share of a segment has gone by; None where it is the formation's."""
    if segment.speed is not None or segment.curve is None or segment.curve.speed is None:
        return segment.speed
    gained = 0.0
    for coefficient in reversed(segment.curve.gained_speed):
        gained = (gained + coefficient) * share
    return segment.curve.speed + gained
