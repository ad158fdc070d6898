"""A seabed from files: NetCDF as GEBCO writes it, ESRI ASCII; and what is wrong with one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from netCDF4 import Dataset
from scipy.interpolate import RegularGridInterpolator

from cardume.errors import DataError
from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.missions.seabed.esri_ascii import read_esri_ascii
from cardume.missions.seabed.netcdf import read_netcdf
from cardume.signals import Spot
from cardume.world.bathymetry.flat import flat
from cardume.world.bathymetry.gridded import gridded, pack_seabed
from cardume.world.bathymetry.slope import slope

ORIGIN = GeoPoint(np.radians(38.5), np.radians(-9.2))


def write_netcdf(path: Path, name: str = "elevation", sign: float = -1.0, **attributes: str) -> Path:
    """Depth 10 m + 1 m per 100 m north + 2 m per 100 m east of the origin, about."""
    with Dataset(path, "w") as file:
        axes = {"lat": 38.5 + 0.001 * np.arange(-20, 21), "lon": -9.2 + 0.001 * np.arange(-20, 21)}
        for axis, values in axes.items():
            file.createDimension(axis, len(values))
            variable = file.createVariable(axis, "f8", (axis,))
            variable.units = "degrees_north" if axis == "lat" else "degrees_east"
            variable[:] = values
        variable = file.createVariable(name, "f4", ("lat", "lon"))
        variable.setncatts({"units": "m", **attributes})
        north, east = (axes["lat"][:, None] - 38.5) * 111_000.0, (axes["lon"] + 9.2) * 87_000.0
        variable[:] = sign * (30.0 + 0.01 * north + 0.02 * east)
    return path


@pytest.mark.parametrize(
    ("name", "sign", "attributes"),
    [
        ("elevation", -1.0, {"standard_name": "height_above_mean_sea_level"}),
        ("depth", 1.0, {}),
        ("z", -1.0, {}),
        ("sea_floor", 1.0, {"standard_name": "sea_floor_depth_below_sea_surface"}),
        ("bathymetry", -1.0, {"positive": "up"}),
    ],
)
def test_netcdf_depths_and_elevations(tmp_path: Path, name: str, sign: float, attributes: dict[str, str]) -> None:
    grid = read_netcdf(write_netcdf(tmp_path / "sea.nc", name, sign, **attributes), ORIGIN, 500.0, None, None)
    assert grid.depths.shape == (len(grid.norths), len(grid.easts))
    assert len(grid.norths) < 20  # only what is near
    table = pack_seabed(*grid)
    for north, east in ((0.0, 0.0), (150.0, -90.0), (-333.0, 222.0)):
        latitude, longitude = np.degrees(to_geographic(north, east, ORIGIN))
        wanted = 30.0 + 0.01 * (latitude - 38.5) * 111_000.0 + 0.02 * (longitude + 9.2) * 87_000.0
        assert gridded.function(Spot(north, east, table)) == pytest.approx(wanted, abs=2e-3)  # float32, axes


def test_esri_ascii_local_and_geographic(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    depths = 20.0 + rng.random((5, 4))
    depths[4, 3] = np.nan
    rows = "\n".join(" ".join(f"{-v:.17g}" if v == v else "-9999" for v in row) for row in depths[::-1])
    path = tmp_path / "sea.asc"
    path.write_text(f"ncols 4\nnrows 5\nxllcorner -15\nyllcorner -5\ncellsize 10\nNODATA_value -9999\n{rows}\n")
    grid = read_esri_ascii(path, None, None)
    assert (grid.easts.tolist(), grid.norths[0]) == ([-10.0, 0.0, 10.0, 20.0], 0.0)
    assert np.allclose(grid.depths, depths, equal_nan=True)  # elevations, by their sign
    table, truth = pack_seabed(*grid), RegularGridInterpolator((grid.norths, grid.easts), depths)
    for north, east in zip(40.0 * rng.random(20) * 0.74, -10.0 + 30.0 * rng.random(20) * 0.66, strict=True):
        assert gridded.function(Spot(north, east, table)) == pytest.approx(float(truth((north, east))), abs=1e-9)
    assert np.isnan(gridded.function(Spot(-1.0, 0.0, table)))
    with pytest.raises(DataError, match="coordinates: local"):
        read_esri_ascii(_edited(path, "xllcorner -15", "xllcorner 480000"), ORIGIN, None)
    path.write_text("ncols 2\nnrows 2\nxllcenter -9.3\nyllcenter 38.4\ncellsize 0.2\n5 6\n7 8\n")
    assert np.array_equal(read_esri_ascii(path, ORIGIN, "down").depths, [[7.0, 8.0], [5.0, 6.0]])


def _edited(path: Path, old: str, new: str) -> Path:
    other = path.with_name("other.asc")
    other.write_text(path.read_text().replace(old, new))
    return other


GOOD = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "lacks ncols, nrows, cellsize"),
        (GOOD.replace("cellsize 1", "cellsize 0"), "must be above 0"),
        (GOOD.replace("ncols 2", "ncols two"), "must be a number"),
        (GOOD.replace("ncols 2", "ncols 1"), "at least 2"),
        (GOOD.replace("ncols 2", "ncols 1e9"), "cells"),
        (GOOD.replace("xllcorner 0\n", ""), "xllcorner or xllcenter"),
        (GOOD.replace("3 4", "3"), "has 3 values"),
        (GOOD.replace("3 4", "3 x"), "every value must be a number"),
        (GOOD.replace("3 4", "3 \u00e9"), "cannot be read"),
    ],
)
def test_a_bad_ascii_grid(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "bad.asc"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DataError, match=words):
        read_esri_ascii(path, None, None)


def test_a_bad_netcdf_grid(tmp_path: Path) -> None:
    (tmp_path / "no.nc").write_bytes(b"CDF?" * 20)
    cases: list[tuple[Path, dict[str, Any], str]] = [
        (tmp_path / "no.nc", {}, "cannot be read as NetCDF"),
        (write_netcdf(tmp_path / "a.nc", "speed"), {}, "name it with variable"),
        (write_netcdf(tmp_path / "b.nc"), {"variable": "nothing"}, "there is no variable 'nothing'"),
        (write_netcdf(tmp_path / "c.nc", units="kelvin"), {}, "no length"),
    ]
    for path, more, words in cases:
        with pytest.raises(DataError, match=words):
            read_netcdf(path, ORIGIN, 500.0, more.get("variable"), None)
    with pytest.raises(DataError, match="origin"):
        read_netcdf(tmp_path / "b.nc", GeoPoint(0.1, 0.1), 500.0, None, None)


def test_synthetic_seabeds() -> None:
    assert flat.function(Spot(5.0, 6.0, np.zeros(1)), depth=12.0) == 12.0
    east = slope.function(Spot(3.0, 10.0, np.zeros(1)), depth=12.0, gradient=0.1, towards=np.pi / 2)
    assert east == pytest.approx(13.0)
    assert slope.function(Spot(0.0, -500.0, np.zeros(1)), depth=12.0, gradient=0.1, towards=np.pi / 2) == 0.0
    for law in (flat, slope, gridded):
        assert law.handle(lanes=True) > 0
