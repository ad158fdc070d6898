"""`python -m benchmarks`: measure, print, and compare with another commit."""

import os
import sys
from pathlib import Path

import click
from rich.console import Console

from benchmarks import (
    batch,
    families,
    first_compilation,
    laboratory,
    many,
    single_mission,
    studies,
    through_water,
    users_law,
    whole_command,
)
from benchmarks.calibration import Calibration
from benchmarks.display import Display
from benchmarks.reference import measure as reference, sizes
from benchmarks.row import Row, load, run_record, save
from benchmarks.table import compare, show
from benchmarks.timing import Effort

WORKLOADS = {
    "mission": single_mission.measure,
    "command": whole_command.measure,
    "lab": laboratory.measure,
    "compilation": first_compilation.measure,
    "law": users_law.measure,
    "batch": batch.measure,
    "many": many.measure,
    "families": families.measure,
    "reference": reference.measure,
    "sizes": sizes.measure,
    "study": studies.measure,
    "through water": through_water.measure,
}
WIDTH = 120  # of tables where there is no terminal, and no COLUMNS
SMOKE_STEPS = 400  # of the calibration loop


@click.command()
@click.option("--only", multiple=True, type=click.Choice(list(WORKLOADS)), help="Just this; may be given again.")
@click.option("--json", "kept", type=click.Path(path_type=Path, dir_okay=False), help="Keep the figures in this file.")
@click.option(
    "--against", type=click.Path(path_type=Path, exists=True, dir_okay=False), help="Compare with such a file."
)
@click.option("--smoke", is_flag=True, help="Run everything for a moment: figures mean nothing.")
def main(only: tuple[str, ...], kept: Path | None, against: Path | None, smoke: bool) -> None:
    """Measure how fast cardume is. Exit code 0: measured, targets met or not; 1: something failed; 2: bad input."""
    try:
        then = load(against) if against else None
    except ValueError as problem:
        raise click.BadParameter(str(problem), param_hint="--against") from None
    console, messages = (
        Console(stderr=stream, width=None if stream_is_terminal(stream) or "COLUMNS" in os.environ else WIDTH)
        for stream in (False, True)
    )
    calibration = Calibration(SMOKE_STEPS) if smoke else Calibration()
    rows, failed = measure_all(only or tuple(WORKLOADS), Effort(calibration, smoke), messages)
    record = run_record(rows, calibration, smoke)
    show(console, rows, record)
    if then is not None and against is not None:
        compare(console, rows, record, then, against.name)
    if kept:
        save(record, kept)
        console.print(f"written to {kept}; compare with --against {kept}", highlight=False, markup=False)
    sys.exit(1 if failed else 0)


def stream_is_terminal(is_stderr: bool) -> bool:
    """Whether a person looks at a stream."""
    return (sys.stderr if is_stderr else sys.stdout).isatty()


def measure_all(names: tuple[str, ...], effort: Effort, messages: Console) -> tuple[list[Row], bool]:
    """Measure workloads one after the other; one that fails is told, and the others go on.

    Args:
        names: of WORKLOADS.
        effort: how hard to try.
        messages: for progress and failures.

    Returns:
        The figures, and whether a workload failed.
    """
    rows: list[Row] = []
    failed = False
    with Display(messages) as display:
        for number, name in enumerate(names, start=1):
            display.begin(name, number, len(names))
            try:
                rows += WORKLOADS[name](effort, display)
            except Exception:  # whatever the workload raises: its traceback is what the developer needs
                failed = True
                messages.print_exception()
    return rows, failed


if __name__ == "__main__":
    main()
