"""The figures that every run gets, as files."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from cardume.report import style
from cardume.report.error_panels import draw_errors
from cardume.report.plan import draw_plan
from cardume.simulation.flight import Flight

FIGURES: Mapping[str, Callable[[Flight], Any]] = {"plan": draw_plan, "errors": draw_errors}
RESOLUTION = 150  # [dots per inch] of PNG files


def save_figures(flight: Flight, folder: Path) -> None:
    """Draw every figure of a flight into a folder, as SVG and PNG; the same flight gives the same bytes.

    Args:
        flight: what was flown.
        folder: exists.
    """
    with style.styled():
        for name, draw in FIGURES.items():
            figure = draw(flight)
            figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
            figure.savefig(folder / f"{name}.png", dpi=RESOLUTION, metadata={"Software": None})
