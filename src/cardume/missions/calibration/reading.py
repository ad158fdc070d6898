"""Tracks from files: `log.nc` of a run, or a table as CSV."""

import csv
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError, MissionError, UnitError
from cardume.laws import laws_of
from cardume.missions.calibration.track import Numbers, Track
from cardume.missions.geodesy import GeoPoint, to_local
from cardume.missions.log import Log, read_log
from cardume.missions.source import parse_yaml
from cardume.missions.tree import Node
from cardume.units import nearest, parse_quantity, printable
from cardume.vehicles.medusa_data import MAX_SHAFT_SPEED, RADIANS_PER_SECOND_PER_RPM

READER = {  # parameter of `thruster_calibration`: field of Numbers, unit
    "thrust_coefficient": "N s^2/rad^2",
    "num_thrusters": "",
    "linear_drag": "N s/m",
    "quadratic_drag": "N s^2/m^2",
    "scale": "",
}
DEGREE = math.pi / 180.0
COLUMNS = ("time", "shaft_speed_rpm", "percent", "speed", "heading_deg", "north", "east", "latitude", "longitude")
MOST_ROWS = 2_000_000
WANTED = (
    "the columns are time [s], shaft_speed_rpm or percent (of 4500 rpm), and either speed [m/s] through the water, or"
    " heading_deg with north and east [m] or latitude and longitude [deg]"
)


def read_tracks(path: Path, model: str | None = None) -> list[Track]:
    """The tracks in a file: of every vehicle of a log, or the one of a table.

    Args:
        path: of a `log.nc`, or of a CSV.
        model: whose numbers are believed, instead of those that the log's mission had; for a table, else `medusa`.

    Raises:
        DataError: missing, damaged, or without what a calibration needs.
    """
    if path.suffix.lower() in (".csv", ".txt"):
        return [_table(path, numbers_of(model or "medusa"))]
    log = read_log(path)
    return [_of_log(log, name, model) for name in log.flight.vehicle_names]


def numbers_of(model: str) -> Numbers:
    """What is believed of one of our models: what it announces for `thruster_calibration`, else that law's defaults.

    Args:
        model: its name.

    Raises:
        DataError: there is no such model.
    """
    models = laws_of("model")
    if model not in models:
        raise DataError(f"there is no model '{printable(model)}'; there are {', '.join(models)}")
    told = models[model].announced.get("speed", {})
    return Numbers()._replace(**{name: value for name, value in told.items() if name in READER})


# ---- a log -----------------------------------------------------------------------------------------------------------


def _of_log(log: Log, name: str, model: str | None) -> Track:
    flight = log.flight
    k = flight.vehicle_names.index(name)
    channels = {
        key: flight.channels[key][:, k].astype(float) for key in ("shaft_speed_rpm", "heading", "north", "east")
    }
    return Track(
        name=name,
        numbers=numbers_of(model) if model else _of_mission(log.mission, name),
        time=np.asarray(flight.times, float),
        shaft_speed=channels["shaft_speed_rpm"] * RADIANS_PER_SECOND_PER_RPM,
        heading=channels["heading"],
        north=channels["north"],
        east=channels["east"],
    )


def _of_mission(text: str, name: str) -> Numbers:
    """The numbers that a vehicle of a saved mission reads its shaft speed with."""
    try:
        tree = parse_yaml(text, "the log's mission")
        vehicle = next(item for item in tree.value["vehicles"].value if item.value["name"].value == name)
        model = _word(_section(tree, vehicle, "model"), "law", "medusa")
        if model == "kinematic":
            raise DataError(
                f"{printable(name)} is kinematic: its shaft speed is its speed, there is nothing to calibrate"
            )
        known = numbers_of(model if ":" not in model else "medusa")
        sensors = _section(tree, vehicle, "sensors")
        reader = sensors.value.get("thruster_speed") if isinstance(sensors.value, dict) else None
        given = reader.value if reader is not None and isinstance(reader.value, dict) else {}
        values = {key: parse_quantity(given[key].value, unit) for key, unit in READER.items() if key in given}
        return known._replace(**values)
    except (MissionError, UnitError, LookupError, AttributeError, TypeError, StopIteration) as problem:
        raise DataError(f"the mission in the log cannot be read ({problem}); say --model") from None


def _section(tree: Node, vehicle: Node, key: str) -> Node:
    found: Node = vehicle.value.get(key) or tree.value[key]
    return found


