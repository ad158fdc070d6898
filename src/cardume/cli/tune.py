"""`cardume tune`: numbers of a mission tuned over all that it draws, and proved on fresh seeds."""

import re
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import Drawing, own_up
from cardume.cli.options import (
    allow_code_option,
    json_option,
    mission_argument,
    quiet_option,
    seed_option,
    set_option,
)
from cardume.cli.progress import Progress
from cardume.cli.stopping import Stopping
from cardume.cli.text import filled
from cardume.cli.version import version

if TYPE_CHECKING:
    from cardume.studies.tuning.tune import Tuning

DONE = 0
DEFAULT_RUNS, DEFAULT_TRIES = 24, 60


class Request(NamedTuple):
    """What the user typed."""

    mission: str
    metrics: tuple[str, ...]
    vary: tuple[str, ...]
    runs: int
    evaluations: int
    quantile: float | None
    met: float
    seed: int | None
    output: Path | None
    overrides: tuple[str, ...]
    no_figures: bool
    allow_code: tuple[Path, ...]
    quiet: bool
    as_json: bool

    @property
    def is_talkative(self) -> bool:
        """Whether a person reads along."""
        return not (self.quiet or self.as_json)


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
@click.option("--runs", type=int, default=DEFAULT_RUNS, metavar="N", help=f"Of each try; {DEFAULT_RUNS} if not given.")
@click.option(
    "--evaluations", type=int, default=DEFAULT_TRIES, metavar="N", help=f"Tries in all; {DEFAULT_TRIES} if not given."
)
@click.option("--quantile", type=float, metavar="Q", help="Of the metric over the runs, as 0.95, instead of its mean.")
@click.option(
    "--met",
    type=float,
    default=0.95,
    metavar="SHARE",
    help="Share of the runs in which all that the mission requires is to be met; 0.95 if not given.",
)
@seed_option
@click.option(
    "-o", "output", type=click.Path(path_type=Path), metavar="DIR", help="Where to; else runs/NAME-tuned/001, ..."
)
@set_option
@click.option("--no-figures", is_flag=True, help="Draw nothing.")
@allow_code_option
@quiet_option
@json_option
def tune(**given: Any) -> int:
    """Look for the values of --vary with which MISSION does best, whatever it draws.

    Every try flies with the same seeds. What the mission requires comes first, then the metric. At the end
    start and best fly with seeds that the search never saw, and mission.yaml holds the better one.

    \b
    Exit code 0: done; 2: bad input; 3: results could not be written; 130 or 143: interrupted, and the
    best so far is kept, unproved.
    """
    request = Request(**given)
    with Stopping() as stopping:
        return _tune(request, stopping)


def _tune(request: Request, stopping: Stopping) -> int:
    from cardume.report.tuning.words import tuning_words
    from cardume.studies.tuning.keeping import keep_tuning, tuning_destination
    from cardume.studies.tuning.tune import tune as search

    name = re.sub(r"[^A-Za-z0-9_-]+", "-", Path(request.mission).name.split(".")[0]).strip("-")[:64]
    name = f"{name or 'mission'}-tuned"
    destination = tuning_destination(name, request.output)
    with Progress(request.is_talkative) as progress:

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
            seed=request.seed,
            overrides=request.overrides,
            allow_code=request.allow_code,
            progress=note,
            should_stop=stopping.is_asked,
        )

    def draw(folder: Path) -> None:
        from cardume.report.tuning.figure import save_tuning

        save_tuning(tuning, folder)

    drawing = Drawing(draw, is_wanted=not (request.no_figures or stopping.is_asked()))
    words = tuning_words(tuning)
    directory, summary = keep_tuning(destination, name, tuning, words=words, version=version(), draw=drawing)
    _report(request, tuning, words, directory, summary)
    if stopping.is_asked():
        click.echo(f"interrupted; the best of {len(tuning.tries)} tries is in {directory}", err=True)
        return stopping.exit_code
    return own_up(drawing.problem, "the figure") if drawing.problem is not None else DONE


def _report(request: Request, tuning: "Tuning", words: list[str], directory: Path, summary: dict[str, Any]) -> None:
    if request.as_json:
        import json

        click.echo(json.dumps(summary, indent=2))
    elif not request.quiet:
        from cardume.report.tuning.words import tuning_table

        what = " and ".join(tuning.metrics)
        click.echo(f"\n{click.style(request.mission, bold=True)}, tuned for {what}\n")
        click.echo(tuning_table(tuning))
        click.echo()
        for sentence in words:
            click.echo(filled(sentence))
        click.echo(f"\nWritten to {directory}\n{filled(', '.join(summary['files']), indent='  ')}")
        _say_next(request, tuning, directory)


def _say_next(request: Request, tuning: "Tuning", directory: Path) -> None:
    mission, allowed = (
        str(directory / "mission.yaml"),
        [w for f in request.allow_code for w in ("--allow-code", str(f))],
    )
    steps = [(["run", mission, *allowed], "one mission with these values, with log and figures")]
    if tuning.is_random:
        steps.append((["study", mission, "--runs", "200", *allowed], "how often what is required is met"))
    click.echo("\nNext")
    for words, why in steps:
        click.echo(f"  cardume {shlex.join(words)}\n      {why}")
