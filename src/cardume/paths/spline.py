"""A cubic spline through points: smooth in course and curvature, passing each of them."""

from collections.abc import Sequence

import numpy as np

from cardume.paths.circle import Center
from cardume.paths.segment import GeometryError, ReferencePath
from cardume.paths.tracing import Trace, laps_of, trace


def spline(points: Sequence[Center], *, closed: bool = False, laps: int = 1) -> ReferencePath:
    """The natural cubic spline through points, over the length of their chords; or the periodic one.

    Between points north and east are cubic in t, t the sum of the distances of the points so far; their
    second derivatives are continuous and, at both ends, 0.

    Args:
        points: three or more; no two that follow one another are the same.
        closed: from the last point back to the first.
        laps: [-] how many times round a closed one.

    Returns:
        The reference path; its gamma is arc length, not t.

    Raises:
        GeometryError: too few points, equal ones, numbers that are none, or a bend too sharp to describe.

    Source: C. de Boor, A Practical Guide to Splines (1978), chapter IV; equal to scipy's `CubicSpline` in tests.
    """
    knots = check_points(points, 3, "spline")
    if not closed and laps != 1:
        raise GeometryError(f"laps is {laps}, and a spline that is not closed has one: give closed, or leave laps out")
    if closed:
        if np.array_equal(knots[0], knots[-1]):
            raise GeometryError(
                "the last point is the first, and a closed spline returns there by itself: leave it out"
            )
        knots = np.vstack([knots, knots[:1]])
    steps = np.linalg.norm(np.diff(knots, axis=0), axis=1)
    times = np.concatenate([[0.0], np.cumsum(steps)])
    bends = _second_derivatives(knots, steps, closed)

    def of(t: np.ndarray) -> tuple[np.ndarray, ...]:
        """Interval, its length, and what is left and gone of it, as columns."""
        k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(steps) - 1)
        return k, steps[k][:, None], (times[k + 1] - t)[:, None], (t - times[k])[:, None]

    def point(t: np.ndarray) -> np.ndarray:
        k, h, left, gone = of(t)
        a, b = knots[k] / h - bends[k] * h / 6.0, knots[k + 1] / h - bends[k + 1] * h / 6.0
        found: np.ndarray = (bends[k] * left**3 + bends[k + 1] * gone**3) / (6.0 * h) + a * left + b * gone
        return found

    def derivative(t: np.ndarray) -> np.ndarray:
        k, h, left, gone = of(t)
        chord = (knots[k + 1] - knots[k]) / h
        slope: np.ndarray = (bends[k + 1] * gone**2 - bends[k] * left**2) / (2.0 * h)
        return slope + chord - (bends[k + 1] - bends[k]) * h / 6.0

    laid = trace(Trace(point=point, derivative=derivative, label="spline"), [float(t) for t in times])
    return laps_of(laid, laps) if closed else laid


def check_points(points: Sequence[Center], least: int, kind: str) -> np.ndarray:
    """The points as an array (n, 2), north and east [m].

    Args:
        points: to be passed in turn.
        least: [-] how many there must be.
        kind: of path, for messages.

    Raises:
        GeometryError: too few, two equal ones in a row, or numbers that are none.
    """
    if len(points) < least:
        raise GeometryError(f"{kind} with {len(points)} points; it needs {least} or more")
    array = np.array(points, float)
    for number, place in enumerate(array, 1):
        if not np.isfinite(place).all():
            raise GeometryError(f"point {number} is ({place[0]:g}, {place[1]:g}) m; it must be two finite numbers")
    apart = np.linalg.norm(np.diff(array, axis=0), axis=1)
    for number, distance in enumerate(apart, 1):
        if not distance > 1e-6:
            raise GeometryError(
                f"points {number} and {number + 1} are {distance:.3g} m apart, at north {array[number, 0]:.6g} m,"
                f" east {array[number, 1]:.6g} m; leave one out"
            )
    return array


def _second_derivatives(knots: np.ndarray, steps: np.ndarray, closed: bool) -> np.ndarray:
    """Second derivatives (n, 2) at the knots, which make the first ones continuous."""
    count = len(knots)
    chords = np.diff(knots, axis=0) / steps[:, None]
    if closed:
        n = count - 1
        before, after = np.roll(steps, 1), steps
        matrix = np.zeros((n, n))
        for k in range(n):
            matrix[k, k] += (before[k] + after[k]) / 3.0
            matrix[k, k - 1] += before[k] / 6.0
            matrix[k, (k + 1) % n] += after[k] / 6.0
        inner = np.linalg.solve(matrix, chords - np.roll(chords, 1, axis=0))
        return np.vstack([inner, inner[:1]])
    matrix = np.eye(count)
    for k in range(1, count - 1):
        matrix[k, k - 1 : k + 2] = steps[k - 1] / 6.0, (steps[k - 1] + steps[k]) / 3.0, steps[k] / 6.0
    jumps = np.zeros((count, 2))
    jumps[1:-1] = np.diff(chords, axis=0)
    solved: np.ndarray = np.linalg.solve(matrix, jumps)
    return solved
