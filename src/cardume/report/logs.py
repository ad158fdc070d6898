"""Whatever holds a flight, as a flight: just flown, a run read back, or a log opened in xarray."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError, InputError
from cardume.missions.log import read_log
from cardume.missions.runs import Run
from cardume.report.limits import limits_of
from cardume.simulation.flight import CHANNELS, MESSAGE_COLUMNS, Flight, Metrics

NO_PATH = np.zeros((0, 2))


def as_flight(log: Any) -> Flight:
    """The flight in a log.

    Args:
        log: a `Flight`, a `Run`, or an xarray Dataset or DataTree of a log.nc, whole or with times or vehicles
            selected. A Dataset holds no messages and paths; they are read from the file that it was opened from.

    Raises:
        DataError: something else, or a log without positions.
    """
    if isinstance(log, Flight):
        return log
    if isinstance(log, Run):
        return log.flight
    if not hasattr(log, "variables"):
        kind = type(log).__name__
        raise DataError(f"a figure is drawn from a Flight, a Run, or a log opened in xarray; this is a {kind}")
    return _of_xarray(log)


def limits_in(log: Any) -> Mapping[str, tuple[float, ...]]:
    """The limits of the actuators, as far as a log knows its mission.

    Args:
        log: as for `as_flight`.
    """
    if isinstance(log, Run):
        return limits_of(log.mission)
    text = getattr(log, "attrs", {}).get("mission")
    return _limits_in_text(text) if isinstance(text, str) else {}


def _limits_in_text(text: str) -> Mapping[str, tuple[float, ...]]:
    from cardume.missions.available import catalog
    from cardume.missions.loading import parse_mission

    try:
        return limits_of(parse_mission(text, catalog()))
    except InputError:
        return {}


def _of_xarray(log: Any) -> Flight:
    if not {"time", "north", "east"} <= set(log.variables):
        raise DataError("a log of cardume has time, north and east; these are missing: open the log.nc of a run")
    names = tuple(str(name) for name in np.atleast_1d(log["vehicle"].values))
    times = np.atleast_1d(np.asarray(log["time"].values, float))
    nothing = np.full((len(times), len(names)), np.nan)
    channels = {name: _column(log, name, nothing.shape) if name in log.variables else nothing for name in CHANNELS}
    file = log.encoding.get("source")
    whole = read_log(Path(file)).flight if file and Path(file).is_file() else None
    flight = Flight(
        mission_name=str(log.attrs.get("mission_name", "")),
        seed=int(log.attrs.get("seed", 0)),
        vehicle_names=names,
        times=times,
        channels=channels,
        neighbor_state_estimate=np.full((len(times), len(names), len(names)), np.nan),
        messages={name: np.zeros(0) for name in MESSAGE_COLUMNS},
        metrics=Metrics(),
        reason=log.attrs.get("reason", "completed"),
        failure=str(log.attrs.get("failure", "")) or None,
        flown=float(log.attrs.get("flown", times[-1] if len(times) else 0.0)),
        reference_path=NO_PATH,
        own_paths=(NO_PATH,) * len(names),
    )
    return _with_rest(flight, whole) if whole and set(names) <= set(whole.vehicle_names) else flight


def _column(log: Any, name: str, shape: tuple[int, int]) -> np.ndarray:
    values: np.ndarray = np.asarray(log[name].transpose("time", "vehicle", missing_dims="ignore").values, float)
    return values.reshape(shape)


def _with_rest(flight: Flight, whole: Flight) -> Flight:
    """The messages and paths of the whole log that belong to the vehicles and times selected."""
    places = [whole.vehicle_names.index(name) for name in flight.vehicle_names]
    sender, receiver = (np.asarray(whole.messages[end]) for end in ("sender", "receiver"))
    sent = np.asarray(whole.messages["time_sent"])
    low, high = (flight.times[0], flight.times[-1]) if len(flight.times) else (0.0, -1.0)
    kept = np.isin(sender, places) & np.isin(receiver, places) & (sent >= low) & (sent <= high)
    new = np.zeros(len(whole.vehicle_names), int)
    new[places] = np.arange(len(places))
    messages = {name: np.asarray(values)[kept] for name, values in whole.messages.items()}
    messages |= {end: new[messages[end]] for end in ("sender", "receiver")}
    return replace(
        flight,
        messages=messages,
        reference_path=whole.reference_path,
        own_paths=tuple(whole.own_paths[place] for place in places),
    )
