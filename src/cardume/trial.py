"""A law tried once in Python: sample input, and whether what comes back is what its family requires."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from cardume.compiler import Rows, SharedRows


def sample(kind: Any) -> Any:
    """Plausible, unremarkable input: every number 0.5, every table a few zeros."""
    if kind is float:
        return 0.5
    rows = {f for f, hint in kind.__annotations__.items() if hint in (Rows, SharedRows)}
    return kind(*[np.zeros(256) if f in rows else 0.5 for f in kind._fields])


def fits(answer: Any, result: Any) -> bool:
    """Whether an answer is a number, or of the record's class."""
    if result is float:
        return isinstance(answer, (int, float, np.floating)) and not isinstance(answer, bool)
    return isinstance(answer, result)


def same(first: Any, second: Any) -> bool:
    """Whether two answers hold the same numbers."""

    def numbers(value: Any) -> Iterable[float]:
        return [x for part in value for x in numbers(part)] if np.ndim(value) else [float(value)]

    if isinstance(first, tuple):
        return len(first) == len(second) and all(same(a, b) for a, b in zip(first, second, strict=True))
    return np.array_equal(list(numbers(first)), list(numbers(second)), equal_nan=True)


def shape(result: Any) -> str:
    """What a law must return, in words."""
    return "a number" if result is float else f"{result.__name__}({', '.join(result._fields)})"


def last_words(problem: Exception) -> str:
    """The part of Numba's message that is about the user's code."""
    lines = [line.strip() for line in str(problem).splitlines() if line.strip()]
    telling = [x for x in lines if x.startswith(("Unknown attribute", "Untyped global", "No implementation", "File "))]
    return "; ".join(telling[:3] or lines[:3])
