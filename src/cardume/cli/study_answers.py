"""What `cardume study` says at its end, and `cardume report` of a study again."""

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from cardume.cli.text import filled

if TYPE_CHECKING:
    import xarray

    from cardume.studies.answers.results import Results

STORE = "study.zarr"


class Drawn(NamedTuple):
    """What became of figures and page."""

    files: Sequence[str]
    lacking: str = ""  # why there is no page
    problem: Exception | None = None


def is_study(directory: Path) -> bool:
    """Whether a directory holds a study.

    Args:
        directory: that a user named.
    """
    return (directory / STORE).is_dir()


def draw_answers(
    directory: Path, results: "Results", allow_code: Sequence[Path], should_stop: Callable[[], bool]
) -> Drawn:
    """Figures and page; a study is not lost for a picture that cannot be drawn.

    Args:
        directory: of the study.
        results: of it.
        allow_code: folders from which laws may be imported.
        should_stop: asked between the pieces.
    """
    from cardume.report.study.keeping import write_study_report

    try:
        return Drawn(*write_study_report(directory, results, allow_code, should_stop))
    except OSError:
        raise
    except Exception as problem:
        return Drawn((), "", problem)


def say_answers(results: "Results") -> None:
    """Tables and sentences.

    Args:
        results: of the study.
    """
    from cardume.report.study.table import study_table
    from cardume.report.study.words import study_words

    if table := study_table(results, shutil.get_terminal_size().columns):
        click.echo(f"{table}\n")
    for sentence in study_words(results):
        click.echo(filled(sentence))


def report_study(
    directory: Path,
    target: Path,
    names: Sequence[str],
    formats: Sequence[str],
    inches: float | None,
    allow_code: Sequence[Path],
) -> list[Path]:
    """Write the page of a study, or figures of it.

    Args:
        directory: of the study.
        target: where to; exists.
        names: of figures, or "all"; none for the page.
        formats: of the figures.
        inches: [inch] width of the figures; None: two columns of a journal.
        allow_code: folders from which laws may be imported.

    Returns:
        The files.

    Raises:
        InputError: no such figure, or one for which the study has nothing to show, or what it names is not here.
        DataError: the study is damaged.
    """
    from cardume.report import style
    from cardume.report.page.frame import FILE_NAME
    from cardume.report.study.figures import WORST
    from cardume.report.study.keeping import FIGURES, fly_worst, write_figures
    from cardume.report.study.page.page import write_study_page

    results = open_results(directory)
    if not names:
        write_study_page(target / FILE_NAME, results, fly_worst(results, allow_code=allow_code))
        return [target / FILE_NAME]
    chosen = _chosen(results, names)
    worst = fly_worst(results, allow_code=allow_code, is_needed="all" not in names) if WORST in chosen else ()
    return write_figures(target / FIGURES, results, chosen, formats, inches or style.WIDTH, worst)


def open_results(directory: Path) -> "Results":
    """A study read back.

    Args:
        directory: of it.

    Raises:
        DataError: it is damaged, or of another version.
    """
    from cardume.studies.answers.results import Results
    from cardume.studies.store import open_study

    runs: xarray.Dataset = open_study(directory)
    return Results(runs)


def _chosen(results: "Results", names: Sequence[str]) -> list[str]:
    from cardume.errors import InputError
    from cardume.report.study.figures import STUDY_FIGURES, WORST, figures_that_matter
    from cardume.units import nearest, printable

    if "all" in names:
        return [*figures_that_matter(results), WORST]
    for name in names:
        if name not in STUDY_FIGURES and name != WORST:
            known = [*STUDY_FIGURES, WORST]
            hint = nearest(name, known) or "."
            raise InputError(f"--figure {printable(name)}: no such figure{hint} Of a study: {', '.join(known)}, all")
        if name != WORST and not STUDY_FIGURES[name].matters(results):
            some = ", ".join([*figures_that_matter(results), WORST])
            raise InputError(f"--figure {name}: nothing to draw: {STUDY_FIGURES[name].lacking}; this study has {some}")
    return list(dict.fromkeys(names))
