"""`cardume list`: the laws that a mission may name, the built-in missions, the metrics."""

import json
import shutil
import sys
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option
from cardume.units import nearest, show_quantity

# Where in a mission a family is chosen, if not under its own name.
KEYS = {
    "reference_point": "guidance.reference_point",
    "messaging": "messaging, as schedule",
    "acoustics": "acoustics, as channel",
    "bathymetry": "bathymetry, as type",
    "current": "current, as type",
    "speed": "sensors.thruster_speed, as reader",
    **{name: f"sensors.{name}" for name in ("gnss", "ahrs", "depth", "usbl", "dvl", "thruster_speed", "altimeter")},
}


@click.command("list", short_help="List laws, missions, metrics, paths, faults, formats.")
@click.argument("what", required=False, metavar="[FAMILY|missions|metrics|paths|faults|formats|recordings|MODULE:LAW]")
@allow_code_option
@quiet_option
@json_option
def list_(what: str | None, allow_code: tuple[Path, ...], quiet: bool, as_json: bool) -> int:
    """List the families of laws, the laws of FAMILY, the built-in missions, the metrics, the types of paths, the kinds
    of faults, the formats of path files and of what is made of a run, or those of recordings.

    A law of yours is shown by its name in a mission, as my_laws:my_law, its folder given by --allow-code.
    """
    if what is None:
        found = _families()
    elif what == "missions":
        found = _missions()
    elif what == "metrics":
        found = _metrics()
    elif what == "formats":
        found = _formats()
    elif what == "recordings":
        found = _recordings()
    elif what == "paths":
        found = _paths()
    elif what == "faults":
        found = _faults()
    elif ":" in what:
        found = _users_law(what, allow_code)
    else:
        found = _laws(what)
    if as_json:
        click.echo(json.dumps(found, indent=2))
    elif quiet:
        for entry in found:
            click.echo(entry["name"])
    else:
        for entry in found:
            _say(entry)
        if what is None:
            click.echo(
                "\ncardume list FAMILY, list missions, list metrics, list paths, list faults, list formats,"
                " list recordings say more."
            )
    return 0


def _every_law() -> Mapping[str, Mapping[str, Any]]:
    from cardume.missions.available import every_law

    return {family: laws for family, laws in every_law().items() if laws}


def _families() -> list[dict[str, Any]]:
    return [
        {
            "name": name,
            "summary": _about(name, next(iter(laws.values()))),
            "key": KEYS.get(name, name),
            "laws": list(laws),
        }
        for name, laws in _every_law().items()
    ]


def _about(family: str, law: Any) -> str:
    """The first line of the room that a law stands in; of a sensor, whose room holds many families, its own."""
    if KEYS.get(family) == f"sensors.{family}":
        return str(_describe(law)["summary"])
    package = law.__module__.rpartition(".")[0]
    return (getattr(sys.modules.get(package), "__doc__", None) or "").strip().partition("\n")[0]


def _laws(family: str) -> list[dict[str, Any]]:
    families = _every_law()
    if family not in families:
        names = [*families, "missions", "metrics", "paths", "faults", "formats", "recordings"]
        hint = nearest(family, names) or "."
        raise click.UsageError(f"There is no family '{family}'{hint} There are {', '.join(names)}")
    return [_describe(law) for law in families[family].values()]


def _users_law(name: str, folders: Sequence[Path]) -> list[dict[str, Any]]:
    """A law of the user's, called as a mission names it."""
    from cardume.missions.available import any_users_law

    law = any_users_law(name, [folder.resolve() for folder in folders])
    return [_describe(law) | {"name": name, "key": KEYS.get(law.family, law.family)}]


def _describe(law: Any) -> dict[str, Any]:
    from cardume.missions.descriptions import describe

    return describe(law)


def _missions() -> list[dict[str, Any]]:
    from cardume.missions import library

    return [{"name": name, "summary": library.describe(name)} for name in library.names()]


def _metrics() -> list[dict[str, Any]]:
    from cardume.simulation.flight import METRICS

    return [
        {"name": name, "summary": metric.meaning, "unit": metric.unit, "wanted": metric.wanted}
        for name, metric in METRICS.items()
    ]


def _paths() -> list[dict[str, Any]]:
    from cardume.missions.route import PATHS

    return [_section(name, record) for name, record in PATHS.items()]


def _faults() -> list[dict[str, Any]]:
    from cardume.missions.faults import FAULTS, REACTIONS

    return [_section(name, record) | {"reaction": REACTIONS[name]} for name, record in FAULTS.items()]


def _section(name: str, record: type) -> dict[str, Any]:
    """A record of the mission file with its keys."""
    from dataclasses import MISSING

    from cardume.missions.schema import fields_of
    from cardume.missions.wording import wanted

    keys = [
        {
            "name": field.key,
            "meaning": field.doc,
            "valid": wanted(field.kind),
            "needed": field.default is MISSING and field.written is None,
        }
        for field in fields_of(record)
    ]
    return {"name": name, "summary": (record.__doc__ or "").strip().partition("\n")[0], "keys": keys}


def _formats() -> list[dict[str, Any]]:
    from cardume.missions.converting import VIEWERS
    from cardume.missions.formats.content import FORMATS

    paths = [
        {"name": name, "summary": f"{known.title}: {known.keeps}", "suffixes": list(known.suffixes)}
        for name, known in FORMATS.items()
    ]
    return paths + [
        {"name": name, "summary": made.holds, "suffixes": list(made.suffixes)} for name, made in VIEWERS.items()
    ]


def _recordings() -> list[dict[str, Any]]:
    from cardume.missions.recordings.reading import MEANINGS

    return [{"name": name, "summary": meaning} for name, meaning in MEANINGS.items()]


def _say(entry: Mapping[str, Any]) -> None:
    width = min(shutil.get_terminal_size().columns, 100)
    unit = f" [{entry['unit']}]" if entry.get("unit") else ""
    click.echo(f"{click.style(entry['name'], bold=True)}{unit}")
    if entry["summary"]:
        click.echo(_indented(entry["summary"], width))
    for line in entry.get("equation", "").splitlines():
        click.echo(f"      {line.strip()}")
    for parameter in entry.get("parameters", ()):
        click.echo(f"    {_one_line(parameter)}")
    for key in entry.get("keys", ()):
        must = "" if key["needed"] else " (may be left out)"
        click.echo(_indented(f"{key['name']}: {key['meaning']}; {key['valid']}{must}", width))
    if entry.get("reaction"):
        click.echo(_indented(f"then: {entry['reaction']}", width))
    if "key" in entry and "laws" not in entry:
        click.echo(_indented(f"chosen under the key {entry['key']}", width))
    if entry.get("source"):
        click.echo(_indented(f"Source: {entry['source']}", width))
    if "suffixes" in entry:
        click.echo(f"    {', '.join(entry['suffixes'])}")
    if "laws" in entry:
        click.echo(_indented(f"{entry['key']}: {', '.join(entry['laws'])}", width))


def _one_line(parameter: Mapping[str, Any]) -> str:
    from cardume.missions.descriptions import ends_of

    if words := parameter["words"]:
        return f"{parameter['name']:<20} {parameter['default']:<12} of {', '.join(words)}"
    default, ends = show_quantity(parameter["default"], parameter["unit"]), ends_of(parameter)
    return f"{parameter['name']:<20} {default:<12} {' and '.join(ends)}".rstrip()


def _indented(text: str, width: int) -> str:
    return textwrap.fill(text, width, initial_indent="    ", subsequent_indent="    ", break_on_hyphens=False)
