"""`cardume calibrate`: from a run's log, or a table from the sea, to the calibration of thruster speed."""

import json
import math
import shutil
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option
from cardume.errors import DataError
from cardume.units import printable

if TYPE_CHECKING:
    from cardume.missions.calibration import Calibration

DONE, UNTOLD = 0, 1


@click.command(short_help="Thruster speed to speed, from a log or a table.")
@click.argument("log", type=click.Path(path_type=Path))
@click.option("--vehicle", "vehicles", multiple=True, metavar="NAME", help="Only this one of a log; may be repeated.")
@click.option("--model", metavar="NAME", help="Whose thrusters and drag are believed, instead of the log's own.")
@allow_code_option
@quiet_option
@json_option
def calibrate(
    log: Path,
    vehicles: tuple[str, ...],
    model: str | None,
    allow_code: tuple[Path, ...],
    quiet: bool,
    as_json: bool,
) -> int:
    """Fit thruster speed to speed, and the current beside it, by the track in LOG.

    LOG is the log.nc of a run, or a CSV with the columns time, shaft_speed_rpm (or percent), and either speed through
    the water, or heading_deg with north and east (or latitude and longitude). Only steady parts count: fly legs there
    and back, at two speeds or more. Exit code 1: the data cannot tell the scale.
    """
    del allow_code
    from cardume.missions.calibration import calibrate as fit, read_tracks

    tracks = read_tracks(log, model)
    names = [track.name for track in tracks]
    for vehicle in vehicles:
        if vehicle not in names:
            given, there = printable(f"'{vehicle}' in {log}"), printable(", ".join(names))
            raise DataError(f"there is no vehicle {given}; there are {there}")
    found = [fit(track) for track in tracks if not vehicles or track.name in vehicles]
    if as_json:
        click.echo(json.dumps([_plain(calibration) for calibration in found], indent=2))
    elif not quiet:
        click.echo("\n\n".join(_told(calibration) for calibration in found))
    return DONE if all(calibration.is_usable for calibration in found) else UNTOLD


def _plain(calibration: "Calibration") -> dict[str, Any]:
    from dataclasses import asdict

    def without_nan(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: without_nan(item) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [without_nan(item) for item in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    plain = without_nan(asdict(calibration))
    return {**plain, "is_usable": calibration.is_usable}


def _told(calibration: "Calibration") -> str:
    c = calibration
    unit = "m/s" if c.current_north is None else "m"
    turned = f", headings up to {math.degrees(c.headings):.0f} deg apart" if math.isfinite(c.headings) else ""
    lines = [
        click.style(printable(c.name), bold=True),
        f"  {c.num_legs} steady legs, {c.used:.0f} of {c.total:.0f} s, {c.slowest:.2f} to {c.fastest:.2f} m/s{turned}",
        f"  scale            {_interval(c.scale)}    believed speed is {c.speed_factor:.4f} of the true one",
    ]
    if c.current_north is not None and c.current_east is not None:
        speed = math.hypot(c.current_north.value, c.current_east.value)
        towards = math.degrees(math.atan2(c.current_east.value, c.current_north.value)) % 360.0
        lines.append(f"  current north    {_interval(c.current_north)} m/s")
        lines.append(f"  current east     {_interval(c.current_east)} m/s    {speed:.3f} m/s towards {towards:.0f} deg")
    lines.append(f"  fit              residual {c.residual:.3g} {unit} RMS, {100.0 * c.explained:.3f} % explained")
    if c.linear_drag is not None and c.quadratic_drag is not None:
        lines.append(f"  linear drag      {_interval(c.linear_drag)} N s/m      with the believed thrust")
        lines.append(
            f"  quadratic drag   {_interval(c.quadratic_drag)} N s^2/m^2  residual {c.drag_residual:.3g} {unit}"
        )
    width = min(shutil.get_terminal_size().columns, 100)
    for warning in c.warnings:
        lines.append(
            textwrap.fill(
                warning, width, initial_indent=f"  {click.style('warning', fg='yellow')}  ", subsequent_indent=" " * 11
            )
        )
    return "\n".join([*lines, *_to_paste(c)])


def _interval(estimate: Any) -> str:
    if not estimate.is_known:
        return f"{estimate.value:>9.4f} not told by these data"
    return f"{estimate.value:>9.4f} +- {estimate.half_width:.4f}"


def _to_paste(c: "Calibration") -> list[str]:
    """The lines of a mission, where the data allow them."""
    if not c.is_usable:
        return []
    lines = ["", "  Paste into the mission, for this vehicle (intervals above are 95 %):", "    sensors:"]
    lines.append(f"      thruster_speed: {{scale: {c.scale.value:.4f}}}")
    if c.linear_drag is not None and c.quadratic_drag is not None and c.quadratic_drag.value > 0.0:
        known = c.quadratic_drag.half_width <= 0.25 * c.quadratic_drag.value
        if known and c.drag_residual < 0.98 * c.residual:
            lines.append("  or, as the drag fits better at all speeds:")
            lines.append("    sensors:")
            drags = (
                f"linear_drag: {c.linear_drag.value:.4g} N s/m, quadratic_drag: {c.quadratic_drag.value:.4g} N s^2/m^2"
            )
            lines.append(f"      thruster_speed: {{{drags}}}")
    return lines
