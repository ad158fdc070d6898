"""The depth figure."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.report.panels import Panel, always, draw_panels, lines
from cardume.simulation.flight import Flight


def draw_depth(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the depths of the vehicles over time, the surface on top.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    return draw_panels(as_flight(log), PANELS, width)


def _draw(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    depth = flight.channels["depth"]
    lines(axes, flight, rows, depth)
    known = depth[np.isfinite(depth)]
    deepest = float(known.max(initial=0.0))
    axes.set_ylim(1.08 * deepest or 1.0, -0.04 * deepest or -0.1)


PANELS = (Panel("depth\n[m]", _draw, always, "below the surface"),)
