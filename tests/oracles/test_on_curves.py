"""Line of sight on curves: row A holds at any curvature; the way along, by the curve's own equation, integrated."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from flying import value_at
from oracles.closed_forms import line_of_sight
from oracles.kinematic import Scene, assert_converges, converged

U, D, A, T0 = 0.5, 5.0, 20.0, 0.4
KNOTS = np.array([[0.0, 0.0], [30.0, 20.0], [60.0, -10.0], [90.0, 30.0]])
Vectors = Callable[[float], np.ndarray]


def eight(t: float) -> np.ndarray:
    """The lemniscate, its first tip to the north, its first turn to starboard."""
    share = A * math.cos(t) / (1.0 + math.sin(t) ** 2)
    return np.array([share, share * math.sin(t)])


def slopes(point: Vectors, t: float) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivative of a curve, by differences of fourth order."""
    h = 1e-3
    before, far_before, after, far_after = point(t - h), point(t - 2 * h), point(t + h), point(t + 2 * h)
    first = (8.0 * (after - before) - (far_after - far_before)) / (12.0 * h)
    second = (16.0 * (after + before) - (far_after + far_before) - 30.0 * point(t)) / (12.0 * h * h)
    return first, second


class Way:
    """A curve by its own equation: tangent, curvature, and flights along it integrated."""

    def __init__(self, point: Vectors, derivatives: Callable[[float], tuple[np.ndarray, np.ndarray]]) -> None:
        self.point, self.derivatives = point, derivatives

    def frame(self, t: float) -> tuple[float, float, float]:
        """|p'|, course and curvature."""
        first, second = self.derivatives(t)
        size = math.hypot(*first)
        return size, math.atan2(first[1], first[0]), (first[0] * second[1] - first[1] * second[0]) / size**3

    def beside(self, t: float, e: float) -> np.ndarray:
        _, course, _ = self.frame(t)
        return self.point(t) + e * np.array([-math.sin(course), math.cos(course)])

    def abeam(self, t: float, e: float, time: float, offset: float = 0.0) -> tuple[float, float]:
        """Parameter and e after a time, beside the parallel at an offset: there u = h v_L, h = 1 - c D.

        t' = u cos(beta) / ((1 - c / h e) h |p'|),  e' = u sin(beta)
        """

        def rates(_: float, x: np.ndarray) -> list[float]:
            size, _, c = self.frame(x[0])
            beta, h = math.atan2(-x[1], D), 1.0 - c * offset
            return [h * U * math.cos(beta) / ((1.0 - c / h * x[1]) * h * size), h * U * math.sin(beta)]

        end = solve_ivp(rates, (0.0, time), [t, e], rtol=1e-10, atol=1e-11).y[:, -1]
        return float(end[0]), float(end[1])

    def chased(self, t: float, place: np.ndarray, k2: float, time: float) -> np.ndarray:
        """Parameter of a virtual target, north and east after a time, in the plane."""

        def rates(_: float, x: np.ndarray) -> list[float]:
            size, course, _ = self.frame(x[0])
            away = x[1:] - self.point(x[0])
            s1 = away[0] * math.cos(course) + away[1] * math.sin(course)
            e = away[1] * math.cos(course) - away[0] * math.sin(course)
            beta = math.atan2(-e, D)
            target = (U * math.cos(beta) + k2 * s1) / size
            return [target, U * math.cos(course + beta), U * math.sin(course + beta)]

        end: np.ndarray = solve_ivp(rates, (0.0, time), [t, *place], rtol=1e-10, atol=1e-11).y[:, -1]
        return end


_chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(KNOTS, axis=0), axis=1))])
_spline = CubicSpline(_chords, KNOTS, bc_type="natural")
WAYS = {
    "lemniscate": Way(eight, lambda t: slopes(eight, t)),
    "spline": Way(lambda t: _spline(t), lambda t: (_spline(t, 1), _spline(t, 2))),
}
STARTS = {"lemniscate": T0, "spline": 0.0}
PATHS = {
    "lemniscate": f"type: lemniscate, centre: {{north: 0, east: 0}}, half_width: {A}, start_parameter: {T0}",
    "spline": f"type: spline, points: [{', '.join(f'{{north: {n}, east: {e}}}' for n, e in KNOTS)}]",
}


