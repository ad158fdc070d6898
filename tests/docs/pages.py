"""What a documentation page holds: its fenced blocks, the marks above them, and its links.

A mark is a comment in the line above a block, invisible where the page is shown:

    <!-- file: NAME -->        the block is written to this file; below `src/`, into a copy of the sources
    <!-- append: NAME -->      the block is added at the end of this file
    <!-- exit code: 2 -->      how the command of the block ends; what it says is then on stderr
    <!-- not run: REASON -->   the block is only to be read
"""

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
MARKS = {"file", "append", "exit code", "not run"}
RUNNABLE = {"yaml", "console", "python"}
READ_ONLY = {"", "text"}
TOPS = ("README.md", "ARCHITECTURE.md", "NOTATION.md", "CONTRIBUTING.md", "CHANGELOG.md")


class Block(NamedTuple):
    """One fenced block of a page."""

    place: str  # page:line
    language: str
    text: str
    marks: dict[str, str]


def all_pages() -> list[Path]:
    """Every page of the documentation."""
    return [*(ROOT / name for name in TOPS), *sorted((ROOT / "docs").rglob("*.md"))]


def name_of(page: Path) -> str:
    """A page's name in messages."""
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page, in order."""
    lines = page.read_text(encoding="utf-8").splitlines()
    found, number = [], 0
    while number < len(lines):
        if fence := re.fullmatch(r"```(\w*)", lines[number]):
            end = lines.index("```", number + 1)
            text = "\n".join(lines[number + 1 : end]) + "\n"
            place = f"{name_of(page)}:{number + 1}"
            found.append(Block(place, fence[1], text, _marks(lines, number)))
            number = end
        number += 1
    return found


def _marks(lines: list[str], fence: int) -> dict[str, str]:
    above = re.fullmatch(r"<!-- ([\w ]+): (.+) -->", lines[fence - 1]) if fence else None
    return {above[1]: above[2]} if above else {}


def prose(page: Path) -> str:
    """A page without its blocks."""
    return re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


def links(page: Path) -> list[str]:
    """Where a page's links lead, if not out of the project."""
    targets = re.findall(r"\]\(([^)\s]+)\)", prose(page))
    return [target for target in targets if not re.match(r"[a-z]+:", target)]
