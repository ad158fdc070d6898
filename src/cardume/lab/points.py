"""Waypoints along whatever path a mission has, to be dragged instead of it."""

import numpy as np

from cardume.missions.formats.thinning import thin
from cardume.missions.geodesy import GeoPoint
from cardume.missions.mission import Mission
from cardume.missions.planning import reference_path
from cardume.paths.offset import offset_path
from cardume.paths.outline import outline

MOST = 12  # few enough to be dragged, and far enough apart for the offsets of a formation


def waypoints_along(mission: Mission) -> list[list[float]]:
    """North and east [m] of points whose straight legs follow the reference path.

    Args:
        mission: with everything drawn.

    Raises:
        InputError: its path cannot be built.
    """
    origin = GeoPoint(mission.origin.latitude, mission.origin.longitude) if mission.origin else None
    segments, _ = reference_path(mission, origin)
    line = outline(offset_path([s for s in segments if not s.beyond], 0.0, 0.0, 1.0))[:, 1:]
    kept, _ = thin(line, MOST)
    distinct = [line[index] for index in kept]
    points = [distinct[0], *(b for a, b in zip(distinct, distinct[1:], strict=False) if np.hypot(*(b - a)) > 0.1)]
    return [[round(float(north), 2), round(float(east), 2)] for north, east in points]
