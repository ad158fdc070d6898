"""The folder that the laboratory may read and write: missions are found in it, and saved into it."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cardume.errors import InputError
from cardume.missions import library
from cardume.missions.atomic import write_file
from cardume.missions.opening import MISSION_FILES
from cardume.missions.tree import SAFE_NAME
from cardume.units import printable, show_text

PATH_FILES = (".plan", ".waypoints", ".gpx", ".geojson", ".medusa.txt")
DEEPEST, MOST = 3, 500  # folders below it, files listed
NOT_LISTED = ("runs", "node_modules", "__pycache__")


@dataclass(frozen=True)
class Folder:
    """A folder, symbolic links in its own name resolved."""

    root: Path

    def names(self) -> list[str]:
        """The mission and path files in it, by their names relative to it."""
        return sorted(name for name, _ in zip(self._found(self.root, 0), range(MOST), strict=False))

    def _found(self, folder: Path, depth: int) -> Iterator[str]:
        try:
            entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError:
            return
        for entry in entries:
            if entry.name.startswith(".") or entry.name in NOT_LISTED:
                continue
            if entry.is_dir(follow_symlinks=False):
                if depth < DEEPEST:
                    yield from self._found(Path(entry.path), depth + 1)
            elif entry.name.lower().endswith((*MISSION_FILES, *PATH_FILES)) and entry.name.isprintable():
                yield Path(entry.path).relative_to(self.root).as_posix()

    def file(self, name: str) -> Path:
        """A file in it, by its name relative to it.

        Args:
            name: as `names` lists it.

        Raises:
            InputError: the name leads elsewhere, to another kind of file, or to nothing.
        """
        try:
            path = (self.root / name).resolve()
            is_inside = path.is_relative_to(self.root) and not Path(name).is_absolute()
            is_file = is_inside and path.is_file()
        except (OSError, ValueError, RuntimeError):
            is_inside = is_file = False
        if not is_inside:
            raise InputError(f"{show_text(name)} lies outside of {self}; only files in that folder are read here")
        if not is_file or not path.name.lower().endswith((*MISSION_FILES, *PATH_FILES)):
            raise InputError(f"there is no mission or path file {show_text(name)} in {self}")
        return path

    def save(self, name: str, text: str, may_replace: bool) -> Path:
        """Write a mission file, complete or not at all.

        Args:
            name: without a folder; `.yaml` may be left out.
            text: of the mission.
            may_replace: whether a file of that name may give way.

        Raises:
            InputError: no plain name, a name that is taken, or a folder that cannot be written to.
            NameTaken: there is a file of that name.
        """
        stem = name.removesuffix(".yaml").removesuffix(".yml")
        if not SAFE_NAME.fullmatch(stem):
            raise InputError(f"{show_text(name)} is no name for a file; 1 to 64 letters, digits, - and _")
        path = self.root / (name if name.endswith(MISSION_FILES) else f"{name}.yaml")
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise InputError(f"{path.name} is taken by something that is no plain file; give another name")
        if path.exists() and not may_replace:
            raise NameTaken(f"there is a {path.name} in {self} already")
        try:
            write_file(path, text.encode("utf-8"))
        except OSError as problem:
            raise InputError(f"{path.name} could not be written to {self}: {problem.strerror}") from None
        return path

    def __str__(self) -> str:
        return printable(str(self.root))


class NameTaken(InputError):
    """A file would be replaced; whoever asked has to say that it may."""


def open_folder(given: Path) -> Folder:
    """A folder to work in.

    Args:
        given: by the person.

    Raises:
        InputError: it is none.
    """
    if not given.is_dir():
        raise InputError(f"{printable(str(given))} is no folder; give the one that holds your missions")
    return Folder(given.resolve())


def readable(folder: Folder) -> list[Path]:
    """What missions may read: the folder, and the data of built-in missions.

    Args:
        folder: chosen by the person.
    """
    return [folder.root, library.HERE, *library.own_data()]
