"""The errors figure: how far off the vehicles were, and how far off they believed they were."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from cardume.report import style
from cardume.simulation.flight import Flight

PANEL, TOP, BOTTOM, LEFT, RIGHT = 1.15, 0.25, 0.45, 0.75, 0.15  # [inch]
GAP = 0.24  # [inch] between panels
ROOMY = 5.5  # [inch] width at which two notes fit above a panel
CLIPPED = 2.0  # a transient this much larger than what follows runs out of its panel


class Panel(NamedTuple):
    """One quantity over time."""

    label: str
    draw: Callable[[Any, Flight, np.ndarray], None]
    matters: Callable[[Flight], bool]
    note: str


def draw_errors(flight: Flight, width: float = style.WIDTH) -> Any:
    """Draw the errors of a flight over time, one panel for each kind that matters in it.

    Args:
        flight: what was flown.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    with style.styled():
        panels = [panel for panel in PANELS if panel.matters(flight)]
        handles = style.vehicle_handles(flight.vehicle_names)
        columns = style.columns(handles, width - LEFT)
        top = TOP + style.ROW * math.ceil(len(handles) / columns)
        height = top + BOTTOM + len(panels) * PANEL + (len(panels) - 1) * GAP
        figure = style.new_figure(width, height)
        rows, last = style.thinned(len(flight.times)), None
        for k, panel in enumerate(panels):
            bottom = height - top - (k + 1) * PANEL - k * GAP
            box = (LEFT / width, bottom / height, (width - LEFT - RIGHT) / width, PANEL / height)
            last = figure.add_axes(box, sharex=last)
            _prepare(last, panel, is_lowest=k == len(panels) - 1)
            last.yaxis.set_label_coords(-0.44 / (width - LEFT - RIGHT), 0.5)
            panel.draw(last, flight, rows)
            _clip_transient(last, flight)
        place = (LEFT / width, 1 - 0.08 / height)
        figure.legend(handles=handles, loc="upper left", bbox_to_anchor=place, ncols=columns, **style.TIGHT)
        return figure


def _prepare(axes: Any, panel: Panel, is_lowest: bool) -> None:
    axes.set_ylabel(panel.label)
    axes.grid(color="#EEEEEE", lw=0.6)
    axes.set_axisbelow(True)
    axes.locator_params(axis="y", nbins=5)
    axes.tick_params(labelbottom=is_lowest)
    axes.margins(x=0.0)
    if is_lowest:
        axes.set_xlabel("time [s]")
    axes.set_title(panel.note, fontsize=7, loc="left", pad=2.5)


def _clip_transient(axes: Any, flight: Flight) -> None:
    """Let what follows the transient fill the panel, and say how far the transient went."""
    if not len(flight.times):
        return
    settled = _settled(flight)
    before, after = _range(axes, -np.inf, settled), _range(axes, settled, np.inf)
    if before is None or after is None:
        return
    half = max(abs(after[0]), abs(after[1]), 1e-9)
    if max(abs(before[0]), abs(before[1])) <= CLIPPED * half:
        return
    low = -1.35 * half if min(before[0], after[0]) < 0 else 0.0
    axes.set_ylim(low, 1.35 * half)
    furthest = max(before, key=abs)
    text = f"before settling up to {furthest:.2g}"
    if axes.get_figure().get_figwidth() >= ROOMY:
        axes.set_title(text, fontsize=7, loc="right", pad=2.5)
    else:
        box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85}
        axes.text(0.008, 0.965, text, transform=axes.transAxes, va="top", fontsize=7, zorder=8, bbox=box)


def _settled(flight: Flight) -> float:
    """[s] when the last vehicle had settled; a third of the flight where one never did."""
    times = [found.get("settling_time", np.nan) for found in flight.metrics.vehicles.values()]
    latest = max(times, default=np.nan) if np.isfinite(times).all() else np.nan
    return float(latest) if np.isfinite(latest) else float(flight.times[0] + np.ptp(flight.times) / 3)


def _range(axes: Any, start: float, end: float) -> tuple[float, float] | None:
    """Least and largest value of all lines between two times."""
    values = []
    for line in axes.lines:
        x, y = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
        if x.shape == y.shape and x.size > 2:
            values.append(y[(x >= start) & (x < end) & np.isfinite(y)])
    found = np.concatenate(values) if values else np.zeros(0)
    return (float(found.min()), float(found.max())) if found.size else None


def _lines(axes: Any, flight: Flight, rows: np.ndarray, values: np.ndarray, **how: Any) -> None:
    for k in range(values.shape[1]):
        axes.plot(flight.times[rows], values[rows, k], **{"color": style.color(k), "lw": 1.1, **how})


BELIEVED: dict[str, Any] = {"lw": 0.8, "alpha": 0.7, "dashes": (2, 1.5)}


def _zero(axes: Any) -> None:
    axes.axhline(0.0, color=style.FAINT, lw=0.6)


def _draw_cross_track(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    _zero(axes)
    _lines(axes, flight, rows, flight.channels["cross_track_estimate"], **BELIEVED)
    _lines(axes, flight, rows, flight.channels["cross_track"])


def _draw_coordination(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    _zero(axes)
    state = flight.channels["coordination_state"]
    _lines(axes, flight, rows, state - state.mean(axis=1, keepdims=True))


def _draw_position(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    channels = flight.channels
    north, east = (channels[f"{axis}_estimate"] - channels[axis] for axis in ("north", "east"))
    _lines(axes, flight, rows, np.hypot(north, east))
    axes.set_ylim(bottom=0.0)


def _draw_current(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    channels = flight.channels
    for axis, how in (("north", {}), ("east", {"dashes": (4, 1.5)})):
        _lines(axes, flight, rows, channels[f"current_{axis}_estimate"], lw=0.8, **how)
        _lines(axes, flight, rows, channels[f"current_{axis}"][:, :1], color=style.INK, lw=1.3, zorder=4, **how)


def _draw_speed(axes: Any, flight: Flight, rows: np.ndarray) -> None:
    _lines(axes, flight, rows, flight.channels["speed_desired"], **BELIEVED)
    _lines(axes, flight, rows, flight.channels["speed"])
    axes.set_ylim(bottom=0.0)


def _always(_flight: Flight) -> bool:
    return True


def _has_company(flight: Flight) -> bool:
    return len(flight.vehicle_names) > 1


def _has_current(flight: Flight) -> bool:
    names = ("current_north", "current_east", "current_north_estimate", "current_east_estimate")
    return any(np.any(np.abs(flight.channels[name]) > 1e-9) for name in names)


PANELS = (
    Panel("cross-track\nerror [m]", _draw_cross_track, _always, "solid true, dashed believed; positive to starboard"),
    Panel("coordi-\nnation [m]", _draw_coordination, _has_company, "coordination state less the fleet's mean"),
    Panel("position\nerror [m]", _draw_position, _always, "distance between believed and true"),
    Panel("current\n[m/s]", _draw_current, _has_current, "color believed, black true; solid north, dashed east"),
    Panel("speed\n[m/s]", _draw_speed, _always, "solid over ground, dashed asked for through water"),
)
