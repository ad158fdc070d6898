"""`cardume report`: the report and the figures of a run or a study, again or in another shape."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option
from cardume.cli.stopping import stoppable
from cardume.errors import InputError

if TYPE_CHECKING:
    from cardume.missions.runs import Run

DONE = 0
FORMATS = ("svg", "pdf", "png")
INCHES = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0}
NARROWEST, WIDEST = 2.0, 40.0  # [inch]


@click.command(short_help="Write the report of an earlier run or study, or figures of it.")
@click.argument("run", type=click.Path(path_type=Path))
@click.option(
    "--figure", "figures", multiple=True, metavar="NAME", help="A figure instead of the page; may be repeated; or all."
)
@click.option(
    "--format",
    "formats",
    multiple=True,
    type=click.Choice(FORMATS),
    help="Of the figures; may be repeated.  [default: svg]",
)
@click.option("--width", metavar="WIDTH", help="Of the figures, as 88mm, 8.8cm or 3.5in.  [default: 183mm]")
@click.option("-o", "output", type=click.Path(path_type=Path), metavar="DIR", help="Where to; else into RUN.")
@allow_code_option
@quiet_option
@json_option
@stoppable
def report(
    run: Path,
    figures: tuple[str, ...],
    formats: tuple[str, ...],
    width: str | None,
    output: Path | None,
    allow_code: tuple[Path, ...],
    quiet: bool,
    as_json: bool,
) -> int:
    """Write report.html of RUN, the directory of an earlier run or study; or figures of it, for a paper.

    \b
      cardume report runs/figure-5/001
      cardume report runs/figure-5/001 --figure plan --format pdf --width 88mm
      cardume report runs/figure-5-study/001 --figure map
    """
    from cardume.cli.study_answers import is_study, report_study
    from cardume.missions.results import ResultsError, note_files
    from cardume.missions.runs import read_run
    from cardume.units import printable

    inches = parse_width(width) if width else None
    if not figures and (formats or width):
        raise InputError("--format and --width are about figures; add --figure NAME, or --figure all")
    directory = run.parent if run.name in ("log.nc", "study.zarr") else run
    target, kinds = output or directory, formats or ("svg",)
    of_study = is_study(directory)
    names = list(figures) if of_study else _chosen(figures)
    found = None if of_study else read_run(run, allow_code)
    try:
        target.mkdir(parents=True, exist_ok=True)
        if found is None:
            written = report_study(directory, target, names, kinds, inches, allow_code)
        else:
            written = _write_figures(found, target, names, kinds, inches) if names else _write_page(found, target)
        if output is None and found is not None:
            note_files(directory, [path.relative_to(directory).as_posix() for path in written])
    except OSError as problem:
        raise ResultsError(
            f"{printable(str(target))} cannot be written to: {problem.strerror}; give another place with -o DIR"
        ) from None
    if as_json:
        click.echo(json.dumps({"run": str(directory), "written": [str(path) for path in written]}, indent=2))
    elif not quiet:
        for path in written:
            click.echo(f"Written: {path}")
    return DONE


def parse_width(given: str) -> float:
    """A width [inch] from a text such as `88mm`.

    Args:
        given: a number with mm, cm or in.

    Raises:
        InputError: it is something else, or a width that no figure can have.
    """
    match = re.fullmatch(r"\s*([0-9]*\.?[0-9]+)\s*(mm|cm|in)\s*", given)
    if match is None:
        raise InputError(f"--width '{given}' is no width; write a number with mm, cm or in, as 88mm")
    inches = float(match[1]) * INCHES[match[2]]
    if not NARROWEST <= inches <= WIDEST:
        low, high = (f"{limit / INCHES['mm']:.0f}mm" for limit in (NARROWEST, WIDEST))
        raise InputError(f"--width {given} cannot be drawn; between {low} and {high} it can")
    return inches


def _chosen(given: tuple[str, ...]) -> list[str]:
    from cardume.report.figures import FIGURES
    from cardume.units import nearest, printable

    if "all" in given:
        return list(FIGURES)
    for name in given:
        if name not in FIGURES:
            hint = nearest(name, list(FIGURES)) or "."
            raise InputError(f"--figure {printable(name)}: no such figure{hint} Valid: {', '.join(FIGURES)}, all")
    return list(dict.fromkeys(given))


def _write_page(found: "Run", target: Path) -> list[Path]:
    from cardume.missions.recordings.base import REPLAYED
    from cardume.report.page.frame import FILE_NAME
    from cardume.report.page.page import write_page

    if found.text.startswith(REPLAYED):
        raise InputError(
            "this is a replay, which has no report of a flight; its figure is figures/replay.svg, and --figure NAME"
            " draws others: plan, errors, estimation"
        )
    path = target / FILE_NAME
    write_page(path, found)
    return [path]


def _write_figures(
    found: "Run", target: Path, names: list[str], formats: tuple[str, ...], inches: float | None
) -> list[Path]:
    from cardume.report.figures import save_figure

    folder, written = target / "figures", []
    folder.mkdir(exist_ok=True)
    for name in names:
        for kind in dict.fromkeys(formats):
            path = folder / f"{name}.{kind}"
            save_figure(path, name, found, inches)
            written.append(path)
    return written
