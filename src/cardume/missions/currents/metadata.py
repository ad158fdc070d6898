"""Which variables of a CF file are the current, and which are its axes: standard names first, then usual names."""

import re
from typing import Any, NamedTuple

from cardume.errors import DataError

# In order of trust: the whole current before a part of it (tide, geostrophic).
STANDARD_NAMES = (
    ("eastward_sea_water_velocity", "northward_sea_water_velocity"),
    ("surface_eastward_sea_water_velocity", "surface_northward_sea_water_velocity"),
    ("barotropic_eastward_sea_water_velocity", "barotropic_northward_sea_water_velocity"),
    ("surface_geostrophic_eastward_sea_water_velocity", "surface_geostrophic_northward_sea_water_velocity"),
)
# For variables without a standard name, as these sources write them.
USUAL_NAMES = (
    ("uo", "vo"),  # Copernicus Marine
    ("water_u", "water_v"),  # HYCOM
    ("u_eastward", "v_northward"),  # ROMS, turned and moved to rho points
    ("eastward_eulerian_current_velocity", "northward_eulerian_current_velocity"),  # GlobCurrent
    ("u", "v"),  # HF radar
)
AXIS_STANDARD_NAMES = {
    "latitude": "latitude", "longitude": "longitude", "depth": "depth", "altitude": "depth", "height": "depth",
    "time": "time", "projection_x_coordinate": "projected", "projection_y_coordinate": "projected",
    "grid_latitude": "projected", "grid_longitude": "projected",
}  # fmt: skip
AXIS_NAMES = {
    "lat": "latitude", "latitude": "latitude", "nav_lat": "latitude", "lon": "longitude", "longitude": "longitude",
    "nav_lon": "longitude", "depth": "depth", "deptht": "depth", "lev": "depth", "time": "time", "ocean_time": "time",
}  # fmt: skip
REGRID = (
    "interpolate the file to a regular grid of latitude and longitude first (CDO: cdo remapbil, or xESMF in Python)"
)
MOST_LISTED = 12


class Pair(NamedTuple):
    """The two variables that hold the current."""

    east: str
    north: str


def find_pair(file: Any, east: str | None, north: str | None, where: str) -> Pair:
    """Names of the variables for the velocity to the east and to the north.

    Args:
        file: an open `netCDF4.Dataset`.
        east: name given by the user, or None.
        north: name given by the user, or None.
        where: how to name the file in a message.

    Raises:
        DataError: none, more than one, or one that does not point east or north; with what the file holds.
    """
    if east is not None or north is not None:
        return _named_pair(file, east, north, where)
    standard = {name: text_of(variable, "standard_name") for name, variable in file.variables.items()}
    for pair in STANDARD_NAMES:
        easts, norths = ([name for name, given in standard.items() if given == wanted] for wanted in pair)
        if len(easts) == 1 and len(norths) == 1:
            return Pair(easts[0], norths[0])
        if easts or norths:
            raise DataError(
                f"{where}: {_listed(easts)} with the standard name {pair[0]} and {_listed(norths)} with {pair[1]};"
                f" say which with east: and north:\n{describe(file)}"
            )
    for first, second in USUAL_NAMES:
        if standard.get(first) == "" and standard.get(second) == "":
            return Pair(first, second)
    raise DataError(f"{where}: {_no_pair(standard)}\n{describe(file)}")


def _named_pair(file: Any, east: str | None, north: str | None, where: str) -> Pair:
    if east is None or north is None:
        given, missing = ("east", "north") if north is None else ("north", "east")
        raise DataError(f"{where}: {given}: names a variable, {missing}: does not; name both or neither")
    for key, name in (("east", east), ("north", north)):
        if name not in file.variables:
            raise DataError(f"{where}: {key}: {name} is not in the file\n{describe(file)}")
    if east == north:
        raise DataError(f"{where}: east: and north: both name {east}\n{describe(file)}")
    return Pair(east, north)


def _no_pair(standard: dict[str, str]) -> str:
    along_grid = [name for name, given in standard.items() if re.match(r"sea_water_[xy]_velocity", given)]
    if along_grid:
        return (
            f"{_listed(along_grid)} point along the grid (sea_water_x_velocity), which need not be east and north;"
            " turn them by the grid's angle and interpolate them to a regular grid of latitude and longitude, or, if"
            " x is east and y north in this file, name them with east: and north:"
        )
    return (
        "no variables with the standard names eastward_sea_water_velocity and northward_sea_water_velocity, and none of"
        " the usual names " + ", ".join("/".join(pair) for pair in USUAL_NAMES) + " without a standard name of"
        " something else; name the variables with east: and north:"
    )


