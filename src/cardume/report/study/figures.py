"""The figures of a study: each also a function that takes its dataset and gives a matplotlib figure."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cardume.missions.atomic import new_file
from cardume.report import style
from cardume.report.figures import FINE, NO_DATES, RESOLUTION
from cardume.report.study.chances import draw_requirements, has_requirements
from cardume.report.study.common import as_results
from cardume.report.study.curves import draw_curves, has_curves
from cardume.report.study.distributions import draw_distributions, has_distributions
from cardume.report.study.influences import draw_influences, has_influences
from cardume.report.study.laws import draw_laws, has_laws
from cardume.report.study.maps import draw_map, has_map
from cardume.studies.answers.results import Results


class StudyFigure(NamedTuple):
    """A figure of a study."""

    draw: Callable[[Any, float], Any]  # dataset and width [inch] to a matplotlib figure
    matters: Callable[[Results], bool]
    lacking: str  # why it does not matter


STUDY_FIGURES: Mapping[str, StudyFigure] = {
    "distributions": StudyFigure(
        draw_distributions, has_distributions, "no metric has a number, or there are many cases"
    ),
    "requirements": StudyFigure(draw_requirements, has_requirements, "nothing is required, or cases are many"),
    "influences": StudyFigure(draw_influences, has_influences, "nothing is drawn or swept, or there are few runs"),
    "curves": StudyFigure(draw_curves, has_curves, "no numbers are swept, or too many other keys are"),
    "map": StudyFigure(draw_map, has_map, "it takes two swept keys of numbers"),
    "laws": StudyFigure(draw_laws, has_laws, "no laws or words are swept"),
}
WORST = "worst"  # which flies five missions again


def figures_that_matter(results: Results) -> list[str]:
    """The names of the figures that have something to show.

    Args:
        results: of the study.
    """
    return [name for name, figure in STUDY_FIGURES.items() if figure.matters(results)]


def save_study_figures(study: Any, folder: Path) -> list[str]:
    """Draw every figure that matters, as SVG and PNG; the same study gives the same bytes.

    Args:
        study: `Results`, or its dataset.
        folder: is made.

    Returns:
        The names of the files.
    """
    results, written = as_results(study), []
    folder.mkdir(exist_ok=True)
    for name in figures_that_matter(results):
        with style.styled():
            figure = STUDY_FIGURES[name].draw(results, style.WIDTH)
            for kind in (".svg", ".png"):
                with new_file(folder / f"{name}{kind}") as partial:
                    figure.savefig(partial, format=kind[1:], dpi=RESOLUTION, metadata=NO_DATES[kind])
                written.append(f"{name}{kind}")
    return written


def save_study_figure(path: Path, figure: Any) -> None:
    """Write one figure for a paper, complete or not at all.

    Args:
        path: of the new file; its ending, .svg, .pdf or .png, says what it becomes.
        figure: of matplotlib.
    """
    with style.styled(), new_file(path) as partial:
        figure.savefig(partial, format=path.suffix[1:], dpi=FINE, metadata=NO_DATES[path.suffix])
