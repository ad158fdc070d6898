"""A track, given by points, as a path of arcs that a vehicle can follow."""

import math
from collections.abc import Sequence

import numpy as np

from cardume.paths.corner import OwnSegment
from cardume.paths.segment import Segment

NEARLY_STRAIGHT = 1e-9  # [1/m]


def arcs_through(points: np.ndarray, gammas: np.ndarray, speeds: Sequence[float | None]) -> list[OwnSegment]:
    """Two arcs from each point to the next, so that course is continuous: a biarc whose tangents are equally long.

    2 (1 - t_0 . t_1) d^2 + 2 v . (t_0 + t_1) d - v . v = 0

    v leads from one point to the next, t_0 and t_1 are the tangents there, those of the circle through a point and its
    neighbors nearly, and d how long they are to where the arcs' tangents meet.

    Args:
        points: (n, 2) [m] north and east.
        gammas: (n,) [m] what they stand for on the reference path, increasing.
        speeds: (n,) [m/s] of the formation there; None: that of the mission.

    Returns:
        The segments of the own path.
    """
    tangents = np.gradient(points, gammas, axis=0)
    tangents /= np.maximum(np.hypot(*tangents.T), 1e-12)[:, None]
    found: list[OwnSegment] = []
    for k in range(len(points) - 1):
        way, first, last = points[k + 1] - points[k], tangents[k], tangents[k + 1]
        bent, along, square = 1.0 - float(first @ last), float(way @ (first + last)), float(way @ way)
        root = math.sqrt(along * along + 2.0 * bent * square)
        length = square / (along + root)  # the positive root, without cancellation
        joint = 0.5 * (points[k] + points[k + 1] + length * (first - last))
        start = math.atan2(first[1], first[0])
        one = _arc(points[k], joint, start, speeds[k])
        other = _arc(joint, points[k + 1], start + one.curvature * one.length, speeds[k])
        share = (gammas[k + 1] - gammas[k]) / (one.length + other.length)
        found += [OwnSegment(shape=arc, reference_length=share * arc.length) for arc in (one, other)]
    return found


def _arc(start: np.ndarray, end: np.ndarray, course: float, speed: float | None) -> Segment:
    """The arc that leaves one point at a course and passes another."""
    north, east = end - start
    chord = math.hypot(north, east)
    half = math.remainder(math.atan2(east, north) - course, math.tau)  # half of what it turns
    curvature = 2.0 * math.sin(half) / chord
    length = chord * (half / math.sin(half) if abs(half) > 1e-12 else 1.0)
    if abs(curvature) < NEARLY_STRAIGHT:
        curvature, length = 0.0, chord
    return Segment(
        north=float(start[0]), east=float(start[1]), course=course, curvature=curvature, length=length, speed=speed
    )
