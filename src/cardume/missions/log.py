"""The log of a flight as a NetCDF-4 file, written and read.

Dimensions `time`, `vehicle`, `neighbor`; one variable per channel, each with `units` and
`long_name`; a group `messages`; a group `paths` with the lines that the vehicles were to follow.
The same flight gives the same bytes: nothing in the file depends on when or where it was written.
"""

import contextlib
import errno
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import DataError
from cardume.missions.atomic import new_file
from cardume.simulation.flight import CERTAINTY, CHANNELS, MESSAGE_COLUMNS, MESSAGE_KINDS, Flight, Metrics
from cardume.units import printable

FORMAT_VERSION = 1
OVERHEAD = 200_000  # [bytes] of names and attributes, in an empty log
REFERENCE = -1  # in `paths`, the vehicle of the formation's reference path


class Meaning(NamedTuple):
    """What a variable of the log holds."""

    units: str
    long_name: str


VARIABLES = {
    "time": Meaning("s", "time since the start of the mission"),
    "vehicle": Meaning("1", "name of the vehicle"),
    "neighbor": Meaning("1", "name of the vehicle that is spoken of"),
    "north": Meaning("m", "true position, north of the origin"),
    "east": Meaning("m", "true position, east of the origin"),
    "depth": Meaning("m", "true depth below the surface"),
    "heading": Meaning("rad", "true heading, clockwise from north"),
    "surge": Meaning("m/s", "true velocity through the water, forward"),
    "sway": Meaning("m/s", "true velocity through the water, to starboard"),
    "yaw_rate": Meaning("rad/s", "true yaw rate, positive to starboard"),
    "course": Meaning("rad", "true direction of travel over ground, clockwise from north"),
    "speed": Meaning("m/s", "true speed over ground"),
    "current_north": Meaning("m/s", "true current, towards north"),
    "current_east": Meaning("m/s", "true current, towards east"),
    "cross_track": Meaning("m", "true cross-track error, positive to starboard of the path"),
    "along_track": Meaning("m", "true along-track error, positive ahead of the reference point"),
    "path_course": Meaning("rad", "course of the path at the true reference point"),
    "curvature": Meaning("1/m", "curvature of the own path there, positive for a turn to starboard"),
    "coordination_state": Meaning("m", "true arc length along the reference path, less the place ahead"),
    "north_estimate": Meaning("m", "believed position, north of the origin"),
    "east_estimate": Meaning("m", "believed position, east of the origin"),
    "current_north_estimate": Meaning("m/s", "believed current, towards north"),
    "current_east_estimate": Meaning("m/s", "believed current, towards east"),
    "cross_track_estimate": Meaning("m", "believed cross-track error, positive to starboard of the path"),
    "coordination_state_estimate": Meaning("m", "believed arc length along the reference path, less the place ahead"),
    "neighbor_state_estimate": Meaning("m", "what a vehicle believes of a neighbor's coordination state"),
    "course_desired": Meaning("rad", "course over ground asked of the vehicle"),
    "heading_desired": Meaning("rad", "heading asked of the autopilot"),
    "speed_desired": Meaning("m/s", "speed through the water asked of the autopilot"),
    "speed_correction": Meaning("m/s", "what coordination adds to the speed along the reference path"),
    "thrust": Meaning("N", "thrust, forward"),
    "yaw_moment": Meaning("N m", "yaw moment, positive to starboard"),
    "shaft_speed_rpm": Meaning("rpm", "mean shaft speed of the horizontal thrusters"),
    "altitude": Meaning("m", "true height above the seabed; none without a bathymetry"),
    "depth_desired": Meaning("m", "depth asked of the autopilot"),
    "phase": Meaning(
        "1", "phase of the mission: 0 dive, 1 gather, 2 ready, 3 assembled, 4 go, 5 hold, 6 surface, 7 abort"
    ),
    "north_variance": Meaning("m2", "believed variance of the believed position, north; none if its law says none"),
    "north_east_covariance": Meaning("m2", "believed covariance of its north and east"),
    "east_variance": Meaning("m2", "believed variance of the believed position, east"),
}
MESSAGES = {
    "time_sent": Meaning("s", "when the message was sent"),
    "time_received": Meaning("s", "when it reached its receiver; none if it was lost"),
    "sender": Meaning("1", "who sent it, by place in the fleet"),
    "receiver": Meaning("1", "whom it was to reach, by place in the fleet"),
    "kind": Meaning("1", "what kind of message it was"),
    "lost": Meaning("1", "1 if it did not arrive"),
    "time_of_validity": Meaning("s", "when what it says was true"),
}
PATHS = {
    "vehicle": Meaning("1", f"whose path the point lies on, by place in the fleet; {REFERENCE} the reference path"),
    "north": Meaning("m", "north of the origin"),
    "east": Meaning("m", "east of the origin"),
}
ADDED = ("altitude", "depth_desired", "phase", *CERTAINTY)  # since the first logs of this format
WHOLE = {"sender": "i4", "receiver": "i4", "kind": "i1", "lost": "i1", "vehicle": "i4"}


