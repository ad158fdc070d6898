"""What is written beside a study: its figures and its page."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from cardume.errors import CardumeError, InputError
from cardume.report.page.frame import FILE_NAME, LibraryMissing
from cardume.report.study.common import as_results
from cardume.report.study.figures import STUDY_FIGURES, WORST, save_study_figure, save_study_figures
from cardume.report.study.page.page import Worst, write_study_page
from cardume.report.study.worst_flights import draw_worst
from cardume.studies.answers.again import fly_again
from cardume.studies.answers.results import Results
from cardume.studies.answers.worst import NUMBER, worst_runs

FIGURES = "figures"


def fly_worst(
    results: Results,
    number: int = NUMBER,
    allow_code: Iterable[str | Path] = (),
    should_stop: Callable[[], bool] = lambda: False,
    is_needed: bool = False,
) -> Worst:
    """The worst runs of a study, flown again.

    Args:
        results: of the study.
        number: how many at most.
        allow_code: folders from which the mission's own laws may be imported.
        should_stop: asked before each.
        is_needed: whether it is an error that none can be flown again; else there are none then.

    Raises:
        InputError: none can, as the mission names what is not here, or no run was flown.
        DataError: none can, as the study does not hold its mission.
    """
    found, folders = [], tuple(allow_code)
    for run in worst_runs(results, number):
        if should_stop():
            break
        try:
            found.append((run, fly_again(results, run.case, run.run, folders)))
        except CardumeError:  # a law or a file of the mission is not here
            if is_needed:
                raise
            return ()
    if is_needed and not found:
        raise InputError("no run of this study was flown yet, so none is the worst; cardume study --resume flies them")
    return tuple(found)


def write_study_report(
    directory: Path,
    study: Any,
    allow_code: Iterable[str | Path] = (),
    should_stop: Callable[[], bool] = lambda: False,
) -> tuple[list[str], str]:
    """Figures and page of a study, into its directory.

    Args:
        directory: of the study.
        study: `Results`, or its dataset.
        allow_code: folders from which the mission's own laws may be imported.
        should_stop: asked between the pieces; what is written by then is complete.

    Returns:
        The names of the files, and why there is no page, or "".
    """
    results = as_results(study)
    written = [f"{FIGURES}/{name}" for name in save_study_figures(results, directory / FIGURES)]
    worst = fly_worst(results, allow_code=allow_code, should_stop=should_stop)
    if worst and not should_stop():
        for kind in ("svg", "png"):
            save_study_figure(directory / FIGURES / f"{WORST}.{kind}", draw_worst(worst))
            written.append(f"{FIGURES}/{WORST}.{kind}")
    if should_stop():
        return written, ""
    try:
        write_study_page(directory / FILE_NAME, results, worst)
    except LibraryMissing as problem:
        return written, str(problem)
    return [*written, FILE_NAME], ""


def write_figures(
    target: Path,
    study: Any,
    names: Sequence[str],
    formats: Sequence[str],
    width: float,
    worst: Worst = (),
) -> list[Path]:
    """Figures of a study for a paper.

    Args:
        target: folder that is made.
        study: `Results`, or its dataset.
        names: of STUDY_FIGURES, or WORST, which is left out where no flights are given.
        formats: svg, pdf or png.
        width: [inch] of each figure.
        worst: from `fly_worst`.

    Returns:
        The files.
    """
    results, written = as_results(study), []
    target.mkdir(parents=True, exist_ok=True)
    for name in names:
        if name == WORST and not worst:
            continue
        figure = draw_worst(worst, width) if name == WORST else STUDY_FIGURES[name].draw(results, width)
        for kind in dict.fromkeys(formats):
            written.append(target / f"{name}.{kind}")
            save_study_figure(written[-1], figure)
    return written
