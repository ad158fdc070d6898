"""`cardume compare`: laws, values or missions side by side, under the same random numbers."""

import re
import shlex
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import Drawing, own_up
from cardume.cli.options import (
    Asked,
    allow_code_option,
    folder_name,
    json_option,
    no_figures_option,
    output_option,
    quiet_option,
    set_option,
    take_asked,
)
from cardume.cli.progress import Progress
from cardume.cli.stopping import Stopped, Stopping
from cardume.cli.text import filled
from cardume.cli.version import version
from cardume.studies.constants import DEFAULT_COMPARED, MOST_COMPARED

if TYPE_CHECKING:
    from cardume.studies.comparing import Comparison

DONE, FAILED = 0, 3


class Request(NamedTuple):
    """What the user typed."""

    missions: tuple[str, ...]
    vary: tuple[str, ...]
    runs: int | None
    seeds: tuple[int, ...] | None
    metrics: tuple[str, ...]
    asked: Asked


def _read_seeds(_ctx: click.Context, _parameter: click.Parameter, given: str | None) -> tuple[int, ...] | None:
    """`3`, `1-20` or `1-5,8,13` as seeds."""
    if given is None:
        return None
    seeds: list[int] = []
    for part in given.split(","):
        ends = re.fullmatch(r"\s*(\d{1,19})\s*(?:-\s*(\d{1,19})\s*)?", part)
        if not ends:
            raise click.BadParameter(f"{part.strip()!r} is no seed; write whole numbers, as 1-20 or 3,7,9")
        first, last = int(ends[1]), int(ends[2] or ends[1])
        if last < first:
            raise click.BadParameter(f"{part.strip()!r} counts backwards; write {last}-{first}")
        if last - first >= MOST_COMPARED:
            raise click.BadParameter(f"{part.strip()!r} are more than {MOST_COMPARED} seeds; give fewer")
        seeds += range(first, last + 1)
    return tuple(seeds)


@click.command(short_help="Compare laws, values or missions, chance allowed for.")
@click.argument("missions", nargs=-1, required=True, metavar="MISSION...")
@click.option(
    "--vary",
    multiple=True,
    metavar="KEY=A,B,...",
    help="A key and the values it takes, as guidance.law=line_of_sight,arcsine; may be repeated.",
)
@click.option(
    "--runs",
    type=click.IntRange(1, MOST_COMPARED),
    metavar="N",
    help=f"With seeds 1 to N; {DEFAULT_COMPARED} if not given.",
)
@click.option("--seeds", callback=_read_seeds, metavar="A-B", help="With these seeds instead, as 1-20 or 3,7,9.")
@click.option(
    "--for", "metrics", multiple=True, metavar="METRIC", help="What to compare, as cross_track_rms; may be repeated."
)
@output_option("runs/NAME-compared")
@set_option
@no_figures_option
@allow_code_option
@quiet_option
@json_option
def compare(**given: Any) -> int:
    """Fly MISSION with each value of --vary, or several missions, and say which differences are real.

    All arms meet the same noise, losses and draws, seed by seed, so that a difference is the arms' own.
    Sweeps in a mission file make arms, too. Differences are to the first arm.

    \b
    Exit code 0: compared; 2: bad input; 3: an arm failed in every mission, or results could not be
    written; 130 or 143: interrupted, and what all arms had flown is compared and kept.
    """
    request = Request(asked=take_asked(given), **given)
    with Stopping() as stopping:
        return _compare(request, stopping)


def _compare(request: Request, stopping: Stopping) -> int:
    from cardume.missions.results import ResultsError, choose_destination
    from cardume.report.comparison_words import conclusions
    from cardume.studies.arms import parse_vary
    from cardume.studies.comparing import compare as fly_and_compare
    from cardume.studies.keeping import keep_comparison, read_comparison

    if request.runs is not None and request.seeds is not None:
        raise click.UsageError("--runs and --seeds both say which seeds to fly; give one of them.")
    asked, name = request.asked, folder_name(request.missions[0], "compared")
    destination = choose_destination(name, asked.output, read_comparison)
    with Progress(asked.is_talkative) as progress:

        def note(stage: str, done: int, total: int) -> None:
            if stage == "compare" and done:
                stopping.begin_flight()  # from now on there is something to keep
            progress(stage, done, total)

        comparison = fly_and_compare(
            list(request.missions),
            parse_vary(request.vary),
            runs=request.runs or DEFAULT_COMPARED,
            seeds=request.seeds,
            metrics=request.metrics,
            overrides=asked.overrides,
            allow_code=asked.allow_code,
            progress=note,
            should_stop=stopping.is_asked,
        )
    if not comparison.seeds and stopping.number is not None:
        raise Stopped(stopping.number)  # before all arms had flown one

    def draw(folder: Path) -> None:
        from cardume.report.comparison_figure import save_comparison

        save_comparison(comparison, folder)

    drawing = Drawing(draw, is_wanted=not (asked.no_figures or stopping.is_asked()))
    words = conclusions(comparison)
    try:
        directory, summary = keep_comparison(
            destination, name, comparison, words=words, version=version(), draw=drawing
        )
    except ResultsError:
        if asked.is_talkative:
            _say_numbers(request, comparison, words)
        raise
    _report(request, comparison, words, directory, summary)
    return _exit_code(comparison, drawing, stopping)


