"""What happened in a flight, as a list: phases of the mission, abort with its reason, limits that were exceeded."""

import math

from cardume.onboard.mind import OWN, Journal
from cardume.onboard.phases import PHASES, REASONS
from cardume.simulation.flight import Event, Limit
from cardume.simulation.fly import Flown
from cardume.simulation.results import limits_of, separation_of

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
    """The events of a flight in the order of time; none where no vehicle has phases or limits.

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
    if plan.is_watched:
        for limit in (*limits_of(flown), *separation_of(flown)):
            if math.isfinite(limit.first_violated):
                found.append(Event(round(limit.first_violated, 6), limit.vehicle or limit.by or "", _beyond(limit)))
    return tuple(sorted(found))


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
