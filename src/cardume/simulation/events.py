"""What happened in a flight, as a list: phases of the mission, aborts, limits that were exceeded, faults."""

import math

import numpy as np

from cardume.onboard.mind import OWN, WATCH, Journal, Watch, Watches
from cardume.onboard.phases import PHASES, REASONS
from cardume.onboard.screening import WATCHED
from cardume.simulation.fleet import FAULTS
from cardume.simulation.flight import DOUBTS, FAULT, Event, Limit
from cardume.simulation.fly import Flown
from cardume.simulation.plan import FaultPlan
from cardume.simulation.results import limits_of, separation_of
from cardume.world.faults import FORGED, REPLAYED, Kept

DEVICES = {  # of what readings the vehicle says that it does not believe them; no echo of the seabed is no fault
    "heading": "AHRS",
    "depth": "depth sensor",
    "shaft_speed": "sensor of shaft speed",
    "surge": "DVL",
    "north": "GNSS",
}
SAYINGS = {
    "dive": "dives",
    "gather": "gathers",
    "ready": "is at its start",
    "assembled": "knows that those it hears are at their starts",
    "go": "sets out",
    "hold": "holds the end of its path",
    "surface": "comes up",
}
BEYOND = {
    "depth_max": "is deeper than",
    "altitude_min": "is nearer to the seabed than",
    "geofence_margin_min": "has left its geofence, with a margin of",
}


def events_of(flown: Flown) -> tuple[Event, ...]:
    """The events of a flight in the order of time; none where no vehicle has phases or limits and nothing goes wrong.

    Args:
        flown: a mission after its flight.
    """
    plan = flown.plan
    minds = flown.tables.minds.reshape(len(plan.vehicles), OWN.width)
    start = OWN.offsets[Journal]
    found = []
    for row, k in enumerate(plan.order):
        vehicle = plan.vehicles[k]
        if vehicle.orders.has_phases:
            journal = Journal(*minds[row, start : start + len(Journal._fields)].tolist())
            found += [Event(round(time, 6), vehicle.name, what) for time, what in _told(journal)]
        if plan.faults:
            found += [Event(round(time, 6), vehicle.name, what) for time, what in _doubted(minds[row])]
    found += [
        _began(fault, plan.duration) for fault in plan.faults if fault.says and fault.numbers.begin < plan.duration
    ]
    found += _packets(flown)
    if plan.is_watched:
        for limit in (*limits_of(flown), *separation_of(flown)):
            if math.isfinite(limit.first_violated):
                found.append(Event(round(limit.first_violated, 6), limit.vehicle or limit.by or "", _beyond(limit)))
    return tuple(sorted(found))


def _began(fault: FaultPlan, duration: float) -> Event:
    begin, end = round(fault.numbers.begin, 6), round(min(fault.numbers.end, duration), 6)
    return Event(begin, fault.vehicle or "", f"{FAULT}{fault.says}", end)


def _packets(flown: Flown) -> list[Event]:
    """At the end of whatever forges or replays packets, how many were sent and how many of them were taken."""
    found, kinds = [], {FORGED: "forged", REPLAYED: "replayed"}
    end = flown.ticks * flown.plan.tick
    rows = flown.tables.faults.reshape(-1, FAULTS.width)
    for fault, row in zip(flown.plan.faults, rows, strict=False):
        sent, taken = row[FAULTS.offsets[Kept] :][:2]
        if fault.kind in kinds and sent > 0.0:
            what = f"{FAULT}of {sent:g} packets {kinds[fault.kind]} in its name {taken:g} were taken for genuine"
            found.append(Event(round(min(end, fault.numbers.end), 6), fault.vehicle or "", what))
    return found


def _doubted(mind: np.ndarray) -> list[tuple[float, str]]:
    """Which readings a vehicle did not believe, and when first."""
    start = OWN.offsets[Watches]
    watches = mind[start : start + len(Watches._fields)].reshape(-1, WATCH.width)
    doubted = WATCH.column(Watch, "doubted")
    return [
        (float(watch[doubted]), f"{DOUBTS} its {DEVICES[name]}")
        for name, watch in zip(WATCHED, watches, strict=True)
        if name in DEVICES and math.isfinite(watch[doubted])
    ]


def _told(journal: Journal) -> list[tuple[float, str]]:
    found = []
    for phase in PHASES[:-1]:
        time, what = getattr(journal, phase), SAYINGS[phase]
        if phase == "gather" and journal.dive_late:
            what += ", not down within the time for it"
        if phase == "go" and journal.gather_late:
            what += " without having heard that all are at their starts"
        if math.isfinite(time):
            found.append((time, what))
    if math.isfinite(journal.abort):
        found.append((journal.abort, f"gives up: {REASONS[round(journal.reason)]}"))
    return found


def _beyond(limit: Limit) -> str:
    if limit.metric == "separation_min":
        return f"are nearer than {limit.limit:g} m"
    return f"{BEYOND[limit.metric]} {limit.limit:g} m"
