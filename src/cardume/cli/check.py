"""`cardume check`: what theory knows about a mission before it flies."""

import json
import shlex
import shutil
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from cardume.cli.options import (
    allow_code_option,
    find_mission,
    json_option,
    mission_argument,
    quiet_option,
    seed_option,
    set_option,
)

DONE, BAD_INPUT = 0, 2
COLORS = {"error": "red", "warning": "yellow", "note": "cyan"}


@click.command(short_help="Say what theory knows of a mission, without flying it.")
@mission_argument
@seed_option
@set_option
@allow_code_option
@quiet_option
@json_option
def check(
    mission: str,
    seed: int | None,
    overrides: tuple[str, ...],
    allow_code: tuple[Path, ...],
    quiet: bool,
    as_json: bool,
) -> int:
    """Say what theory knows about MISSION, without flying it.

    Each finding names the key and a value that would pass. Exit code 0: nothing forbids it; 2: an error.
    """
    from cardume.missions.checks import check_mission

    found = find_mission(mission, overrides, seed, allow_code)
    order = list(COLORS)
    findings = sorted(check_mission(found, allow_code), key=lambda finding: order.index(finding.level))
    has_errors = any(finding.level == "error" for finding in findings)
    if as_json:
        plain = [{"level": f.level, "key": f.key, "message": f.message, "suggestion": f.suggestion} for f in findings]
        click.echo(json.dumps({"mission": found.name, "findings": plain}, indent=2))
    else:
        shown = [finding for finding in findings if not quiet or finding.level == "error"]
        for finding in shown:
            _say(finding, is_error=quiet)
        if not quiet:
            click.echo(_total(findings))
    return BAD_INPUT if has_errors else DONE


def _say(finding: Any, is_error: bool) -> None:
    width = min(shutil.get_terminal_size().columns, 100)
    click.secho(finding.level, fg=COLORS[finding.level], bold=True, nl=False, err=is_error)
    click.echo(f"  {finding.key}", err=is_error)
    click.echo(textwrap.fill(finding.message, width, initial_indent="    ", subsequent_indent="    "), err=is_error)
    if finding.suggestion:
        settings = finding.suggestion.split(" and ")
        typed = " ".join(f"--set {shlex.quote(setting)}" for setting in settings)
        click.echo(f"    would pass: {typed}", err=is_error)


def _total(findings: Sequence[Any]) -> str:
    counts = {level: sum(finding.level == level for finding in findings) for level in COLORS}
    parts = [f"{count} {level}{'s' if count > 1 else ''}" for level, count in counts.items() if count]
    return ", ".join(parts) if parts else "Nothing found: theory has no objection to this mission."
