"""The coordination figure: how far apart the vehicles are along the path, and what they do about it."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.report.panels import BELIEVED, Panel, always, draw_panels, lines, zero
from cardume.simulation.flight import Flight


def draw_coordination(log: Any, width: float = style.WIDTH) -> Any:
    """Draw coordination states, what vehicles believe of their own, and corrections of speed over time.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    return draw_panels(as_flight(log), PANELS, width)


def _draw_state(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    zero(axes)
    state = flight.channels["coordination_state"]
    mean = state.mean(axis=1, keepdims=True)
    lines(axes, flight, rows, flight.channels["coordination_state_estimate"] - mean, **BELIEVED)
    lines(axes, flight, rows, state - mean)


def _draw_correction(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    zero(axes)
    lines(axes, flight, rows, flight.channels["speed_correction"])


def _draw_speed(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    lines(axes, flight, rows, flight.channels["speed"])
    axes.set_ylim(bottom=0.0)


PANELS = (
    Panel(
        "along the\npath [m]",
        _draw_state,
        always,
        "less the fleet's true mean; solid true, dashed what a vehicle believes",
    ),
    Panel("correction\n[m/s]", _draw_correction, always, "of the speed along the reference path"),
    Panel("speed\n[m/s]", _draw_speed, always, "over ground"),
)
