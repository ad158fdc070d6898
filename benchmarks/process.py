"""Start another Python and time it."""

import os
import resource
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from benchmarks.calibration import Taken
from benchmarks.row import ROOT


class Process(NamedTuple):
    """A process that ended."""

    taken: Taken
    output: str
    errors: str


def run_process(
    command: Sequence[str],
    environment: Mapping[str, str] | None = None,
    good: Sequence[int] = (0,),
    folder: Path = ROOT,
) -> Process:
    """Run a command to its end.

    Args:
        command: and its arguments.
        environment: added to this process's own.
        good: exit codes that are no failure.
        folder: where it runs.

    Raises:
        RuntimeError: another exit code, with the last lines that it wrote.
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    done = subprocess.run(
        command, cwd=folder, env=os.environ | dict(environment or {}), capture_output=True, text=True, check=False
    )
    seconds = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in good:
        said = "\n".join((done.stderr or done.stdout).strip().splitlines()[-5:])
        raise RuntimeError(f"{' '.join(command)} ended with exit code {done.returncode}:\n{said}")
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Process(Taken(seconds, cpu), done.stdout, done.stderr)


def cardume_command() -> list[str]:
    """What a user types, from the environment that runs this."""
    script = Path(sys.executable).with_name("cardume")
    return [sys.executable, str(script)] if script.is_file() else [sys.executable, "-c", _MAIN]


_MAIN = "import sys; from cardume.cli.main import main; sys.exit(main())"
