"""Least-squares adjustment of a chain of lines and arcs, as a surveyor adjusts a traverse.

Lengths, curvatures and the angles of corners are chosen so that the chain passes as near as possible
to given points, while it stays continuous in position and, between corners, in course.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cardume.paths.segment import PathPoint, Segment, end_of

WINDOW, LOOKAHEAD = 96, 16  # segments adjusted at once; what lies further ahead no longer matters

Point = tuple[float, float]
Marks = Sequence[Point]


def adjust_chain(rough: list[Segment], corners: list[float], given: Sequence[Marks]) -> list[Segment]:
    """Make a chain continuous and as near as possible to given points.

    Window after window, each going on from the last and looking past its own end: time grows with length.

    Args:
        rough: the segments as they would be alone.
        corners: [rad] the angle of each joint that is a corner; 0 where it is to be smooth.
        given: start, end and, of an arc, center of each segment [m], north and east.

    Returns:
        The segments, adjusted.
    """
    fitted: list[Segment] = []
    for first in range(0, len(rough), WINDOW):
        part = slice(first, first + WINDOW + LOOKAHEAD)
        traverse = Traverse(rough[part], corners[part], given[part])
        if fitted:
            traverse.hold(end_of(fitted[-1]), is_corner=corners[first - 1] != 0.0)
        fitted += traverse.adjust()[:WINDOW]
    return fitted


class Traverse:
    """A chain described by as few numbers as it has freedoms, so that it cannot help being continuous.

    The freedoms: first point and course, the lengths, the curvatures of arcs, the angles of corners.
    """

    def __init__(self, rough: list[Segment], corners: list[float], given: Sequence[Marks]) -> None:
        self.rough = rough
        self.is_arc = np.array([s.curvature != 0.0 for s in rough])
        corners = corners[: len(rough) - 1]
        self.is_corner = np.array([False, *(angle != 0.0 for angle in corners)])
        self.given = np.concatenate(list(given))
        curvatures = [s.curvature for s in rough if s.curvature]
        turns = [angle for angle in corners if angle]
        first = [rough[0].north, rough[0].east, rough[0].course]
        self.freedoms = np.array([*first, *(s.length for s in rough), *curvatures, *turns])
        self.held = 0

    def hold(self, place: PathPoint, is_corner: bool) -> None:
        """Go on where the part before ended and, unless at a corner, in its direction."""
        turn = math.remainder(place.course - self.freedoms[2], 2.0 * math.pi)
        self.held = 3
        self.freedoms[:3] = place.north, place.east, self.freedoms[2] + (0.0 if is_corner else turn)

    def adjust(self) -> list[Segment]:
        """Gauss-Newton; from rounded points it takes a few steps."""
        x = self.freedoms.copy()
        for _ in range(20):
            misfit = (self.marks(x) - self.given).ravel()
            slopes = self.slopes(x)
            step = np.linalg.solve(slopes.T @ slopes, slopes.T @ misfit)
            x[self.held :] -= step
            if np.abs(step).max() < 1e-6:
                break
        return self.chain(x)

    def slopes(self, x: np.ndarray) -> np.ndarray:
        """How the marks move with each freedom that is not held, by central differences.

        Args:
            x: [any] (freedoms,).

        Returns:
            [any] (2 marks, freedoms that are not held).
        """
        columns = []
        for k in range(self.held, len(x)):
            nudge = np.zeros(len(x))
            nudge[k] = 1e-6
            columns.append(((self.marks(x + nudge) - self.marks(x - nudge)) / 2e-6).ravel())
        return np.column_stack(columns)

    def _split(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Lengths, curvatures and the course at the start of each segment."""
        count = len(self.rough)
        lengths, curvatures, turns = x[3 : 3 + count], np.zeros(count), np.zeros(count)
        curvatures[self.is_arc] = x[3 + count : 3 + count + self.is_arc.sum()]
        turns[self.is_corner] = x[len(x) - self.is_corner.sum() :]
        turned = np.concatenate([[0.0], np.cumsum(lengths * curvatures)[:-1]])
        return lengths, curvatures, x[2] + turned + np.cumsum(turns)

    def marks(self, x: np.ndarray) -> np.ndarray:
        """The points that the file gives, where the chain has them.

        Args:
            x: [any] (freedoms,).

        Returns:
            [m] (marks, 2) north, east.
        """
        lengths, curvatures, courses = self._split(x)
        curved = self.is_arc
        radii = 1.0 / np.where(curved, curvatures, 1.0)
        ahead = np.where(curved, radii * np.sin(curvatures * lengths), lengths)
        aside = np.where(curved, 2.0 * radii * np.sin(0.5 * curvatures * lengths) ** 2, 0.0)
        unit = np.column_stack([np.cos(courses), np.sin(courses)])
        across = np.column_stack([-unit[:, 1], unit[:, 0]])
        nodes = x[:2] + np.cumsum(ahead[:, None] * unit + aside[:, None] * across, axis=0)
        starts = np.vstack([x[:2], nodes[:-1]])
        marks = np.stack([starts, nodes, starts + radii[:, None] * across], axis=1)
        wanted = np.column_stack([np.ones_like(curved), np.ones_like(curved), curved])
        return marks[wanted.astype(bool)]

    def chain(self, x: np.ndarray) -> list[Segment]:
        """The segments.

        Args:
            x: [any] (freedoms,).
        """
        lengths, curvatures, courses = self._split(x)
        path: list[Segment] = []
        north, east = float(x[0]), float(x[1])
        for rough, length, curvature, course in zip(self.rough, lengths, curvatures, courses, strict=True):
            path.append(
                replace(
                    rough,
                    north=north,
                    east=east,
                    course=float(course),
                    curvature=float(curvature),
                    length=float(length),
                )
            )
            north, east, _ = end_of(path[-1])
        return path
