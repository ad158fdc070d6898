"""Run a compiled function over columns of numbers the three ways it can run: plain Python, one number, eight lanes."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numba import config, njit

from cardume.compiler import WIDTH, load, rows_of, store

IN_PYTHON = bool(config.DISABLE_JIT)  # then the compiled ways are plain Python too, and there are no lanes


@cache
def _runner(function: Callable[..., Any], num_arguments: int, num_results: int) -> Callable[..., None]:
    """A compiled loop that reads rows of arguments, calls the function and writes rows of results."""
    arguments = ", ".join(f"load(rows_of(table[{k}]), i)" for k in range(num_arguments))
    names = [f"r{k}" for k in range(num_results)]
    stores = "\n".join(f"        store(rows_of(out[{k}]), i, {name})" for k, name in enumerate(names))
    source = (
        "def run(table, out):\n    for i in range(table.shape[1]):\n"
        f"        {', '.join(names)} = function({arguments})\n{stores}\n"
    )
    scope = {"function": function, "load": load, "store": store, "rows_of": rows_of}
    exec(source, scope)
    return njit(error_model="numpy")(scope["run"])


def scalar(function: Callable[..., Any], *columns: np.ndarray, num_results: int = 1) -> np.ndarray:
    """The function of each row, one number at a time: (n,), or (num_results, n) where it returns several."""
    table = np.array(columns, dtype=np.float64)
    out = np.empty((num_results, table.shape[1]))
    with np.errstate(all="ignore"):  # an interpreter with numpy's numbers would warn of infinities
        _runner(function, len(columns), num_results)(table, out)
    return out[0] if num_results == 1 else out


def lanes(function: Callable[..., Any], *columns: np.ndarray, num_results: int = 1) -> np.ndarray:
    """The same, eight rows at a time; the columns hold a multiple of eight numbers."""
    table = np.array(columns, dtype=np.float64).reshape(len(columns), -1, WIDTH)
    out = np.empty((num_results, *table.shape[1:]))
    _runner(function, len(columns), num_results)(table, out)
    out = out.reshape(num_results, -1)
    return out[0] if num_results == 1 else out


def plain(function: Callable[..., Any], *columns: np.ndarray, num_results: int = 1) -> np.ndarray:
    """The same by the interpreter."""
    rows = zip(*(column.tolist() for column in columns), strict=True)
    out = np.array([function(*row) for row in rows], dtype=np.float64)
    return out if num_results == 1 else out.T


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether all numbers agree to the last bit and in the sign of zero; any NaN equals any other."""
    nan = np.isnan(a) & np.isnan(b)
    return bool(np.all(nan | (a.view(np.int64) == b.view(np.int64))))


def nearly(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether all numbers agree to 1e-12, as plain Python does, which rounds a product before it adds it."""
    return bool(np.allclose(a, b, rtol=1e-12, atol=1e-12, equal_nan=True))
