"""The axes of a current field: which of the file's nodes are wanted, and where they are in our units."""

from datetime import UTC, datetime, timedelta
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import DataError
from cardume.missions.currents.cf_units import length_factor
from cardume.missions.currents.field import around, meters_per_degree
from cardume.missions.currents.metadata import REGRID, text_of
from cardume.missions.geodesy import GeoPoint

REAL_CALENDARS = ("standard", "gregorian", "proleptic_gregorian")
SAME = 1e-6  # [deg] 0.1 m: nodes that differ by less are the same meridian, as 0 and 360
MOST_UNEVEN = 2.0  # longest step of a grid over its shortest
RADIUS = 50e3  # [m] around the origin


class Window(NamedTuple):
    """What of a file is wanted."""

    origin: GeoPoint | None = None  # None: the whole grid
    radius: float = RADIUS  # [m] around the origin
    start_time: str | None = None  # of the mission, ISO 8601, UTC; None: the first time of the file
    duration: float | None = None  # [s] None: to the end of the file
    deepest: float | None = None  # [m] None: to the last level


class Axis(NamedTuple):
    """The nodes of an axis that are wanted."""

    nodes: np.ndarray  # (n,) increasing
    picks: np.ndarray  # (n,) where each stands in the file

    def between(self, low: float, high: float) -> "Axis":
        """The nodes from the last one at or below `low` to the first one at or above `high`."""
        first = max(int(np.searchsorted(self.nodes, low, side="right")) - 1, 0)
        last = int(np.searchsorted(self.nodes, high, side="left")) + 1
        return Axis(self.nodes[first:last], self.picks[first:last])


def latitude_axis(values: np.ndarray, window: Window) -> Axis:
    """Latitudes [deg] in the window and one more on either side.

    Args:
        values: (n,) [deg] in the order of the file.
        window: what is wanted.

    Raises:
        DataError: values that are no latitudes, an origin outside them, or uneven steps.
    """
    if np.abs(values).max() > 90.0 + SAME:
        raise DataError(f"latitudes reach from {values.min():g} to {values.max():g} deg")
    axis = _at_least_two(sort_nodes(values), "latitude")
    if window.origin is None:
        return _even(axis, "latitude")
    center = float(np.degrees(window.origin.latitude))
    if not axis.nodes[0] <= center <= axis.nodes[-1]:
        raise DataError(f"origin is at latitude {center:.4f} deg; {_extent(axis, 'latitude')}")
    half = window.radius / meters_per_degree(0.0)[0]
    return _even(axis.between(center - half, center + half), "latitude")


def longitude_axis(values: np.ndarray, window: Window) -> Axis:
    """Longitudes [deg] in the window and one more on either side, continuous around its middle.

    Args:
        values: (n,) [deg] in the order of the file, to 180 or to 360.
        window: what is wanted.

    Raises:
        DataError: values that are no longitudes, an origin outside them, or uneven steps.
    """
    if np.abs(values).max() > 720.0:
        raise DataError(f"longitudes reach from {values.min():g} to {values.max():g} deg")
    angles = np.radians(values)
    middle = float(np.degrees(np.arctan2(np.sin(angles).mean(), np.cos(angles).mean())))
    center = middle if window.origin is None else float(np.degrees(window.origin.longitude))
    axis = sort_nodes(center + around(values, center))
    repeated = np.diff(axis.nodes, prepend=-np.inf) < SAME
    axis = _at_least_two(Axis(axis.nodes[~repeated], axis.picks[~repeated]), "longitude")
    if window.origin is None:
        return _even(axis, "longitude")
    if not axis.nodes[0] <= center <= axis.nodes[-1]:
        raise DataError(f"origin is at longitude {center:.4f} deg; {_extent(axis, 'longitude')}")
    half = min(window.radius / max(meters_per_degree(window.origin.latitude)[1], 1.0), 180.0)
    return _even(axis.between(center - half, center + half), "longitude")


def depth_axis(values: np.ndarray, variable: Any, window: Window) -> Axis:
    """Depths [m], positive down, to the first level at or below the deepest place wanted.

    Args:
        values: (n,) in the file's unit and order.
        variable: the coordinate, a `netCDF4.Variable`.
        window: what is wanted.

    Raises:
        DataError: a unit that is no length, or repeated levels.
    """
    unit = text_of(variable, "units")
    factor = length_factor(unit)
    if factor is None:
        raise DataError(f"unit {unit!r} is no length: interpolate the file to depths in meters first")
    positive = text_of(variable, "positive").lower()
    if not positive:
        is_height = text_of(variable, "standard_name") in ("height", "altitude") or values.max() <= 0.0
        positive = "up" if is_height else "down"
    axis = sort_nodes((-factor if positive == "up" else factor) * values + 0.0)
    if np.any(np.diff(axis.nodes) <= 0.0):
        raise DataError("a level occurs twice")
    return axis if window.deepest is None else axis.between(-np.inf, window.deepest)


