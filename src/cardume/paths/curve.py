"""A piece of a smooth curve, as polynomials in the share tau of its arc length that has gone by.

The turned angle is interpolated where Chebyshev would; its cosine and sine, interpolated there too
and integrated, give the place.  A piece that bends little is so described to the last digits, and
its arc length is the polynomials' own variable: nothing has to be inverted in flight.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from cardume.paths.table import DEGREE, PLACE_DEGREE


def _powers_of_chebyshev(count: int) -> np.ndarray:
    """Row k: what multiplies 1, tau, tau^2, ... in Chebyshev's polynomial k of 2 tau - 1; whole numbers, exact."""
    rows = np.zeros((count, count))
    rows[0, 0], rows[1, :2] = 1.0, (-1.0, 2.0)
    for k in range(2, count):
        rows[k, 1:] = 4.0 * rows[k - 1, :-1]
        rows[k] -= 2.0 * rows[k - 1] + rows[k - 2]
    return rows


NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)  # of tau; both ends are among them
BETWEEN = 0.5 * (NODES[1:] + NODES[:-1])  # where a fit is judged
_TO_POWERS = _powers_of_chebyshev(PLACE_DEGREE + 1)
_TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(2.0 * NODES - 1.0, DEGREE))

Coefficients = tuple[float, ...]
Function = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """How a curve bends, in the axes of its start; each polynomial is what multiplies tau, tau^2, ...

    Attributes:
        length: [m]
        turned: [rad] by which the course changes.
        ahead, starboard: [m] place.
        bends: [1/m] least and greatest curvature, > 0 to starboard.
        speed: [m/s] v_L at its start; None: the formation's.
        gained_speed: [m/s] v_L less that.
    """

    length: float
    turned: Coefficients
    ahead: Coefficients
    starboard: Coefficients
    bends: tuple[float, float]
    speed: float | None = None
    gained_speed: Coefficients = (0.0,) * DEGREE

    @property
    def whole_turn(self) -> float:
        """Angle [rad] from its start to its end, > 0 to starboard."""
        return math.fsum(self.turned)

    def at(self, arc_length: float) -> tuple[float, float, float]:
        """The point at an arc length, extended straight beyond both ends.

        Args:
            arc_length: [m] from its start.

        Returns:
            Place ahead and to starboard [m], turned angle [rad].
        """
        tau = min(max(arc_length / self.length, 0.0), 1.0)
        beyond = arc_length - tau * self.length
        ahead, starboard, turned = (_value(c, tau) for c in (self.ahead, self.starboard, self.turned))
        return ahead + beyond * math.cos(turned), starboard + beyond * math.sin(turned), turned

    def own_at(self, arc_length: float, offset: float) -> tuple[float, float, float]:
        """The same on the parallel curve, in the axes of its own start.

        Args:
            arc_length: [m] from its start, on the parallel curve.
            offset: [m] to starboard.
        """
        ahead, starboard, turned = self.at(self._abeam(arc_length, offset))
        return ahead - offset * math.sin(turned), starboard + offset * (math.cos(turned) - 1.0), turned

    def _abeam(self, own: float, offset: float) -> float:
        """Arc length s with s - offset * turned = own, by bisection: s grows with it."""
        if offset == 0.0:
            return own
        whole = self.length - offset * self.whole_turn
        if not 0.0 < own < whole:
            return own if own <= 0.0 else own - whole + self.length
        low, high = 0.0, 1.0
        for _ in range(60):
            tau = 0.5 * (low + high)
            short = tau * self.length - offset * _value(self.turned, tau) < own
            low, high = (tau, high) if short else (low, tau)
        return 0.5 * (low + high) * self.length

    def along(self, tau: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Many points at once.

        Args:
            tau: [-] (n,) shares of the length.

        Returns:
            Each (n,): place ahead and to starboard [m], turned angle [rad], curvature [1/m].
        """
        ahead, starboard, turned = (
            polynomial.polyval(tau, [0.0, *c]) for c in (self.ahead, self.starboard, self.turned)
        )
        return ahead, starboard, turned, polynomial.polyval(tau, polynomial.polyder([0.0, *self.turned])) / self.length

    def speed_along(self, tau: np.ndarray) -> np.ndarray:
        """v_L [m/s] (n,), or what it gains where the curve has none of its own.

        Args:
            tau: [-] (n,) shares of the length.
        """
        speed: np.ndarray = polynomial.polyval(tau, [self.speed or 0.0, *self.gained_speed])
        return speed


def _value(coefficients: Coefficients, tau: float) -> float:
    total = 0.0
    for coefficient in reversed(coefficients):
        total = total * tau + coefficient
    return total * tau


def fit_curve(turned: np.ndarray, length: float, speed: np.ndarray | None = None) -> Curve:
    """The curve through turned angles; `NODES` says where.

    Args:
        turned: [rad] (nodes,) angle since the start at the nodes.
        length: [m]
        speed: [m/s] (nodes,) v_L at the nodes; None: the formation's.
    """
    powers = _without_start(_TO_CHEBYSHEV @ turned, DEGREE)
    waves = np.cos(turned), np.sin(turned)
    ahead, starboard = (length * chebyshev.chebint(_TO_CHEBYSHEV @ wave, lbnd=-1.0, scl=0.5) for wave in waves)
    gained = (0.0,) * DEGREE if speed is None else _without_start(_TO_CHEBYSHEV @ speed, DEGREE)
    return Curve(
        length=length,
        turned=powers,
        ahead=_without_start(ahead, PLACE_DEGREE),
        starboard=_without_start(starboard, PLACE_DEGREE),
        bends=bends_of_turn(powers, length),
        speed=None if speed is None else float(speed[0]),
        gained_speed=gained,
    )


def fits(curve: Curve, turned: np.ndarray, ahead: np.ndarray, starboard: np.ndarray, rounding: float) -> bool:
    """Whether a curve passes through what was not used to make it, to 1e-11.

    Args:
        curve: the fit.
        turned: [rad] (places,) angle at `BETWEEN`.
        ahead: [m] (places,) place there.
        starboard: [m] (places,)
        rounding: [m] of the coordinates.
    """
    room = 1e-11 * max(1.0, curve.length) + rounding
    found_ahead, found_starboard, found_turned, _ = curve.along(BETWEEN)
    angles, places = abs(found_turned - turned), np.hypot(found_ahead - ahead, found_starboard - starboard)
    return bool(angles.max() < 1e-11 and places.max() < room)


def fits_speed(curve: Curve, speed: np.ndarray) -> bool:
    """Whether the speed of a fit is right between its nodes, to 1e-10 m/s.

    Args:
        curve: the fit.
        speed: [m/s] (places,) v_L at `BETWEEN`.
    """
    return bool(abs(curve.speed_along(BETWEEN) - speed).max() < 1e-10)


def _without_start(coefficients: np.ndarray, degree: int) -> Coefficients:
    powers = coefficients @ _TO_POWERS[: len(coefficients)]
    return tuple(float(c) for c in powers[1 : degree + 1])


def bends_of_turn(turned: Coefficients, length: float) -> tuple[float, float]:
    """Least and greatest curvature [1/m] of a curve.

    Args:
        turned: [rad] what multiplies tau, tau^2, ...
        length: [m]
    """
    bends = polynomial.polyder([0.0, *turned]) / length
    turns = polynomial.polyroots(np.trim_zeros(polynomial.polyder(bends), "b")) if bends[1:].any() else np.zeros(0)
    inside = [z.real for z in np.atleast_1d(turns) if 0.0 < z.real < 1.0]
    values = polynomial.polyval(np.array([0.0, 1.0, *inside, *BETWEEN]), bends)
    return float(values.min()), float(values.max())
