"""Figures of several panels over one axis of time."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.report import style
from cardume.report.fault_lanes import fault_handles, shade_faults
from cardume.simulation.flight import Flight

PANEL, TOP, BOTTOM, LEFT, RIGHT = 1.15, 0.25, 0.45, 0.75, 0.15  # [inch]
GAP = 0.24  # [inch] between panels
ROOMY = 5.5  # [inch] width at which two notes fit above a panel
CLIPPED = 2.0  # a transient this much larger than what follows runs out of its panel
BELIEVED: dict[str, Any] = {"lw": 0.8, "alpha": 0.7, "dashes": (2, 1.5)}


class Panel(NamedTuple):
    """One quantity over time."""

    label: str
    draw: Callable[[Any, Flight, np.ndarray], None]
    matters: Callable[[Flight], bool]
    note: str


def draw_panels(flight: Flight, candidates: Sequence[Panel], width: float) -> Any:
    """Draw the panels that matter for a flight, below one another.

    Args:
        flight: what was flown.
        candidates: from the top down; the first stays where none matters.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    with style.styled():
        panels = [panel for panel in candidates if panel.matters(flight)] or list(candidates[:1])
        handles = [*style.vehicle_handles(flight.vehicle_names), *fault_handles(flight)]
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
            shade_faults(last, flight)
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


def lines(axes: Any, flight: Flight, rows: np.ndarray, values: np.ndarray, **how: Any) -> None:
    """Draw one line per vehicle, in the vehicle's color.

    Args:
        axes: of the panel.
        flight: what was flown.
        rows: (n,) of the log, to be drawn.
        values: (time, vehicle)
        how: as matplotlib's `plot` takes it.
    """
    for k in range(values.shape[1]):
        axes.plot(flight.times[rows], values[rows, k], **{"color": style.color(k), "lw": 1.1, **how})


def zero(axes: Any) -> None:
    """Draw where the quantity is zero."""
    axes.axhline(0.0, color=style.FAINT, lw=0.6)


def always(_flight: Flight) -> bool:
    """Whether a panel matters that matters always."""
    return True


def has_company(flight: Flight) -> bool:
    """Whether there is more than one vehicle."""
    return len(flight.vehicle_names) > 1


def has_current(flight: Flight) -> bool:
    """Whether there is a current, or a vehicle that believes in one."""
    names = ("current_north", "current_east", "current_north_estimate", "current_east_estimate")
    return any(varies(flight, name) for name in names)


def varies(flight: Flight, channel: str) -> bool:
    """Whether a channel of the log is ever anything but zero.

    Args:
        flight: what was flown.
        channel: its name.
    """
    return bool(np.any(np.abs(flight.channels[channel]) > 1e-9))