def time_axis(values: np.ndarray, variable: Any, window: Window) -> tuple[Axis, datetime | None]:
    """Times [s] since the start of the mission, and the UTC of that start.

    Args:
        values: (n,) in the file's unit.
        variable: the coordinate, a `netCDF4.Variable`.
        window: what is wanted.

    Returns:
        The times; the date is None in a calendar of the file's own (noleap, 360_day).

    Raises:
        DataError: a unit that is no time since a date, times that do not increase, or a start outside them.
    """
    unit, calendar = text_of(variable, "units"), text_of(variable, "calendar").lower() or "standard"
    first, per_unit = _first_date(values[0], unit, calendar)
    seconds = (values - values[0]) * per_unit
    if np.any(np.diff(seconds) <= 0.0):
        raise DataError("times do not increase")
    offset = 0.0
    if window.start_time is not None:
        start = parse_date(window.start_time)
        offset = _seconds_after(first, start, calendar, seconds)
        first = start
    axis = Axis(seconds - offset, np.arange(len(seconds)))
    return (axis if window.duration is None else axis.between(0.0, window.duration)), first


def _first_date(value: float, unit: str, calendar: str) -> tuple[datetime | None, float]:
    """The date of a file's first time, and how many seconds its unit has."""
    from netCDF4 import num2date  # loaded where a mission needs it: 0.1 s

    try:
        dates: Any = num2date(np.array([value, value + 1.0]), unit, calendar)
        first, per_unit = dates[0], float((dates[1] - dates[0]).total_seconds())
        if calendar not in REAL_CALENDARS:
            return None, per_unit
        date = datetime(first.year, first.month, first.day, first.hour, first.minute, first.second, tzinfo=UTC)
        return date + timedelta(microseconds=first.microsecond), per_unit
    except (ValueError, OverflowError, TypeError, AttributeError) as problem:
        raise DataError(f"unit {unit!r}, calendar {calendar!r}, {value:g} is no date: {problem}") from problem


def _seconds_after(first: datetime | None, start: datetime, calendar: str, seconds: np.ndarray) -> float:
    """When the mission starts, counted from the file's first time."""
    if first is None:
        raise DataError(f"start_time needs dates; the file's calendar is {calendar}: leave start_time out")
    offset = (start - first).total_seconds()
    if len(seconds) > 1 and not 0.0 <= offset <= seconds[-1]:
        last = datetime.fromtimestamp(first.timestamp() + seconds[-1], UTC)
        raise DataError(f"start_time {_shown(start)} is outside the file, {_shown(first)} to {_shown(last)}")
    return offset


def parse_date(text: str) -> datetime:
    """A date in UTC from ISO 8601; without a time zone it is taken as UTC.

    Args:
        text: as 2013-10-31T22:00.

    Raises:
        DataError: not such a date.
    """
    try:
        date = datetime.fromisoformat(text)
    except ValueError as problem:
        raise DataError(f"start_time {text!r} is no date; write it as 2013-10-31T22:00, UTC") from problem
    return date.replace(tzinfo=UTC) if date.tzinfo is None else date.astimezone(UTC)


def sort_nodes(values: np.ndarray) -> Axis:
    """All nodes in increasing order.

    Args:
        values: (n,) in the order of the file.
    """
    picks = np.argsort(values, kind="stable")
    return Axis(values[picks], picks)


def _at_least_two(axis: Axis, kind: str) -> Axis:
    if len(axis.nodes) < 2:
        raise DataError(f"there is only one {kind}; a field needs at least two")
    return axis


def _even(axis: Axis, kind: str) -> Axis:
    steps = np.diff(axis.nodes)
    if steps.min() <= 0.0 or steps.max() > MOST_UNEVEN * steps.min():
        raise DataError(f"steps of {kind} reach from {steps.min():g} to {steps.max():g} deg; {REGRID}")
    return axis


def _extent(axis: Axis, kind: str) -> str:
    return (
        f"the file covers {kind} {axis.nodes[0]:.4f} to {axis.nodes[-1]:.4f} deg; move the origin or use another file"
    )


def _shown(date: datetime) -> str:
    return date.strftime("%Y-%m-%dT%H:%M")