class Log(NamedTuple):
    """A log read back."""

    mission: str  # the resolved mission as YAML
    version: str  # of cardume, which flew it
    flight: Flight  # without metrics and wall time, which stand in summary.json


def write_log(path: Path, flight: Flight, *, mission: str, version: str) -> None:
    """Write a log, complete or not at all.

    Args:
        path: of the new file.
        flight: what to write.
        mission: the resolved mission as YAML.
        version: of cardume.

    Raises:
        OSError: the disk refused, as when it is full.
    """
    from netCDF4 import Dataset

    size = OVERHEAD + sum(values.nbytes for values in _arrays(flight))
    with (
        new_file(path, size) as partial,
        _failing_as_os_error(path),
        contextlib.closing(Dataset(str(partial), "w", format="NETCDF4")) as file,
    ):
        _write_attributes(file, flight, mission, version)
        _write_channels(file, flight)
        _write_messages(file.createGroup("messages"), flight)
        _write_paths(file.createGroup("paths"), flight)


def read_log(path: Path) -> Log:
    """Read a log.

    Args:
        path: of a `log.nc`.

    Raises:
        DataError: missing, damaged, or not a log of cardume.
    """
    _look(path)
    from netCDF4 import Dataset

    try:
        with contextlib.closing(Dataset(str(path))) as file:
            _identify(path, file)
            file.set_auto_mask(False)
            return _read(file)
    except (OSError, RuntimeError, LookupError, AttributeError, ValueError, TypeError) as problem:
        reason = printable(" ".join(str(problem).split()))[:200]
        advice = "fly the mission again, or fetch another copy of the file"
        raise DataError(f"{printable(str(path))} is damaged ({reason}); {advice}") from None


def _arrays(flight: Flight) -> list[np.ndarray]:
    paths = [flight.reference_path, *flight.own_paths]
    return [*flight.channels.values(), *flight.messages.values(), flight.neighbor_state_estimate, *paths]


@contextlib.contextmanager
def _failing_as_os_error(path: Path) -> Iterator[None]:
    """The library's errors have numbers of their own, which are no errno."""
    try:
        yield
    except (RuntimeError, OSError) as problem:
        raise OSError(errno.EIO, f"the log could not be written ({problem})", str(path)) from problem


def _write_attributes(file: Any, flight: Flight, mission: str, version: str) -> None:
    file.setncatts(
        {
            "Conventions": "CF-1.11",
            "title": f"Flight of the mission {flight.mission_name}",
            "source": f"cardume {version}",
            "cardume_log": np.int32(FORMAT_VERSION),
            "version": version,
            "mission_name": flight.mission_name,
            "seed": np.int64(flight.seed),
            "reason": flight.reason,
            "failure": flight.failure or "",
            "flown": flight.flown,
        }
    )
    file.setncattr_string("mission", mission)


def _write_channels(file: Any, flight: Flight) -> None:
    names = np.array(flight.vehicle_names, dtype=object)
    file.createDimension("time", len(flight.times))
    for dimension in ("vehicle", "neighbor"):
        file.createDimension(dimension, len(names))
        variable = file.createVariable(dimension, str, (dimension,))
        variable.setncatts(VARIABLES[dimension]._asdict())
        variable[:] = names
    _write(file, "time", ("time",), flight.times, VARIABLES["time"])
    for name in CHANNELS:
        _write(file, name, ("time", "vehicle"), flight.channels[name], VARIABLES[name])
    known = flight.neighbor_state_estimate
    name = "neighbor_state_estimate"
    _write(file, name, ("time", "vehicle", "neighbor"), known, VARIABLES[name])


