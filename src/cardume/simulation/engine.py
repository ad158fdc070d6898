"""What Python calls: fly some ticks of one mission, or of eight."""

from cardume.compiler import entry, passing
from cardume.onboard.agent import decide
from cardume.signals import Reference, Report
from cardume.simulation.air import inbox_of
from cardume.simulation.fleet import Tables, fleet_of, measured_of, mind_of
from cardume.simulation.tick import tick


@entry
def advance(tables: Tables, start: int, stop: int) -> int:
    """Fly ticks start, start + 1, … stop - 1 and stop early when a number is not one.

    Args:
        tables: (n,) arrays of one mission or (n, 8) of eight, changed in place.
        start: [ticks] the first.
        stop: [ticks] one past the last.

    Returns:
        The first tick that was not flown.
    """
    fleet = passing(fleet_of(tables))
    for now in range(start, stop):
        if tick(fleet, now):
            return now + 1
    return stop


@entry
def think(tables: Tables, vehicle: int, time: float) -> tuple[Reference, Report]:
    """Let one vehicle decide by what stands in its tables, with no world around it; only its mind changes.

    Args:
        tables: (n,) arrays, in which its readings, its USBL readings and its inbox are those of this tick.
        vehicle: [-] its place in the engine's order.
        time: [s] since the start of the mission.

    Returns:
        What it asks of its autopilot, and the head of what it tells the others.
    """
    fleet = passing(fleet_of(tables))
    mind, measured = passing(mind_of(fleet, vehicle)), measured_of(fleet, vehicle)
    reference, said = decide(mind, measured, inbox_of(fleet, vehicle), time)
    return reference, said.report