def _exit_code(comparison: "Comparison", drawing: Drawing, stopping: Stopping) -> int:
    if stopping.is_asked():
        return stopping.exit_code
    if any(len(comparison.failures(arm)) == len(comparison.seeds) for arm in range(len(comparison.arms))):
        return FAILED
    if drawing.problem is not None:
        return own_up(drawing.problem, "the figure")
    return DONE


def _report(
    request: Request, comparison: "Comparison", words: Sequence[str], directory: Path, summary: dict[str, Any]
) -> None:
    if request.asked.as_json:
        import json

        click.echo(json.dumps(summary, indent=2))
    elif not request.asked.quiet:
        _say_numbers(request, comparison, words)
        click.echo(f"\nWritten to {directory}\n{filled(', '.join(summary['files']), indent='  ')}")
        _say_next(request, comparison)
    if comparison.is_interrupted:
        flown = f"{len(comparison.seeds)} of {comparison.asked} seeds"
        click.echo(f"interrupted; what all arms flew, {flown}, is in {directory}", err=True)


def _say_numbers(request: Request, comparison: "Comparison", words: Sequence[str]) -> None:
    from cardume.report.comparison_table import comparison_table

    missions = ", ".join(request.missions) if len(request.missions) < 4 else f"{len(request.missions)} missions"
    varied = f", {' and '.join(comparison.varied)} varied" if comparison.varied else ""
    click.echo(f"\n{click.style(missions, bold=True)}{varied}; {_seed_words(comparison.seeds)}\n")
    click.echo(comparison_table(comparison, shutil.get_terminal_size().columns))
    click.echo()
    for sentence in words:
        click.echo(filled(sentence))


def _seed_words(seeds: Sequence[int]) -> str:
    if len(seeds) == 1:
        return f"seed {seeds[0]}"
    if list(seeds) == list(range(seeds[0], seeds[0] + len(seeds))):
        return f"seeds {seeds[0]} to {seeds[-1]}, the same for all"
    return f"{len(seeds)} seeds, the same for all"


def _say_next(request: Request, comparison: "Comparison") -> None:
    click.echo("\nNext")
    for command, why in next_steps(request, comparison):
        click.echo(f"  {command}\n      {why}")


def next_steps(request: Request, comparison: "Comparison") -> list[tuple[str, str]]:
    """Commands that make sense after this comparison, and why.

    Args:
        request: what was typed.
        comparison: what was flown.
    """
    steps = []
    real = [place for place in range(1, len(comparison.arms)) if _is_any_real(comparison, place)]
    count = len(comparison.seeds)
    is_random = any(e.low < e.high for metric in comparison.metrics for e in comparison.differences[metric])
    same = list(request.missions)
    for text in request.vary:
        same += ["--vary", text]
    for text in request.metrics:
        same += ["--for", text]
    same += request.asked.same
    if count == 1 or (is_random and len(real) < len(comparison.arms) - 1 and count < MOST_COMPARED // 4):
        more = DEFAULT_COMPARED if count == 1 else 4 * count
        steps.append((["compare", *same, "--runs", str(more)], "more seeds, smaller differences"))
    arm = comparison.arms[real[0] if real else -1]
    alone = ["run", arm.given, "--seed", str(comparison.seeds[0])]
    for text in (*request.asked.overrides, *arm.changes):
        alone += ["--set", text]
    if arm.is_runnable:
        steps.append(([*alone, *request.asked.allowed], f"one mission of {arm.label}, with log and figures"))
    return [(f"cardume {shlex.join(words)}", why) for words, why in steps]


def _is_any_real(comparison: "Comparison", place: int) -> bool:
    return any(comparison.is_real[metric][place - 1] for metric in comparison.metrics)
