"""Records in tables: raw indices live in `Layout` alone, so they are checked here, three ways."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from numba import config

from cardume.compiler import WIDTH, Layout, compiled, load, passing, rows_of, store, value_of, where
from compiler.three_ways import three_ways


class First(NamedTuple):
    """Three numbers."""

    a: float = 1.0
    b: float = 2.0
    c: float = 3.0


class Second(NamedTuple):
    """Two more."""

    d: float = 4.0
    e: float = 5.0


BOTH = Layout(First, Second)
get_first, put_first = BOTH.reader(First), BOTH.writer(First)
get_second, put_second = BOTH.reader(Second), BOTH.writer(Second)
pick_second = BOTH.picker(Second)
view_first = BOTH.viewer(First)


def test_a_layout_puts_records_one_after_the_other() -> None:
    assert BOTH.width == 5
    assert BOTH.offsets == {First: 0, Second: 3}
    assert BOTH.column(First, "c") == 2
    assert BOTH.column(Second, "e") == 4


def test_plain_python_reads_and_writes_an_owners_own_rows() -> None:
    table = np.arange(15.0)
    assert get_first(table, 1) == First(5.0, 6.0, 7.0)
    assert get_second(table, 2) == Second(13.0, 14.0)
    assert pick_second(table, 1.0) == Second(8.0, 9.0)
    put_second(table, 0, Second(-1.0, -2.0))
    assert table.tolist() == [0, 1, 2, -1, -2, *range(5, 15)]


def exchange(given: np.ndarray, out: np.ndarray) -> None:
    """Copy the owners' records into `out` in another order, some of them changed."""
    g, o = rows_of(given), rows_of(out)
    for owner in range(3):
        first, second = get_first(g, owner), get_second(g, 2 - owner)
        put_first(o, owner, First(first.c, 0.5, first.a * second.e))
        put_second(o, owner, where(first.b > 7.0, second, Second(-1.0, first.b)))
    picked = pick_second(g, load(g, 15))
    store(o, 15, picked.d)
    store(o, 16, picked.e)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
def test_records_three_ways() -> None:
    given = np.vstack([np.arange(15.0)[:, None] + 0.125 * np.arange(WIDTH), np.resize([0.0, 2.0, 1.0], WIDTH)])
    out = three_ways(exchange, given, 17)
    assert out[:5, 0].tolist() == [2.0, 0.5, 0.0 * 14.0, -1.0, 1.0]
    assert out[10:15, 0].tolist() == [12.0, 0.5, 10.0 * 4.0, 3.0, 4.0]
    assert out[15:, 1].tolist() == [13.125, 14.125]  # the second mission picks the third owner


@compiled
def sum_of(first: First) -> float:
    """Of a record by value or by reference."""
    return first.a + 10.0 * first.b + 100.0 * first.c


def look_at(given: np.ndarray, out: np.ndarray) -> None:
    """Read the same records by value, where they lie, and put aside."""
    g, o = rows_of(given), rows_of(out)
    for owner in range(3):
        put_first(o, owner, get_first(g, owner))
        seen, kept = view_first(o, owner), passing(get_first(o, owner))
        store(o, 15 + owner, sum_of(seen) - sum_of(kept))
        changed = First(seen.c, 2.0 * seen.b, seen.a)
        put_first(o, owner, changed)
        store(o, 18 + owner, sum_of(kept))
        put_second(o, owner, Second(value_of(kept).a, sum_of(value_of(changed))))


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
def test_a_record_by_reference_three_ways() -> None:
    given = np.arange(15.0)[:, None] + 0.125 * np.arange(WIDTH)
    out = three_ways(look_at, given, 21)
    assert (out[15:18] == 0.0).all()
    assert out[18:21, 0].tolist() == [210.0, 765.0, 1320.0]  # what was put aside stays as it was
    assert out[3:5, 0].tolist() == [0.0, 2.0 + 10.0 * 2.0]


WIDER = Layout(Second, width=4)
pick_wider = WIDER.picker(Second)


def pick_all(given: np.ndarray, out: np.ndarray) -> None:
    """Owners that lanes choose alike, apart, and not at all."""
    g, o = rows_of(given), rows_of(out)
    for k in range(3):
        picked = pick_wider(g, load(g, 12 + k))
        store(o, 2 * k, picked.d)
        store(o, 2 * k + 1, picked.e)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
def test_owners_that_lanes_choose_three_ways() -> None:
    table = np.arange(12.0)[:, None] + 100.0 * np.arange(WIDTH)
    owners = np.array([[2.0] * WIDTH, np.resize([0.0, 2.0, 1.0], WIDTH), [np.nan] * WIDTH])
    out = three_ways(pick_all, np.vstack([table, owners]), 6)
    assert out[:2, 3].tolist() == [308.0, 309.0]
    assert out[2:4, 1].tolist() == [108.0, 109.0]
    assert out[4:, 5].tolist() == [500.0, 501.0]
