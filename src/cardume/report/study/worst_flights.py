"""The worst runs of a study, flown again: each seen from above, with its error over time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.study.common import dress
from cardume.simulation.flight import Flight
from cardume.studies.answers.worst import WorstRun

PLAN, ERROR = 2.0, 1.2  # [inch]
CAPTION = 27  # characters of a line


def draw_worst(flights: Sequence[tuple[WorstRun, Flight]], width: float = style.WIDTH) -> Any:
    """Plan views above, cross-track errors below, one column for each run, the worst first.

    Args:
        flights: from `fly_again`, one at least.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    with style.styled():
        columns = min(len(flights), max(1, int(width / 1.4)))
        rows = -(-len(flights) // columns)
        figure = style.new_figure(width, rows * (PLAN + ERROR + 0.55) + 0.3)
        figure.set_layout_engine("constrained")
        grid = figure.subplots(2 * rows, columns, squeeze=False, height_ratios=(PLAN, ERROR) * rows)
        for place in range(rows * columns):
            row, column = divmod(place, columns)
            plan, error = grid[2 * row, column], grid[2 * row + 1, column]
            if place >= len(flights):
                plan.set_visible(False)
                error.set_visible(False)
                continue
            run, flight = flights[place]
            _draw_plan(plan, run, flight)
            _draw_error(error, flight, is_first=column == 0)
        names = flights[0][1].vehicle_names
        if len(names) > 1:
            figure.legend(
                handles=style.vehicle_handles(names), loc="outside lower center", ncols=6, frameon=False, fontsize=7.0
            )
        return figure


def _draw_plan(axes: Any, run: WorstRun, flight: Flight) -> None:
    rows = style.thinned(len(flight.times))
    for k, path in enumerate(flight.own_paths):
        axes.plot(path[:, 1], path[:, 0], color=style.color(k), lw=3.5, alpha=0.18, solid_capstyle="butt")
        east, north = flight.channels["east"][rows, k], flight.channels["north"][rows, k]
        axes.plot(east, north, color=style.color(k), lw=1.0)
        believed = flight.channels["east_estimate"][rows, k], flight.channels["north_estimate"][rows, k]
        axes.plot(*believed, color=style.color(k), lw=0.6, alpha=0.8, dashes=(2, 1.5))
    axes.set_aspect("equal", adjustable="datalim")
    axes.locator_params(nbins=4)
    axes.tick_params(labelsize=6.0)
    dress(axes)
    axes.set_title(caption(run), fontsize=6.0, loc="left", pad=4.0)


def _draw_error(axes: Any, flight: Flight, is_first: bool) -> None:
    rows = style.thinned(len(flight.times))
    for k in range(len(flight.vehicle_names)):
        axes.plot(flight.times[rows], flight.channels["cross_track"][rows, k], color=style.color(k), lw=0.9)
    late = flight.channels["cross_track"][len(flight.times) // 4 :]
    top = 1.3 * float(np.nanmax(np.abs(late), initial=0.0))
    if np.isfinite(top) and top > 0.0:
        axes.set_ylim(-top, top)
    axes.tick_params(labelsize=6.0)
    dress(axes, "", "time [s]", "cross-track error [m]" if is_first else "")


def caption(run: WorstRun) -> str:
    """Seed, case and what was missed, in a few short lines.

    Args:
        run: one of the worst.
    """
    import textwrap

    why = run.failure or "; ".join(run.missed) or "nothing missed"
    lines = [f"seed {run.seed}", *textwrap.wrap(run.label, CAPTION), *textwrap.wrap(why, CAPTION)]
    return "\n".join(lines[:5])
