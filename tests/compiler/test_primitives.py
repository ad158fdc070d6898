"""Every primitive means the same in plain Python, compiled for one mission, and compiled for eight."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from numba import config, njit
from numba.core.errors import NumbaError

from cardume.compiler import (
    WIDTH,
    Rows,
    at,
    floor,
    gather,
    load,
    negate,
    rows_of,
    scale2,
    scatter,
    some,
    split2,
    sqrt,
    store,
    to_bits,
    to_float,
    where,
)
from compiler.three_ways import OPTIONS, same, three_ways

pytestmark = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
NAN, INF = math.nan, math.inf
LANES = np.arange(WIDTH)


def table(*rows: tuple[float, ...]) -> np.ndarray:
    """(n, 8): each row's numbers, repeated to fill the lanes."""
    return np.array([np.resize(row, WIDTH) for row in rows], float)


PAIRS = table((1.5, -2.0, 0.0, -0.0, NAN, INF, -INF, 1e-320), (3.0, NAN, -0.0, 0.0, NAN, -INF, 2.0, 7.0))


def arithmetic(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    x, y = load(g, 0), load(g, 1)
    store(o, 0, x + y)
    store(o, 1, x - y)
    store(o, 2, x * y)
    store(o, 3, x / (y + 1.0))
    store(o, 4, 2.0 - x)
    store(o, 5, x - 2)
    store(o, 6, -x)
    store(o, 7, abs(y))
    store(o, 8, sqrt(x))
    store(o, 9, floor(x))
    store(o, 10, floor(0.3 * y))
    store(o, 11, 7)
    store(o, 12, 3.0 / (x * x + 1.0))


def test_arithmetic() -> None:
    out = three_ways(arithmetic, PAIRS, 13)
    assert math.isnan(out[8, 1])  # the root of -2
    assert out[8, 3] == 0.0
    assert np.signbit(out[8, 3])  # the root of -0 is -0
    assert out[9, 5] == INF
    assert (out[11] == 7.0).all()


def choices(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    x, y = load(g, 0), load(g, 1)
    store(o, 0, where(x < y, 1.0, 0.0))
    store(o, 1, where(x <= y, 1.0, 0.0))
    store(o, 2, where(x > y, 1.0, 0.0))
    store(o, 3, where(x >= y, 1.0, 0.0))
    store(o, 4, where(x == y, 1.0, 0.0))
    store(o, 5, where(x != y, 1.0, 0.0))
    store(o, 6, where(x == x, 1, 0))
    store(o, 7, where((x > 0.0) & (y > 0.0), x, y))
    store(o, 8, where((x > 0.0) | (y > 0.0), x, y))
    store(o, 9, where(negate(x > 0.0) & (y == y), x, 5.0))
    store(o, 10, where(where(x > 0.0, y > 2.0, x == x), 1.0, 2.0))
    store(o, 11, where(True, x, y))
    store(o, 12, where((x > 0.0) & True, where(False | (y > 0.0), 1.0, 2.0), 3.0))
    store(o, 13, where(1.0 > x, x, 1.0))


def test_comparisons_and_masks_with_nan_infinities_and_signed_zeros() -> None:
    out = three_ways(choices, PAIRS, 14)
    assert out[5, 4] == 1.0  # NaN differs from itself
    assert out[6, 4] == 0.0
    assert out[4, 2] == 1.0  # 0 is -0
    assert out[7, 0] == 1.5
    assert math.isnan(out[7, 1])  # -2 > 0 does not hold


class Pair(NamedTuple):
    """A record."""

    x: float
    y: float


class Tabled(NamedTuple):
    """A record that carries a table."""

    x: float
    rows: Rows


def records(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    x, y = load(g, 0), load(g, 1)
    chosen = where(x > 0.0, Pair(x, 1.0), Pair(y, x))
    store(o, 0, chosen.x)
    store(o, 1, chosen.y)
    mixed = where(x > 0.0, Pair(1.0, 2.0), Pair(3.0, 4.0))
    store(o, 2, mixed.x + 0.0)
    store(o, 3, mixed.y)
    tabled = where(y > 0.0, Tabled(x, at(g, 1)), Tabled(y, at(g, 1)))
    store(o, 4, tabled.x)
    store(o, 5, load(tabled.rows, 0))


def test_where_chooses_records_field_by_field() -> None:
    out = three_ways(records, PAIRS, 6)
    assert out[:4, 0].tolist() == [1.5, 1.0, 1.0, 2.0]
    assert out[3, 1] == 4.0


def asked(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    store(o, 0, 0.0)
    store(o, 1, 0.0)
    if some(load(g, 0) > 2.0):
        store(o, 0, 1.0)
    if some(negate(load(g, 0) == load(g, 0))):
        store(o, 1, 1.0)


@pytest.mark.parametrize("lane", [None, 0, 3, 7])
@pytest.mark.parametrize("value", [3.0, NAN])
def test_some_asks_whether_any_lane_does(lane: int | None, value: float) -> None:
    compiled = njit(**OPTIONS)(asked)
    given, out = np.ones((1, WIDTH)), np.zeros((2, WIDTH))
    if lane is not None:
        given[0, lane] = value
    compiled(given, out)
    expected = [lane is not None and value > 2.0, lane is not None and math.isnan(value)]
    assert out.tolist() == [[float(e)] * WIDTH for e in expected]


def lookups(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    index = load(g, 0)
    store(o, 0, load(at(g, 3), 0))
    store(o, 1, load(at(at(g, 1), 2), 1))
    store(o, 2, gather(at(g, 2), index))
    store(o, 3, gather(g, 4.0))
    scatter(at(o, 4), index, index > 0.5, 9.0 + index)
    scatter(at(o, 4), 3.0, index == index, index)
    scatter(at(o, 8), 1.0, True, 2.5)


def test_tables_are_read_and_written_where_each_lane_says() -> None:
    given = np.vstack([table((0.0, 1.0, 2.0, NAN)), 100.0 * np.arange(1, 6)[:, None] + LANES])
    out = three_ways(lookups, given, 10)
    assert out[0].tolist() == (300.0 + LANES).tolist()
    assert out[1].tolist() == (400.0 + LANES).tolist()
    assert out[2].tolist()[:4] == [200.0, 301.0, 402.0, 203.0]  # a NaN index reads row 0
    assert out[4:8, 1].tolist() == [-7.0, 10.0, -7.0, 1.0]
    assert out[4:8, 3].tolist() == [-7.0] * 4  # no condition holds: nothing is written
    assert out[9].tolist() == [2.5] * WIDTH


def bits(given: np.ndarray, out: np.ndarray) -> None:
    g, o = rows_of(given), rows_of(out)
    x, k, whole = load(g, 0), load(g, 1), load(g, 2)
    store(o, 0, scale2(x, k))
    exponent, mantissa = split2(x)
    store(o, 1, exponent)
    store(o, 2, mantissa)
    word = to_bits(whole)
    store(o, 3, to_float((word * np.uint64(0xD2511F53)) >> np.uint64(32)))
    store(o, 4, to_float((word ^ np.uint64(12345)) & np.uint64(0xFFFFFF)))
    store(o, 5, to_float((word + np.uint64(7)) | np.uint64(1)))
    store(o, 6, to_float((word << np.uint64(2)) >> np.uint64(1)))


def test_bits_of_numbers() -> None:
    given = table(
        (1.0, 3.7, 1e-300, 1e300, 0.7071, 0.70711, 2.0**-1022, 123456.789),
        (0.0, 5.0, -20.0, -900.0, 1.0, -1.0, 1023.0, -3.0),
        (0.0, 1.0, 2.0**32 - 1.0, 12345.0, 2.0**31, 7.0, 1e9, 65535.0),
    )
    out = three_ways(bits, given, 7)
    assert (out[2] * 2.0 ** out[1] == given[0]).all()
    assert ((out[2] >= math.sqrt(0.5)) & (out[2] < math.sqrt(2.0))).all()


def test_a_record_has_as_many_fields_as_its_other_half() -> None:
    def wrong(given: np.ndarray) -> None:
        x = load(rows_of(given), 0)
        store(rows_of(given), 0, where(x > 0.0, Pair(x, x), Tabled(x, rows_of(given))).x)

    with pytest.raises(NumbaError):
        njit(**OPTIONS)(wrong)(np.ones((1, WIDTH)))


def test_the_bits_of_a_lane_do_not_depend_on_the_other_lanes() -> None:
    compiled = njit(**OPTIONS)(arithmetic)
    rng = np.random.default_rng(3)
    given = rng.normal(size=(2, WIDTH))
    out, rolled = np.zeros((13, WIDTH)), np.zeros((13, WIDTH))
    compiled(given, out)
    compiled(np.ascontiguousarray(np.roll(given, 3, axis=1)), rolled)
    assert same(np.roll(out, 3, axis=1), rolled)


def whole_numbers(ints: np.ndarray, out: np.ndarray) -> None:
    numbers = rows_of(ints)
    for k in range(load(numbers, 0)):
        store(rows_of(out), k, gather(at(numbers, 1), k * 1.0) + 0.5)
    store(numbers, 0, load(at(numbers, 2), 0) + 40)


def test_a_table_of_whole_numbers() -> None:
    ints, out = np.array([3, 10, 20, 30]), np.zeros(3)
    njit(**OPTIONS)(whole_numbers)(ints, out)
    assert out.tolist() == [10.5, 20.5, 30.5]
    assert ints[0] == 60
    again, plain = np.array([3, 10, 20, 30]), np.zeros(3)
    whole_numbers(again, plain)
    assert (plain == out).all()
    assert (again == ints).all()


@pytest.mark.parametrize("array", [np.arange(10.0)[::2], np.zeros((4, WIDTH)).T, np.zeros(4, np.float32), np.zeros(())])
def test_only_a_table_without_gaps_has_rows(array: np.ndarray) -> None:
    def first(given: np.ndarray) -> float:
        return load(rows_of(given), 0) * 1.0

    with pytest.raises(NumbaError, match="rows_of"):
        njit(**OPTIONS)(first)(array)
