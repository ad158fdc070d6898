"""`cardume convert`: missions and path files into one another."""

import json
import shlex
import shutil
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option, seed_option, set_option
from cardume.cli.stopping import stoppable
from cardume.errors import InputError
from cardume.units import parse_quantity, printable

if TYPE_CHECKING:
    from cardume.missions.converting import Conversion
    from cardume.missions.geodesy import GeoPoint

FLYABLE_BY_ITSELF = "A mission or path file flies as it is: cardume run FILE."


class Quantity(click.ParamType):
    """A number with or without a unit, as `0.5 m/s`."""

    def __init__(self, unit: str, metavar: str) -> None:
        self.unit, self.name = unit, metavar

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """The SI value."""
        try:
            number = parse_quantity(value, self.unit)
        except InputError as problem:
            self.fail(str(problem), param, ctx)
        if not number > 0.0:
            self.fail(f"{value} is not > 0", param, ctx)
        return number


class LatLon(click.ParamType):
    """Latitude and longitude in degrees, as `38.7,-9.1`."""

    name = "LAT,LON"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> "GeoPoint":
        """The place."""
        from cardume.missions.formats.waypoints import check_place, geo

        words = str(value).replace(",", " ").split()
        try:
            latitude, longitude = map(float, words)
        except ValueError:
            self.fail(f"{printable(str(value))!r} is not LATITUDE,LONGITUDE in degrees, as 38.7,-9.1", param, ctx)
        if problem := check_place(latitude, longitude):
            self.fail(problem, param, ctx)
        return geo(latitude, longitude)


@click.command(epilog=FLYABLE_BY_ITSELF, short_help="Turn a mission or path file into another format.")
@click.argument("source", metavar="IN")
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@click.option("--from", "source_kind", metavar="FORMAT", help="What IN is, if its contents do not say.")
@click.option("--to", "target_kind", metavar="FORMAT", help="What OUT is to be, if its name does not say.")
@click.option("--origin", type=LatLon(), help="Where north = east = 0 lies, in degrees, as 38.7,-9.1.")
@click.option("--speed", type=Quantity("m/s", "SPEED"), help="Where IN has none, as 0.5 or '1 kn'.")
@click.option("--vehicle", metavar="NAME", default="", help="Write this vehicle's own path, not the formation's.")
@click.option(
    "--tolerance",
    type=Quantity("m", "LENGTH"),
    default=0.05,
    show_default="0.05 m",
    help="Of legs that stand for arcs.",
)
@click.option("--force", is_flag=True, help="Write OUT even where it exists.")
@seed_option
@set_option
@allow_code_option
@quiet_option
@json_option
@stoppable
def convert(**given: Any) -> int:
    """Convert IN, a mission, a path file, or a run and its log, to OUT: its ending says the format.

    \b
    .yaml  mission              .plan       QGroundControl
    .gpx   route                .waypoints  ArduPilot, QGC WPL 110
    .geojson                    .medusa.txt MEDUSA / Farol
    Of a run or its log.nc: tracks .gpx .geojson .kml, tables .csv .parquet, ROS 2 .mcap,
    Rerun .rrd
    Says what OUT cannot hold, and what of IN is not flown. cardume list formats says more.
    """
    from cardume.missions import converting

    quiet, as_json, is_forced = given.pop("quiet"), given.pop("as_json"), given.pop("force")
    for end in ("source_kind", "target_kind"):
        given[end] = _known(given[end], list(converting.KINDS))
    request = converting.Request(**given)
    if request.target.exists() and not is_forced:
        raise InputError(
            f"{printable(str(request.target))} exists already; give another name, or --force to replace it"
        )
    result = converting.convert(request)
    _write(request.target, result.content)
    if as_json:
        said = {"file": str(request.target), "holds": result.holds, "lost": result.lost, "not_flown": result.notes}
        click.echo(json.dumps(said, indent=2))
    elif not quiet:
        _say(request.source, request.target, result)
    return 0


def _known(kind: str | None, kinds: Sequence[str]) -> str:
    from cardume.missions.wording import unknown

    if kind and kind not in kinds:
        raise click.UsageError(f"{unknown(f'There is no format {kind!r}', kind, list(kinds))}")
    return kind or ""


def _write(target: Path, content: bytes) -> None:
    from cardume.missions.atomic import write_file
    from cardume.missions.results import FULL, ResultsError

    try:
        write_file(target, content)
    except OSError as problem:
        if problem.errno in FULL:
            advice = "nothing was changed there: make room and convert again"
            raise ResultsError(f"the disk of {printable(str(target))} is full ({problem.strerror}); {advice}") from None
        advice = "give a place that exists and is yours"
        raise InputError(f"{printable(str(target))} cannot be written: {problem.strerror}; {advice}") from None


def _say(source: str, target: Path, result: "Conversion") -> None:
    click.echo(f"Wrote {printable(str(target))}\n  {result.holds}")
    for heading, sentences in (("Not kept", result.lost), (f"Not flown of {printable(source)}", result.notes)):
        if sentences:
            click.echo(f"\n{heading}")
        width = min(shutil.get_terminal_size().columns, 100)
        for sentence in sentences:
            click.echo(textwrap.fill(sentence, width, initial_indent="  - ", subsequent_indent="    "))
    if result.is_flyable:
        click.echo(f"\nNext\n  cardume check {shlex.quote(str(target))}")
