"""`cardume study`: one mission with values that are drawn or swept, flown as often as it takes."""

import shlex
import sys
import time
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import own_up
from cardume.cli.options import (
    Asked,
    allow_code_option,
    folder_name,
    json_option,
    mission_argument,
    no_figures_option,
    output_option,
    quiet_option,
    seed_option,
    set_option,
    take_asked,
)
from cardume.cli.progress import Progress, time_words
from cardume.cli.stopping import Stopping
from cardume.cli.text import filled
from cardume.studies.constants import FAILED, NOT_FLOWN, REFUSED, SAMPLINGS

if TYPE_CHECKING:
    import xarray

    from cardume.studies.answers.results import Results
    from cardume.studies.forecast import Forecast

DONE, ALL_FAILED = 0, 3
NO_TIME = 1.0  # [s] that nobody waits for


class Request(NamedTuple):
    """What the user typed."""

    mission: str
    runs: int | None
    sampling: str | None
    workers: int | None
    scheduler: str | None
    resume: bool
    asked: Asked


@click.command(short_help="Fly a mission hundreds of times, values drawn and swept.")
@mission_argument
@click.option("--runs", type=int, metavar="N", help="How often each case is flown; its seeds count from the mission's.")
@output_option("runs/NAME-study")
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
@no_figures_option
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
    request = Request(asked=take_asked(given), **given)
    with Stopping() as stopping:
        return _study(request, stopping)


class Clock:
    """How long the missions took, beside what was expected."""

    def __init__(self) -> None:
        self._began, self._expected, self._missions = 0.0, 0.0, 0

    def begin(self, forecast: "Forecast") -> None:
        """Now they fly.

        Args:
            forecast: what was announced.
        """
        self._began, self._expected, self._missions = time.monotonic(), forecast.seconds, forecast.missions

    def words(self) -> str:
        """Nothing where all was over in no time."""
        took = time.monotonic() - self._began
        if not self._missions or took < NO_TIME:
            return ""
        flown = f"{self._missions:,} missions flown in {time_words(took)}, {self._missions / took:,.3g} a second"
        return f"{flown}; {time_words(self._expected)} expected" if self._expected >= NO_TIME else flown


def _study(request: Request, stopping: Stopping) -> int:
    with _place(request) as directory:
        runs = _fly(request, directory, stopping)
    return _end(request, directory, runs, stopping)


def _fly(request: Request, directory: Path, stopping: Stopping) -> "xarray.Dataset":
    from cardume.studies.studying import study as fly_study

    asked, clock = request.asked, Clock()
    with Progress(asked.is_talkative) as progress:

        def announce(forecast: "Forecast") -> None:
            stopping.begin_flight()  # from now on there is something to keep
            progress.pause()
            if asked.is_talkative:
                _say_forecast(forecast)
            clock.begin(forecast)

        runs = fly_study(
            request.mission,
            request.runs,
            directory=directory,
            sampling=request.sampling,
            seed=asked.seed,
            overrides=asked.overrides,
            allow_code=asked.allow_code,
            workers=request.workers,
            scheduler=request.scheduler,
            resume=request.resume,
            command=shlex.join(["cardume", *sys.argv[1:]]),
            announce=announce,
            progress=progress,
            should_stop=stopping.is_asked,
        )
    if asked.is_talkative and not stopping.is_asked() and (took := clock.words()):
        click.echo(took, err=True)
    return runs


def _place(request: Request) -> AbstractContextManager[Path]:
    """Where the study is, or will be; a place that was not given is taken at once, so that nobody else takes it."""
    from cardume.errors import InputError
    from cardume.missions.results import RUNS, last_number, numbered_directory

    if request.asked.output is not None:
        return nullcontext(request.asked.output)
    parent = RUNS / folder_name(request.mission, "study")
    if not request.resume:
        return numbered_directory(parent)
    if not (number := last_number(parent)):
        raise InputError(f"there is no study in {parent} to continue; say where it is with -o DIR")
    return nullcontext(parent / f"{number:03d}")


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
    left, failed, refused = (int((status == kind).sum()) for kind in (NOT_FLOWN, FAILED, REFUSED))
    if left:
        again = shlex.join(["cardume", "study", request.mission, "--resume", "-o", str(directory), *request.asked.same])
        click.echo(
            f"interrupted; {status.size - left:,} of {status.size:,} missions are kept in {directory}; continue with\n"
            f"  {again}",
            err=True,
        )
        return stopping.exit_code or DONE
    code = _report(request, directory, runs, stopping)
    if failed or refused:
        said = [f"{failed:,} failed in flight"] * bool(failed) + [f"{refused:,} could not be flown"] * bool(refused)
        click.echo(f"of {status.size:,} missions {', '.join(said)}; `failure` in the data set says why", err=True)
    return ALL_FAILED if failed + refused == status.size else code


def _report(request: Request, directory: Path, runs: "xarray.Dataset", stopping: Stopping) -> int:
    from cardume.cli.study_answers import Drawn, draw_answers
    from cardume.report.study.words import study_words
    from cardume.studies.answers.results import Results
    from cardume.studies.summing_up import summarize_study, write_summary

    results, drawn = Results(runs), Drawn(())
    summary = summarize_study(runs) | {"conclusions": study_words(results)}
    write_summary(directory, summary)
    if request.asked.is_talkative:
        _say_numbers(request, results)
    if not (request.asked.no_figures or stopping.is_asked()):
        drawn = draw_answers(directory, results, request.asked.allow_code, stopping.is_asked)
    if request.asked.as_json:
        import json

        click.echo(json.dumps(summary, indent=2, allow_nan=False))
    elif not request.asked.quiet:
        files = sorted(path.name + "/" * path.is_dir() for path in directory.iterdir() if path.name[0] != ".")
        click.echo(f"\nWritten to {directory}\n{filled(', '.join(files), indent='  ')}")
        _say_next(request, directory, results)
        if drawn.lacking:
            click.echo(f"\nnote: {drawn.lacking}", err=True)
    return own_up(drawn.problem, "figures or report") if drawn.problem is not None else DONE


def _say_numbers(request: Request, results: "Results") -> None:
    from cardume.cli.study_answers import say_answers

    count, sampling = len(results.seeds), str(results.dataset.attrs["sampling"]).replace("_", " ")
    what = f"{results.num_cases} cases, {count:,} runs each" if results.num_cases > 1 else f"{count:,} runs"
    how = "" if sampling == "monte carlo" else f", by {sampling}"
    click.echo(f"\n{click.style(request.mission, bold=True)}, {what}{how}\n")
    say_answers(results)


def _say_next(request: Request, directory: Path, results: "Results") -> None:
    from cardume.report.study.figures import figures_that_matter

    python = f"import cardume; print(cardume.open_study({str(directory)!r}))"
    more = ["cardume", "study", request.mission, "--runs", str(4 * len(results.seeds)), *request.asked.same]
    figure = next(iter(figures_that_matter(results)), "worst")
    paper = ["cardume", "report", str(directory), "--figure", figure, "--format", "pdf", "--width", "88mm"]
    click.echo("\nNext")
    if len(results.seeds) > 1:
        click.echo(f"  {shlex.join(more)}\n      half the width of every interval")
    click.echo(f"  {shlex.join(paper)}\n      a figure for a paper")
    click.echo(f"  python -c {_quoted(python)}\n      every number of every run, in xarray")


def _quoted(text: str) -> str:
    return f'"{text}"' if not set(text) & set('"$`\\\\!') else shlex.quote(text)
