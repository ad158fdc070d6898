"""A grid of depths, whatever file it came from."""

from typing import Literal, NamedTuple

import numpy as np

Positive = Literal["up", "down"]


class DepthGrid(NamedTuple):
    """Depths of the seabed in local axes."""

    norths: np.ndarray  # (n,) [m] increasing
    easts: np.ndarray  # (m,) [m] increasing
    depths: np.ndarray  # (n, m) [m] below the surface; NaN: unknown


def as_depths(values: np.ndarray, positive: Positive | None) -> np.ndarray:
    """Depths, positive down, from what a file holds.

    Args:
        values: [m] (n, m) elevations (positive up) or depths (positive down).
        positive: which; None: by the values, most of a sea chart is water.

    Returns:
        (n, m) [m] positive down.
    """
    if positive is None:
        known = values[np.isfinite(values)]
        positive = "up" if known.size and np.median(known) < 0.0 else "down"
    return -values if positive == "up" else values
