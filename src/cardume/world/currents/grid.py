"""A current on a grid, as a flat table that compiled code reads: how it is packed, and how it is looked up.

The table holds four axes, AXIS_WIDTH numbers each (size, row of the first node, first node, nodes per unit), the row of
the first velocity, then the nodes of the four axes and the velocities, (time, depth, north, east, 2), 2 being north and
east.  NaN is water that nobody measured, or land.
"""

from typing import NamedTuple

import numpy as np

from cardume.compiler import Rows, at, compiled, gather, load, some, where
from cardume.maths import clip, floor
from cardume.signals import NOTHING, Water

__all__ = ["LEAST_WEIGHT", "pack_grid", "water_at"]

TIME, DEPTH, NORTH, EAST = 0, 1, 2, 3
AXIS_WIDTH = 4
VELOCITIES = 4 * AXIS_WIDTH  # where the row of the first velocity stands
HEADER = VELOCITIES + 1
LEAST_WEIGHT = 0.25  # of the nodes around a place that must hold water: one node carries that in the middle of a cell


class Bracket(NamedTuple):
    """Between which nodes of an axis a value lies."""

    lower: float  # [-] number of the node at or below it
    upper: float  # [-] number of the next node; the same one on an axis with a single node
    fraction: float  # [-] of the way from one to the other, 0 to 1
    inside: bool  # [-] a truth value or mask: not before the first node nor after the last


class Sums(NamedTuple):
    """Weighted sums over the nodes that hold water."""

    weight: float  # [-]
    north: float  # [m/s]
    east: float  # [m/s]


def pack_grid(
    times: np.ndarray, depths: np.ndarray, norths: np.ndarray, easts: np.ndarray, velocity: np.ndarray
) -> np.ndarray:
    """The table of a gridded current.

    Args:
        times: [s] (num_times,) since the start of the mission, increasing.
        depths: [m] (num_depths,) below the surface, increasing.
        norths: [m] (num_norths,) increasing, at least two.
        easts: [m] (num_easts,) increasing, at least two.
        velocity: [m/s] (num_times, num_depths, num_norths, num_easts, 2), north and east parts; NaN where unknown.

    Returns:
        (n,) float64, read-only.
    """
    header: list[float] = []
    nodes: list[float] = []
    for axis in (times, depths, norths, easts):
        size = len(axis)
        per_unit = (size - 1) / (axis[-1] - axis[0]) if size > 1 else 0.0
        header += [size, HEADER + len(nodes), axis[0], per_unit]
        nodes += list(axis)
    table = np.concatenate([header, [HEADER + len(nodes)], nodes, np.ravel(velocity)]).astype(np.float64)
    table.flags.writeable = False
    return table


@compiled
def _bracket(grid: Rows, axis: int, x: float) -> Bracket:
    """Find a value on an axis; the guess from the mean step is right at once where the axis is regular."""
    row = at(grid, axis * AXIS_WIDTH)
    size, start = load(row, 0), load(row, 1)
    last = where(size > 2.0, size - 2.0, 0.0)
    k = clip(floor((x - load(row, 2)) * load(row, 3)), 0.0, last)
    step = where(size > 1.0, 1.0, 0.0)
    away = _nodes_away(grid, start, k, step, last, x)
    while some(abs(away) > 0.5):
        k = k + away
        away = _nodes_away(grid, start, k, step, last, x)
    low, high = gather(grid, start + k), gather(grid, start + k + step)
    width = where(high > low, high - low, 1.0)
    fraction = (x - low) / width * step
    return Bracket(k, k + step, clip(fraction, 0.0, 1.0), (fraction >= 0.0) & (fraction <= 1.0))


@compiled
def _nodes_away(grid: Rows, start: float, k: float, step: float, last: float, x: float) -> float:
    """-1, 0 or 1: the way from cell k to the one that holds x; 0 at the ends of the axis."""
    above = (x >= gather(grid, start + k + step)) & (k < last)
    below = (x < gather(grid, start + k)) & (k > 0.0)
    return where(above, 1.0, where(below, -1.0, 0.0))


