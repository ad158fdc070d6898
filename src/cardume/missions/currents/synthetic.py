"""A field for where no real one is at hand: made up, and it says so."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError

TITLE = "SYNTHETIC surface current: made up by cardume, no measurement"
LATITUDES_DEG = 36.4198 + 0.0135167 * np.arange(61)
LONGITUDES_DEG = -7.8684 + 0.0168135 * np.arange(97)
FILL = -9999.0


def synthetic_cadiz(path: str | Path) -> Path:
    """Write a made-up field on the grid of an HF radar off Cadiz: 61 x 97 cells of 1.5 km, most of them holes.

    The flow has no divergence; median speed 0.1 m/s, fastest 0.3 m/s, near 0.1 m/s to the south-south-east at 36.80 N
    7.24 W.  NetCDF-3, CF-1.4.

    Args:
        path: of the file, which is written under another name first and then renamed.

    Returns:
        The path.

    Raises:
        DataError: the file cannot be written.
    """
    from netCDF4 import Dataset

    path = Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with Dataset(part, "w", format="NETCDF3_CLASSIC") as file:
            _write(file)
        part.replace(path)
    except OSError as problem:
        part.unlink(missing_ok=True)
        raise DataError(f"{path}: cannot be written: {problem.strerror or problem}") from problem
    return path


def _write(file: Any) -> None:
    file.Conventions, file.title, file.source = "CF-1.4", TITLE, "analytic stream function"
    axes = {
        "time": (np.zeros(1), "hours since 2000-01-01 00:00:00", "time"),
        "lat": (LATITUDES_DEG, "degrees_north", "latitude"),
        "lon": (LONGITUDES_DEG, "degrees_east", "longitude"),
    }
    for name, (values, unit, standard_name) in axes.items():
        file.createDimension(name, len(values))
        variable = file.createVariable(name, "f8", (name,))
        variable.units, variable.standard_name = unit, standard_name
        variable[:] = values
    for name, towards, values in zip("uv", ("eastward", "northward"), _velocity(), strict=True):
        variable = file.createVariable(name, "f4", tuple(axes), fill_value=np.float32(FILL))
        variable.units, variable.standard_name = "m/s", f"{towards}_sea_water_velocity"
        variable[0] = values


def _velocity() -> tuple[np.ndarray, np.ndarray]:
    """East and north parts (61, 97) [m/s], FILL in holes, of a slope current with an eddy on it."""
    y, x = np.meshgrid((LATITUDES_DEG - 36.80) * 111.0, (LONGITUDES_DEG + 7.24) * 89.1, indexing="ij")  # [km]
    eddy = np.exp(-((x + 14.0) ** 2 + (y - 4.0) ** 2) / (2.0 * 15.0**2))
    u = 0.062 + 0.0035 * y + 0.21 * eddy * (y - 4.0) / 15.0
    v = 0.02 + 0.002 * x - 0.21 * eddy * (x + 14.0) / 15.0
    seen = ((x + 6.0) / 34.0) ** 2 + ((y + 2.0) / 29.0) ** 2 < 1.0 + 0.12 * np.sin(0.3 * x + 0.2 * y)
    shadow = (np.hypot(x - 12.0, y + 18.0) < 4.0) | (np.hypot(x + 30.0, y - 9.0) < 2.5)
    holes = ~seen | shadow
    return np.where(holes, FILL, u), np.where(holes, FILL, v)
