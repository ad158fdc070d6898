"""When missions fly in lanes: what is compiled already is worth less work than what is not."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from numba import config

from cardume.compiler import Rows, entry, load, rows_of, store
from cardume.compiler.compiled import cached, is_kept_for_lanes
from cardume.studies import work


@pytest.mark.parametrize(
    ("ticks", "is_kept", "wanted"),
    [(9e6, True, False), (11e6, True, True), (11e6, False, False), (99e6, False, False), (101e6, False, True)],
)
def test_what_is_compiled_already_is_used_sooner(
    ticks: float, is_kept: bool, wanted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "is_kept_for_lanes", lambda _entry: is_kept)
    assert work.wants_lanes(ticks) == wanted


class Pair(NamedTuple):
    size: int
    numbers: Rows


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles an entry")
def test_code_for_lanes_is_found_where_there_is_some(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))

    def double(pair: Pair) -> None:
        rows = rows_of(pair.numbers)
        store(rows, 0, 2.0 * load(rows, 0))

    one = entry(double)
    assert not is_kept_for_lanes(one)
    one(Pair(1, np.ones(1)))
    assert not is_kept_for_lanes(one)
    one(Pair(1, np.ones((1, 8))))
    assert is_kept_for_lanes(one)
    assert is_kept_for_lanes(cached(double))  # on the disk, for another process


def test_plain_python_has_none() -> None:
    assert not is_kept_for_lanes(print)
