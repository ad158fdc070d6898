"""What Python calls: fly some ticks of one mission, or of eight."""

from cardume.compiler import entry
from cardume.simulation.fleet import Tables, fleet_of
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
    fleet = fleet_of(tables)
    for now in range(start, stop):
        if tick(fleet, now):
            return now + 1
    return stop
