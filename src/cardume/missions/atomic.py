"""Files and directories that appear complete or not at all."""

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def new_file(path: Path, size: int = 0) -> Iterator[Path]:
    """A name to write to, renamed to the path when the block ends, removed when it fails.

    Args:
        path: its folder exists; the file may.
        size: [bytes] that must fit on the disk before the block begins, for writers that cannot say why they failed.
    """
    partial = _beside(path)
    try:
        if size:
            _reserve(partial, size)
        yield partial
        with partial.open("rb+") as file:
            os.fsync(file.fileno())  # a full disk says so now, not after success was reported
        os.replace(partial, path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


def write_file(path: Path, content: bytes) -> None:
    """Write a file so that at any moment its name holds the old content or all of the new.

    Args:
        path: its folder exists.
        content: [bytes] all of it.
    """
    with new_file(path) as partial:
        partial.write_bytes(content)


@contextmanager
def new_directory(target: Path) -> Iterator[Path]:
    """A folder to fill beside the target, renamed to it when the block ends, removed when it fails.

    Args:
        target: must not exist, or be empty; its missing parents are made, and unmade on failure.

    Raises:
        FileExistsError: something else took the target's name meanwhile.
    """
    made = make_parents(target.parent)
    partial = _beside(target)
    try:
        partial.mkdir()
        yield partial
        try:
            os.rename(partial, target)
        except OSError as problem:
            if target.exists():
                raise FileExistsError(problem.errno, "exists already", str(target)) from None
            raise
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        for folder in made:
            remove_if_empty(folder)
        raise


@contextmanager
def renewed_directory(target: Path, ours: tuple[str, ...]) -> Iterator[Path]:
    """A folder to fill inside an existing target, whose entries take the places of old ones when the block ends.

    The target itself stays, for it may be a mount point or somebody's current directory.

    Args:
        target: an existing directory.
        ours: its entries that make place, whether or not a new one comes.

    Raises:
        FileExistsError: an entry that is not ours took a name meanwhile.
    """
    partial, old = _beside(target / "new"), _beside(target / "old")
    moved: list[tuple[Path, Path]] = []
    try:
        partial.mkdir()
        old.mkdir()
        yield partial
        moves = [(target / name, old / name) for name in ours if (target / name).exists()]
        moves += [(entry, target / entry.name) for entry in sorted(partial.iterdir())]
        for source, destination in moves:
            if destination.exists():
                raise FileExistsError(errno.EEXIST, f"{destination.name} appeared there meanwhile", str(target))
            os.rename(source, destination)
            moved.append((source, destination))
    except BaseException:
        for source, destination in reversed(moved):
            os.rename(destination, source)
        raise
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)


def _beside(path: Path) -> Path:
    """A hidden name in the same folder, so on the same disk; one of ours left by a killed process is removed."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    if partial.is_symlink():  # somebody else's, and wherever it leads is not ours to write to
        partial.unlink()
    elif partial.is_dir():
        shutil.rmtree(partial)
    return partial


def _reserve(path: Path, size: int) -> None:
    """Fail now, with the disk's own reason, if so much does not fit."""
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)


def make_parents(folder: Path) -> list[Path]:
    """Make a folder and its parents; return those that did not exist, innermost first.

    Args:
        folder: that is to be there.
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    for path in reversed(missing):
        path.mkdir(exist_ok=True)
    return missing


def remove_if_empty(folder: Path) -> None:
    """Remove a folder if nothing is in it.

    Args:
        folder: that may be there.
    """
    with suppress(OSError):
        folder.rmdir()