def _write_messages(group: Any, flight: Flight) -> None:
    group.createDimension("message", len(flight.messages["time_sent"]))
    for name in MESSAGE_COLUMNS:
        variable = _write(group, name, ("message",), flight.messages[name], MESSAGES[name])
        flags = {"sender": flight.vehicle_names, "receiver": flight.vehicle_names, "kind": MESSAGE_KINDS}.get(name)
        if flags:
            variable.flag_values = np.arange(len(flags), dtype=WHOLE[name])
            variable.flag_meanings = " ".join(flags)


def _write_paths(group: Any, flight: Flight) -> None:
    lines = [flight.reference_path, *flight.own_paths]
    owners = [np.full(len(line), REFERENCE + k) for k, line in enumerate(lines)]
    points = np.concatenate(lines).reshape(-1, 2)
    group.createDimension("point", len(points))
    for name, values in (("vehicle", np.concatenate(owners)), ("north", points[:, 0]), ("east", points[:, 1])):
        _write(group, name, ("point",), values, PATHS[name])


def _write(group: Any, name: str, dimensions: tuple[str, ...], values: np.ndarray, meaning: Meaning) -> Any:
    kind = WHOLE.get(name, "f8")
    variable = group.createVariable(
        name,
        kind,
        dimensions,
        compression="zlib",
        fill_value=np.nan if kind == "f8" and name != "time" else False,
    )
    variable.setncatts(meaning._asdict())
    variable[:] = values
    return variable


def _look(path: Path) -> None:
    """Refuse what is no NetCDF-4 file before the library, which cannot say why, gets it."""
    name = printable(str(path))
    try:
        with path.open("rb") as file:
            first = file.read(8)
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror}; give the log.nc of a run") from None
    if not first:
        raise DataError(f"{name} is empty; fly the mission again")
    if first != b"\x89HDF\r\n\x1a\n":
        raise DataError(f"{name} is not a NetCDF-4 file; give the log.nc of a run")


def _identify(path: Path, file: Any) -> None:
    name, found = printable(str(path)), getattr(file, "cardume_log", None)
    if found is None:
        raise DataError(f"{name} is a NetCDF file, but not a log of cardume; give the log.nc of a run")
    if found != FORMAT_VERSION:
        raise DataError(
            f"{name} is a log of format {found}; this cardume reads format {FORMAT_VERSION}: "
            f"use cardume {printable(str(getattr(file, 'version', 'of that format')))}"
        )


def _read(file: Any) -> Log:
    flight = Flight(
        mission_name=str(file.mission_name),
        seed=int(file.seed),
        vehicle_names=tuple(str(name) for name in file["vehicle"][:]),
        times=_values(file, "time", "time"),
        channels={name: _channel(file, name) for name in CHANNELS},
        neighbor_state_estimate=_values(file, "neighbor_state_estimate", "time", "vehicle", "neighbor"),
        messages={name: _values(file["messages"], name, "message") for name in MESSAGE_COLUMNS},
        metrics=Metrics(),
        reason=file.reason,
        failure=str(file.failure) or None,
        flown=float(file.flown),
        **_read_paths(file["paths"], len(file.dimensions["vehicle"])),
    )
    return Log(str(file.mission), str(file.version), flight)


def _channel(file: Any, name: str) -> np.ndarray:
    """One channel (time, vehicle); not known where it was not logged yet when the log was written."""
    if name in ADDED and name not in file.variables:
        return np.full((len(file.dimensions["time"]), len(file.dimensions["vehicle"])), np.nan)
    return _values(file, name, "time", "vehicle")


def _values(group: Any, name: str, *dimensions: str) -> np.ndarray:
    """A variable of numbers over those dimensions, and nothing else that a file may call so."""
    values = np.asarray(group[name][:])
    shape = tuple(len(group.dimensions[dimension]) for dimension in dimensions)
    if values.dtype.kind not in "fiub" or values.shape != shape:
        raise ValueError(f"{name} is {values.dtype} of shape {values.shape}, not numbers of shape {shape}")
    return values


def _read_paths(group: Any, num_vehicles: int) -> Mapping[str, Any]:
    owner = _values(group, "vehicle", "point")
    points = np.column_stack([_values(group, name, "point") for name in ("north", "east")])
    lines = [points[owner == k] for k in range(REFERENCE, num_vehicles)]
    return {"reference_path": lines[0], "own_paths": tuple(lines[1:])}
