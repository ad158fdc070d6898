"""Must show 9: the heart reads as prose.  `tick` and `decide` stay short, flat, and free of raw indices."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from typing import Any

import pytest

from cardume.onboard.agent import decide
from cardume.simulation.engine import advance
from cardume.simulation.tick import tick

LONGEST = 40  # lines
LOOPS = (ast.For, ast.While)


def problems_of(source: str) -> list[str]:
    """What makes a function unreadable."""
    (function,) = ast.parse(source).body
    found = []
    length = (function.end_lineno or 0) - function.lineno + 1
    if length > LONGEST:
        found.append(f"{length} lines")
    for node in ast.walk(function):
        if isinstance(node, ast.Subscript) and isinstance(node.slice, (ast.Constant, ast.Slice, ast.UnaryOp)):
            found.append(f"line {node.lineno}: a raw index")
        if isinstance(node, (*LOOPS, ast.If)):
            inner = [n for n in ast.walk(node) if n is not node and isinstance(n, (*LOOPS, ast.If, ast.comprehension))]
            found += [f"line {n.lineno}: nested" for n in inner if isinstance(n, ast.stmt)]
        if isinstance(node, ast.IfExp) and any(isinstance(n, ast.IfExp) for n in ast.walk(node) if n is not node):
            found.append(f"line {node.lineno}: a choice within a choice")
    return found


@pytest.mark.parametrize("function", [tick, decide], ids=lambda f: f.__name__)
def test_the_heart_reads_as_prose(function: Callable[..., Any]) -> None:
    assert problems_of(inspect.getsource(function)) == []


def test_what_python_calls_is_no_longer_either() -> None:
    source = inspect.getsource(getattr(advance, "py_func", advance))
    assert [p for p in problems_of(source) if "nested" not in p] == []


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        ("    x = 1\n" * LONGEST, "41 lines"),
        ("    x = rows[3]\n", "a raw index"),
        ("    x = rows[1:]\n", "a raw index"),
        ("    x = rows[-1]\n", "a raw index"),
        ("    for i in a:\n        for j in b:\n            pass\n", "nested"),
        ("    for i in a:\n        if i:\n            pass\n", "nested"),
        ("    return 1 if a else 2 if b else 3\n", "a choice within a choice"),
    ],
)
def test_what_is_not_prose_is_noticed(body: str, problem: str) -> None:
    assert any(problem in found for found in problems_of("def f(rows, a, b):\n" + body))


def test_prose_passes() -> None:
    assert (
        problems_of("def f(fleet):\n    for i in range(fleet.size):\n        x = get(fleet, i)\n    return x\n") == []
    )
