"""Build the site into a folder, without a network: `python docs/site/build.py [FOLDER]`; a warning is a failure."""

import shutil
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SITE = ROOT / ".cache" / "site"
TOPS = ("README.md", "ARCHITECTURE.md", "NOTATION.md", "CONTRIBUTING.md", "CHANGELOG.md")
BESIDE = ("LICENSE", "CITATION.cff", "Makefile", "pyproject.toml")  # that pages link to
SECTIONS = {
    "Begin": ["README", "docs/tutorials/index", "docs/missions", "docs/formats", "docs/report", "docs/lab", "docs/replay"],
    "Laws": ["docs/laws/index"],
    "Extend": ["docs/extending/index"],
    "Theory": ["docs/theory/errata", "docs/theory/claims", "docs/theory/closed-forms"],
    "Inside": ["ARCHITECTURE", "NOTATION", "docs/api", "docs/decisions/index", "CONTRIBUTING", "CHANGELOG"],
}
FIRST = (
    '<!DOCTYPE html><meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">cardume</a>'
)
INDEXED = ("tutorials", "extending", "decisions", "laws")  # folders whose index leads to their other pages

sys.path.insert(0, str(HERE))


def write_source(folder: Path) -> None:
    """Lay out all pages as links between them expect it.

    Args:
        folder: empty.
    """
    from catalog import write_catalog

    for name in (*TOPS, *BESIDE):
        shutil.copy(ROOT / name, folder)
    shutil.copytree(ROOT / "examples", folder / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=shutil.ignore_patterns("site"))
    write_catalog(folder / "docs" / "laws")
    (folder / "docs" / "api.md").write_text(api(), encoding="utf-8")
    for name in INDEXED:
        inner = folder / "docs" / name
        pages = [path.stem for path in sorted(inner.glob("*.md")) if path.stem != "index"]
        with (inner / "index.md").open("a", encoding="utf-8") as file:
            file.write(toctree("", pages, "hidden"))
    with (folder / "docs" / "index.md").open("a", encoding="utf-8") as file:
        file.write(menu(folder))


def menu(folder: Path) -> str:
    """The pages by sections, for the side of every page."""
    known = {page for pages in SECTIONS.values() for page in pages}
    others = sorted(path.relative_to(folder).with_suffix("").as_posix() for path in (folder / "docs").glob("*.md"))
    theory = sorted(f"docs/theory/{path.stem}" for path in (folder / "docs" / "theory").glob("*.md"))
    sections = {title: list(pages) for title, pages in SECTIONS.items()}
    sections["Begin"] += [page for page in others if page not in known | {"docs/index"}]
    sections["Theory"] += [page for page in theory if page not in known]
    return "".join(toctree(title, [f"/{page}" for page in pages], "hidden") for title, pages in sections.items())


def toctree(title: str, pages: list[str], *options: str) -> str:
    """A list of pages for the menu."""
    heads = [f":caption: {title}"] if title else []
    lines = [*heads, *(f":{option}:" for option in options), "", *pages]
    return "\n```{toctree}\n" + "\n".join(lines) + "\n```\n"


def api() -> str:
    """What `import cardume` offers."""
    import cardume

    parts = [
        "# From Python\n\nWhat `import cardume` offers. Angles are radians, everything else SI, axes north, east, down."
    ]
    for name in sorted(cardume.__all__):
        value = getattr(cardume, name)
        if isinstance(value, type):
            kind, more = "autoclass", "\n   :members:"
        elif callable(value):
            kind, more = "autofunction", ""
        else:
            continue
        parts.append(f"```{{eval-rst}}\n.. {kind}:: cardume.{name}{more}\n```")
    return "\n\n".join(parts) + "\n"


def main() -> int:
    """Build; 0 where nothing was to be complained about."""
    from sphinx.cmd.build import build_main

    target = Path(sys.argv[1]) if len(sys.argv) > 1 else SITE
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch) / "source"
        source.mkdir()
        write_source(source)
        strict = ["-W", "--keep-going", "-q", "-b", "html", "-c", str(HERE), "-d", f"{scratch}/trees"]
        code = build_main([*strict, str(source), str(target)])
    if code == 0:
        (target / "index.html").write_text(FIRST, encoding="utf-8")
        print(f"open {target / 'index.html'}")
    return int(code)


if __name__ == "__main__":
    sys.exit(main())
