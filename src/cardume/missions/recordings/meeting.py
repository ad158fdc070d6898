"""What a vehicle met, tick by tick: from a recording to what its navigation takes.

Readings are held from one to the next, as aboard; before the first one that one holds. A fix comes in the first tick
after it was heard, of one source at most one in a tick, as a message that tells it.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cardume.errors import InputError
from cardume.maths.angles import wrap_angle
from cardume.missions.available import catalog
from cardume.missions.geodesy import GeoPoint
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.missions.recordings.base import Recorded, Sighted, Stream
from cardume.onboard.mind import FLAG, HEAD, SIGHTING_WIDTH, inbox_width
from cardume.signals import Sighting
from cardume.simulation.fleet import Held, Satellite
from cardume.simulation.plan import Plan
from cardume.simulation.replaying import READINGS

MOST_SOURCES = 40  # of fixes of one vehicle
AHEAD = "x"  # a source's name begins so


class Met(NamedTuple):
    """One vehicle of a plan, and what it met."""

    name: str
    plan: Plan  # in which it has the laws that are to be judged
    vehicle: int  # [-] its place among the vehicles of the plan
    readings: np.ndarray  # (tick, READINGS.width)
    inboxes: Callable[[int, int], np.ndarray]  # (ticks, width) from one tick up to another
    truth: np.ndarray  # (tick, 2) [m] north, east; NaN: not known
    true_current: np.ndarray  # (tick, 2) [m/s]; NaN: not known


def draft(name: str, recorded: Recorded, tick: float, start: tuple[float, float], origin: GeoPoint | None) -> str:
    """The text of a mission in which a vehicle like the recorded one hears its fixes from other vehicles.

    Args:
        name: of the mission.
        recorded: the vehicle.
        tick: [s]
        start: [m] north and east where it believes it starts.
        origin: where north = east = 0 lies; None: not known.
    """
    sources = "\n".join(
        f"  - {{name: {AHEAD}{k}, sensors: {{usbl: {{}}, ahrs: {{}}}}}}" for k in range(len(recorded.sources))
    )
    ticks = max(1, math.ceil(recorded.last / tick))
    place = f"origin: {{latitude: {origin.latitude!r} rad, longitude: {origin.longitude!r} rad}}\n" if origin else ""
    return (
        f"cardume: 1\nname: {name}\ntick: {tick!r} s\nduration: {ticks * tick!r} s\n{place}"
        "path: {type: line, start: {north: 0 m, east: 0 m, course: 0 rad}, length: 1000 m}\n"
        "formation: {speed: 0.5 m/s}\nmodel: kinematic\nvehicles:\n"
        f"  - name: recorded\n    sensors: {{ahrs: {{}}}}\n"
        f"    initial_estimate: {{north: {start[0]!r} m, east: {start[1]!r} m}}\n{sources}\n"
        "guidance: {law: line_of_sight}\n"
    )


def meet(
    recorded: Recorded, text: str, overrides: Sequence[str], allow_code: Sequence[str | Path]
) -> tuple[Mission, Met]:
    """What a recorded vehicle met in each tick.

    Args:
        recorded: the vehicle.
        text: from `draft`.
        overrides: as `--set` gives them.
        allow_code: folders from which laws may be imported.

    Raises:
        InputError: laws that do not exist, or more sources than a fleet may have.
    """
    if len(recorded.sources) > MOST_SOURCES:
        raise InputError(
            f"{recorded.name} has fixes from {len(recorded.sources)} sources; at most {MOST_SOURCES} can be replayed"
        )
    known = catalog(allow_code)
    mission = parse_mission(text, known, overrides, source="the replay")
    plan = make_plan(mission, known).plan
    times = mission.tick * np.arange(max(1, math.ceil(recorded.last / mission.tick)) + 1)
    truth = recorded.truth.between(times) if recorded.truth.is_there else np.full((len(times), 2), np.nan)
    vehicle = next(k for k, v in enumerate(plan.vehicles) if v.name == "recorded")
    met = Met(
        recorded.name,
        plan,
        vehicle,
        _readings(recorded, times),
        _inboxes(recorded, times, plan, vehicle),
        truth[:, :2],
        np.full((len(times), 2), np.nan),
    )
    return mission, met


def _readings(recorded: Recorded, times: np.ndarray) -> np.ndarray:
    """(tick, READINGS.width) what the sensors say; a vehicle of which speed or heading is not known stands still."""
    held = {name: np.full(len(times), np.nan) for name in Held._fields}
    attitude = _with_yaw_rate(recorded.attitude)
    heading = attitude.held(times) if attitude.is_there else np.zeros((len(times), 2))
    velocity = recorded.velocity.held(times) if recorded.velocity.is_there else np.zeros((len(times), 2))
    held["heading"], held["yaw_rate"] = heading.T
    held["dvl_surge"], held["dvl_sway"] = velocity.T
    if recorded.depth.is_there:
        held["depth"] = recorded.depth.held(times)[:, 0]
    found = np.zeros((len(times), READINGS.width))
    for record, values in ((Held, np.column_stack(list(held.values()))), (Satellite, np.nan)):
        start = READINGS.offsets[record]
        found[:, start : start + len(record._fields)] = values
    return found


def _with_yaw_rate(attitude: Stream) -> Stream:
    """Heading and yaw rate; where no rate was measured that since the reading before, 0 at first."""
    if not attitude.is_there:
        return attitude
    heading, rate = attitude.values.T
    turned = np.array([wrap_angle(float(angle)) for angle in np.diff(heading)])
    since = np.append(0.0, turned / np.diff(attitude.times))
    return attitude._replace(values=np.column_stack([heading, np.where(np.isfinite(rate), rate, since)]))


def _inboxes(recorded: Recorded, times: np.ndarray, plan: Plan, vehicle: int) -> Callable[[int, int], np.ndarray]:
    """The inbox of the vehicle: from each source the last fix that was heard, and whether it is new."""
    size, own, tick = len(plan.vehicles), plan.order.index(vehicle), times[1] - times[0]
    senders = [plan.vehicles[k].name for k in plan.order if k != vehicle]  # in the order of their rooms in the inbox
    width = inbox_width(size)
    told: list[tuple[int, np.ndarray, np.ndarray]] = []
    for name, source in enumerate(recorded.sources):
        rows, said, free = [-1], [[math.nan] * SIGHTING_WIDTH], 0
        for sighted in (s for s in recorded.sighted if s.source == source):
            rows.append(max(free, math.ceil(sighted.heard / tick - 1e-6)))
            said.append(_told(sighted))
            free = rows[-1] + 1
        told.append((senders.index(f"{AHEAD}{name}") * width, np.array(rows), np.array(said)))

    def inboxes(first: int, last: int) -> np.ndarray:
        ticks, found = np.arange(first, last), np.full((last - first, len(senders) * width), np.nan)
        for room, rows, said in told:
            newest = np.searchsorted(rows, ticks, side="right") - 1
            start = room + HEAD + own * SIGHTING_WIDTH
            found[:, start : start + SIGHTING_WIDTH] = said[newest]
            found[:, room + FLAG] = (rows[newest] == ticks).astype(float)
        return found

    return inboxes


def _told(sighted: Sighted) -> list[float]:
    told = Sighting(
        north=sighted.north,
        east=sighted.east,
        time_of_fix=sighted.valid,
        north_variance=sighted.north_variance,
        covariance=sighted.covariance,
        east_variance=sighted.east_variance,
        range=sighted.range,
        range_variance=sighted.range_variance,
        depth=sighted.depth,
    )
    return [*told]
