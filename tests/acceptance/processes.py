"""Other processes, with their own sources, caches and homes."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import cardume.compiler

PACKAGE = Path(cardume.compiler.__file__).parent.parent
NO_HOME = {"HOME": "/proc/nowhere", "XDG_CACHE_HOME": "/proc/nowhere/cache", "USERPROFILE": "/proc/nowhere"}


def run(
    code: str,
    folders: Sequence[Path] = (),
    variables: Mapping[str, str] = {},
    interactive: bool = False,
) -> Any:
    """Run code in a new process, and return what it prints last, which is JSON.

    Args:
        code: Python.
        folders: where it looks for modules first; a copy of the package in one of them is the package.
        variables: of its environment.
        interactive: type it line by line, as at a prompt, instead of giving it whole.
    """
    paths = [*map(str, folders), str(PACKAGE.parent), *[p for p in sys.path if p]]
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    environment |= {"PYTHONPATH": os.pathsep.join(paths), "PYTHONDONTWRITEBYTECODE": "1"} | dict(variables)
    command = [sys.executable, "-W", "ignore", *(["-i", "-q"] if interactive else ["-c", code])]
    done = subprocess.run(
        command,
        input=code if interactive else None,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    return json.loads(done.stdout.strip().splitlines()[-1])


def copy_package(to: Path) -> Path:
    """A copy of the package, without what it has compiled."""
    return Path(shutil.copytree(PACKAGE, to / PACKAGE.name, ignore=shutil.ignore_patterns("__pycache__")))


def edit(file: Path, before: str, after: str) -> None:
    """Change a file as a person would."""
    text = file.read_text()
    assert text.count(before) == 1, f"{before!r} stands {text.count(before)} times in {file.name}"
    file.write_text(text.replace(before, after))
