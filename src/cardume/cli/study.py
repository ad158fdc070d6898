"""`cardume study`: one mission with values that are drawn or swept, flown as often as it takes."""

import shlex
import shutil
import sys
import textwrap
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.options import (
    allow_code_option,
    json_option,
    mission_argument,
    quiet_option,
    seed_option,
    set_option,
)
from cardume.cli.progress import Progress, time_words
from cardume.cli.stopping import Stopping

if TYPE_CHECKING:
    import xarray

    from cardume.studies.forecast import Forecast

DONE, FAILED, BUG = 0, 3, 4
RUNS = Path("runs")
SAMPLINGS = ("monte_carlo", "latin_hypercube", "sobol")
WIDEST_TEXT = 100  # characters


class Request(NamedTuple):
    """What the user typed."""

    mission: str
    runs: int | None
    output: Path | None
    sampling: str | None
    workers: int | None
    scheduler: str | None
    resume: bool
    seed: int | None
    overrides: tuple[str, ...]
    allow_code: tuple[Path, ...]
    no_figures: bool
    quiet: bool
    as_json: bool

    @property
    def is_talkative(self) -> bool:
        """Whether a person reads along."""
        return not (self.quiet or self.as_json)


@click.command(short_help="Fly a mission hundreds of times, values drawn and swept.")
@mission_argument
@click.option("--runs", type=int, metavar="N", help="How often each case is flown; its seeds count from the mission's.")
@click.option(
    "-o", "output", type=click.Path(path_type=Path), metavar="DIR", help="Where to; else runs/NAME-study/001, ..."
)
@click.option(
    "--sampling",
    type=click.Choice(SAMPLINGS),
    help="How values are drawn: by chance (monte_carlo, if not given), or spread more evenly.",
)
@click.option("--workers", type=int, metavar="N", help="On N processes of this machine, by Dask.")
@click.option("--scheduler", metavar="ADDRESS", help="On a Dask cluster that runs already, as tcp://192.168.1.7:8786.")
@click.option("--resume", is_flag=True, help="Continue a study that was interrupted, killed or damaged.")
@seed_option
@set_option
@click.option("--no-figures", is_flag=True, help="Draw nothing.")
@allow_code_option
@quiet_option
@json_option
def study(**given: Any) -> int:
    """Fly MISSION with many seeds, and with every combination of the values that it sweeps.

    Values vary where the mission says so, in the file or by --set: {uniform: [0 m/s, 0.3 m/s]}, {normal:
    [0 deg, 1 deg]} and {choose: [1 s, 2 s]} are drawn for each run, {sweep: [0, 0.2, 0.5]} makes cases.
    All cases meet the same noise and the same draws, run by run.

    \b
    Exit code 0: flown; 2: bad input; 3: every mission failed, or results could not be written;
    130 or 143: interrupted, and --resume continues, as it does after a crash.
    """
    request = Request(**given)
    with Stopping() as stopping:
        return _study(request, stopping)


def _study(request: Request, stopping: Stopping) -> int:
    from cardume.studies.studying import study as fly_study

    directory = _place(request)
    with Progress(request.is_talkative) as progress:

        def announce(forecast: "Forecast") -> None:
            stopping.begin_flight()  # from now on there is something to keep
            progress.pause()
            if request.is_talkative:
                _say_forecast(forecast)

        try:
            runs = fly_study(
                request.mission,
                request.runs,
                directory=directory,
                sampling=request.sampling,
                seed=request.seed,
                overrides=request.overrides,
                allow_code=request.allow_code,
                workers=request.workers,
                scheduler=request.scheduler,
                resume=request.resume,
                command=shlex.join(["cardume", *sys.argv[1:]]),
                announce=announce,
                progress=progress,
                should_stop=stopping.is_asked,
            )
        except BaseException:
            if not request.resume:
                with suppress(OSError):
                    directory.rmdir()  # reserved, and still empty
            raise
    return _end(request, directory, runs, stopping)


def _place(request: Request) -> Path:
    """Where the study is, or will be; a place that was not given is taken at once, so that nobody else takes it."""
    from cardume.errors import InputError

    if request.output is not None:
        return request.output
    parent = RUNS / f"{_name(request.mission)}-study"
    there = sorted((path for path in parent.glob("*") if path.name.isdigit()), key=lambda path: int(path.name))
    if request.resume:
        if not there:
            raise InputError(f"there is no study in {parent} to continue; say where it is with -o DIR")
        return there[-1]
    number = int(there[-1].name) + 1 if there else 1
    while True:
        try:
            (parent / f"{number:03d}").mkdir(parents=True)
            return parent / f"{number:03d}"
        except FileExistsError:
            number += 1


def _name(mission: str) -> str:
    stem = Path(mission).name.split(".")[0]
    safe = "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in stem).strip("-")
    return safe or "mission"


