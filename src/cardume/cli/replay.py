"""`cardume replay`: an estimator over recorded data, held against the truth where there is one."""

import json
import math
import shlex
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.cli.drawing import Drawing, own_up
from cardume.cli.options import (
    Asked,
    allow_code_option,
    json_option,
    no_figures_option,
    output_option,
    quiet_option,
    set_option,
    take_asked,
)
from cardume.cli.progress import Progress
from cardume.cli.stopping import stoppable
from cardume.cli.text import filled
from cardume.cli.version import version

if TYPE_CHECKING:
    from cardume.missions.recordings.asking import Request
    from cardume.missions.recordings.replaying import Replay

DONE = 0
KINDS = ("log", "nmea", "evologics", "plaza", "bag", "csv")


class Column(NamedTuple):
    """A column of the table, left out where the terminal is too narrow for its rank or nothing is known of it."""

    rank: int
    heading: str
    field: str
    form: str


COLUMNS = (
    Column(3, "fixes", "fixes", ".0f"),
    Column(8, "believed", "believed", ".0f"),
    Column(1, "error rms [m]", "position_error_rms", ".3f"),
    Column(2, "worst [m]", "position_error_max", ".3f"),
    Column(7, "current [m/s]", "current_error_rms", ".4f"),
    Column(5, "ANEES", "anees", ".2f"),
    Column(4, "NIS", "nis", ".2f"),
    Column(9, "inside 95 %", "inside_95", ".1%"),
    Column(6, "innov. rms [m]", "innovation_rms", ".3f"),
)


@click.command(short_help="An estimator over recorded data, against the truth.")
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--position",
    metavar="law=NAME,...",
    help="The position law and its parameters, as law=reset or law=kalman_replay,gate=9.",
)
@click.option("--current-observer", metavar="law=NAME,...", help="The same of the current.")
@click.option("--vehicle", "vehicles", multiple=True, metavar="NAME", help="Only this one; may be repeated.")
@click.option("--format", "kind", type=click.Choice(KINDS), help="Of the recording, where its contents do not say it.")
@click.option("--start", metavar="NORTH,EAST", help="Where it starts [m], or 'unknown' for a recording of ranges.")
@click.option("--smooth", "looks_back", is_flag=True, help="Also say where it was by all fixes, later ones too.")
@click.option(
    "--topic", "topics", multiple=True, metavar="ROLE=/TOPIC", help="Of a bag: fix, truth, heading, velocity or depth."
)
@click.option(
    "--tick",
    default=0.1,
    metavar="S",
    type=click.FloatRange(1e-3, 60.0),
    help="Of the navigation; of a flight, its own.",
    show_default=True,
)
@click.option(
    "--depth", default=float("nan"), metavar="M", type=float, help="Of the vehicle, where nobody measured it."
)
@click.option("--head", metavar="NORTH,EAST", help="Where a USBL head lies [m], where nobody measured it.")
@click.option(
    "--sound-speed",
    default=1500.0,
    metavar="M/S",
    type=click.FloatRange(1300.0, 1700.0),
    help="For times of travel.",
    show_default=True,
)
@click.option(
    "--fix-sigma",
    default=float("nan"),
    metavar="M",
    type=click.FloatRange(1e-3, 1e4),
    help="Of fixes that do not tell theirs.",
)
@output_option("runs/replay-NAME")
@set_option
@no_figures_option
@allow_code_option
@quiet_option
@json_option
@stoppable
def replay(**given: Any) -> int:
    """Play RECORDING through the navigation of a vehicle, and say how far it is from the truth, or from its fixes.

    RECORDING is the log.nc of a run, an NMEA log, a transcript of an EvoLogics modem, a Plaza record, a ROS bag or a
    CSV: docs/replay.md has the columns, topics and traps.

    \b
      cardume replay runs/figure-5/001 --position law=kalman_replay
      cardume replay boat.nmea --vehicle ship
      cardume replay dive.mcap --topic fix=/usbl --topic heading=/imu --topic velocity=/dvl
    """
    from cardume.missions.recordings.asking import name_of
    from cardume.missions.recordings.keeping import keep
    from cardume.missions.recordings.replaying import replay as play
    from cardume.missions.results import choose_destination
    from cardume.report.replay_figure import save_replay

    asked = take_asked(given)
    request = _request(asked, given)
    destination = choose_destination(name_of(request.path), asked.output)
    with Progress(asked.is_talkative) as progress:
        found = play(request, progress)
    drawing = Drawing(lambda folder: save_replay(found, folder / "figures"), not asked.no_figures)
    directory, summary = keep(destination, found, version=version(), draw=drawing)
    if asked.as_json:
        click.echo(json.dumps(summary, indent=2))
    elif not asked.quiet:
        _say(found, directory, summary, request)
    return own_up(drawing.problem, "the figure") if drawing.problem is not None else DONE


