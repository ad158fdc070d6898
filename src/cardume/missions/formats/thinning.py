"""Fewer points for the same line, where a recording has more than a path may have."""

from collections.abc import Sequence

import numpy as np

FINEST = 0.05  # [m]


def thin(points: np.ndarray, most: int, fixed: Sequence[int] = ()) -> tuple[list[int], float]:
    """Indices of points that draw the line that all of them draw, to the smallest tolerance at which they fit.

    Args:
        points: [m] (n, 2).
        most: how many may be kept.
        fixed: indices that are kept in any case.

    Returns:
        The indices, and how far [m] the points left out may lie beside the line.
    """
    tolerance = FINEST
    while True:
        kept = simplify(points, tolerance, fixed)
        if len(kept) <= most:
            return kept, tolerance
        tolerance *= 1.5


def simplify(points: np.ndarray, tolerance: float, fixed: Sequence[int] = ()) -> list[int]:
    """Indices of the points that remain when those within the tolerance of their neighbors' line are left out.

    Args:
        points: [m] (n, 2).
        tolerance: [m] > 0.
        fixed: indices that are kept in any case.

    Source: Douglas and Peucker (1973), with distances to the segment, not to its extension.
    """
    kept = np.zeros(len(points), bool)
    ends = sorted({0, len(points) - 1, *fixed})
    kept[ends] = True
    waiting = list(zip(ends, ends[1:], strict=False))
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        distances = _beside(points[first + 1 : last], points[first], points[last])
        farthest = int(np.argmax(distances))
        if distances[farthest] > tolerance:
            middle = first + 1 + farthest
            kept[middle] = True
            waiting += [(first, middle), (middle, last)]
    return [int(index) for index in np.flatnonzero(kept)]


def _beside(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distances [m] of points from a line segment."""
    along = end - start
    squared = float(along @ along)
    share = np.clip((points - start) @ along / squared, 0.0, 1.0) if squared > 0.0 else np.zeros(len(points))
    off = points - start - share[:, None] * along
    distances: np.ndarray = np.hypot(off[:, 0], off[:, 1])
    return distances
