"""`cardume new`: a mission to begin with."""

import os
import re
import shlex
from importlib import resources
from pathlib import Path

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option
from cardume.errors import InputError
from cardume.units import printable

KINDS = ("single", "fleet")
MISSION_ENDINGS = (".yaml", ".yml")


@click.command(short_help="Write a commented mission to begin with.")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--kind", type=click.Choice(KINDS), default="fleet", show_default=True, help="One vehicle or three.")
@allow_code_option
@quiet_option
@json_option
def new(file: Path, kind: str, allow_code: tuple[Path, ...], quiet: bool, as_json: bool) -> int:
    """Write a commented mission to FILE that flies as it is. An existing file is left alone."""
    del allow_code
    if file.is_dir():
        raise InputError(
            f"{printable(str(file))} is a directory; give a file in it, as {printable(str(file / 'mission.yaml'))}"
        )
    if file.suffix.lower() not in MISSION_ENDINGS:
        named = printable(str(file.with_suffix(".yaml")))
        raise InputError(f"{printable(str(file))}: a mission file ends in .yaml; write: cardume new {named}")
    text = template(kind, mission_name(file))
    _write_new(file, text)
    if as_json:
        import json

        click.echo(json.dumps({"file": str(file), "kind": kind}))
    elif not quiet:
        quoted = shlex.quote(str(file))
        click.echo(f"Wrote {file}\n\nNext\n  cardume check {quoted}\n  cardume run {quoted}")
    return 0


def template(kind: str, name: str) -> str:
    """The text of a starting mission.

    Args:
        kind: one of KINDS.
        name: of the mission.
    """
    text = resources.files("cardume.cli").joinpath("templates", f"{kind}.yaml").read_text(encoding="utf-8")
    return text.replace("NAME", name, 1)


def mission_name(file: Path) -> str:
    """What a mission in this file is called, as YAML: letters, digits, - and _, quoted where it would be no text.

    Args:
        file: to be written.
    """
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", file.stem).strip("-_")[:64] or "mission"
    is_text = name[0].isalpha() and name.lower() not in ("true", "false", "null")
    return name if is_text else f"'{name}'"


def _write_new(file: Path, text: str) -> None:
    """Write a file that must not exist, complete or not at all."""
    name = printable(str(file))
    try:
        handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    except FileExistsError:
        raise InputError(f"{name} exists already; give another name, or remove it first") from None
    except OSError as problem:
        advice = "give a place that exists and is yours"
        raise InputError(f"{name} cannot be written: {problem.strerror}; {advice}") from None
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as opened:
            opened.write(text)
    except BaseException:
        file.unlink(missing_ok=True)
        raise
