"""Points along a path, for figures and for limits of area."""

import math

import numpy as np

from cardume.paths import table
from cardume.paths.projection import point_at


def outline(path: np.ndarray, spacing: float = 1.0) -> np.ndarray:
    """Points on a vehicle's own path, from its start to its end; of an arc of many laps only one.

    Args:
        path: [any] (n,) path table.
        spacing: [m] at most this far apart.

    Returns:
        [m] (points, 3): arc length, north, east; both ends of every segment are among them.
    """
    parts = []
    for row in table.rows_on_path(path):
        length = row[table.LENGTH]
        if row[table.RADIUS] > 0.0:
            length = min(length, 2.0 * math.pi * row[table.RADIUS])
        steps = max(2, math.ceil(length / spacing) + 1)
        parts.append(row[table.ARC_START] + np.linspace(0.0, length, steps))
    arc_length = np.concatenate(parts)
    return np.array([(s, *point_at(path, float(s))[:2]) for s in arc_length])
