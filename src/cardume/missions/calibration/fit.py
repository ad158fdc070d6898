"""Least squares: from steady legs to the relation of shaft speed and speed, and to the current.

Speed through the water, u, from the thrust tau = N c n |n| of the shaft speed n, by (37):

    u(n; s) = s u_0(n)                                  one unknown, the scale; u_0 by the numbers that are believed
    u(n; d, D) = 2 tau / (d + sqrt(d^2 + 4 D tau))      two unknowns, the drag; c cannot be told from d and D

A measured speed gives one row, u_i = u(n_i) + noise. A track gives, on each leg with an unknown beginning p_0,

    p(t) = p_0 + integral of u(n) (cos psi, sin psi) dt + V_c t + noise

two rows for each time, and with the drag or the scale the current V_c. Both are solved by Gauss and Newton's steps:
du / ds = u_0, and from (d + D u) u = tau, du / dd = -u / (d + 2 D u), du / dD = -u^2 / (d + 2 D u). Beginnings are
taken out by subtracting each leg's mean from its rows and columns, which changes no estimate (Frisch and Waugh).

Intervals are 95 %. Noise need not be white, so each half width is the wider of two: by Newey and West's covariance with
Andrews' bandwidth for the residuals' own memory, and by one that takes each leg as one sample, with Student's quantile.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Literal

import numpy as np

from cardume.missions.calibration.track import Numbers, Track

Kind = Literal["scale", "drag"]
MOST_STEPS = 50
QUANTILE = NormalDist().inv_cdf(0.975)
FEWEST_LEGS = 4  # that count as samples


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """What was estimated.

    Attributes:
        kind: which relation.
        values: (m,) scale, or linear and quadratic drag; then the current's north and east parts, if there is a track.
        half_widths: (m,) of the 95 % intervals; infinite where the data cannot tell.
        residual: [m] or [m/s] root mean square of what is left.
        explained: [-] share of the rows' variance.
    """

    kind: Kind
    values: np.ndarray
    half_widths: np.ndarray
    residual: float
    explained: float


def calibrated_speed(thrust: np.ndarray, linear: float, quadratic: float) -> np.ndarray:
    """u = 2 tau / (d + sqrt(d^2 + 4 D |tau|)).

    Args:
        thrust: [N] (n,)
        linear: [N s/m] d.
        quadratic: [N s^2/m^2] D.

    Returns:
        (n,) [m/s]
    """
    root = linear + np.sqrt(linear * linear + 4.0 * quadratic * np.abs(thrust))
    speed: np.ndarray = 2.0 * thrust / np.maximum(root, 1e-12)
    return speed


def fit(legs: Sequence[Track], kind: Kind, is_linear: bool = True) -> Fit:
    """Estimate by least squares.

    Args:
        legs: steady parts of one track, at least one.
        kind: the scale, or the drag.
        is_linear: whether there is linear drag; else it stays 0.
    """
    numbers = legs[0].numbers
    theta = np.array([1.0]) if kind == "scale" else np.array([numbers.linear_drag, numbers.quadratic_drag])
    if kind == "drag" and not is_linear:
        theta[0] = 0.0
    num_current = 0 if legs[0].speed is not None else 2
    beta = np.concatenate([theta, np.zeros(num_current)])
    free = np.ones(len(beta), bool)
    free[0] = is_linear or kind == "scale"
    columns, left = np.zeros((0, 0)), np.zeros(0)
    for _ in range(MOST_STEPS):
        columns, left, _ = _rows(legs, numbers, kind, beta)
        moved = np.linalg.lstsq(columns[:, free] / _sizes(columns[:, free]), left, rcond=1e-9)[0]
        moved = moved / _sizes(columns[:, free])
        if kind == "drag":  # stay where there is some drag
            quadratic = len(moved) - num_current - 1
            moved[quadratic] = max(moved[quadratic], -0.7 * beta[1])
        beta[free] += moved
        if np.all(np.abs(moved) <= 1e-10 * (1.0 + np.abs(beta[free]))):
            break
    if kind == "drag" and is_linear and beta[0] < 0.0:
        return fit(legs, kind, is_linear=False)
    columns, left, groups = _rows(legs, numbers, kind, beta)
    half_widths = np.zeros(len(beta))
    half_widths[free] = _half_widths(columns[:, free], left, groups)
    total = _total(legs)
    return Fit(
        kind=kind,
        values=beta,
        half_widths=half_widths,
        residual=float(np.sqrt(np.mean(left**2))),
        explained=1.0 - float(np.sum(left**2)) / total if total > 0.0 else math.nan,
    )


def _sizes(columns: np.ndarray) -> np.ndarray:
    return np.asarray(np.maximum(np.linalg.norm(columns, axis=0), 1e-300))


def _rows(
    legs: Sequence[Track], numbers: Numbers, kind: Kind, beta: np.ndarray
) -> tuple[np.ndarray, np.ndarray, list[tuple[int, int, int]]]:
    """Columns (n, m), what is left (n,), and of each series of rows its leg, first row and end."""
    parts, rests, groups, first = [], [], [], 0
    for number, leg in enumerate(legs):
        speed, slopes = _speed_and_slopes(leg, numbers, kind, beta)
        series = [(slopes, leg.speed - speed)] if leg.speed is not None else _track_rows(leg, speed, slopes, beta)
        for columns, rest in series:
            parts.append(columns)
            rests.append(rest)
            groups.append((number, first, first + len(rest)))
            first += len(rest)
    return np.concatenate(parts), np.concatenate(rests), groups


def _speed_and_slopes(leg: Track, numbers: Numbers, kind: Kind, beta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    thrust = numbers.thrust(leg.shaft_speed)
    if kind == "scale":
        believed = calibrated_speed(thrust, numbers.linear_drag, numbers.quadratic_drag)
        return beta[0] * believed, believed[:, None]
    speed = calibrated_speed(thrust, beta[0], beta[1])
    stiffness = np.maximum(beta[0] + 2.0 * beta[1] * np.abs(speed), 1e-12)
    return speed, np.column_stack([-speed / stiffness, -speed * np.abs(speed) / stiffness])


def _track_rows(
    leg: Track, speed: np.ndarray, slopes: np.ndarray, beta: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray]]:
    assert leg.heading is not None
    assert leg.north is not None
    assert leg.east is not None
    since, series = leg.time - leg.time[0], []
    along = (np.cos(leg.heading), np.sin(leg.heading))
    for axis, (position, part) in enumerate(zip((leg.north, leg.east), along, strict=True)):
        drift = np.zeros((len(since), 2))
        drift[:, axis] = since
        columns = np.column_stack([*(_integrated(since, slope * part) for slope in slopes.T), drift])
        rest = position - _integrated(since, speed * part) - drift @ beta[-2:]
        series.append((columns - columns.mean(axis=0), rest - rest.mean()))
    return series


def _integrated(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time))])


def _total(legs: Sequence[Track]) -> float:
    if legs[0].speed is not None:
        return float(np.sum((np.concatenate([leg.speed for leg in legs if leg.speed is not None])) ** 2))
    parts = [axis - axis.mean() for leg in legs for axis in (leg.north, leg.east) if axis is not None]
    return float(np.sum(np.concatenate(parts) ** 2))


def _half_widths(columns: np.ndarray, left: np.ndarray, groups: list[tuple[int, int, int]]) -> np.ndarray:
    """Half widths of the intervals; infinite where the columns cannot be told apart."""
    sizes = _sizes(columns)
    scaled = columns / sizes
    count, unknowns = columns.shape
    intercepts = len(groups) if len(groups) > len({g for g, _, _ in groups}) else 0
    if count <= unknowns + intercepts or np.linalg.matrix_rank(scaled, tol=1e-6) < unknowns:
        return np.full(unknowns, math.inf)
    inverse = np.linalg.inv(scaled.T @ scaled)
    scores = scaled * left[:, None]
    few = count / (count - unknowns - intercepts)
    lag = _bandwidth(left, groups)
    memory = sum(_with_memory(scores[first:end], lag) for _, first, end in groups)
    wide = QUANTILE * np.sqrt(np.diag(inverse @ memory @ inverse) * few)
    num_legs = len({leg for leg, _, _ in groups})
    if num_legs >= FEWEST_LEGS:
        sums = np.zeros((num_legs, unknowns))
        for leg, first, end in groups:
            sums[leg] += scores[first:end].sum(axis=0)
        by_leg = inverse @ (sums.T @ sums) @ inverse * num_legs / (num_legs - 1)
        wide = np.maximum(wide, student(num_legs - 1) * np.sqrt(np.diag(by_leg)))
    return np.asarray(wide / sizes)


def _bandwidth(left: np.ndarray, groups: list[tuple[int, int, int]]) -> int:
    """Andrews (1991) for a first-order memory rho: 1.1447 (4 rho^2 / ((1 - rho)^2 (1 + rho)^2) n)^(1/3)."""
    pairs = [(left[first : end - 1], left[first + 1 : end]) for _, first, end in groups]
    power = sum(float(a @ a) for a, _ in pairs)
    rho = sum(float(a @ b) for a, b in pairs) / power if power > 0.0 else 0.0
    rho = min(max(rho, -0.97), 0.97)
    alpha = 4.0 * rho**2 / ((1.0 - rho) ** 2 * (1.0 + rho) ** 2)
    return int(1.1447 * (alpha * len(left)) ** (1.0 / 3.0))


def _with_memory(scores: np.ndarray, lag: int) -> np.ndarray:
    """Newey and West's sum of products of scores up to a lag."""
    total = scores.T @ scores
    for k in range(1, min(lag, len(scores) - 1) + 1):
        product = scores[k:].T @ scores[:-k]
        total = total + (1.0 - k / (lag + 1.0)) * (product + product.T)
    return np.asarray(total)


def student(freedom: int) -> float:
    """The 97.5 % quantile of Student's distribution, by the expansion about the normal one; within 1 % from 3 on.

    Args:
        freedom: [-] degrees of freedom, at least 3.

    Source: Abramowitz & Stegun 26.7.5.
    """
    z, n = QUANTILE, float(freedom)
    terms = (
        (z**3 + z) / 4.0,
        (5.0 * z**5 + 16.0 * z**3 + 3.0 * z) / 96.0,
        (3.0 * z**7 + 19.0 * z**5 + 17.0 * z**3 - 15.0 * z) / 384.0,
    )
    return z + sum(term / n ** (k + 1) for k, term in enumerate(terms))
