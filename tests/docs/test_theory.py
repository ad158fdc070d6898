"""The theory pages name tests; each of them exists, and each row of the errata names one or says why not."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from docs.pages import ROOT, name_of

PAGES = sorted((ROOT / "docs" / "theory").glob("*.md"))
NAMED = re.compile(r"`([\w/]+\.py)::(\w+)`")
NO_TEST = "no test"  # followed by the reason


@cache
def functions_in(file: Path) -> frozenset[str]:
    """The test functions of a file."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return frozenset(n.name for n in tree.body if isinstance(n, ast.FunctionDef) and n.name.startswith("test_"))


def rows(page: Path) -> list[str]:
    """The rows of a page's tables, without their heads."""
    lines = page.read_text(encoding="utf-8").splitlines()
    return [line for k, line in enumerate(lines) if line.startswith("|") and not is_head(lines, k)]


def is_head(lines: list[str], k: int) -> bool:
    return lines[k].startswith("|---") or (k + 1 < len(lines) and lines[k + 1].startswith("|---"))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_named_tests_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    named = NAMED.findall(text)
    assert text.count("::") == len(named), "a test is named as `folder/file.py::function`"
    missing = []
    for file, function in named:
        path = ROOT / "tests" / file
        if not path.is_file() or function not in functions_in(path):
            missing.append(f"{file}::{function}")
    assert not missing


@pytest.mark.parametrize("name", ["errata.md", "claims.md", "closed-forms.md"])
def test_every_row_names_its_test_or_says_why_there_is_none(name: str) -> None:
    found = rows(ROOT / "docs" / "theory" / name)
    assert len(found) > 20
    bare = [row for row in found if not NAMED.search(row) and NO_TEST not in row]
    assert not bare


def test_every_equation_has_a_row_in_the_errata() -> None:
    """(1) to (55), alone or within "(9) to (11)"."""
    seen: set[int] = set()
    for row in rows(ROOT / "docs" / "theory" / "errata.md"):
        first = row.split("|")[1]
        numbers = [int(n) for n in re.findall(r"\((\d+)\)", first)]
        seen |= set(range(numbers[0], numbers[-1] + 1)) if " to " in first else set(numbers)
    assert seen == set(range(1, 56))


def test_closed_forms_that_sources_name_are_in_the_table() -> None:
    """Nobody is sent to a table that is not here."""
    known = {row.split("|")[1].strip() for row in rows(ROOT / "docs" / "theory" / "closed-forms.md")}
    assert len(known) > 35
    strangers = []
    for file in (*(ROOT / "src").rglob("*.py"), *(ROOT / "tests").rglob("*.py"), *(ROOT / "docs").rglob("*.md")):
        text = " ".join(file.read_text(encoding="utf-8").split())
        named = re.findall(r"\bclosed forms? ([A-Z]{1,2}\d?(?:(?:, | and )[A-Z]{1,2}\d?\b)*)\b", text, re.IGNORECASE)
        letters = [letter for some in named for letter in re.split(r", | and ", some)]
        strangers += [(file.name, letter) for letter in letters if letter.isupper() and letter not in known]
        if file.is_relative_to(ROOT / "src"):
            strangers += [(file.name, found) for found in re.findall(r"theory (?:page|row)s?\b.{10}", text)]
    assert not strangers
