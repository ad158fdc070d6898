"""The errors figure: how far off the vehicles were, and how far off they believed they were."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.report.panels import BELIEVED, Panel, always, draw_panels, has_company, has_current, lines, zero
from cardume.simulation.flight import Flight


def draw_errors(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the errors of a flight over time, one panel for each kind that matters in it.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    return draw_panels(as_flight(log), PANELS, width)


def _draw_cross_track(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    zero(axes)
    lines(axes, flight, rows, flight.channels["cross_track_estimate"], **BELIEVED)
    lines(axes, flight, rows, flight.channels["cross_track"])


def _draw_coordination(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    zero(axes)
    state = flight.channels["coordination_state"]
    lines(axes, flight, rows, state - state.mean(axis=1, keepdims=True))


def _draw_position(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    channels = flight.channels
    north, east = (channels[f"{axis}_estimate"] - channels[axis] for axis in ("north", "east"))
    lines(axes, flight, rows, np.hypot(north, east))
    axes.set_ylim(bottom=0.0)


def _draw_current(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    channels = flight.channels
    for axis, how in (("north", {}), ("east", {"dashes": (4, 1.5)})):
        lines(axes, flight, rows, channels[f"current_{axis}_estimate"], lw=0.8, **how)
        lines(axes, flight, rows, channels[f"current_{axis}"][:, :1], color=style.INK, lw=1.3, zorder=4, **how)


def _draw_speed(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    lines(axes, flight, rows, flight.channels["speed_desired"], **BELIEVED)
    lines(axes, flight, rows, flight.channels["speed"])
    axes.set_ylim(bottom=0.0)


PANELS = (
    Panel("cross-track\nerror [m]", _draw_cross_track, always, "solid true, dashed believed; positive to starboard"),
    Panel("coordi-\nnation [m]", _draw_coordination, has_company, "coordination state less the fleet's mean"),
    Panel("position\nerror [m]", _draw_position, always, "distance between believed and true"),
    Panel("current\n[m/s]", _draw_current, has_current, "color believed, black true; solid north, dashed east"),
    Panel("speed\n[m/s]", _draw_speed, always, "solid over ground, dashed asked for through water"),
)
