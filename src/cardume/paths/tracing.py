"""From a curve given by a parameter, or by its curvature, to segments of which arc length is the variable."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cardume.paths.curve import BETWEEN, NODES, Curve, fit_curve, fits, fits_speed
from cardume.paths.segment import GeometryError, ReferencePath, Segment
from cardume.paths.table import MAX_SEGMENTS

MOST_TURNED = 1.0  # [rad] within a segment: the search for the foot of a vehicle counts on it
HALVINGS = 24
CUSP = 1e-9  # of the largest derivative: below it there is none
ABSCISSAE, WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True, slots=True, kw_only=True)
class Trace:
    """A smooth curve with a parameter t.

    Attributes:
        point: t (n,) to north and east [m] (n, 2).
        derivative: t (n,) to d/dt of that (n, 2), never 0.
        speed: t (n,) to v_L [m/s] (n,); None: the formation's.
        label: for messages.
    """

    point: Callable[[np.ndarray], np.ndarray]
    derivative: Callable[[np.ndarray], np.ndarray]
    speed: Callable[[np.ndarray], np.ndarray] | None = None
    label: str = ""


def trace(curve: Trace, ends: Sequence[float]) -> ReferencePath:
    """Segments along a curve, halved until each is described to the last digits.

    Args:
        curve: what is traced.
        ends: [any] of the parameter, increasing; between two the curve is analytic.

    Raises:
        GeometryError: a bend too sharp to describe, or too many segments.
    """
    _refuse_cusps(curve, np.array(ends, float))
    found: list[Segment] = []
    waiting = [(a, b, 0) for a, b in zip(ends, ends[1:], strict=False)][::-1]
    while waiting:
        low, high, halvings = waiting.pop()
        piece = _piece(curve, low, high)
        if piece is None and halvings == HALVINGS:
            raise _too_sharp(curve, low)
        if piece is None:
            middle = 0.5 * (low + high)
            waiting += [(middle, high, halvings + 1), (low, middle, halvings + 1)]
        else:
            found.append(piece)
        if len(found) + len(waiting) > MAX_SEGMENTS:
            raise GeometryError(
                f"the {curve.label or 'curve'} needs more than {MAX_SEGMENTS} pieces: split the mission", curve.label
            )
    return tuple(found)


def _refuse_cusps(curve: Trace, ends: np.ndarray) -> None:
    """Where the derivative is 0 the curve turns back on itself: between two pieces, nobody else would see it."""
    slopes = np.linalg.norm(curve.derivative(ends), axis=1)
    for t in ends[slopes < CUSP * slopes.max()]:
        raise _too_sharp(curve, float(t))


def _too_sharp(curve: Trace, t: float) -> GeometryError:
    north, east = curve.point(np.array([t]))[0]
    return GeometryError(
        f"the {curve.label or 'curve'} turns too sharply near north {north:.6g} m, east {east:.6g} m:"
        " move the points there apart, or leave one out",
        curve.label,
    )


def _lengths(curve: Trace, low: float, high: np.ndarray) -> np.ndarray:
    """Arc lengths [m] (n,) from the parameter `low` to each of `high` (n,), by Gauss and Legendre."""
    half = 0.5 * (high - low)
    nodes = low + half[:, None] * (1.0 + ABSCISSAE)
    slopes = np.linalg.norm(curve.derivative(nodes.ravel()), axis=1).reshape(nodes.shape)
    lengths: np.ndarray = half * (slopes @ WEIGHTS)
    return lengths


def _piece(curve: Trace, low: float, high: float) -> Segment | None:
    """One segment between two values of the parameter; None where that is too much for one."""
    middle = 0.5 * (low + high)
    (length,) = _lengths(curve, low, np.array([high]))
    halves = _lengths(curve, low, np.array([middle]))[0] + _lengths(curve, middle, np.array([high]))[0]
    if not abs(length - halves) <= 1e-13 * length:
        return None
    wanted = length * np.concatenate([NODES, BETWEEN])
    t = low + (high - low) * np.concatenate([NODES, BETWEEN])
    with np.errstate(divide="ignore", invalid="ignore"):  # a cusp has no slope there; its turn is refused below
        for _ in range(30):
            slopes = np.linalg.norm(curve.derivative(t), axis=1)
            step = (_lengths(curve, low, t) - wanted) / slopes
            t = np.clip(t - step, low, high)
            if abs(step * slopes).max() < 1e-14 * length:
                break
    north, east = curve.derivative(t).T
    courses = np.arctan2(east, north)
    turned = np.arctan2(np.sin(courses - courses[0]), np.cos(courses - courses[0]))
    if not abs(turned).max() < MOST_TURNED:
        return None
    speed = curve.speed(t) if curve.speed else None
    count = len(NODES)
    made = fit_curve(turned[:count], float(length), None if speed is None else speed[:count])
    points = curve.point(t)
    (ahead, starboard) = _in_axes(points[count:] - points[0], courses[0])
    if not fits(made, turned[count:], ahead, starboard, 1e-14 * float(abs(points).max())):
        return None
    if speed is not None and not fits_speed(made, speed[count:]):
        return None
    return _segment(made, (points[0, 0], points[0, 1], courses[0]), curve.label)


def _in_axes(vectors: np.ndarray, course: float) -> tuple[np.ndarray, np.ndarray]:
    north, east = vectors.T
    return north * math.cos(course) + east * math.sin(course), east * math.cos(course) - north * math.sin(course)


def _segment(curve: Curve, start: tuple[float, float, float], label: str) -> Segment:
    north, east, course = (float(x) for x in start)
    return Segment(north=north, east=east, course=course, curvature=0.0, length=curve.length, label=label, curve=curve)


def clothoid(first: float, last: float, length: float) -> list[Segment]:
    """A curve whose curvature changes evenly, to lay in a `chain`.

    chi(s) = c_0 s + (c_1 - c_0) s^2 / (2 L)

    Args:
        first: [1/m] curvature c_0 at its start, > 0 to starboard.
        last: [1/m] c_1 at its end.
        length: [m] L > 0.

    Returns:
        One segment or, where it turns far, several.
    """
    most = max(abs(first), abs(last)) * length
    count = max(1, math.ceil(most / (0.8 * MOST_TURNED)))
    share = np.linspace(0.0, 1.0, count + 1)
    bends = first + (last - first) * share
    step = length / count
    made = []
    for before, after in zip(bends, bends[1:], strict=False):
        s = step * NODES
        made.append(fit_curve(before * s + (after - before) * s * s / (2.0 * step), step))
    return [_segment(curve, (0.0, 0.0, 0.0), "") for curve in made]


def laps_of(round_trip: ReferencePath, laps: int) -> ReferencePath:
    """A closed path flown several times; before its start and past its end it goes on as one lap more.

    Args:
        round_trip: that ends where it begins.
        laps: [-] at least 1.

    Raises:
        GeometryError: not a whole number of laps, or too many.
    """
    if laps != int(laps) or laps < 1:
        raise GeometryError(f"laps is {laps}; it is a whole number, 1 or more")
    most = MAX_SEGMENTS // len(round_trip) - 2
    if laps > most:
        raise GeometryError(f"laps is {laps}; at most {most} of this path fit: split the mission")
    beyond = tuple(replace(segment, beyond=True) for segment in round_trip)
    return beyond + round_trip * int(laps) + beyond
