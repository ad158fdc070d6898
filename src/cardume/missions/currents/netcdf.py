"""Read the part of a CF NetCDF file that a mission needs."""

import itertools
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import DataError
from cardume.missions.currents.axes import Axis, Window, depth_axis, latitude_axis, longitude_axis, time_axis
from cardume.missions.currents.cf_units import speed_factor
from cardume.missions.currents.classic import ShortFileError, promised_size
from cardume.missions.currents.field import CurrentField
from cardume.missions.currents.metadata import REGRID, Pair, axis_kind, find_axes, find_pair, text_of

MOST_NUMBERS = 20_000_000  # 160 MB
FASTEST = 20.0  # [m/s] no ocean current; a fill value that was not declared
KINDS = ("time", "depth", "latitude", "longitude")
ALONE = Axis(np.zeros(1), np.zeros(1, dtype=int))  # an axis that the file does not have


class Grid(NamedTuple):
    """Where a variable's numbers are."""

    axes: dict[str, Axis]  # of each kind that the file has
    dimensions: dict[str, str]  # of the variable -> its kind
    start: datetime | None


def read_current(
    path: str | Path, *, window: Window | None = None, east: str | None = None, north: str | None = None
) -> CurrentField:
    """Read the current of a region from a CF NetCDF file (version 3 or 4).

    The variables are found by standard name, then by usual names; latitude may run either way, longitude may count to
    180 or to 360 and cross either; depth may be positive up; numbers may be packed; NaN, fill values and values outside
    the valid range are holes.

    Args:
        path: of the file.
        window: what of it is wanted; None: all.
        east: variable for the velocity to the east, where the file does not say it.
        north: variable for the velocity to the north.

    Raises:
        DataError: no file, not NetCDF, damaged, or not a current on a grid of latitude and longitude; with what was
            found and what to do.
    """
    path, wanted = Path(path), window or Window()
    where = str(path)
    _check_whole(path)
    with _opened(path) as file:
        names = find_pair(file, east, north, where)
        grid = _find_grid(file, names, wanted, where)
        velocity = np.stack([_read_velocity(file, name, grid, where) for name in (names.north, names.east)], axis=-1)
        title = text_of(file, "title")
    _check_velocity(velocity, grid, names, where)
    times, depths, latitudes_deg, longitudes_deg = (grid.axes[kind].nodes for kind in KINDS)
    return CurrentField(
        source=where,
        title=title,
        names=names,
        start=grid.start,
        times=times,
        depths=depths,
        latitudes_deg=latitudes_deg,
        longitudes_deg=longitudes_deg,
        velocity=velocity,
    )


def _check_whole(path: Path) -> None:
    """Refuse what is no file before NetCDF sees it: it would fetch a URL, and read past the end of a cut file."""
    if not path.is_file():
        kind = "is a directory" if path.is_dir() else "does not exist"
        raise DataError(f"{path}: {kind}; give the path of a CF NetCDF file")
    try:
        size, promised = path.stat().st_size, promised_size(path)
    except ShortFileError:
        raise DataError(f"{path}: damaged: it ends within its header; get it again") from None
    except OSError as problem:
        raise DataError(f"{path}: cannot be read: {problem.strerror}") from problem
    if promised is not None and size < promised:
        raise DataError(f"{path}: cut short: it has {size:,} bytes, by its header {promised:,}; get it again")


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """A `netCDF4.Dataset`; whatever goes wrong while reading it becomes a DataError."""
    from netCDF4 import Dataset  # loaded where a mission needs it: 0.1 s

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of valid ranges that do not fit the type
            with Dataset(path) as file:
                yield file
    except OSError as problem:
        if problem.errno == -51:
            raise DataError(f"{path}: is not NetCDF; gridded currents come from CF NetCDF files") from problem
        raise DataError(f"{path}: cannot be read: {problem.strerror or problem}; it may be damaged") from problem
    except (RuntimeError, ValueError, IndexError, KeyError, TypeError, AttributeError, OverflowError) as problem:
        raise DataError(f"{path}: damaged: {type(problem).__name__}: {problem}") from problem


def _find_grid(file: Any, names: Pair, window: Window, where: str) -> Grid:
    """The nodes that are wanted, by kind of axis."""
    _check_same_points(file, names, where)
    coordinates = find_axes(file, names.east, where)
    dimensions = {dimension: axis_kind(name, file.variables[name]) for dimension, name in coordinates.items()}
    axes, start = dict.fromkeys(KINDS, ALONE), None
    for dimension, name in coordinates.items():
        variable, kind = file.variables[name], dimensions[dimension]
        try:
            values = _coordinate_values(variable)
            if kind == "latitude":
                axes[kind] = latitude_axis(values, window)
            elif kind == "longitude":
                axes[kind] = longitude_axis(values, window)
            elif kind == "depth":
                axes[kind] = depth_axis(values, variable, window)
            else:
                axes[kind], start = time_axis(values, variable, window)
        except DataError as problem:
            raise DataError(f"{where}: {name}: {problem}") from problem
    return Grid(axes, dimensions, start)


