"""The catalogue of laws, written from their signatures and docstrings."""

import html
from pathlib import Path
from typing import Any

from equations import as_math

from cardume.cli.list import KEYS
from cardume.missions.available import every_law
from cardume.missions.descriptions import describe, ends_of
from cardume.units import show_quantity


def write_catalog(folder: Path) -> list[str]:
    """Write a page for each family.

    Args:
        folder: of the pages.

    Returns:
        The names of the families.
    """
    folder.mkdir(parents=True, exist_ok=True)
    families = {family: laws for family, laws in every_law().items() if laws}
    for family, laws in families.items():
        parts = [
            f"# {family.replace('_', ' ').capitalize()}",
            f"In a mission under the key `{KEYS.get(family, family)}`.",
        ]
        parts += [_law(describe(law)) for law in laws.values()]
        (folder / f"{family}.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    listed = "\n".join(
        f"| [{family.replace('_', ' ')}]({family}.md) | {_names(laws)} |" for family, laws in families.items()
    )
    head = "# Laws\n\nWritten from the laws' own signatures and docstrings; `cardume list` says the same on a terminal."
    table = f"| family | laws |\n|---|---|\n{listed}"
    (folder / "index.md").write_text(f"{head}\n\n{table}\n", encoding="utf-8")
    return list(families)


def _names(laws: dict[str, Any]) -> str:
    return ", ".join(f"`{name}`" for name in laws)


def _law(told: dict[str, Any]) -> str:
    parts = [f"## {told['name']}", html.escape(told["summary"], quote=False)]
    if told["equation"]:
        parts.append(f'<div class="equation">\n{as_math(told["equation"])}\n</div>')
    if told["parameters"]:
        rows = "\n".join(_parameter(parameter) for parameter in told["parameters"])
        parts.append(f"| parameter | default | bounds | meaning |\n|---|---|---|---|\n{rows}")
    if told["source"]:
        parts.append(f"Source: {_plain(told['source'])}")
    return "\n\n".join(parts)


def _parameter(parameter: dict[str, Any]) -> str:
    if parameter["words"]:
        words = ", ".join(f"`{word}`" for word in parameter["words"])
        return f"| `{parameter['name']}` | `{parameter['default']}` | {words} | {_plain(parameter['meaning'])} |"
    default = show_quantity(parameter["default"], parameter["unit"])
    return f"| `{parameter['name']}` | {default} | {', '.join(ends_of(parameter))} | {_plain(parameter['meaning'])} |"


def _plain(text: str) -> str:
    """Text that Markdown shows as it is."""
    return "".join(f"\\{c}" if c in "\\*_|[]<>#$" else c for c in text)
