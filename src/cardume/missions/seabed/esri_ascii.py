"""ESRI ASCII grids (.asc): six lines of header, then rows from north to south."""

from pathlib import Path

import numpy as np

from cardume.errors import DataError
from cardume.missions.currents.field import local_axes
from cardume.missions.geodesy import GeoPoint
from cardume.missions.seabed.grid import DepthGrid, Positive, as_depths

NEEDED = ("ncols", "nrows", "cellsize")
HEADER = (*NEEDED, "xllcorner", "yllcorner", "xllcenter", "yllcenter", "nodata_value")
MOST_CELLS = 10_000_000


def read_esri_ascii(path: Path, origin: GeoPoint | None, positive: Positive | None) -> DepthGrid:
    """Read an ESRI ASCII grid.

    x and y are longitude and latitude in degrees where there is an origin, else east and north in meters.

    Args:
        path: of the file.
        origin: of the local axes; None: the file's axes are local themselves.
        positive: whether its values grow up or down; None: by the values.

    Raises:
        DataError: not such a grid, or damaged; with the line.
    """
    try:
        lines = path.read_text(encoding="ascii").splitlines()
    except (OSError, UnicodeDecodeError) as problem:
        raise DataError(f"{path}: cannot be read as an ESRI ASCII grid: {problem}") from None
    header, first = _header(path, lines)
    rows, columns, cell = _count(path, header, "nrows"), _count(path, header, "ncols"), header["cellsize"]
    if rows * columns > MOST_CELLS:
        raise DataError(f"{path}: has {rows} x {columns} cells; at most {MOST_CELLS:,}: cut out what the mission needs")
    values = _values(path, lines[first:], first, (rows, columns))
    values[values == header.get("nodata_value", -9999.0)] = np.nan
    x, y = (_first_center(path, header, axis) + cell * np.arange(n) for axis, n in (("x", columns), ("y", rows)))
    depths = as_depths(values[::-1], positive)
    if origin is None:
        return DepthGrid(y, x, depths)
    if np.abs(y).max() > 90.0 or np.abs(x).max() > 360.0:
        raise DataError(
            f"{path}: x {x[0]:g} to {x[-1]:g}, y {y[0]:g} to {y[-1]:g} are no longitudes and latitudes; for a grid in"
            " meters, east and north of the origin, add coordinates: local"
        )
    norths, easts = local_axes(y, x, origin)
    return DepthGrid(norths, easts, depths)


def _header(path: Path, lines: list[str]) -> tuple[dict[str, float], int]:
    header: dict[str, float] = {}
    for number, line in enumerate(lines):
        words = line.split()
        if len(words) != 2 or words[0].lower() not in HEADER:
            break
        try:
            header[words[0].lower()] = float(words[1])
        except ValueError:
            raise DataError(f"{path}:{number + 1}: given {words[1]!r}; {words[0]} must be a number") from None
    if lacking := [key for key in NEEDED if key not in header]:
        raise DataError(f"{path}: is no ESRI ASCII grid: its header lacks {', '.join(lacking)}")
    if not header["cellsize"] > 0.0:
        raise DataError(f"{path}: cellsize is {header['cellsize']:g}; it must be above 0")
    return header, len(header)


def _count(path: Path, header: dict[str, float], key: str) -> int:
    value = header[key]
    if not (value == round(value) and value >= 2.0):
        raise DataError(f"{path}: {key} is {value:g}; a grid has at least 2")
    return int(value)


def _first_center(path: Path, header: dict[str, float], axis: str) -> float:
    if f"{axis}llcenter" in header:
        return header[f"{axis}llcenter"]
    if f"{axis}llcorner" in header:
        return header[f"{axis}llcorner"] + 0.5 * header["cellsize"]
    raise DataError(f"{path}: its header lacks {axis}llcorner or {axis}llcenter")


def _values(path: Path, lines: list[str], first: int, shape: tuple[int, int]) -> np.ndarray:
    words = [word for line in lines for word in line.split()]
    if len(words) != shape[0] * shape[1]:
        raise DataError(
            f"{path}: has {len(words)} values after line {first}, by its header {shape[0]} x {shape[1]} ="
            f" {shape[0] * shape[1]}; it is cut short or its header is wrong"
        )
    try:
        return np.array(words, float).reshape(shape)
    except ValueError as problem:
        raise DataError(f"{path}: {problem}; every value must be a number") from None
