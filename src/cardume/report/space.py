"""The 3-D view: where the vehicles went, at their depths."""

import math
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.logs import as_flight
from cardume.simulation.flight import Flight

FLATTEST = 0.22  # height of the box over its longer side; where the dive is flatter, depth is stretched to it
TALL = 0.72  # height of the figure over its width
SIDE = 0.35  # shortest side of the box over the longest


def draw_space(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the tracks of a flight in three dimensions, north to the upper left, equal scales in the horizontal.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    flight = as_flight(log)
    with style.styled():
        figure = style.new_figure(width, TALL * width)
        axes = figure.add_axes((0.0, 0.0, 1.0, 0.94), projection="3d", computed_zorder=False)
        stretch = _prepare(axes, flight)
        rows = style.thinned(len(flight.times))
        for k, line in enumerate(flight.own_paths):
            depth = flight.channels["depth"][:, k]
            known = depth[np.isfinite(depth)]
            usual = float(np.median(known)) if known.size else 0.0
            axes.plot(line[:, 1], line[:, 0], usual, color=style.color(k), lw=3.0, alpha=0.18)
            axes.plot(*(flight.channels[c][rows, k] for c in ("east", "north", "depth")), color=style.color(k), lw=1.2)
        _draw_end(axes, flight)
        handles = style.vehicle_handles(flight.vehicle_names)
        columns = style.columns(handles, width - 0.4)
        place = (0.2 / width, 1 - 0.08 / (TALL * width))
        figure.legend(handles=handles, loc="upper left", bbox_to_anchor=place, ncols=columns, **style.TIGHT)
        if stretch > 1.05:
            figure.text(0.2 / width, 0.02, f"depth drawn {stretch:.2g} times too large", fontsize=7)
        return figure


def _prepare(axes: Any, flight: Flight) -> float:
    """Set limits and proportions; return by how much depths are exaggerated."""
    tracks = np.column_stack([flight.channels["north"].ravel(), flight.channels["east"].ravel()])
    points = np.concatenate([*flight.own_paths, tracks])
    points = points[np.isfinite(points).all(axis=1)]
    low, high = (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(2), np.zeros(2))
    longest = max(float(np.max(high - low)) * 1.1, 2.0)
    sides = np.maximum(1.1 * (high - low), SIDE * longest)
    middle = (low + high) / 2
    depth = flight.channels["depth"]
    deepest = max(1.1 * float(depth[np.isfinite(depth)].max(initial=0.0)), 1.0)
    height = max(FLATTEST, deepest / longest)
    axes.set_xlim(middle[1] - sides[1] / 2, middle[1] + sides[1] / 2)
    axes.set_ylim(middle[0] - sides[0] / 2, middle[0] + sides[0] / 2)
    axes.set_zlim(deepest, 0.0)
    axes.set_box_aspect((sides[1] / longest, sides[0] / longest, height), zoom=1.05)
    axes.view_init(elev=32, azim=-125)
    axes.set_xlabel("east [m]")
    axes.set_ylabel("north [m]")
    axes.set_zlabel("depth [m]")
    axes.locator_params(nbins=5)
    axes.locator_params(axis="z", nbins=3)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_visible(False)
        axis._axinfo["grid"].update(color="#DDDDDD", linewidth=0.5)
    return height * longest / deepest


def _draw_end(axes: Any, flight: Flight) -> None:
    """The vehicles at the end, each with a line up to the surface."""
    if not len(flight.times):
        return
    for k in range(len(flight.vehicle_names)):
        north, east, depth = (float(flight.channels[c][-1, k]) for c in ("north", "east", "depth"))
        if all(map(math.isfinite, (north, east, depth))):
            axes.plot([east, east], [north, north], [depth, 0.0], color=style.FAINT, lw=0.7, dashes=(2, 2))
            axes.plot([east], [north], [depth], "o", ms=4.5, color=style.color(k))
