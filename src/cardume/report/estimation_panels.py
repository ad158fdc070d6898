"""The estimation figure: what the vehicles believe less what is true, component by component."""

from collections.abc import Callable
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.report.panels import Panel, always, draw_panels, has_current, lines, zero
from cardume.simulation.flight import Flight


def draw_estimation(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the errors of position and current over time, north and east by themselves.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    return draw_panels(as_flight(log), PANELS, width)


def _less(channel: str) -> Callable[[Any, Flight, np.ndarray], None]:
    def draw(axes: Any, flight: Flight, rows: np.ndarray) -> None:
        zero(axes)
        lines(axes, flight, rows, flight.channels[f"{channel}_estimate"] - flight.channels[channel])

    return draw


PANELS = (
    Panel("position,\nnorth [m]", _less("north"), always, "believed less true"),
    Panel("position,\neast [m]", _less("east"), always, "believed less true"),
    Panel("current,\nnorth [m/s]", _less("current_north"), has_current, "believed less true"),
    Panel("current,\neast [m/s]", _less("current_east"), has_current, "believed less true"),
)
