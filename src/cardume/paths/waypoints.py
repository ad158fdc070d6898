"""Straight legs through points; corners sharp, or rounded by arcs or by clothoids."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from cardume.laws import Meters, Positive
from cardume.paths.circle import Center
from cardume.paths.segment import (
    GeometryError,
    ReferencePath,
    Segment,
    Start,
    bend,
    chain,
    end_of,
    positive,
    straight,
)
from cardume.paths.spline import check_points
from cardume.paths.tracing import clothoid

Joint = Literal["arc", "clothoid"]
JOINTS = ("arc", "clothoid")
STRAIGHT_ON = 1e-9  # [rad] a turn below this is none
BACK = 1e-6  # [rad] as near to a half turn as this, no curve of any radius leads round the corner
FITS = 1e-9  # [m] by which a leg may be too short, rounding


def waypoints(
    points: Sequence[Center], turn_radius: Positive[Meters] | None = None, joint: Joint = "arc"
) -> ReferencePath:
    """Legs from point to point; with a turn radius the corners are cut by curves that touch both legs.

    An arc of radius R leaves the leg T = R tan(theta / 2) before a corner of angle theta.  A clothoid
    joint bends evenly more until its middle, where the radius is R, and evenly less after it: two halves of
    length R theta each, so its curvature does not jump.

    Args:
        points: two or more; no two that follow one another are the same.
        turn_radius: [m] R > 0; None: sharp corners.
        joint: arc or clothoid.

    Returns:
        The reference path.

    Raises:
        GeometryError: too few or equal points, a leg that turns straight back, or legs too short for the
            radius; the text says the largest that fits.
    """
    array = check_points(points, 2, "waypoints")
    if joint not in JOINTS:
        raise GeometryError(f"joint is {joint!r}; it is arc or clothoid")
    legs = np.diff(array, axis=0)
    courses, lengths = np.arctan2(legs[:, 1], legs[:, 0]), np.linalg.norm(legs, axis=1)
    turns = [math.remainder(b - a, 2.0 * math.pi) for a, b in zip(courses, courses[1:], strict=False)]
    radius = None if turn_radius is None else positive("turn_radius", turn_radius)
    rounded = [_corner(angle, joint, number) if radius else None for number, angle in enumerate(turns, 2)]
    cuts = np.array([0.0, *(corner.cut if corner else 0.0 for corner in rounded), 0.0])  # of a radius of 1 m
    if radius:
        _check_room(lengths, cuts, radius)
    path: list[Segment] = []
    for k, (place, course) in enumerate(zip(array, courses, strict=False)):
        before, after = (radius or 0.0) * cuts[k], (radius or 0.0) * cuts[k + 1]
        direction = np.array([math.cos(course), math.sin(course)])
        here = place + before * direction
        rest = float(lengths[k] - before - after)
        if rest > FITS:
            path += _laid(here, float(course), [straight(rest)], f"leg {k + 1}")
        corner = rounded[k] if k < len(rounded) else None
        if corner and radius:
            path += _laid(array[k + 1] - after * direction, float(course), corner.pieces(radius), f"point {k + 2}")
    return tuple(path)


class _Corner:
    """A rounded corner: what it cuts off the legs, per meter of radius, and its pieces."""

    def __init__(self, angle: float, joint: Joint) -> None:
        self.angle, self.joint = angle, joint
        half = chain(Start(), self.pieces(1.0)[: len(self.pieces(1.0)) // 2] if joint == "clothoid" else [])
        if joint == "arc":
            self.cut = math.tan(0.5 * abs(angle))
        else:
            middle = end_of(half[-1])
            self.cut = middle.north + abs(middle.east) * math.tan(0.5 * abs(angle))

    def pieces(self, radius: float) -> list[Segment]:
        """What to lay in a chain for this radius [m]."""
        if self.joint == "arc":
            return [bend(radius, "starboard" if self.angle > 0.0 else "port", abs(self.angle), "turn_radius")]
        tightest, length = math.copysign(1.0 / radius, self.angle), radius * abs(self.angle)
        return clothoid(0.0, tightest, length) + clothoid(tightest, 0.0, length)


def _corner(angle: float, joint: Joint, number: int) -> _Corner | None:
    if abs(angle) < STRAIGHT_ON:
        return None
    if math.pi - abs(angle) < BACK:
        raise GeometryError(
            f"the path turns straight back at point {number}, and no curve leads round that:"
            " add a point beside it, or leave turn_radius out",
            f"point {number}",
        )
    return _Corner(angle, joint)


def _check_room(lengths: np.ndarray, cuts: np.ndarray, radius: float) -> None:
    """Whether the corners at both ends of each leg fit on it."""
    needed = cuts[:-1] + cuts[1:]
    tight = np.flatnonzero(radius * needed > lengths + FITS)
    if tight.size:
        fits = math.floor(min(lengths[k] / needed[k] for k in tight) * 1000.0) / 1000.0
        k = int(tight[np.argmin([lengths[k] / needed[k] for k in tight])])
        raise GeometryError(
            f"turn_radius is {radius:.6g} m, and the leg from point {k + 1} to point {k + 2}, {lengths[k]:.6g} m long,"
            f" is too short for it: its turns need {radius * needed[k]:.6g} m; the largest radius that fits is"
            f" {fits:.3f} m",
            f"leg {k + 1}",
        )


def _laid(place: np.ndarray, course: float, pieces: list[Segment], label: str) -> list[Segment]:
    return [replace(s, label=label) for s in chain(Start(float(place[0]), float(place[1]), course), pieces)]
