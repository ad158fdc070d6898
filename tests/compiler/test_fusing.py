"""Products that feed a sum are rounded once: where, where not, and the same in lanes."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from numba import config, njit

from cardume.compiler import compiled, load, polynomial, rows_of, store, turned
from compiler.three_ways import three_ways

pytestmark = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="plain Python rounds twice")

A, B, C, D = 1.0 + 2.0**-30, 1.0 - 2.0**-30, -1.0, 1.0 + 2.0**-29  # A B = 1 - 2^-60 rounds to 1
ONCE = float(Fraction(A) * Fraction(B) + Fraction(C))
FUSED, TWICE = -(2.0**-60), 0.0


@compiled
def sums(a: float, b: float, c: float, d: float) -> tuple[float, ...]:
    named = a * b
    total = c
    total += a * b
    return (
        a * b + c,
        c + a * b,
        a * b - -c,
        -c - a * b,
        total,
        (a * b + c) + d * 0.0,
        named + c,  # another expression
        a * b - d * d,  # both sides are products
        a * a - a * a,
    )


WANTED = [FUSED, FUSED, FUSED, -FUSED, FUSED, FUSED, TWICE, A * B - D * D, 0.0]


@njit
def scalar_sums(a: float, b: float, c: float, d: float) -> tuple[float, ...]:
    return sums(a, b, c, d)


def test_one_expression_is_rounded_once() -> None:
    assert ONCE == FUSED
    assert list(scalar_sums(A, B, C, D)) == WANTED


def test_branches_and_loops_and_what_is_read_twice() -> None:
    @compiled
    def mixed(a: float, b: float, c: float, x: float) -> float:
        total = 0.0
        for _ in range(3):
            total = total * b + a if x > 0.0 else a * b - total
        return total if a * b < c * c < a * b + c else -total

    @njit
    def call(a: float, b: float, c: float, x: float) -> float:
        return mixed(a, b, c, x)

    for x in (1.0, -1.0):
        assert call(1.5, 2.0, 3.0, x) == mixed(1.5, 2.0, 3.0, x)  # exact numbers
        assert call(1.5, 2.0, -1.0, x) == mixed(1.5, 2.0, -1.0, x)


def test_whole_numbers_stay_whole() -> None:
    @compiled
    def place(row: int, width: int, column: int) -> int:
        return row * width + column

    @njit
    def call(row: int, width: int, column: int) -> int:
        return place(row, width, column)

    assert call(2**40, 2**13, 1) == 2**53 + 1  # no float64 holds it


def test_other_peoples_code_is_left_alone() -> None:
    @njit
    def theirs(a: float, b: float, c: float) -> float:
        return a * b + c

    assert theirs(A, B, C) == TWICE


def fused_in_rows(given: np.ndarray, out: np.ndarray) -> None:
    table, target = rows_of(given), rows_of(out)
    a, b, c, d = load(table, 0), load(table, 1), load(table, 2), load(table, 3)
    first, second, third, fourth, fifth, sixth, seventh, eighth, ninth = sums(a, b, c, d)
    store(target, 0, first)
    store(target, 1, second + fifth)
    store(target, 2, third + sixth)
    store(target, 3, fourth + seventh)
    store(target, 4, eighth + ninth)
    store(target, 5, cubic(a))
    sine, cosine = turned(6755399441055744.0 + 0.0 * a, b, c)
    store(target, 6, sine)
    store(target, 7, cosine)


cubic = polynomial(1.0, -0.5, 0.25, 3.0)


def test_lanes_give_the_same_bits() -> None:
    given = np.random.default_rng(3).normal(size=(4, 8))
    out = three_ways(fused_in_rows, given, 8)
    assert out[5] == pytest.approx(1.0 - 0.5 * given[0] + 0.25 * given[0] ** 2 + 3.0 * given[0] ** 3, rel=1e-13)


@pytest.mark.parametrize("quarters", range(-9, 10))
def test_quarter_turns(quarters: int) -> None:
    @njit
    def turn(raised: float, sine: float, cosine: float) -> tuple[float, float]:
        return turned(raised, sine, cosine)

    raised, turns = 1.5 * 2.0**52 + quarters, np.array([[0, 1], [-1, 0]])
    wanted = np.linalg.matrix_power(turns, quarters % 4) @ [0.6, 0.8]
    assert list(turn(raised, 0.6, 0.8)) == list(turned(raised, 0.6, 0.8)) == wanted.tolist()
