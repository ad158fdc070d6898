"""The name of a user's law in the cache covers everything its result depends on: another result, another name."""

from __future__ import annotations

import importlib
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

from cardume.compiler.calls import FLAT
from cardume.compiler.reach import fields_read, is_recursive
from cardume.laws import Law

HEADER = """
from typing import NamedTuple
import numpy as np
from cardume.laws import Meters
from cardume.maths import atan2
from cardume.onboard.estimation.position import position_law
from cardume.onboard.guidance import guidance_law
from cardume.signals import Fix, Motion, NavigationEstimate, PathError
"""
LAW = """
@guidance_law
def mine(error: PathError, lookahead: Meters = 5.0) -> float:
    return error.path_course - {body}
"""
MEMORY = """
class Ring(NamedTuple):
    first: float = 0.0
    ring: np.ndarray = np.zeros({size})
    last: float = 0.0

@guidance_law
def mine(error: PathError, memory: Ring) -> float:
    return error.path_course + memory.last, memory
"""
PICKED = """
@position_law
def mine(one: {one}, two: {two}) -> NavigationEstimate:
    return make(one, two)

def make(one, two):
    return NavigationEstimate(one[0], two[1])
"""
HELPER = "\ndef helper(x{given}):\n    return {body}\n"
NESTED = """
def outer(k):
    @guidance_law
    def mine(error: PathError) -> float:
        return error.path_course - k
    return mine
mine = outer({k})
"""
CASES = {
    "a number in the law": (LAW.format(body="1.0"), LAW.format(body="2.0")),
    "an operation in the law": (LAW.format(body="error.cross_track + 1.0"), LAW.format(body="error.cross_track * 1.0")),
    "a signal's field": (LAW.format(body="error.cross_track"), LAW.format(body="error.along_track")),
    "a module's constant": ("K = 1.0" + LAW.format(body="K"), "K = 2.0" + LAW.format(body="K")),
    "a whole number": ("K = 1" + LAW.format(body="K"), "K = 1.0" + LAW.format(body="K")),
    "a sign of zero": ("K = 0.0" + LAW.format(body="K"), "K = -0.0" + LAW.format(body="K")),
    "a truth value": ("K = True" + LAW.format(body="K"), "K = False" + LAW.format(body="K")),
    "a numpy integer": ("K = np.int64(1)" + LAW.format(body="K"), "K = np.int64(2)" + LAW.format(body="K")),
    "a numpy float": ("K = np.float32(1)" + LAW.format(body="K"), "K = np.float32(2)" + LAW.format(body="K")),
    "a tuple": ("K = (1.0, (2.0,))" + LAW.format(body="K[0]"), "K = (1.0, (3.0,))" + LAW.format(body="K[0]")),
    "an array": ("K = np.ones(3)" + LAW.format(body="K[0]"), "K = np.zeros(3)" + LAW.format(body="K[0]")),
    "the shape of an array": (
        "K = np.zeros((2, 3))" + LAW.format(body="K[0, 1]"),
        "K = np.zeros((3, 2))" + LAW.format(body="K[0, 1]"),
    ),
    "the type of an array": (
        "K = np.zeros(2)" + LAW.format(body="K[0]"),
        "K = np.zeros(2, int)" + LAW.format(body="K[0]"),
    ),
    "a helper": (
        HELPER.format(given="", body="x") + LAW.format(body="helper(1.0)"),
        HELPER.format(given="", body="2.0 * x") + LAW.format(body="helper(1.0)"),
    ),
    "a helper's default": (
        HELPER.format(given=", k=1.0", body="k * x") + LAW.format(body="helper(1.0)"),
        HELPER.format(given=", k=2.0", body="k * x") + LAW.format(body="helper(1.0)"),
    ),
    "a helper's constant": (
        "K = 1.0" + HELPER.format(given="", body="K") + LAW.format(body="helper(1.0)"),
        "K = 2.0" + HELPER.format(given="", body="K") + LAW.format(body="helper(1.0)"),
    ),
    "a closure": (NESTED.format(k="1.0"), NESTED.format(k="2.0")),
    "a lambda": (
        "helper = lambda x: x" + LAW.format(body="helper(1.0)"),
        "helper = lambda x: -x" + LAW.format(body="helper(1.0)"),
    ),
    "the size of a memory it only hands back": (MEMORY.format(size=8), MEMORY.format(size=16)),
    "which signal is which": (PICKED.format(one="Fix", two="Motion"), PICKED.format(one="Motion", two="Fix")),
}


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A folder of a user's own modules."""
    sys.path.insert(0, str(tmp_path))
    before = set(sys.modules)
    yield tmp_path
    sys.path.remove(str(tmp_path))
    for name in set(sys.modules) - before:
        del sys.modules[name]


def law_in(source: str, name: str = "users_module") -> Law:
    """The law `mine` of a module of this source."""
    scope = {"__name__": name}
    exec(compile(HEADER + source, f"<{name}>", "exec"), scope)
    law = scope["mine"]
    assert isinstance(law, Law)
    return law


def name_in_the_cache(law: Law) -> str:
    return str(law._wrapper(FLAT).__name__)


@pytest.mark.parametrize("what", CASES)
def test_whatever_changes_the_result_changes_the_name(what: str) -> None:
    before, after = CASES[what]
    assert name_in_the_cache(law_in(before)) == name_in_the_cache(law_in(before))
    assert name_in_the_cache(law_in(before)) != name_in_the_cache(law_in(after))


