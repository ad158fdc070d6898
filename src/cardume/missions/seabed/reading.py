"""From what a mission says of its seabed to the law's numbers and its table."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError
from cardume.missions.geodesy import GeoPoint
from cardume.missions.mission import Mission
from cardume.missions.seabed.esri_ascii import read_esri_ascii
from cardume.missions.seabed.grid import DepthGrid
from cardume.missions.seabed.netcdf import read_netcdf
from cardume.missions.vehicle import Table
from cardume.world.bathymetry.gridded import pack_seabed

MARGIN = 1000.0  # [m] around the paths that is read
ASCII = (".asc", ".txt", ".grd")


def read_seabed(mission: Mission, origin: GeoPoint | None, lines: Sequence[np.ndarray]) -> np.ndarray:
    """The table of a gridded seabed; a single 0 where it is none.

    Args:
        mission: with every value fixed.
        origin: where north = east = 0 lies.
        lines: [m] (n, 2) north and east along each vehicle's path.

    Returns:
        (n,) the table that the law `gridded` reads.

    Raises:
        MissionError: a file that cannot be read, with its key.
    """
    chosen = mission.bathymetry
    if chosen is None or chosen.name != "gridded":
        return np.zeros(1)
    try:
        grid = _read(chosen.parameters, origin, max(float(np.hypot(*line.T).max()) for line in lines) + MARGIN)
    except DataError as problem:
        raise mission.error("bathymetry.file", str(problem)) from None
    order = np.argsort(grid.easts)
    return pack_seabed(grid.norths, grid.easts[order], grid.depths[:, order])


def _read(given: Table, origin: GeoPoint | None, radius: float) -> DepthGrid:
    path, positive = Path(str(given["file"])), given.get("positive")
    coordinates = given.get("coordinates") or ("geographic" if origin else "local")
    if coordinates == "geographic" and origin is None:
        raise DataError(f"{path}: is a grid of latitude and longitude; give the mission an origin")
    if path.suffix.lower() in ASCII:
        return read_esri_ascii(path, origin if coordinates == "geographic" else None, _direction(positive))
    if coordinates == "local" or origin is None:
        raise DataError(f"{path}: a NetCDF grid is one of latitude and longitude; give the mission an origin")
    return read_netcdf(path, origin, radius, given.get("variable"), _direction(positive))


def _direction(positive: Any) -> Any:
    return positive if positive in ("up", "down") else None
