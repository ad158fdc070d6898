"""What docs/theory/closed-forms.md lists, written down anew: root finding and quadrature, nothing of the package."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import OdeSolution, solve_ivp
from scipy.optimize import brentq

Rates = Callable[[float, np.ndarray], Sequence[float]]


def line_of_sight(e0: float, u: float, d: float, t: float) -> float:
    """Row A: F(e(t)) = F(e0) - u t, F(e) = sqrt(d^2 + e^2) - d asinh(d / |e|); negative t runs backwards."""

    def potential(log_e: float) -> float:
        e = math.exp(log_e)
        return math.hypot(d, e) - d * math.asinh(d / e)

    target = potential(math.log(abs(e0))) - u * t
    return math.copysign(math.exp(brentq(lambda x: potential(x) - target, -200.0, 50.0, xtol=1e-14, rtol=1e-15)), e0)


def line_of_sight_time(e0: float, e1: float, u: float, d: float) -> float:
    """Row A: how long e takes from e0 to e1."""
    values = [math.hypot(d, e) - d * math.asinh(d / abs(e)) for e in (e0, e1)]
    return (values[0] - values[1]) / u


def line_of_sight_arc_length(e0: float, e: float, c: float, d: float) -> float:
    """Row A2: the arc length after which e0 has become e, from e(s) = e0 E / (1 - c e0 + c e0 E), E = exp(-s / d)."""
    return -d * math.log(e * (1.0 - c * e0) / (e0 * (1.0 - c * e)))


def arcsine(e0: float, u: float, k1: float, t: float, saturation: float = 1.0) -> float:
    """Row B: straight at sat u until |e| = sat u / k1, then exponential."""
    edge = saturation * u / k1
    saturated = max(0.0, (abs(e0) - edge) / (saturation * u))
    if t <= saturated:
        return e0 - math.copysign(saturation * u * t, e0)
    return math.copysign(min(abs(e0), edge), e0) * math.exp(-k1 * (t - saturated))


def solve(rates: Rates, start: Sequence[float], t: float) -> OdeSolution:
    """The solution of an ordinary differential equation from 0 to t."""
    found = solve_ivp(rates, (0.0, t), start, method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
    assert found.success
    return found.sol


def integrate(rates: Rates, start: Sequence[float], t: float) -> np.ndarray:
    """The solution of an ordinary differential equation at t."""
    return solve(rates, start, t)(t)