def test_what_does_not_matter_does_not() -> None:
    """Other lines, comments and a docstring compile nothing anew."""
    law = LAW.format(body="helper(1.0)")
    one = law_in(HELPER.format(given="", body="x") + law)
    other = law_in("# a comment\n\n" + HELPER.format(given="", body="x  # why") + "UNUSED = 3\n" + law)
    assert name_in_the_cache(one) == name_in_the_cache(other)


MODULES = {
    "from": ("from lab.tools import turn", "turn(1.0)"),
    "as": ("from lab.tools import turn as t", "t(1.0)"),
    "dotted constant": ("from lab import tools", "tools.GAIN"),
    "two dots": ("import lab.tools", "lab.tools.GAIN"),
}


@pytest.mark.parametrize("how", MODULES)
def test_other_files_are_reached_however_they_are_imported(folder: Path, how: str) -> None:
    imported, used = MODULES[how]
    names = []
    for gain in ("1.0", "2.0"):
        (folder / "lab").mkdir(exist_ok=True)
        (folder / "lab" / "__init__.py").write_text("")
        (folder / "lab" / "tools.py").write_text(f"GAIN = {gain}\ndef turn(x):\n    return GAIN * x\n")
        for module in ("lab", "lab.tools"):
            sys.modules.pop(module, None)
        shutil.rmtree(folder / "lab" / "__pycache__", ignore_errors=True)  # edits within a second look alike to it
        names.append(name_in_the_cache(law_in(imported + LAW.format(body=used))))
    assert names[0] != names[1]


RECURSIVE = """
def down(n):
    return {first}
def other(n):
    return {second}
@guidance_law
def mine(error: PathError) -> float:
    return error.path_course + down(3.0)
"""


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("n if n < 1.0 else down(n - 1.0)", "n", True),
        ("n if n < 1.0 else other(n - 1.0)", "down(n)", True),
        ("other(n) + other(n)", "n", False),
    ],
)
def test_recursion_is_noticed(first: str, second: str, expected: bool) -> None:
    law = law_in(RECURSIVE.format(first=first, second=second))
    assert is_recursive(law.function) is expected


def test_another_module_with_the_same_code_does_not_find_what_the_first_one_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("first_of_two", "second_of_two"):  # what is kept imports its module by name when it is read
        (tmp_path / f"{name}.py").write_text(HEADER + LAW.format(body="0.125 * error.cross_track"))
        law = importlib.import_module(name).mine
        assert law.handle(lanes=False) > 0
        (tmp_path / f"{name}.py").unlink()
        del sys.modules[name]


# ---- which fields of a record a function reads -----------------------------------------------------------------------


class Draws(NamedTuple):
    """Four numbers."""

    a: float = 0.0
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0


def reads_two(x: float, draws: Draws) -> float:
    first = draws.b
    second = draws.c
    return x * first * second


def reads_one_last(x: float, draws: Draws) -> float:
    return x * draws.a


def reads_none(x: float, draws: Draws) -> float:
    return x


def hands_it_on(x: float, draws: Draws) -> float:
    return x + reads_one_last(x, draws)


def renames_it(x: float, draws: Draws) -> float:
    other = draws
    return x + other.d


def overwrites_it(x: float, draws: Draws) -> float:
    draws = Draws(x, x, x, x)
    return draws.a


def reads_it_inside(x: float, draws: Draws) -> Callable[[], float]:
    return lambda: x * draws.d


READ = {
    reads_two: {"b", "c"},
    reads_one_last: {"a"},
    reads_none: set(),
    hands_it_on: set("abcd"),
    renames_it: set("abcd"),
    overwrites_it: set("abcd"),
    reads_it_inside: set("abcd"),
}


@pytest.mark.parametrize("function", READ, ids=lambda f: f.__name__)
def test_fields_that_are_read_are_seen_or_all_are_taken_for_read(function: Callable[..., Any]) -> None:
    assert fields_read(function, Draws) == READ[function]


# What Python 3.13 makes of some of them: two locals in one instruction, by name.
IN_3_13: dict[Callable[..., Any], list[tuple[str, Any]]] = {
    reads_two: [
        ("LOAD_FAST", "draws"),
        ("LOAD_ATTR", "b"),
        ("STORE_FAST_LOAD_FAST", ("first", "draws")),
        ("LOAD_ATTR", "c"),
        ("STORE_FAST_LOAD_FAST", ("second", "x")),
        ("LOAD_FAST", "first"),
        ("BINARY_OP", 5),
    ],
    reads_one_last: [("LOAD_FAST_LOAD_FAST", ("x", "draws")), ("LOAD_ATTR", "a"), ("BINARY_OP", 5)],
    hands_it_on: [("LOAD_FAST", "x"), ("LOAD_GLOBAL", "f"), ("LOAD_FAST_LOAD_FAST", ("x", "draws")), ("CALL", 2)],
    renames_it: [("LOAD_FAST", "draws"), ("STORE_FAST_LOAD_FAST", ("other", "x")), ("LOAD_FAST", "other")],
    overwrites_it: [("CALL", 4), ("STORE_FAST_LOAD_FAST", ("draws", "draws")), ("LOAD_ATTR", "a")],
}


@pytest.mark.parametrize("function", IN_3_13, ids=lambda f: f.__name__)
def test_they_are_also_seen_where_one_instruction_names_two_locals(
    function: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    steps = [SimpleNamespace(opname=name, argval=value) for name, value in IN_3_13[function]]
    monkeypatch.setattr("dis.get_instructions", lambda _: steps)
    assert fields_read(function, Draws) == READ[function]
