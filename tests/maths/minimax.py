"""Where the polynomial coefficients of `cardume.maths.elementary` come from: Remez exchange in 40 digits.

Run `python tests/maths/minimax.py` to print them; `test_elementary.py` compares them with the ones in the source.
"""

from collections.abc import Callable
from typing import NamedTuple

from mpmath import asin, atan, atanh, cos, coth, fdot, lu_solve, matrix, mp, mpf, pi, sin, sqrt, tan

DIGITS = 40
GRID = 200


class Approximation(NamedTuple):
    """Find p with `num_terms` coefficients that makes max |p(z) - wanted(z)| weight(z) least, 0 < z <= end."""

    wanted: Callable
    weight: Callable
    end: Callable
    num_terms: int


APPROXIMATIONS = {
    # sin y = y + y z p(z), z = y y; the error is relative to sin y
    "SIN": Approximation(lambda z: (sin(sqrt(z)) / sqrt(z) - 1) / z, lambda z: z, lambda: (pi / 4) ** 2, 6),
    # cos y = 1 - z / 2 + z z p(z)
    "COS": Approximation(lambda z: (cos(sqrt(z)) - 1 + z / 2) / z**2, lambda z: z * z, lambda: (pi / 4) ** 2, 6),
    # r coth(r / 2) = 2 + z p(z), z = r r, from which exp r and tanh(r / 2) follow
    "COTH": Approximation(
        lambda z: (sqrt(z) * coth(sqrt(z) / 2) - 2) / z, lambda z: z / 2, lambda: (mp.ln2 * 0.51) ** 2, 5
    ),
    # 2 artanh s = 2 s + s z p(z), z = s s
    "ARTANH": Approximation(
        lambda z: (2 * atanh(sqrt(z)) / sqrt(z) - 2) / z, lambda z: z / 2, lambda: (3 - 2 * sqrt(2)) ** 2, 7
    ),
    # atan t = t - t z p(z), z = t t
    "ATAN": Approximation(lambda z: (1 - atan(sqrt(z)) / sqrt(z)) / z, lambda z: z, lambda: tan(pi / 8) ** 2, 11),
    # asin s = s + s z p(z), z = s s
    "ASIN": Approximation(lambda z: (asin(sqrt(z)) / sqrt(z) - 1) / z, lambda z: z, lambda: mpf(1) / 4, 12),
}


def coefficients(name: str) -> tuple[list[float], float]:
    """Minimax coefficients (lowest power first, rounded to float64) and the weighted error before rounding."""
    with mp.workdps(DIGITS):
        task = APPROXIMATIONS[name]
        end, size = task.end(), task.num_terms
        nodes = [end * (1 - mp.cos(pi * (k + 1) / (size + 1))) / 2 for k in range(size + 1)]
        grid = [end * (1 - mp.cos(pi * k / GRID)) / 2 for k in range(1, GRID + 1)]
        wanted, weight = [task.wanted(z) for z in grid], [task.weight(z) for z in grid]
        for _ in range(12):
            solution = _level(task, nodes, size)
            powers = list(solution[:size])
            errors = [
                (fdot((c, z**k) for k, c in enumerate(powers)) - f) * w
                for z, f, w in zip(grid, wanted, weight, strict=True)
            ]
            nodes = _alternating_peaks(grid, errors)
            if len(nodes) != size + 1:
                raise ArithmeticError(f"{name}: {len(nodes)} peaks instead of {size + 1}")
        return [float(c) for c in powers], float(max(abs(e) for e in errors))


def _level(task: Approximation, nodes: list, size: int):
    """Solve sum c_k z^k + (-1)^i E / weight = wanted at the nodes."""
    rows = [[z**k for k in range(size)] + [(-1) ** i / task.weight(z)] for i, z in enumerate(nodes)]
    return lu_solve(matrix(rows), matrix([task.wanted(z) for z in nodes]))


def _alternating_peaks(grid: list, errors: list) -> list:
    """The place of the largest error in each run of equal sign."""
    peaks, best = [], 0
    for k in range(1, len(grid)):
        if errors[k] * errors[best] < 0:
            peaks.append(grid[best])
            best = k
        elif abs(errors[k]) > abs(errors[best]):
            best = k
    return [*peaks, grid[best]]


if __name__ == "__main__":
    for each in APPROXIMATIONS:
        values, error = coefficients(each)
        print(f"{each} = {tuple(values)}  # error {error:.1e}")
