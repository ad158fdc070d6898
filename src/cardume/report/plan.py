"""The plan view: where the vehicles were to go, where they went, where they believed they were."""

import itertools
import math
from typing import Any

import numpy as np

from cardume.report import style
from cardume.report.ellipse import LABEL, certainty, ellipse, vehicles_with_certainty
from cardume.report.logs import as_flight
from cardume.simulation.flight import Flight

LEFT, RIGHT, BOTTOM = 0.58, 0.12, 0.45  # [inch] around the axes
COMPASS = 1.2  # [inch] width of the corner with north and the current
MARGIN = 0.38  # [inch] around what is drawn, for labels
HULL = 0.14  # [inch] length of a vehicle
INSTANTS = 5
WEAKEST_CURRENT = 1e-3  # [m/s] that is worth an arrow


def draw_plan(log: Any, width: float = style.WIDTH) -> Any:
    """Draw the plan view of a flight, north up, equal scales.

    Args:
        log: a `Flight`, a `Run`, or a log opened in xarray.
        width: [inch] of the figure; its height follows from the paths.

    Returns:
        A matplotlib figure.
    """
    flight = as_flight(log)
    with style.styled():
        inner = width - LEFT - RIGHT
        low, high = _limits(flight, inner)
        legends = [style.vehicle_handles(flight.vehicle_names), _meanings(flight)]
        columns = [style.columns(handles, width - LEFT - COMPASS + 0.1) for handles in legends]
        rows = [math.ceil(len(handles) / count) for handles, count in zip(legends, columns, strict=True)]
        top = max(0.6, style.ROW * sum(rows) + 0.25)
        inner_height = min(max(inner * (high[0] - low[0]) / (high[1] - low[1]), 0.45 * inner), 1.25 * inner)
        low, high = _widened(low, high, inner_height / inner)
        height = inner_height + top + BOTTOM
        figure = style.new_figure(width, height)
        axes = figure.add_axes((LEFT / width, BOTTOM / height, inner / width, inner_height / height))
        _prepare(axes, low, high)
        _draw_paths(axes, flight)
        _draw_tracks(axes, flight)
        _draw_ellipses(axes, flight)
        _draw_instants(axes, flight, size=HULL * (high[1] - low[1]) / inner)
        for handles, count, above in zip(legends, columns, (0, rows[0]), strict=True):
            place = (LEFT / width, 1 - (0.08 + style.ROW * above) / height)
            figure.legend(handles=handles, loc="upper left", bbox_to_anchor=place, ncols=count, **style.TIGHT)
        _draw_compass(figure, flight, width, height)
        return figure


