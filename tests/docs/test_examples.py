"""Every example in README and docs runs and gives what it shows; see `pages.py` for how a page is marked."""

import re
import tomllib
from pathlib import Path

import pytest

from docs.pages import MARKS, READ_ONLY, ROOT, RUNNABLE, TOPS, all_pages, blocks, links, name_of, prose
from docs.session import Session, agrees, makefile

PAGES = all_pages()
EXAMPLES = [page for page in PAGES if any(block.language in RUNNABLE for block in blocks(page))]


@pytest.mark.parametrize("page", EXAMPLES, ids=name_of)
def test_examples_do_what_the_page_says(page: Path, tmp_path: Path) -> None:
    session = Session(tmp_path)
    for block in blocks(page):
        if block.language in RUNNABLE and "not run" not in block.marks:
            session.work_through(block)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_blocks_are_of_a_known_kind(page: Path) -> None:
    for block in blocks(page):
        assert block.language in RUNNABLE | READ_ONLY, f"{block.place}: {block.language}"
        assert set(block.marks) <= MARKS, f"{block.place}: {block.marks}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    lost = [target for target in links(page) if not (page.parent / target.partition("#")[0]).exists()]
    assert not lost


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_named_files_and_make_targets_exist(page: Path) -> None:
    """Whatever a page names in code quotes as a file of ours or as `make TARGET`."""
    quoted = re.findall(r"`([^`\n]+)`", prose(page))
    targets = {match[1] for text in quoted if (match := re.match(r"make ([a-z-]+)$", text))}
    assert targets <= set(re.findall(r"^([a-z-]+):", makefile(), re.MULTILINE))
    files = [text for text in quoted if re.fullmatch(r"(src|tests|docs|benchmarks)/[\w./-]+", text)]
    assert not [text for text in files if not (ROOT / text).exists()]


@pytest.mark.parametrize("folder", ["extending", "decisions", "tutorials"])
def test_every_page_is_in_its_index(folder: str) -> None:
    pages = {page.name for page in (ROOT / "docs" / folder).glob("*.md")} - {"index.md"}
    assert pages == {target for target in links(ROOT / "docs" / folder / "index.md") if "/" not in target}


def test_every_family_is_in_the_index() -> None:
    package = ROOT / "src" / "cardume"
    text = (ROOT / "docs" / "extending" / "index.md").read_text(encoding="utf-8")
    folders = [base.parent.relative_to(package).as_posix() for base in package.rglob("base.py")]
    assert not [folder for folder in folders if f"| `{folder}` |" not in text]


def test_the_version_is_the_same_everywhere() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[1] == version
    assert (
        re.search(r"^version: (\S+)", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)[1] == version
    )


def test_the_top_pages_are_there() -> None:
    assert not [name for name in TOPS if not (ROOT / name).is_file()]


# ---- what reads the pages --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shown", "is_right"),
    [
        ("home, seed 0\n...\nFlew 120 s,\nin 17 ms of computing. Good.", True),
        ("home, seed 0\n\nalone  0.340 0.337\n...", True),  # within 5 %, or the last digit
        ("home, seed 0\n\nalone  0.353 0.336\n...", False),
        ("home, seed 0\n\nahead  0.333 0.336\n...", False),
        ("home, seed 0\n\nalone  0.333\n\nFlew ...", False),
        ("alone  0.333 0.336", False),
    ],
)
def test_shown_output_is_compared(shown: str, is_right: bool) -> None:
    said = "\nhome, seed 0\n\nalone  0.333 0.336\n\nFlew 120 s, in 9.8 ms of computing. Good.\n"
    assert agrees(shown, said) == is_right


def test_marks_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("docs.pages.ROOT", tmp_path)
    page = tmp_path / "page.md"
    page.write_text("a\n\n<!-- exit code: 2 -->\n```console\n$ cardume run\n```\n\n```\nx\n```\n", encoding="utf-8")
    first, second = blocks(page)
    assert (first.place, first.language, first.marks) == ("page.md:4", "console", {"exit code": "2"})
    assert (second.language, second.marks, second.text) == ("", {}, "x\n")
