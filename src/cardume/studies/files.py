"""The files that the numbers of a mission come from beside its own text: data that it names, and laws of the user's."""

import ast
import hashlib
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import is_dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from cardume.errors import InputError
from cardume.missions.distributions import Varying, parts_of
from cardume.missions.lookup import TEXT_PARAMETERS
from cardume.missions.mission import Mission
from cardume.missions.schema import File, fields_of
from cardume.missions.vehicle import LawChoice
from cardume.units import printable

AT_ONCE = 1 << 20  # bytes

_imported: dict[Path, str] = {}  # files of laws, as they were when this process saw them first


class Named(NamedTuple):
    """Files by the names under which they are compared: data by their paths, laws by those within their folder."""

    data: dict[str, Path]
    laws: dict[str, Path]


def named_files(mission: Mission, allow_code: Iterable[str | Path]) -> Named:
    """The data files that a mission names, and the modules of its laws with all modules that these import.

    Args:
        mission: also with distributions and sweeps.
        allow_code: folders from which laws may be imported; what lies elsewhere is installed, and not looked at.
    """
    folders = [Path(folder).resolve() for folder in allow_code]
    named = Named({}, {})
    for kind, name in _names(mission):
        if kind == "data":
            named.data[name] = Path(name)
        else:
            _add_module(name.partition(":")[0], folders, named.laws)
    return named


def digests_of(named: Named) -> dict[str, str]:
    """SHA-256 of each file; "" of one that cannot be read.

    Args:
        named: from `named_files`.
    """
    return {name: _digest(path) for name, path in sorted((named.data | named.laws).items())}


def refuse_changed(kept: Mapping[str, str], found: Mapping[str, str], of: str, advice: str) -> None:
    """Check that files are what they were.

    Args:
        kept: digests of those with which a study was begun.
        found: of those that are here.
        of: whose files they are, in words.
        advice: what to do.

    Raises:
        InputError: which one is another.
    """
    for name in sorted({*kept, *found}):
        if kept.get(name) != found.get(name):
            lacking = "is not there" if not found.get(name) else "was not read" if name not in kept else "is another"
            raise InputError(f"{printable(name)} {lacking} than when {of} was begun; {advice}")


def refuse_stale(named: Named) -> None:
    """Check that the laws that this process imported are still what their files say.

    Args:
        named: from `named_files`, after the laws were imported.

    Raises:
        InputError: which one was edited meanwhile.
    """
    for name, path in named.laws.items():
        now = _digest(path)
        if _imported.setdefault(path, now) != now:
            raise InputError(
                f"{printable(name)} was edited after this process imported it, and flies as it was; start Python, or"
                " the workers of the cluster, anew"
            )


def _names(value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Varying):
        for option in getattr(value, "options", ()):
            yield from _names(option)
    elif isinstance(value, LawChoice):
        if ":" in value.name:
            yield "law", value.name
        files = [f.key for f in TEXT_PARAMETERS.get((value.family, value.name), ()) if isinstance(f.kind, File)]
        yield from (("data", str(value.parameters[key])) for key in files if value.parameters.get(key) is not None)
    else:
        if is_dataclass(value) and not isinstance(value, type):
            files = [field.key for field in fields_of(type(value)) if isinstance(field.kind, File)]
            yield from (("data", str(getattr(value, key))) for key in files)
        for _, part, _ in parts_of(value):
            yield from _names(part)


def _add_module(name: str, folders: list[Path], found: dict[str, Path]) -> None:
    """Add a module, the packages around it, and what they import, where they lie in the folders."""
    parts = name.split(".")
    for end in range(1, len(parts) + 1):
        place = Path(*parts[:end])
        files = [(f, folder) for folder in folders for f in (folder / place / "__init__.py", folder / f"{place}.py")]
        there = next(((file, folder) for file, folder in files if file.is_file()), None)
        if there is None:
            return
        file, folder = there
        key = file.relative_to(folder).as_posix()
        if key not in found:
            found[key] = file
            package = parts[:end] if file.name == "__init__.py" else parts[: end - 1]
            for inner in _imports(file, package):
                _add_module(inner, folders, found)


def _imports(file: Path, package: list[str]) -> Iterator[str]:
    """The modules that a file may import, and names in them that may be modules."""
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return  # importing it tells why
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            module = [*above, *(node.module.split(".") if node.module else [])]
            if module:
                yield ".".join(module)
            yield from (".".join([*module, alias.name]) for alias in node.names)


def _digest(path: Path) -> str:
    try:
        about = os.stat(path)
        return _digest_of(path, about.st_size, about.st_mtime_ns)
    except OSError:
        return ""


@lru_cache(maxsize=256)
def _digest_of(path: Path, _size: int, _changed: int) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as content:
        while part := content.read(AT_ONCE):
            digest.update(part)
    return digest.hexdigest()
