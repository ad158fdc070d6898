"""A seabed on a grid, read from a file."""

import numpy as np

from cardume.laws import Meters
from cardume.signals import Spot
from cardume.world.bathymetry.base import bathymetry_law
from cardume.world.currents.grid import pack_grid, water_at


def pack_seabed(norths: np.ndarray, easts: np.ndarray, depths: np.ndarray) -> np.ndarray:
    """The table of a gridded seabed: a grid of one time and one level, both of whose values are the depth.

    Args:
        norths: [m] (num_norths,) increasing, at least two.
        easts: [m] (num_easts,) increasing, at least two.
        depths: [m] (num_norths, num_easts) below the surface; NaN where unknown.

    Returns:
        (n,) float64, read-only.
    """
    both = np.stack([depths, depths], axis=-1)[None, None]
    return pack_grid(np.zeros(1), np.zeros(1), norths, easts, both)


@bathymetry_law
def gridded(spot: Spot) -> Meters:
    """The file's depth here, bilinear between its nodes.

    b = sum of w_i b_i / sum of w_i, over the four nodes around the place that have a depth

    NaN outside the grid and in its holes: no echo comes from there.

    Args:
        spot: where, and the table of the grid.

    Returns:
        Depth of the seabed [m].

    Source: multilinear interpolation, tested against SciPy's RegularGridInterpolator.
    """
    return water_at(spot.field, spot.north, spot.east, 0.0 * spot.north, 0.0 * spot.north).north
