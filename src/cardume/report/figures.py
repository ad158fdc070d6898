"""The figures of a run as files: two with every run, all of them on request."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from cardume.missions.atomic import new_file
from cardume.report import style
from cardume.report.command_panels import draw_commands
from cardume.report.coordination_panels import draw_coordination
from cardume.report.depth_panels import draw_depth
from cardume.report.error_panels import draw_errors
from cardume.report.estimation_panels import draw_estimation
from cardume.report.message_lanes import draw_messages
from cardume.report.plan import draw_plan
from cardume.report.space import draw_space
from cardume.simulation.flight import Flight

# each takes a `Flight`, a `Run` or a log opened in xarray, and a width [inch]; each gives a matplotlib figure
FIGURES: Mapping[str, Callable[[Any, float], Any]] = {
    "plan": draw_plan,
    "space": draw_space,
    "errors": draw_errors,
    "estimation": draw_estimation,
    "coordination": draw_coordination,
    "commands": draw_commands,
    "messages": draw_messages,
    "depth": draw_depth,
}
ALWAYS = {"plan": draw_plan, "errors": draw_errors}  # what every run gets
RESOLUTION = 150  # [dots per inch] of PNG files
FINE = 300  # [dots per inch] for papers
NO_DATES: Mapping[str, dict[str, Any]] = {
    ".svg": {"Date": None},
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": "cardume"},
}


def save_figures(flight: Flight, folder: Path) -> None:
    """Draw the figures that every run gets, as SVG and PNG; the same flight gives the same bytes.

    Args:
        flight: what was flown.
        folder: is made.
    """
    folder.mkdir(exist_ok=True)
    with style.styled():
        for name, draw in ALWAYS.items():
            figure = draw(flight)
            for kind in (".svg", ".png"):
                figure.savefig(folder / f"{name}{kind}", dpi=RESOLUTION, metadata=NO_DATES[kind])


def save_figure(path: Path, name: str, log: Any, width: float | None = None) -> None:
    """Draw one figure, complete or not at all; the same run gives the same bytes.

    Args:
        path: of the new file; its ending, .svg, .pdf or .png, says what it becomes.
        name: one of FIGURES.
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure; None: two columns of a journal.
    """
    with style.styled():
        figure = FIGURES[name](log, style.WIDTH if width is None else width)
        with new_file(path) as partial:
            figure.savefig(partial, format=path.suffix[1:], dpi=FINE, metadata=NO_DATES[path.suffix])