def _say_forecast(forecast: "Forecast") -> None:
    from cardume.studies.beginning import in_bytes

    for note in forecast.notes:
        click.secho("note: ", fg="yellow", bold=True, nl=False, err=True)
        click.echo(note, err=True)
    if forecast.missions == 0:
        click.echo("All was flown before, and is undamaged.", err=True)
        return
    more = " more" if forecast.complete else ""
    took = max(forecast.seconds, 1.0)
    at_once = f"{forecast.slots} at a time" if forecast.slots else "as soon as the cluster has workers"
    click.echo(
        f"{forecast.missions:,}{more} missions, {at_once}: some {time_words(took)}; at most {in_bytes(forecast.bytes)}"
        f" in {forecast.directory}, of {in_bytes(forecast.free)} that are free there",
        err=True,
    )


def _end(request: Request, directory: Path, runs: "xarray.Dataset", stopping: Stopping) -> int:
    status = runs["status"].to_numpy()
    left, failed = int((status == 0).sum()), int((status > 1).sum())
    if left:
        again = shlex.join(["cardume", "study", request.mission, "--resume", "-o", str(directory), *_same(request)])
        click.echo(
            f"interrupted; {status.size - left:,} of {status.size:,} missions are kept in {directory}; continue with\n"
            f"  {again}",
            err=True,
        )
        return stopping.exit_code or DONE
    return _report(request, directory, runs, failed)


def _same(request: Request) -> list[str]:
    """The options without which it would be another mission, or could not be read."""
    words = []
    for change in request.overrides:
        words += ["--set", change]
    if request.seed is not None:
        words += ["--seed", str(request.seed)]
    for folder in request.allow_code:
        words += ["--allow-code", str(folder)]
    return words


def _report(request: Request, directory: Path, runs: "xarray.Dataset", failed: int) -> int:
    from cardume.studies.summing_up import summarize_study, write_summary

    summary, problem = summarize_study(runs), None
    write_summary(directory, summary)
    if not request.no_figures:
        problem = _draw(directory, runs)
    if request.as_json:
        import json

        click.echo(json.dumps(summary, indent=2, allow_nan=False))
    elif not request.quiet:
        _say_numbers(request, runs)
        files = sorted(path.name + "/" * path.is_dir() for path in directory.iterdir() if path.name[0] != ".")
        click.echo(f"\nWritten to {directory}\n{_filled(', '.join(files), indent='  ')}")
        _say_next(request, directory, runs)
    if failed:
        click.echo(
            f"{failed:,} of {runs['status'].size:,} missions failed; `failure` in the data set says why", err=True
        )
    if failed == runs["status"].size:
        return FAILED
    return _own_up(problem) if problem is not None else DONE


def _draw(directory: Path, runs: "xarray.Dataset") -> Exception | None:
    """Draw the figures; a study is not lost for one that cannot be drawn."""
    from cardume.report.study.figures import save_study_figures

    try:
        save_study_figures(runs, directory / "figures")
    except OSError:
        raise
    except Exception as problem:
        return problem
    return None


def _own_up(problem: Exception) -> int:
    from cardume.cli.bugs import save_traceback

    where = save_traceback(problem)
    click.echo(f"error: the figures could not be drawn, a bug in cardume; the details are in {where}", err=True)
    return BUG


def _say_numbers(request: Request, runs: "xarray.Dataset") -> None:
    from cardume.report.study.table import study_table
    from cardume.report.study.words import study_words

    count, sampling = runs.sizes["run"], str(runs.attrs["sampling"]).replace("_", " ")
    cases = runs["status"].size // count
    what = f"{cases} cases, {count:,} runs each" if cases > 1 else f"{count:,} runs"
    how = "" if sampling == "monte carlo" else f", by {sampling}"
    click.echo(f"\n{click.style(request.mission, bold=True)}, {what}{how}\n")
    click.echo(study_table(runs, shutil.get_terminal_size().columns))
    click.echo()
    for sentence in study_words(runs):
        click.echo(_filled(sentence))


def _say_next(request: Request, directory: Path, runs: "xarray.Dataset") -> None:
    python = f"import cardume; print(cardume.open_study({str(directory)!r}))"
    more = ["cardume", "study", request.mission, "--runs", str(4 * runs.sizes["run"]), *_same(request)]
    click.echo(f"\nNext\n  {shlex.join(more)}\n      half the width of every interval")
    click.echo(f"  python -c {_quoted(python)}\n      every number of every run, in xarray")


def _quoted(text: str) -> str:
    return f'"{text}"' if not set(text) & set('"$`\\\\!') else shlex.quote(text)


def _filled(text: str, indent: str = "") -> str:
    room = max(40, min(shutil.get_terminal_size().columns, WIDEST_TEXT))
    return textwrap.fill(
        text, room, initial_indent=indent, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
