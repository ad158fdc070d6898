"""`cardume run`: fly a mission and keep what comes out."""

import shlex
import shutil
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import own_up
from cardume.cli.options import (
    Asked,
    allow_code_option,
    find_mission,
    json_option,
    mission_argument,
    no_figures_option,
    output_option,
    quiet_option,
    seed_option,
    set_option,
    take_asked,
    warn_of_path_file,
)
from cardume.cli.progress import Progress
from cardume.cli.stopping import Stopped, Stopping
from cardume.cli.text import filled
from cardume.cli.version import version

if TYPE_CHECKING:
    from cardume.missions.mission import Mission
    from cardume.simulation.flight import Flight

DONE, MISSED, FAILED = 0, 1, 3


class Request(NamedTuple):
    """What the user typed."""

    mission: str
    asked: Asked


@click.command(short_help="Fly a mission, and keep what comes out.")
@mission_argument
@output_option("runs/NAME")
@seed_option
@set_option
@no_figures_option
@allow_code_option
@quiet_option
@json_option
def run(**given: Any) -> int:
    """Fly MISSION: a mission file, a path file, or a built-in mission (cardume list missions).

    Keeps the log, the numbers, the resolved mission, figures and a report to look at, and says what they mean.

    \b
    Exit code 0: done, and what the mission requires is met; 1: requirements missed;
    2: bad input; 3: failed while flying; 130 or 143: interrupted, what was flown is kept.
    """
    request = Request(asked=take_asked(given), **given)
    with Stopping() as stopping:
        return _run(request, stopping)


def _run(request: Request, stopping: Stopping) -> int:
    from cardume.missions.flying import fly_mission
    from cardume.missions.results import ResultsError, choose_destination, write_results

    asked = request.asked
    mission = find_mission(request.mission, asked.overrides, asked.seed, asked.allow_code)
    destination = choose_destination(mission.name, asked.output)
    if asked.is_talkative:
        warn_of_path_file(mission)
    with Progress(asked.is_talkative) as progress:

        def note(stage: str, done: int, total: int) -> None:
            if stage == "fly":
                stopping.begin_flight()
            progress(stage, done, total)

        flight = fly_mission(mission, progress=note, should_stop=stopping.is_asked, allow_code=asked.allow_code)
    drawing = Drawing(mission, flight, stopping)
    try:
        directory, summary = write_results(
            destination, mission, flight, version=version(), draw=None if asked.no_figures else drawing
        )
    except (ResultsError, Stopped):
        if asked.is_talkative:
            _say_numbers(mission, flight)
        raise
    _report(request, mission, flight, directory, summary)
    if drawing.lacking and asked.is_talkative:
        click.echo(f"\nnote: {drawing.lacking}", err=True)
    return _exit_code(flight, summary, drawing, stopping)


class Drawing:
    """Draws figures and report; a flight is not lost for a picture that cannot be drawn."""

    def __init__(self, mission: "Mission", flight: "Flight", stopping: Stopping) -> None:
        self.mission, self.flight, self.stopping = mission, flight, stopping
        self.problem: Exception | None = None
        self.lacking = ""  # why there is no report

    def __call__(self, folder: Path) -> None:
        if self.stopping.is_asked():
            return  # whoever pressed Ctrl-C does not want to wait for pictures
        from cardume.missions.runs import run_of
        from cardume.report.figures import save_figures
        from cardume.report.page.frame import FILE_NAME, LibraryMissing
        from cardume.report.page.page import write_page

        try:
            save_figures(self.flight, folder / "figures")
            text = (folder / "mission.yaml").read_text(encoding="utf-8")
            write_page(folder / FILE_NAME, run_of(self.mission, self.flight, text, version()))
        except LibraryMissing as problem:
            self.lacking = str(problem)
        except OSError:
            raise
        except Exception as problem:
            self.problem = problem


def _exit_code(flight: "Flight", summary: dict[str, Any], drawing: Drawing, stopping: Stopping) -> int:
    if flight.reason == "failed":
        return FAILED
    if stopping.is_asked():
        return stopping.exit_code
    if drawing.problem is not None:
        return own_up(drawing.problem, "figures or report")
    return MISSED if summary["requirements_met"] is False else DONE


def _report(request: Request, mission: "Mission", flight: "Flight", directory: Path, summary: dict[str, Any]) -> None:
    from cardume.missions.summary import to_json

    if request.asked.as_json:
        click.echo(to_json(summary), nl=False)
    elif not request.asked.quiet:
        _say_numbers(mission, flight)
        _say_files(directory, summary["files"])
        _say_next(request, mission, flight)
    if flight.reason == "failed":
        click.echo(f"error: the mission failed: {flight.failure}; what was flown is in {directory}", err=True)
    elif flight.reason == "interrupted":
        click.echo(f"interrupted at {flight.flown:g} s; what was flown is in {directory}", err=True)


def _say_numbers(mission: "Mission", flight: "Flight") -> None:
    from cardume.missions.summary import judge
    from cardume.report.table import results_table
    from cardume.report.words import meaning, verdict_lines

    width = shutil.get_terminal_size().columns
    verdicts = judge(mission.require, flight.metrics)
    click.echo(f"\n{click.style(mission.name, bold=True)}, seed {flight.seed}\n")
    click.echo(results_table(flight, width))
    if verdicts:
        click.echo("\nRequired")
    for line, is_met in verdict_lines(verdicts):
        click.secho(
            textwrap.fill(line, max(width, 40), initial_indent="  ", subsequent_indent="    "),
            fg="green" if is_met else "red",
        )
    click.echo()
    click.echo(filled(meaning(flight, mission, verdicts)))


def _say_files(directory: Path, files: Sequence[str]) -> None:
    click.echo(f"\nWritten to {directory}\n{filled(', '.join(files), indent='  ')}")


def _say_next(request: Request, mission: "Mission", flight: "Flight") -> None:
    steps = next_steps(request, mission, flight)
    longest = max(len(command) for command, _ in steps)
    width = shutil.get_terminal_size().columns
    click.echo("\nNext")
    for command, why in steps:
        fits = longest + 4 + max(len(why) for _, why in steps) <= width
        click.echo(f"  {command:<{longest}}  {why}" if fits else f"  {command}\n      {why}")


def next_steps(request: Request, mission: "Mission", flight: "Flight") -> list[tuple[str, str]]:
    """Commands that make sense after this run, and why.

    Args:
        request: what was typed.
        mission: as flown.
        flight: what came out.
    """
    same = [request.mission, *request.asked._replace(seed=None).same]
    steps = [(["check", *same], "what theory says of it")]
    if flight.reason == "completed":
        steps.append((["run", *same, "--seed", str(flight.seed + 1)], "the same with other noise"))
    if change := _worthwhile_change(mission):
        steps.append((["run", *same, "--set", change[0]], change[1]))
    return [(f"cardume {shlex.join(words)}", why) for words, why in steps]


def _worthwhile_change(mission: "Mission") -> tuple[str, str] | None:
    """A `--set` that this mission has, with a value that shows something."""
    speed = mission.current.parameters.get("speed")
    if isinstance(speed, float):
        return f"current.speed={2 * speed or 0.1:.3g}", "in twice the current" if speed else "in a current"
    law = mission.vehicles[0].guidance.law
    for name, value in law.parameters.items():
        if isinstance(value, float) and value:
            return f"guidance.{name}={2 * value:.3g}", f"with twice the {name.replace('_', ' ')}"
    return None