def describe(file: Any) -> str:
    """The variables of a file with shape, unit and standard name, for a message.

    Args:
        file: an open `netCDF4.Dataset`.
    """
    lines = []
    for name, variable in file.variables.items():
        shape = ", ".join(f"{d} {n}" for d, n in zip(variable.dimensions, variable.shape, strict=True))
        unit, standard = text_of(variable, "units"), text_of(variable, "standard_name")
        lines.append(f"  {name} ({shape})" + (f" [{unit}]" if unit else "") + (f" {standard}" if standard else ""))
    shown = lines[:MOST_LISTED] + ([f"  and {len(lines) - MOST_LISTED} more"] if len(lines) > MOST_LISTED else [])
    groups = f"\n  groups, which are not searched: {', '.join(file.groups)}" if file.groups else ""
    return "the file holds:\n" + "\n".join(shown or ["  no variables"]) + groups


def find_axes(file: Any, name: str, where: str) -> dict[str, str]:
    """Which coordinate variable belongs to each dimension of a variable.

    Args:
        file: an open `netCDF4.Dataset`.
        name: of the variable.
        where: how to name the file in a message.

    Returns:
        {dimension: coordinate variable}; a dimension of size 1 without a coordinate is left out.

    Raises:
        DataError: a grid that is not one of latitude and longitude, with what to do.
    """
    variable = file.variables[name]
    axes: dict[str, str] = {}
    kinds: dict[str, list[str]] = {}
    for dimension, size in zip(variable.dimensions, variable.shape, strict=True):
        if size == 0:
            raise DataError(f"{where}: dimension {dimension} of {name} has no entries")
        candidates = [n for n, v in file.variables.items() if v.dimensions == (dimension,) and axis_kind(n, v)]
        candidates.sort(key=lambda n: (n != dimension, n))
        if candidates:
            axes[dimension] = candidates[0]
            kind = axis_kind(candidates[0], file.variables[candidates[0]])
            kinds.setdefault(kind, []).append(dimension)
        elif size > 1:
            raise DataError(f"{where}: {_no_coordinate(file, name, dimension, size)}")
    if "sigma" in kinds:
        raise DataError(
            f"{where}: {axes[kinds['sigma'][0]]} counts terrain-following levels; interpolate the file to depths in"
            " meters first"
        )
    if "projected" in kinds:
        raise DataError(f"{where}: {axes[kinds['projected'][0]]} is an axis of a map projection; {REGRID}")
    for kind in ("latitude", "longitude"):
        if kind not in kinds:
            raise DataError(f"{where}: {name} ({', '.join(variable.dimensions)}) has no {kind}; {REGRID}")
    for kind, dimensions in kinds.items():
        if len(dimensions) > 1:
            raise DataError(f"{where}: {name} has more than one axis of {kind}: {', '.join(dimensions)}")
    return axes


def _no_coordinate(file: Any, name: str, dimension: str, size: int) -> str:
    for other, variable in file.variables.items():
        is_plane = len(variable.dimensions) == 2 and dimension in variable.dimensions
        if is_plane and axis_kind(other, variable) in ("latitude", "longitude"):
            return (
                f"{name} is on a curvilinear grid: {other} has the two dimensions {', '.join(variable.dimensions)};"
                f" turn the velocities to east and north by the grid's angle, then {REGRID}"
            )
    return (
        f"dimension {dimension} ({size}) of {name} has no coordinate: no variable with this one dimension is a"
        " latitude, longitude, depth or time; add one, or take out one slice of the file"
    )


def axis_kind(name: str, variable: Any) -> str:
    """What a coordinate variable counts: latitude, longitude, depth, time, projected, sigma, or nothing ("").

    Args:
        name: of the variable.
        variable: a `netCDF4.Variable`.
    """
    standard, unit = text_of(variable, "standard_name"), text_of(variable, "units").lower()
    if re.match(r"ocean_(s|sigma|double_sigma)\w*coordinate|ocean_sigma|model_level", standard):
        return "sigma"
    if standard in AXIS_STANDARD_NAMES:
        return AXIS_STANDARD_NAMES[standard]
    if re.fullmatch(r"degrees?[ _]?(north|n)", unit):
        return "latitude"
    if re.fullmatch(r"degrees?[ _]?(east|e)", unit):
        return "longitude"
    if " since " in unit:
        return "time"
    if text_of(variable, "positive").lower() in ("up", "down"):
        return "depth"
    return "" if standard else AXIS_NAMES.get(name.lower(), "")


def text_of(variable: Any, attribute: str) -> str:
    """An attribute as text; "" where there is none or it is a number.

    Args:
        variable: a `netCDF4.Variable` or `netCDF4.Dataset`.
        attribute: its name.
    """
    value = getattr(variable, attribute, "")
    return value.strip() if isinstance(value, str) else ""


def _listed(names: list[str]) -> str:
    return ", ".join(names) if names else "no variable"
