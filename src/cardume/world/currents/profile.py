"""A current given at a few depths, as a flat table that compiled code reads.

The table holds the number of points, then for each of them its depth, one over the distance to the next one, and how
much the velocity changes from the one before it (of the first, the velocity itself).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cardume.compiler import Rows, at, compiled, load
from cardume.maths import clip
from cardume.signals import Water

__all__ = ["ProfilePoint", "flow_at", "pack_profile"]

POINT_WIDTH = 4


class ProfilePoint(NamedTuple):
    """The current at one depth."""

    depth: float  # [m]
    north: float  # [m/s]
    east: float  # [m/s]


def pack_profile(points: Sequence[ProfilePoint]) -> np.ndarray:
    """The table of a profile.

    Args:
        points: at least one, by increasing depth.

    Returns:
        (n,) float64.
    """
    rows, before = [], ProfilePoint(0.0, 0.0, 0.0)
    for point, following in zip(points, [*points[1:], None], strict=True):
        per_meter = 0.0 if following is None else 1.0 / (following.depth - point.depth)
        rows.append((point.depth, per_meter, point.north - before.north, point.east - before.east))
        before = point
    return np.concatenate([[float(len(points))], np.ravel(rows)])


@compiled
def flow_at(profile: Rows, depth: float) -> Water:
    """The velocity at a depth, linear between the points; above the first and below the last that of the nearest.

    V(z) = V_0 + sum_k sat((z - z_k) / (z_k+1 - z_k)) (V_k+1 - V_k),   sat to [0, 1]

    Args:
        profile: made by `pack_profile`.
        depth: [m]

    Returns:
        Velocity [m/s].
    """
    north, east = load(profile, 3) + 0.0 * depth, load(profile, 4) + 0.0 * depth
    for k in range(1, int(load(profile, 0))):
        above, here = at(profile, 1 + (k - 1) * POINT_WIDTH), at(profile, 1 + k * POINT_WIDTH)
        share = clip((depth - load(above, 0)) * load(above, 1), 0.0, 1.0)
        north = north + share * load(here, 2)
        east = east + share * load(here, 3)
    return Water(north, east)
