"""Hard limits of size; the soft ones are CONTRIBUTING.md's: 250 lines a file, 40 a function."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "src" / "cardume"
FILES = sorted(PACKAGE.rglob("*.py"))
MAX_FILE, MAX_FUNCTION, MAX_DEPTH, MAX_FOLDERS = 500, 80, 3, 12


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_a_file_and_its_functions_are_small(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    num_lines = len(text.splitlines())
    assert num_lines <= MAX_FILE, f"{num_lines} lines, at most {MAX_FILE}: is this still one room?"
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            statements = node.body[1:] if ast.get_docstring(node) and node.body[1:] else node.body
            num_lines = (node.end_lineno or node.lineno) - statements[0].lineno + 1  # a law may have many parameters
            where = f"{node.name}, line {node.lineno}"
            assert num_lines <= MAX_FUNCTION, f"{where}: {num_lines} lines, at most {MAX_FUNCTION}"


def test_the_tree_is_shallow_and_narrow() -> None:
    deepest = max(len(path.relative_to(PACKAGE).parents) - 1 for path in FILES)
    assert deepest <= MAX_DEPTH, f"{deepest} folders deep, at most {MAX_DEPTH}"
    folders = [path.name for path in PACKAGE.iterdir() if (path / "__init__.py").is_file()]
    assert len(folders) <= MAX_FOLDERS, f"{len(folders)} folders at the top, at most {MAX_FOLDERS}: {sorted(folders)}"