def scene(kind: str, e: float, offset: float = 0.0, law: str = "projection", ahead: float = 0.0) -> Scene:
    """A vehicle that starts beside the start of the path."""
    way, t = WAYS[kind], STARTS[kind]
    _, course, _ = way.frame(t)
    north, east = (way.beside(t, offset + e) + ahead * np.array([math.cos(course), math.sin(course)])).tolist()
    heading = float(course) + math.atan2(-e, D)
    start = f"north: {north!r}, east: {east!r}, heading: {heading!r}"
    guidance = f"law: line_of_sight, lookahead: {D!r}, reference_point: {law}"
    return Scene(PATHS[kind], guidance, start, 60.0, U, sensors=f"ideal\n    offset: {{starboard: {offset!r}}}")


@pytest.mark.parametrize("kind", WAYS)
@pytest.mark.parametrize("e", [4.0, -3.0])
def test_a_on_curves(kind: str, e: float) -> None:
    """Row A on a lemniscate and a spline, e(t) and place: by F(e), and by integration on the curve."""
    way, scene_ = WAYS[kind], scene(kind, e)
    for time in (20.0, 60.0):
        t, left = way.abeam(STARTS[kind], e, time)
        assert left == pytest.approx(line_of_sight(e, U, D, time), abs=1e-8)
        north, east = way.beside(t, left)
        assert converged(scene_, lambda f, at=time: value_at(f, "north", at))[0] == pytest.approx(north, abs=2e-5)
        assert converged(scene_, lambda f, at=time: value_at(f, "east", at))[0] == pytest.approx(east, abs=2e-5)
    assert_converges(scene_, lambda f: value_at(f, "cross_track", 20.0), line_of_sight(e, U, D, 20.0))


@pytest.mark.parametrize("kind", WAYS)
@pytest.mark.parametrize("offset", [3.0, -3.0])
def test_beside_their_parallels(kind: str, offset: float) -> None:
    """At 3 m to either side the curvature is c / (1 - c D), the speed (1 - c D) v_L: e and place, integrated."""
    way, scene_ = WAYS[kind], scene(kind, 2.0, offset=offset)
    t, left = way.abeam(STARTS[kind], 2.0, 24.0, offset)
    north, east = way.beside(t, offset + left)
    assert converged(scene_, lambda f: value_at(f, "north", 24.0))[0] == pytest.approx(north, abs=2e-5)
    assert converged(scene_, lambda f: value_at(f, "east", 24.0))[0] == pytest.approx(east, abs=2e-5)
    assert_converges(scene_, lambda f: value_at(f, "cross_track", 24.0), left)


@pytest.mark.parametrize(
    ("kind", "ahead", "e"), [("lemniscate", 3.0, -4.0), ("lemniscate", -6.0, 2.0), ("spline", 3.0, -4.0)]
)
def test_the_virtual_target_on_curves(kind: str, ahead: float, e: float) -> None:
    """(24)-(27) on curves: the place of the vehicle, by integration in the plane with the curve's equation."""
    way, scene_ = WAYS[kind], scene(kind, e, law="virtual_target, target_gain: 0.4", ahead=ahead)
    _, course, _ = way.frame(STARTS[kind])
    place = way.beside(STARTS[kind], e) + ahead * np.array([math.cos(course), math.sin(course)])
    for time in (10.0, 60.0):
        _, north, east = way.chased(STARTS[kind], place, 0.4, time)
        assert converged(scene_, lambda f, at=time: value_at(f, "north", at))[0] == pytest.approx(north, abs=3e-5)
        assert converged(scene_, lambda f, at=time: value_at(f, "east", at))[0] == pytest.approx(east, abs=3e-5)