def _word(node: Node, selector: str, default: str) -> str:
    value: Any = node.value
    if isinstance(value, dict):
        value = value[selector].value if selector in value else default
    return str(value)


# ---- a table ---------------------------------------------------------------------------------------------------------


def _table(path: Path, numbers: Numbers) -> Track:
    name = printable(str(path))
    columns = _columns(path, name)
    has_speed, has_track = "speed" in columns, "heading_deg" in columns
    shaft = "shaft_speed_rpm" if "shaft_speed_rpm" in columns else "percent" if "percent" in columns else ""
    if "time" not in columns or not shaft or not (has_speed or has_track):
        raise DataError(f"{name}: has the columns {', '.join(columns) or 'none'}; {WANTED}")
    values = {key: np.array(column, float) for key, column in columns.items()}
    time = values["time"]
    if len(time) < 2 or not np.all(np.diff(time) > 0.0):
        later = int(np.argmin(np.diff(time) > 0.0)) if len(time) > 1 else 0
        raise DataError(f"{name}:{later + 3}:time: must increase from row to row, and there must be at least two rows")
    factor = RADIANS_PER_SECOND_PER_RPM if shaft == "shaft_speed_rpm" else 0.01 * MAX_SHAFT_SPEED
    bare = Track(name=path.stem, numbers=numbers, time=time, shaft_speed=factor * values[shaft])
    if has_speed:
        return _whole(replace(bare, speed=values["speed"]))
    north, east = _positions(values, name)
    return _whole(replace(bare, heading=DEGREE * values["heading_deg"], north=north, east=east))


def _positions(values: dict[str, np.ndarray], name: str) -> tuple[np.ndarray, np.ndarray]:
    if "north" in values and "east" in values:
        return values["north"], values["east"]
    if "latitude" not in values or "longitude" not in values:
        raise DataError(f"{name}: has heading_deg, but no position beside it; {WANTED}")
    latitude, longitude = DEGREE * values["latitude"], DEGREE * values["longitude"]
    first = int(np.flatnonzero(np.isfinite(latitude + longitude))[0]) if np.isfinite(latitude + longitude).any() else 0
    north, east = to_local(latitude, longitude, GeoPoint(float(latitude[first]), float(longitude[first])))
    return np.asarray(north, float), np.asarray(east, float)


def _whole(track: Track) -> Track:
    """Without the rows in which something is missing."""
    columns = (track.time, track.shaft_speed, track.heading, track.north, track.east, track.speed)
    is_there = np.all([np.isfinite(column) for column in columns if column is not None], axis=0)
    return track.part(is_there)


def _columns(path: Path, name: str) -> dict[str, list[float]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = csv.reader(file)
            header = [word.strip().lower() for word in next(rows, [])]
            _look(header, name)
            found: dict[str, list[float]] = {key: [] for key in header}
            for number, row in enumerate(rows, start=2):
                _append(found, header, row, f"{name}:{number}")
                if number > MOST_ROWS:
                    raise DataError(f"{name}: has more than {MOST_ROWS:,} rows; thin it out")
            return found
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror}; give a log.nc or a CSV") from None
    except (UnicodeDecodeError, csv.Error) as problem:
        raise DataError(f"{name} is no CSV text in UTF-8 ({printable(str(problem))}); {WANTED}") from None


def _look(header: Sequence[str], name: str) -> None:
    if not any(header):
        raise DataError(f"{name} is empty; {WANTED}")
    for word in header:
        if word not in COLUMNS:
            raise DataError(
                f"{name}:1: there is no column '{printable(word)}'{nearest(word, list(COLUMNS)) or '.'} {WANTED}"
            )
    if len(set(header)) < len(header):
        raise DataError(f"{name}:1: a column is there twice; {WANTED}")


def _append(found: dict[str, list[float]], header: Sequence[str], row: Sequence[str], place: str) -> None:
    if not row:
        return
    if len(row) != len(header):
        raise DataError(f"{place}: has {len(row)} values, the header {len(header)} columns")
    for key, text in zip(header, row, strict=True):
        try:
            value = float(text) if text.strip() else math.nan
        except ValueError:
            raise DataError(f"{place}:{key}: '{printable(text)}' is no number; leave empty what is not known") from None
        found[key].append(value if math.isfinite(value) else math.nan)
