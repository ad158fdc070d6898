"""CF NetCDF grids of depth or elevation on latitude and longitude, as GEBCO and EMODnet publish them."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError
from cardume.missions.currents.axes import Axis, Window, latitude_axis, longitude_axis
from cardume.missions.currents.cf_units import length_factor
from cardume.missions.currents.field import local_axes
from cardume.missions.currents.metadata import axis_kind, describe, find_axes, text_of
from cardume.missions.geodesy import GeoPoint
from cardume.missions.seabed.grid import DepthGrid, Positive, as_depths

DOWN = {"sea_floor_depth_below_sea_surface", "sea_floor_depth_below_mean_sea_level", "sea_floor_depth_below_geoid"}
UP = {"height_above_mean_sea_level", "height_above_geoid", "surface_altitude", "altitude", "bedrock_altitude"}
NAMES: dict[str, Positive] = {
    "elevation": "up", "z": "up", "topo": "up", "altitude": "up", "depth": "down", "bathymetry": "down",
    "deptho": "down", "bathy": "down", "h": "down",
}  # fmt: skip
MOST_NUMBERS = 10_000_000


def read_netcdf(
    path: Path, origin: GeoPoint, radius: float, variable: str | None, positive: Positive | None
) -> DepthGrid:
    """Read the part of a grid around an origin.

    Args:
        path: of the file.
        origin: of the mission's local axes.
        radius: [m] around it that is wanted.
        variable: that holds the depth; None: found by standard name, then by usual names.
        positive: whether its values grow up or down; None: by the metadata, else by the values.

    Raises:
        DataError: not such a grid; with what was found and what to do.
    """
    from netCDF4 import Dataset  # loaded where a mission needs it: 0.1 s

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Dataset(path) as file:
                return _read(file, path, Window(origin=origin, radius=radius), (variable, positive))
    except OSError as problem:
        raise DataError(f"{path}: cannot be read as NetCDF: {problem.strerror or problem}") from problem
    except (RuntimeError, ValueError, IndexError, KeyError, TypeError) as problem:
        raise DataError(f"{path}: damaged: {type(problem).__name__}: {problem}") from problem


def _read(file: Any, path: Path, window: Window, asked: tuple[str | None, Positive | None]) -> DepthGrid:
    name = asked[0] or _found(file, path)
    if name not in file.variables:
        raise DataError(f"{path}: there is no variable '{name}'; {describe(file)}")
    variable = file.variables[name]
    axes: dict[str, tuple[int, Axis]] = {}
    for dimension, coordinate in find_axes(file, name, str(path)).items():
        values = np.asarray(np.ma.filled(np.ma.asarray(file.variables[coordinate][:], float), np.nan), float)
        kind, place = axis_kind(coordinate, file.variables[coordinate]), variable.dimensions.index(dimension)
        if kind in ("latitude", "longitude"):
            axes[kind] = place, (latitude_axis if kind == "latitude" else longitude_axis)(values, window)
    (row, latitudes), (column, longitudes) = axes["latitude"], axes["longitude"]
    if len(latitudes.picks) * len(longitudes.picks) > MOST_NUMBERS:
        raise DataError(f"{path}: the part around the origin has more than {MOST_NUMBERS:,} numbers; cut the file")
    picks: list[Any] = [0] * variable.ndim
    picks[row], picks[column] = np.sort(latitudes.picks), np.sort(longitudes.picks)
    part: np.ndarray = np.ma.filled(np.ma.asarray(variable[tuple(picks)], float), np.nan)
    values = part if row < column else part.T
    back = np.ix_(*(np.searchsorted(np.sort(p), p) for p in (latitudes.picks, longitudes.picks)))
    depths = as_depths(_factor(variable, path) * values[back], asked[1] or _direction(name, variable))
    norths, easts = local_axes(latitudes.nodes, longitudes.nodes, window.origin or GeoPoint(0.0, 0.0))
    return DepthGrid(norths, easts, depths)


def _found(file: Any, path: Path) -> str:
    grids: dict[str, Any] = {n: v for n, v in file.variables.items() if v.ndim >= 2}
    named = [n for n, v in grids.items() if text_of(v, "standard_name") in DOWN | UP]
    usual = [n for n in grids if n.lower() in NAMES]
    found = named or usual
    if len(found) != 1:
        reason = f"several may be the depth: {', '.join(found)}" if found else "no variable is known to be the depth"
        raise DataError(f"{path}: {reason}; name it with variable: NAME. {describe(file)}")
    return found[0]


def _direction(name: str, variable: Any) -> Positive | None:
    said, standard = text_of(variable, "positive").lower(), text_of(variable, "standard_name")
    if said in ("up", "down"):
        return "up" if said == "up" else "down"
    if standard in DOWN | UP:
        return "down" if standard in DOWN else "up"
    return None if text_of(variable, "standard_name") else NAMES.get(name.lower())


def _factor(variable: Any, path: Path) -> float:
    unit = text_of(variable, "units") or "m"
    factor = length_factor(unit)
    if factor is None:
        raise DataError(f"{path}: unit of {variable.name} is {unit!r}, which is no length; meters are wanted")
    return factor
