"""The depth figure."""

from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.report.panels import Panel, draw_panels, lines
from cardume.simulation.flight import Flight

SEABED: dict[str, Any] = {"lw": 0.8, "alpha": 0.8, "ls": ":"}


def draw_depth(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the depths of the vehicles over time, the surface on top; the seabed below them and their heights above it.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    return draw_panels(as_flight(log), PANELS, width)


def _draw(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    depth, seabed = flight.channels["depth"], _seabed(flight)
    lines(axes, flight, rows, depth)
    lines(axes, flight, rows, seabed, **SEABED)
    known = np.concatenate([depth[np.isfinite(depth)], seabed[np.isfinite(seabed)]])
    deepest = float(known.max(initial=0.0))
    axes.set_ylim(1.08 * deepest or 1.0, -0.04 * deepest or -0.1)


def _seabed(flight: Flight) -> np.ndarray:
    """Depth of the seabed below each vehicle (time, vehicle) [m]; NaN where it is not known."""
    depth = flight.channels["depth"]
    seabed: np.ndarray = depth + flight.channels.get("altitude", np.full_like(depth, np.nan))
    return seabed


def _has_seabed(flight: Flight) -> bool:
    return bool(np.isfinite(_seabed(flight)).any())


def _has_no_seabed(flight: Flight) -> bool:
    return not _has_seabed(flight)


def _draw_altitude(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    lines(axes, flight, rows, flight.channels["altitude"])
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))


PANELS = (
    Panel("depth\n[m]", _draw, _has_no_seabed, "below the surface"),
    Panel("depth\n[m]", _draw, _has_seabed, "below the surface; dotted: the seabed below each vehicle"),
    Panel("altitude\n[m]", _draw_altitude, _has_seabed, "height above the seabed"),
)
