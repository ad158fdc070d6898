"""The commands figure: what is asked of the actuators, against what they can give."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight, limits_in
from cardume.report.panels import BELIEVED, Panel, always, draw_panels, lines, varies, zero
from cardume.simulation.flight import Flight

Limits = Mapping[str, tuple[float, ...]]
FAR = 2.5  # a limit so many times beyond what was used is told, not drawn


def draw_commands(log: Any, width: float = style.WIDTH) -> Any:
    """Draw thrust, yaw moment and shaft speed over time with the actuators' limits, and the speed asked for.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray; limits come from the mission in it.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    limits = limits_in(log)
    candidates = [
        Panel("speed\n[m/s]", _draw_speed, always, "solid over ground, dashed asked for through water"),
        *(_panel(*row, limits) for row in EFFORT),
    ]
    return draw_panels(as_flight(log), candidates, width)


EFFORT = (  # channel, label, unit, what stands above it
    ("thrust", "thrust", "N", "ahead"),
    ("yaw_moment", "moment", "N m", "in yaw"),
    ("shaft_speed_rpm", "shafts", "rpm", "mean of the horizontal thrusters"),
)


def _panel(channel: str, label: str, unit: str, what: str, limits: Limits) -> Panel:
    most = sorted(set(limits.get(channel, ())))
    limit = f"limit {' and '.join(f'{value:.4g}' for value in most)} {unit} either way" if most else "limit not known"
    return Panel(
        f"{label}\n[{unit}]", _drawn(channel, most), lambda flight: varies(flight, channel), f"{what}; {limit}"
    )


def _drawn(channel: str, most: list[float]) -> Callable[[Any, Flight, np.ndarray], None]:
    def draw(axes: Any, flight: Flight, rows: np.ndarray) -> None:
        values = flight.channels[channel]
        known = values[np.isfinite(values)]
        zero(axes)
        lines(axes, flight, rows, values)
        for limit in most:
            for sign, furthest in ((1, known.max(initial=0.0)), (-1, -known.min(initial=0.0))):
                if limit <= FAR * furthest:
                    axes.axhline(sign * limit, color=style.FAINT, lw=0.9, dashes=(5, 2))

    return draw


def _draw_speed(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    lines(axes, flight, rows, flight.channels["speed_desired"], **BELIEVED)
    lines(axes, flight, rows, flight.channels["speed"])
    axes.set_ylim(bottom=0.0)
