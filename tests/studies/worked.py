"""What tests of worked missions share: the scripts in examples/ that fly them, and the tables of the pages."""

import re
import sys
from importlib import util
from pathlib import Path
from types import ModuleType

import numpy as np

ROOT = Path(__file__).parents[2]
NUMBER = r"\d+(?:\.\d+)?"


def example_of(name: str) -> ModuleType:
    """The module examples/NAME.py."""
    spec = util.spec_from_file_location(f"{name}_example", ROOT / "examples" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def printed(page: str, table: str) -> list[str]:
    """The rows of a table of a tutorial that a comment names."""
    text = (ROOT / "docs" / "tutorials" / page).read_text(encoding="utf-8")
    return text.partition(f"<!-- table: {table} -->\n")[2].partition("\n\n")[0].splitlines()[2:]


def differences(rows: list[str], wanted: list[str]) -> list[str]:
    """What of the wanted rows is not on the page; numbers may differ by one in the last digit."""
    if len(rows) != len(wanted):
        return wanted
    return [other for row, other in zip(rows, wanted, strict=True) if not _alike(row, other)]


def _alike(row: str, other: str) -> bool:
    if re.sub(NUMBER, "", row) != re.sub(NUMBER, "", other):
        return False
    ours, theirs = re.findall(NUMBER, row), re.findall(NUMBER, other)
    last_digits = [10.0 ** -len(number.partition(".")[2]) for number in theirs]
    apart = np.abs(np.array(ours, float) - np.array(theirs, float))
    return bool(np.all(apart <= 1.01 * np.array(last_digits)))