def _request(asked: Asked, given: dict[str, Any]) -> "Request":
    from cardume.missions.recordings.asking import Request, read_position, read_start
    from cardume.missions.recordings.base import Options

    topics = []
    for text in given["topics"]:
        role, equals, topic = text.partition("=")
        if not equals or not topic:
            raise click.BadParameter(f"'{text}' cannot be read; write ROLE=/TOPIC, as --topic fix=/usbl/fix")
        topics.append((role.strip(), topic.strip()))
    head = read_start(given["head"]) if given["head"] else (0.0, 0.0)
    if isinstance(head, str):
        raise click.BadParameter("--head is NORTH,EAST in meters")
    options = Options(
        sound_speed=given["sound_speed"],
        depth=given["depth"],
        head=head,
        topics=tuple(topics),
        fix_sigma=given["fix_sigma"],
    )
    return Request(
        path=given["recording"],
        kind=given["kind"] or "",
        vehicles=given["vehicles"],
        position=read_position(given["position"], "--position") if given["position"] else None,
        current_observer=read_position(given["current_observer"], "--current-observer")
        if given["current_observer"]
        else None,
        overrides=asked.overrides,
        start=read_start(given["start"]) if given["start"] else None,
        tick=given["tick"],
        options=options,
        looks_back=given["looks_back"],
        allow_code=asked.allow_code,
    )


def _say(found: "Replay", directory: Path, summary: dict[str, Any], request: "Request") -> None:
    click.echo(
        f"\n{click.style(found.name, bold=True)}, {found.kind}{f', began {found.began}' if found.began else ''}\n"
    )
    click.echo(table_of(found, shutil.get_terminal_size().columns))
    click.echo()
    click.echo(filled(meaning(found)))
    for note in found.notes:
        click.echo(filled(f"note: {note}", ""))
    click.echo(f"\nWritten to {directory}\n{filled(', '.join(summary['files']), indent='  ')}")
    click.echo("\nNext")
    for command, why in next_steps(found, directory, request):
        click.echo(f"  {command}\n      {why}")


def table_of(found: "Replay", width: int) -> str:
    """One row for each vehicle, with the columns of which anything is known, as wide as the terminal and no wider.

    Args:
        found: the replay.
        width: [characters] of the terminal.
    """
    names = ["vehicle", *(part.believed.name for part in found.parts)]
    laws = ["law", *(part.position for part in found.parts)]
    known: dict[float, list[str]] = {column.rank: cells for column in COLUMNS if (cells := _cells(column, found))}
    extra = sorted({key for part in found.parts for key, value in (part.found or {}).items() if value})
    known |= {
        4.5 + 0.1 * k: [
            key.replace("_", " "),
            *(f"{(part.found or {}).get(key, math.nan):.4f}" for part in found.parts),
        ]
        for k, key in enumerate(extra)
    }
    if any(part.smoothed for part in found.parts):
        rms = [part.smoothed.position_error_rms if part.smoothed else math.nan for part in found.parts]
        known[2.5] = ["smoothed rms [m]", *(_text(value, ".3f") for value in rms)]
    shown = dict(known)
    while len(shown) > 1 and len(_line(names, laws, shown, 0)) > width:
        del shown[max(shown)]
    order: list[float] = [column.rank for column in COLUMNS]
    columns = {rank: shown[rank] for rank in sorted(shown, key=lambda r: order.index(r) if r in order else 100 + r)}
    lines = [_line(names, laws, columns, row) for row in range(len(names))]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def _cells(column: Column, found: "Replay") -> list[str]:
    """Heading and cells of a column; none where nothing is known."""
    values = [getattr(part.score, column.field) for part in found.parts]
    return [column.heading, *(_text(v, column.form) for v in values)] if any(v == v for v in values) else []


def _text(value: float, form: str) -> str:
    return format(value, form) if value == value else "-"


def _line(names: list[str], laws: list[str], columns: Mapping[float, list[str]], row: int) -> str:
    left = [cells[row].ljust(max(map(len, cells))) for cells in (names, laws)]
    right = [cells[row].rjust(max(map(len, cells))) for cells in columns.values()]
    return "  ".join([*left, *right]).rstrip()


def meaning(found: "Replay") -> str:
    """What the numbers say, in words.

    Args:
        found: the replay.
    """
    sentences = []
    for part in found.parts:
        s, name = part.score, part.believed.name
        if s.position_error_rms == s.position_error_rms:
            sentences.append(
                f"{name} was {s.position_error_rms:.2f} m from the truth (RMS), {s.position_error_max:.2f} m at worst."
            )
        elif s.fixes:
            sentences.append(
                f"{name}: no truth is recorded; fixes came {s.innovation_rms:.2f} m (RMS) from where they were"
                " expected."
            )
        if s.nis == s.nis and s.fixes >= 30 and not 0.5 < s.nis < 2.0:
            less = "more" if s.nis > 1.0 else "less"
            sentences.append(
                f"They are {less} scattered than the filter thinks (NIS {s.nis:.2f}, 1 where it is right)."
            )
    return " ".join(sentences) or "Nothing is known of how right that is."


def next_steps(found: "Replay", directory: Path, request: "Request") -> list[tuple[str, str]]:
    """Commands that make sense after this replay, and why.

    Args:
        found: the replay.
        directory: of its results.
        request: what was asked for.
    """
    laws = {part.position for part in found.parts}
    other = "reset" if "kalman_replay" in laws else "kalman_replay"
    words = ["cardume", "replay", str(request.path)]
    for role, topic in request.options.topics:
        words += ["--topic", f"{role}={topic}"]
    steps = [(shlex.join([*words, "--position", f"law={other}"]), "the same with another law")]
    if not request.looks_back and "range_filter" not in laws:
        steps.append((shlex.join([*words, "--smooth"]), "with what later fixes say"))
    target = "track.geojson" if found.origin else "track.csv"
    steps.append(
        (shlex.join(["cardume", "convert", str(directory / "log.nc"), target]), "the track for another program")
    )
    return steps
