"""One source, three ways: plain Python, compiled for one mission, compiled for eight."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit

from cardume.compiler import WIDTH

OPTIONS = {"nogil": True, "error_model": "numpy"}


def three_ways(function: Callable[..., None], given: np.ndarray, num_out: int) -> np.ndarray:
    """Run function(given, out) all three ways and check that they agree.

    One mission and every lane do to the last bit; plain Python, which rounds a product before it adds it, to 1e-12.

    Args:
        function: reads (n,) or (n, 8) numbers by `rows_of`, and writes num_out rows.
        given: (n, 8) what it reads, one mission per column.
        num_out: rows it writes.

    Returns:
        (num_out, 8) what it wrote.
    """
    compiled: Any = njit(**OPTIONS)(function)
    given = np.ascontiguousarray(given, float)
    wide = np.full((num_out, WIDTH), -7.0)
    compiled(given.copy(), wide)
    for lane in range(WIDTH):
        own = np.ascontiguousarray(given[:, lane])
        single, plain = np.full(num_out, -7.0), np.full(num_out, -7.0)
        compiled(own.copy(), single)
        with np.errstate(all="ignore"):  # plain Python warns where compiled code gives NaN or infinity
            function(np.array(own), plain)
        assert same(single, wide[:, lane]), (lane, np.flatnonzero(~equal(single, wide[:, lane])))
        assert np.allclose(plain, single, rtol=1e-12, atol=1e-12, equal_nan=True), (lane, plain - single)
    return wide


def equal(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return (one == other) & (np.signbit(one) == np.signbit(other)) | (np.isnan(one) & np.isnan(other))


def same(one: np.ndarray, other: np.ndarray) -> bool:
    """Equal, zeros with their sign, and NaN where NaN."""
    return bool(equal(one, other).all())