def _limits(flight: Flight, inner: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners (north, east) of what must be seen, with room for labels around it on so many inches."""
    tracks = np.column_stack([flight.channels["north"].ravel(), flight.channels["east"].ravel()])
    points = np.concatenate([flight.reference_path, *flight.own_paths, tracks])
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        points = np.zeros((1, 2))
    low, high = points.min(axis=0), points.max(axis=0)
    margin = max(float(np.max(high - low)) * MARGIN / (inner - 2 * MARGIN), 2.0)
    return low - margin, high + margin


def _widened(low: np.ndarray, high: np.ndarray, shape: float) -> tuple[np.ndarray, np.ndarray]:
    """The corners moved apart so that height / width is the given shape."""
    middle, extent = (low + high) / 2, high - low
    extent = np.maximum(extent, [extent[1] * shape, extent[0] / shape])
    return middle - extent / 2, middle + extent / 2


def _prepare(axes: Any, low: np.ndarray, high: np.ndarray) -> None:
    axes.set_xlim(low[1], high[1])
    axes.set_ylim(low[0], high[0])
    axes.set_xlabel("east [m]")
    axes.set_ylabel("north [m]")
    axes.locator_params(nbins=6)
    axes.grid(color="#EEEEEE", lw=0.6)
    axes.set_axisbelow(True)


def _draw_paths(axes: Any, flight: Flight) -> None:
    reference = flight.reference_path
    if not any(line.shape == reference.shape and np.allclose(line, reference) for line in flight.own_paths):
        axes.plot(reference[:, 1], reference[:, 0], color=style.PATH, lw=0.8, dashes=(1, 2))
    for k, line in enumerate(flight.own_paths):
        axes.plot(line[:, 1], line[:, 0], color=style.color(k), lw=4.0, alpha=0.18, solid_capstyle="butt")


def _draw_tracks(axes: Any, flight: Flight) -> None:
    rows = style.thinned(len(flight.times))
    channels = flight.channels
    for k in range(len(flight.vehicle_names)):
        north, east = channels["north"][rows, k], channels["east"][rows, k]
        believed_north, believed_east = channels["north_estimate"][rows, k], channels["east_estimate"][rows, k]
        axes.plot(believed_east, believed_north, color=style.color(k), lw=0.8, alpha=0.8, dashes=(2, 1.5))
        axes.plot(east, north, color=style.color(k), lw=1.3)
        if len(rows):
            axes.plot(east[0], north[0], "o", ms=5, mfc="white", mec=style.color(k), mew=1.2, zorder=5)


def _draw_ellipses(axes: Any, flight: Flight) -> None:
    """What vehicles expect of their own error, about where they believed to be: midway, where no hull hides it."""
    covariance, rows = certainty(flight), [0, *_instants(flight.times)]
    for k in vehicles_with_certainty(flight):
        for row in [(before + after) // 2 for before, after in itertools.pairwise(rows)]:
            if np.isfinite(covariance[:, row, k]).all():
                curve = ellipse(covariance[:, row, k])
                north, east = (flight.channels[f"{axis}_estimate"][row, k] for axis in ("north", "east"))
                axes.plot(east + curve[:, 1], north + curve[:, 0], color=style.color(k), lw=0.6, zorder=6)


def _draw_instants(axes: Any, flight: Flight, size: float) -> None:
    """The fleet at a few instants, each vehicle a small hull, joined by a thin line."""
    for row in _instants(flight.times):
        north, east = flight.channels["north"][row], flight.channels["east"][row]
        if not np.isfinite([north, east]).all():
            continue
        order = _across(flight, row)
        axes.plot(east[order], north[order], color=style.INK, lw=0.7, zorder=5)
        for k, heading in enumerate(flight.channels["heading"][row]):
            hull = _hull(north[k], east[k], heading, size)
            axes.fill(hull[:, 1], hull[:, 0], fc=style.color(k), ec="white", lw=0.5, zorder=6)
        _label(axes, f"{flight.times[row]:.4g} s", north, east, flight.channels["path_course"][row, 0], order)


def _instants(times: np.ndarray) -> list[int]:
    """Rows at a few round times, and the last row."""
    if len(times) < 2 or times[-1] <= 0.0:
        return []
    rough = times[-1] / INSTANTS
    power = 10.0 ** math.floor(math.log10(rough))
    step = power * next(nice for nice in (1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0) if nice * power >= 0.999 * rough)
    round_times = np.arange(step, times[-1] - 0.4 * step, step)
    return [*np.searchsorted(times, round_times - 1e-9).tolist(), len(times) - 1]


def _label(axes: Any, text: str, north: np.ndarray, east: np.ndarray, course: float, order: np.ndarray) -> None:
    """Write beside the vehicle furthest to port, on its outer side."""
    away = np.array([math.sin(course), -math.cos(course)])  # (north, east) to port
    axes.annotate(
        text,
        (east[order[0]], north[order[0]]),
        xytext=(9 * away[1], 9 * away[0]),
        textcoords="offset points",
        ha="left" if away[1] > 0.5 else "right" if away[1] < -0.5 else "center",
        va="bottom" if away[0] > 0.5 else "top" if away[0] < -0.5 else "center",
        fontsize=7,
        zorder=7,
        bbox={"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.75},
    )


def _across(flight: Flight, row: int) -> np.ndarray:
    """The vehicles from port to starboard of the fleet's mean heading."""
    north, east = flight.channels["north"][row], flight.channels["east"][row]
    heading = flight.channels["path_course"][row, 0]
    return np.argsort(east * math.cos(heading) - north * math.sin(heading))


def _hull(north: float, east: float, heading: float, size: float) -> np.ndarray:
    """Corners (north, east) of a hull seen from above, bow towards the heading."""
    shape = size * np.array([[0.6, 0.0], [0.1, 0.26], [-0.5, 0.22], [-0.5, -0.22], [0.1, -0.26]])
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    corners: np.ndarray = np.array([north, east]) + shape @ turn.T
    return corners


def _meanings(flight: Flight) -> list[Any]:
    from matplotlib.lines import Line2D

    told = bool(vehicles_with_certainty(flight))
    own_error = [Line2D([], [], color=style.FAINT, lw=0.6, label=LABEL)] if told else []
    return [
        Line2D([], [], color=style.FAINT, lw=4.0, alpha=0.35, label="path"),
        Line2D([], [], color=style.FAINT, lw=1.3, label="true"),
        Line2D([], [], color=style.FAINT, lw=0.8, dashes=(2, 1.5), label="believed"),
        Line2D([], [], color="none", marker="o", ms=5, mfc="white", mec=style.FAINT, mew=1.2, label="start"),
        *own_error,
    ]


def _draw_compass(figure: Any, flight: Flight, width: float, height: float) -> None:
    """North, and where the water goes."""
    axes = figure.add_axes((1 - (COMPASS + 0.04) / width, 1 - 0.58 / height, COMPASS / width, 0.52 / height))
    axes.set_xlim(0.0, COMPASS)
    axes.set_ylim(0.0, 0.52)
    axes.axis("off")
    arrow: dict[str, Any] = {"arrowstyle": "-|>", "lw": 1.0, "mutation_scale": 8, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (COMPASS - 0.08, 0.4), (COMPASS - 0.08, 0.06), arrowprops=arrow | {"color": style.INK})
    axes.text(COMPASS - 0.08, 0.41, "N", ha="center", va="bottom", fontsize=7.5)
    flow = np.array([_mean(flight.channels[f"current_{axis}"]) for axis in ("north", "east")])
    speed = float(np.hypot(*flow))
    if not speed > WEAKEST_CURRENT:
        return
    middle = (COMPASS - 0.25) / 2
    north, east = 0.16 * flow / speed
    tail, tip = (middle - east, 0.33 - north), (middle + east, 0.33 + north)
    axes.annotate("", tip, tail, arrowprops=arrow | {"color": style.PALETTE[5], "lw": 1.5})
    axes.text(middle, 0.0, f"current {speed:.2g} m/s", ha="center", va="bottom", fontsize=7)


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else 0.0