def _check_same_points(file: Any, names: Pair, where: str) -> None:
    east, north = file.variables[names.east], file.variables[names.north]
    if {*east.dimensions} != {*north.dimensions}:
        raise DataError(
            f"{where}: {names.east} ({', '.join(east.dimensions)}) and {names.north} ({', '.join(north.dimensions)})"
            f" are not at the same points, as on a staggered C-grid (ROMS, NEMO, CROCO); move both to the centers of"
            f" the cells, turn them to east and north, then {REGRID}"
        )


def _coordinate_values(variable: Any) -> np.ndarray:
    """All values of a coordinate as float64."""
    values = np.ma.asarray(_numbers(variable, (slice(None),)))
    if np.ma.is_masked(values) or not np.all(np.isfinite(values.data)):
        raise DataError("some of the coordinates are missing")
    return np.asarray(values.data)


def _numbers(variable: Any, part: tuple[slice, ...]) -> Any:
    """Part of a variable, unpacked, as a masked array of float64."""
    values = variable[part]
    if not np.issubdtype(np.asanyarray(values).dtype, np.number):
        raise DataError(f"{variable.name} holds {variable.dtype}, not numbers")
    return np.ma.asarray(values).astype(np.float64)


def _read_velocity(file: Any, name: str, grid: Grid, where: str) -> np.ndarray:
    """(time, depth, latitude, longitude) in m/s, NaN in holes."""
    variable = file.variables[name]
    unit = text_of(variable, "units")
    factor = speed_factor(unit)
    if factor is None:
        raise DataError(
            f"{where}: unit of {name} is {unit!r}, which is no speed; valid are m s-1, cm/s, knots and the like (NCO:"
            f" ncatted -a units,{name},o,c,'m s-1' FILE)"
        )
    picks = [grid.axes[grid.dimensions[d]].picks if d in grid.dimensions else ALONE.picks for d in variable.dimensions]
    if 2 * np.prod([float(len(p)) for p in picks]) > MOST_NUMBERS:
        shape = ", ".join(f"{d} {len(p)}" for d, p in zip(variable.dimensions, picks, strict=True))
        raise DataError(
            f"{where}: the part that is wanted, {shape}, has more than {MOST_NUMBERS:,} numbers; give the mission an"
            " origin and a shorter duration, or cut the file (CDO: cdo sellonlatbox)"
        )
    values = _gathered(variable, picks)
    kinds = [grid.dimensions.get(d, d) for d in variable.dimensions]
    lengths = dict(zip(kinds, values.shape, strict=True))
    kept = values.reshape([n for kind, n in lengths.items() if kind in KINDS])
    present = [kind for kind in kinds if kind in KINDS]
    ordered = kept.transpose([present.index(kind) for kind in KINDS if kind in present])
    return factor * ordered.reshape([lengths.get(kind, 1) for kind in KINDS])


def _gathered(variable: Any, picks: list[np.ndarray]) -> np.ndarray:
    """Read nodes in any order, by contiguous parts: a window across the end of the longitudes has two."""
    values = np.empty([len(p) for p in picks])
    for parts in itertools.product(*[_runs(np.sort(p)) for p in picks]):
        there = tuple(slice(*run.of_file) for run in parts)
        here = tuple(slice(*run.of_result) for run in parts)
        values[here] = _numbers(variable, there).filled(np.nan)
    return values[np.ix_(*[np.searchsorted(np.sort(p), p) for p in picks])]


class Run(NamedTuple):
    """Neighbors in a file and where they go."""

    of_file: tuple[int, int]
    of_result: tuple[int, int]


def _runs(picks: np.ndarray) -> list[Run]:
    bounds = [0, *(np.flatnonzero(np.diff(picks) != 1) + 1), len(picks)]
    return [
        Run((int(picks[first]), int(picks[last - 1]) + 1), (int(first), int(last)))
        for first, last in itertools.pairwise(bounds)
    ]


def _check_velocity(velocity: np.ndarray, grid: Grid, names: Pair, where: str) -> None:
    velocity[np.isinf(velocity)] = np.nan
    known = np.isfinite(velocity).all(axis=-1)
    if not known.any():
        latitudes, longitudes = grid.axes["latitude"].nodes, grid.axes["longitude"].nodes
        raise DataError(
            f"{where}: no water at all between latitude {latitudes[0]:.3f} and {latitudes[-1]:.3f}, longitude"
            f" {longitudes[0]:.3f} and {longitudes[-1]:.3f} deg: every cell is masked; move the origin or use another"
            " file"
        )
    fastest = np.abs(velocity[known]).max()
    if fastest > FASTEST:
        raise DataError(
            f"{where}: {names.east}, {names.north} reach {fastest:g} m/s, which no current does: probably a fill value"
            f" that is not declared (NCO: ncatted -a _FillValue,{names.east},o,f,{fastest:g} FILE) or a wrong unit"
        )
