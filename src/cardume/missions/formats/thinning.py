"""Fewer points for the same line, where a recording has more than a path may have."""

from collections.abc import Sequence

import numpy as np

FINEST = 0.05  # [m]


def thin(points: np.ndarray, most: int, fixed: Sequence[int] = ()) -> tuple[list[int], float]:
    """Indices of points that draw the line that all of them draw, to the smallest tolerance at which they fit.

    Args:
        points: [m] (n, 2).
        most: how many may be kept, more than are fixed.
        fixed: indices that are kept in any case.

    Returns:
        The indices, and how far [m] the points left out may lie beside the line.
    """
    worth = significance(points, fixed)
    tolerance = max(FINEST, float(np.sort(worth)[::-1][most]) if len(points) > most else 0.0)
    return [int(index) for index in np.flatnonzero(worth > tolerance)], tolerance


def significance(points: np.ndarray, fixed: Sequence[int] = ()) -> np.ndarray:
    """The tolerance [m] (n,) below which each point is kept: its distance from the line that leaves it out.

    A line is split at its farthest point, and its parts in turn; a point is never worth more than the one
    at which its line was split off.  What is worth less than the finest tolerance is not told apart.

    Args:
        points: [m] (n, 2).
        fixed: indices that are kept in any case.

    Source: Douglas and Peucker (1973), with distances to the segment, not to its extension.
    """
    worth = np.zeros(len(points))
    ends = sorted({0, len(points) - 1, *fixed})
    worth[ends] = np.inf
    waiting = [(first, last, np.inf) for first, last in zip(ends, ends[1:], strict=False)]
    while waiting:
        first, last, limit = waiting.pop()
        if last - first < 2:
            continue
        distances = _beside(points[first + 1 : last], points[first], points[last])
        farthest = int(np.argmax(distances))
        limit = min(float(distances[farthest]), limit)
        if limit > FINEST:
            middle = first + 1 + farthest
            worth[middle] = limit
            waiting += [(first, middle, limit), (middle, last, limit)]
    return worth


def _beside(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distances [m] of points from a line segment."""
    along = end - start
    squared = float(along @ along)
    share = np.clip((points - start) @ along / squared, 0.0, 1.0) if squared > 0.0 else np.zeros(len(points))
    off = points - start - share[:, None] * along
    distances: np.ndarray = np.hypot(off[:, 0], off[:, 1])
    return distances
