"""`cardume tune`: numbers of a mission tuned over all that it draws, and proved on fresh seeds."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import Drawing, own_up
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
from cardume.cli.progress import Progress
from cardume.cli.stopping import Stopping
from cardume.cli.text import filled
from cardume.cli.version import version
from cardume.studies.constants import DEFAULT_MET, DEFAULT_TRIES, DEFAULT_TUNED

if TYPE_CHECKING:
    from cardume.studies.tuning.tune import Tuning

DONE = 0


class Request(NamedTuple):
    """What the user typed."""

    mission: str
    metrics: tuple[str, ...]
    vary: tuple[str, ...]
    runs: int
    evaluations: int
    quantile: float | None
    met: float
    resume: Path | None
    asked: Asked


@click.command(short_help="Tune gains over all that a mission draws.")
@mission_argument
@click.option(
    "--for",
    "metrics",
    multiple=True,
    required=True,
    metavar="METRIC",
    help="What to improve, as cross_track_rms; two or three give the best compromises.",
)
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY[=A..B]",
    help="A number to change, and from where to where, as guidance.lookahead=2..15; may be repeated.",
)
@click.option(
    "--runs", type=int, default=DEFAULT_TUNED, metavar="N", help=f"Of each try; {DEFAULT_TUNED} if not given."
)
@click.option(
    "--evaluations", type=int, default=DEFAULT_TRIES, metavar="N", help=f"Tries in all; {DEFAULT_TRIES} if not given."
)
@click.option("--quantile", type=float, metavar="Q", help="Of the metric over the runs, as 0.95, instead of its mean.")
@click.option(
    "--met",
    type=float,
    default=DEFAULT_MET,
    metavar="SHARE",
    help=f"Share of the runs in which all that the mission requires is to be met; {DEFAULT_MET} if not given.",
)
@seed_option
@output_option("runs/NAME-tuned")
@click.option(
    "--resume",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Continue a tuning that was interrupted, with what is given as it was then.",
)
@set_option
@no_figures_option
@allow_code_option
@quiet_option
@json_option
def tune(**given: Any) -> int:
    """Look for the values of --vary with which MISSION does best, whatever it draws.

    Every try flies with the same seeds. What the mission requires comes first, then the metric. At the end
    start and best fly with seeds that the search never saw, and mission.yaml holds the better one.

    \b
    Exit code 0: done; 2: bad input; 3: results could not be written; 130 or 143: interrupted, and the
    best so far is kept, unproved; --resume continues.
    """
    request = Request(asked=take_asked(given), **given)
    with Stopping() as stopping:
        return _tune(request, stopping)


def _tune(request: Request, stopping: Stopping) -> int:
    from cardume.missions.results import choose_destination
    from cardume.report.tuning.words import tuning_words
    from cardume.studies.tuning.keeping import Journal, keep_tuning
    from cardume.studies.tuning.resuming import read_tuning
    from cardume.studies.tuning.tune import tune as search

    asked, name = request.asked, folder_name(request.mission, "tuned")
    journal = Journal(choose_destination(name, asked.output or request.resume, read_tuning), name, version())
    with Progress(asked.is_talkative) as progress:

        def note(stage: str, done: int, total: int) -> None:
            if stage == "tune" and done:
                stopping.begin_flight()  # from now on there is something to keep
            progress(stage, done, total)

        tuning = search(
            request.mission,
            request.vary,
            request.metrics,
            runs=request.runs,
            evaluations=request.evaluations,
            quantile=request.quantile,
            met=request.met,
            seed=asked.seed,
            overrides=asked.overrides,
            allow_code=asked.allow_code,
            resume=request.resume,
            remember=journal,
            progress=note,
            should_stop=stopping.is_asked,
        )

    def draw(folder: Path) -> None:
        from cardume.report.tuning.figure import save_tuning

        save_tuning(tuning, folder)

    drawing = Drawing(draw, is_wanted=not (asked.no_figures or stopping.is_asked()))
    words = tuning_words(tuning)
    directory, summary = keep_tuning(journal.destination, name, tuning, words=words, version=version(), draw=drawing)
    _report(request, tuning, words, directory, summary)
    if tuning.is_interrupted:
        again = shlex.join(["cardume", "tune", request.mission, *_same(request), "--resume", str(directory)])
        click.echo(
            f"interrupted; the best of {len(tuning.tries)} tries is in {directory}; continue with\n  {again}", err=True
        )
    if stopping.is_asked():
        return stopping.exit_code
    return own_up(drawing.problem, "the figure") if drawing.problem is not None else DONE


def _report(request: Request, tuning: "Tuning", words: list[str], directory: Path, summary: dict[str, Any]) -> None:
    if request.asked.as_json:
        import json

        click.echo(json.dumps(summary, indent=2))
    elif not request.asked.quiet:
        from cardume.report.tuning.words import tuning_table

        what = " and ".join(tuning.metrics)
        click.echo(f"\n{click.style(request.mission, bold=True)}, tuned for {what}\n")
        click.echo(tuning_table(tuning))
        click.echo()
        for sentence in words:
            click.echo(filled(sentence))
        click.echo(f"\nWritten to {directory}\n{filled(', '.join(summary['files']), indent='  ')}")
        _say_next(request, tuning, directory)


def _same(request: Request) -> list[str]:
    """The options without which it would be another search."""
    words = [word for metric in request.metrics for word in ("--for", metric)]
    words += [word for text in request.vary for word in ("--vary", text)]
    words += ["--runs", str(request.runs), "--evaluations", str(request.evaluations), "--met", str(request.met)]
    words += [] if request.quantile is None else ["--quantile", str(request.quantile)]
    return words + request.asked.same


def _say_next(request: Request, tuning: "Tuning", directory: Path) -> None:
    mission, allowed = str(directory / "mission.yaml"), request.asked.allowed
    steps = [(["run", mission, *allowed], "one mission with these values, with log and figures")]
    if tuning.is_random:
        steps.append((["study", mission, "--runs", "200", *allowed], "how often what is required is met"))
    click.echo("\nNext")
    for words, why in steps:
        click.echo(f"  cardume {shlex.join(words)}\n      {why}")
