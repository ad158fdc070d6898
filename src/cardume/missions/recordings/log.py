"""The log of a flight as a recording: what its vehicles measured and heard is had again by flying it again.

A log holds truth and beliefs, not readings. But it holds the mission and the seed, and the same seed gives the same
bits: each vehicle's readings and messages are taken out of a second flight, and the log proves that it is the same one.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cardume.compiler import Layout
from cardume.errors import DataError, InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.log import Log, read_log
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.missions.recordings.base import REPLAYED
from cardume.missions.recordings.meeting import Met
from cardume.missions.wording import unknown
from cardume.onboard.mind import OWN, Asked, Whereabouts
from cardume.signals import VesselState, Water
from cardume.simulation.engine import advance
from cardume.simulation.fleet import VEHICLE, Held, Satellite
from cardume.simulation.plan import Plan
from cardume.simulation.replaying import READINGS
from cardume.simulation.tables import make_tables
from cardume.simulation.warming import warm_up
from cardume.units import printable

Progress = Callable[[str, int, int], None]
STEPS = 100  # ticks between two words about the progress


def directory_of(path: Path) -> Path:
    """The folder that a log lies in.

    Args:
        path: of a log.nc, or of the directory of a run.
    """
    return path if path.is_dir() else path.parent


def read(path: Path) -> Log:
    """The log of a run.

    Args:
        path: of a log.nc, or of the directory of a run.

    Raises:
        DataError: missing, damaged, not a log, or that of a replay.
    """
    log = read_log(path / "log.nc" if path.is_dir() else path)
    if log.mission.startswith(REPLAYED):
        name = printable(str(path))
        raise DataError(f"{name} is the log of a replay, nobody flew it; replay the recording that it was made from")
    return log


def meet_again(
    log: Log,
    names: Sequence[str],
    overrides: Callable[[str], Sequence[str]],
    *,
    directory: Path,
    more: Sequence[str] = (),
    allow_code: Sequence[str | Path] = (),
    progress: Progress = lambda stage, done, total: None,
) -> tuple[Mission, list[Met]]:
    """What the vehicles of a flight met, tick by tick.

    Args:
        log: of the flight.
        names: of the vehicles wanted; none: all.
        overrides: of the replay's mission, as `--set` gives them, by the name of a vehicle.
        directory: of the log, to which the files that its mission names are relative.
        more: of them, for the whole mission.
        allow_code: folders from which the mission's own laws may be imported.
        progress: called with "compile" or "fly", how much is done, and how much there is.

    Returns:
        The replay's mission, and what each vehicle met.

    Raises:
        InputError: no such vehicle, a mission whose laws are not here, or one that flies otherwise than its log says.
    """
    flight, known = log.flight, catalog(allow_code)
    for name in names:
        if name not in flight.vehicle_names:
            raise InputError(
                f"--vehicle {printable(name)}: {unknown('no such vehicle', name, [*flight.vehicle_names])}"
            )
    wanted = [name for name in flight.vehicle_names if name in names or not names]
    read_mission = partial(parse_mission, log.mission, known, source="the log", directory=directory)
    flown = replace(read_mission(), seed=flight.seed)
    changes = [*more, *(change for name in wanted for change in overrides(name))]
    replayed = replace(read_mission(overrides=changes), seed=flight.seed)
    plan, judged = make_plan(flown, known).plan, make_plan(replayed, known).plan
    if judged.tick != plan.tick or [v.name for v in judged.vehicles] != [v.name for v in plan.vehicles]:
        raise InputError("the tick and the vehicles of a flight cannot be changed by --set; fly it with them")
    warm_up(plan, lambda done, total: progress("compile", done, total))
    seen = _fly_again(plan, round(flight.flown / plan.tick), lambda done, total: progress("fly", done, total))
    _compare(log, plan, seen)
    return replayed, [_met(judged, flight.vehicle_names.index(name), seen) for name in wanted]


class Seen:
    """What was seen of a flight: tables (tick, vehicle, ...), vehicles in the engine's order.

    Attributes:
        readings: (tick, vehicle, READINGS.width)
        inboxes: (tick, vehicle, width)
        truth: (tick, vehicle, 2) [m] north, east.
        current: (tick, vehicle, 2) [m/s]
        believed: (tick, vehicle, 2) [m] by the vehicle itself.
    """

    def __init__(self, plan: Plan, ticks: int, width: int) -> None:
        size = len(plan.vehicles)
        self.readings = np.zeros((ticks, size, READINGS.width))
        self.inboxes = np.zeros((ticks, size, width))
        self.truth, self.current, self.believed = (np.zeros((ticks, size, 2)) for _ in range(3))


def _fly_again(plan: Plan, ticks: int, progress: Callable[[int, int], None]) -> Seen:
    tables, size = make_tables(plan), len(plan.vehicles)
    width = tables.whole.widest * tables.whole.message_width
    seen = Seen(plan, ticks, width)
    rows = tables.vehicles.reshape(size, VEHICLE.width)
    minds = tables.minds.reshape(size, OWN.width)
    inbox = tables.inbox.reshape(size, width) if width else np.zeros((size, 0))
    vessel, water, own = VEHICLE.offsets[VesselState], VEHICLE.offsets[Water], OWN.offsets[Whereabouts]
    for now in range(ticks):
        seen.truth[now] = rows[:, vessel : vessel + 2]
        _copy(Asked, minds, OWN, seen.readings[now])
        advance(tables, now, now + 1)
        _copy(Held, rows, VEHICLE, seen.readings[now])
        _copy(Satellite, rows, VEHICLE, seen.readings[now])
        seen.inboxes[now], seen.current[now] = inbox, rows[:, water : water + 2]
        seen.believed[now] = minds[:, own : own + 2]
        if now % STEPS == 0:
            progress(now, ticks)
    progress(ticks, ticks)
    return seen


def _copy(record: Any, rows: np.ndarray, layout: Layout, readings: np.ndarray) -> None:
    """A record of every vehicle into its room of the readings of a tick."""
    first, room, size = layout.offsets[record], READINGS.offsets[record], len(record._fields)
    readings[:, room : room + size] = rows[:, first : first + size]


def _compare(log: Log, plan: Plan, seen: Seen) -> None:
    """Refuse a flight that is not the one in the log."""
    flight, places = log.flight, [plan.order.index(k) for k in range(len(plan.vehicles))]
    rows = np.round(flight.times / plan.tick).astype(int)
    is_inside = rows < len(seen.truth)
    for channels, found in ((("north", "east"), seen.truth), (("north_estimate", "east_estimate"), seen.believed)):
        for column, name in enumerate(channels):
            logged = flight.channels[name][is_inside]
            same = (logged == found[rows[is_inside]][:, places, column]) | np.isnan(logged)
            if not same.all():
                first = float(flight.times[is_inside][np.flatnonzero(~same.all(axis=1))[0]])
                raise DataError(
                    f"the log says otherwise than its mission flies here: {name} differs from {first:g} s on. A log has"
                    f" no readings, they are had by flying again; this one is of cardume {printable(log.version)}: use"
                    " that, or fly the mission again"
                )


def _met(plan: Plan, vehicle: int, seen: Seen) -> Met:
    place = plan.order.index(vehicle)
    return Met(
        plan.vehicles[vehicle].name,
        plan,
        vehicle,
        seen.readings[:, place],
        lambda first, last: seen.inboxes[first:last, place],
        seen.truth[:, place],
        seen.current[:, place],
    )