@compiled
def _add_node(grid: Rows, sums: Sums, row: float, weight: float) -> Sums:
    north, east = gather(grid, row), gather(grid, row + 1.0)
    is_water = (north == north) & (east == east)
    return Sums(
        sums.weight + where(is_water, weight, 0.0),
        sums.north + where(is_water, weight * north, 0.0),
        sums.east + where(is_water, weight * east, 0.0),
    )


@compiled
def _add_layer(grid: Rows, sums: Sums, layer: float, norths: Bracket, easts: Bracket, weight: float) -> Sums:
    """The four nodes around a place in one horizontal layer, counted from the first of all layers."""
    rows, columns = load(at(grid, NORTH * AXIS_WIDTH), 0), load(at(grid, EAST * AXIS_WIDTH), 0)
    first = load(grid, VELOCITIES)
    south = first + 2.0 * columns * (layer * rows + norths.lower)
    north = first + 2.0 * columns * (layer * rows + norths.upper)
    of_south, of_north = weight * (1.0 - norths.fraction), weight * norths.fraction
    sums = _add_node(grid, sums, south + 2.0 * easts.lower, of_south * (1.0 - easts.fraction))
    sums = _add_node(grid, sums, south + 2.0 * easts.upper, of_south * easts.fraction)
    sums = _add_node(grid, sums, north + 2.0 * easts.lower, of_north * (1.0 - easts.fraction))
    return _add_node(grid, sums, north + 2.0 * easts.upper, of_north * easts.fraction)


@compiled
def _add_column(
    grid: Rows, sums: Sums, time: float, depths: Bracket, norths: Bracket, easts: Bracket, weight: float
) -> Sums:
    """The nodes around a place at one of the times, at one or two depths."""
    levels = load(at(grid, DEPTH * AXIS_WIDTH), 0)
    sums = _add_layer(grid, sums, time * levels + depths.lower, norths, easts, weight * (1.0 - depths.fraction))
    if some(depths.fraction > 0.0):
        sums = _add_layer(grid, sums, time * levels + depths.upper, norths, easts, weight * depths.fraction)
    return sums


@compiled
def water_at(grid: Rows, north: float, east: float, depth: float, time: float) -> Water:
    """Velocity of the water: bilinear in the horizontal, linear in depth and time.

    V = sum of w_i V_i / sum of w_i, over those nodes i around the place that hold water

    Before the first and after the last time, above the first and below the last level, the nearest one counts.  Where
    some of the nodes are land or were not measured the others carry the whole weight, if they had LEAST_WEIGHT of it;
    this is continuous, and carries a velocity at most a cell beyond the last node that has one.

    Args:
        grid: table made by `pack_grid`.
        north: [m]
        east: [m]
        depth: [m]
        time: [s] since the start of the mission.

    Returns:
        Velocity [m/s]; NaN outside the grid in the horizontal and where too few nodes hold water.
    """
    times, depths = _bracket(grid, TIME, time), _bracket(grid, DEPTH, depth)
    norths, easts = _bracket(grid, NORTH, north), _bracket(grid, EAST, east)
    later = times.fraction
    nothing = 0.0 * later  # as wide as a signal; NaN where the time is
    sums = Sums(nothing, nothing, nothing)
    sums = _add_column(grid, sums, times.lower, depths, norths, easts, 1.0 - later)
    if some(later > 0.0):
        sums = _add_column(grid, sums, times.upper, depths, norths, easts, later)
    known = norths.inside & easts.inside & (sums.weight >= LEAST_WEIGHT)
    weight = where(known, sums.weight, 1.0)
    return Water(where(known, sums.north / weight, NOTHING), where(known, sums.east / weight, NOTHING))
