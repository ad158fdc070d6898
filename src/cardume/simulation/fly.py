"""Fly a plan: in slices, so that it can be watched and stopped, or many plans on a thread pool."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from cardume.compiler import WIDTH
from cardume.simulation.engine import advance
from cardume.simulation.fleet import Tables
from cardume.simulation.plan import Plan
from cardume.simulation.side_by_side import join, lane
from cardume.simulation.tables import make_tables
from cardume.simulation.tick import CODE, FINE, TIME, VEHICLE

SLICE = 1000  # ticks between two looks at whether to stop: some milliseconds
IN_LANES = (
    100_000  # the same in ticks of vehicles, for eight missions: a thread that looks up too often waits for others
)
SIGNALS = {1.0: "state", 2.0: "current", 3.0: "reference", 4.0: "position estimate"}


@dataclass(frozen=True)
class Trouble:
    """The first number that was not one."""

    vehicle: str
    signal: str
    time: float  # [s]


@dataclass(frozen=True)
class Flown:
    """A mission after its flight.

    Attributes:
        plan: what was flown.
        tables: as the engine left them; vehicles in the order of `plan.order`.
        ticks: how many were flown.
        trouble: why it ended early, if a number was not one.
        stopped: whether it was asked to stop.
    """

    plan: Plan
    tables: Tables
    ticks: int
    trouble: Trouble | None = None
    stopped: bool = False


def fly(
    plan: Plan,
    progress: Callable[[int, int], None] = lambda done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Flown:
    """Fly one mission.

    Args:
        plan: the mission.
        progress: called with ticks flown and ticks in all.
        should_stop: asked every few milliseconds.

    Returns:
        The mission after its flight, whole or as far as it came.
    """
    return fly_alone(plan, make_tables(plan), should_stop, progress)


def fly_alone(
    plan: Plan,
    tables: Tables,
    should_stop: Callable[[], bool] = lambda: False,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Flown:
    """Fly one mission whose tables were made before.

    Args:
        plan: the mission.
        tables: its own, changed in place.
        should_stop: asked every few milliseconds.
        progress: called with ticks flown and ticks in all.
    """
    now, total = 0, plan.num_ticks
    while now < total:
        if should_stop():
            return Flown(plan, tables, now, stopped=True)
        stop = min(now + SLICE, total)
        now = int(advance(tables, now, stop))
        progress(now, total)
        if trouble := trouble_in(plan, tables):
            return Flown(plan, tables, now, trouble)
    return Flown(plan, tables, now)


def fly_batch(
    plans: Sequence[Plan],
    threads: int = 2,
    lanes: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
) -> list[Flown]:
    """Fly many missions on a pool of threads; the bits are those of `fly`, whatever the number of threads.

    Args:
        plans: the missions; for lanes, of the same laws and sizes.
        threads: [-] how many at once.
        lanes: [-] fly eight in one SIMD register each.
        should_stop: asked every few milliseconds; then all that fly or wait end where they are.

    Returns:
        The missions after their flight, in order.

    Raises:
        ValueError: missions that cannot share their lanes.
    """
    if lanes:
        groups = [plans[k : k + WIDTH] for k in range(0, len(plans), WIDTH)]
        with ThreadPoolExecutor(threads) as pool:
            return [flown for group in pool.map(lambda g: _fly_lanes(g, should_stop), groups) for flown in group]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(lambda plan: fly(plan, should_stop=should_stop), plans))


def _fly_lanes(plans: Sequence[Plan], should_stop: Callable[[], bool]) -> list[Flown]:
    joined = join([make_tables(plan, lanes=True) for plan in plans])
    return fly_joined(plans, joined, lambda k: lane(joined, k), should_stop)


def fly_joined(
    plans: Sequence[Plan],
    joined: Tables,
    leave: Callable[[int], Tables],
    should_stop: Callable[[], bool] = lambda: False,
) -> list[Flown]:
    """Fly missions in the lanes of the same tables, each to its own end.

    Args:
        plans: at most eight missions.
        joined: their tables, changed in place.
        leave: what to keep of a lane when its mission has ended.
        should_stop: asked every few milliseconds.

    Returns:
        The missions after their flight; one in which a number is none was flown again alone.
    """
    kept: dict[int, Flown] = {}
    ticks, goes_on = 0, True
    slice_ = max(SLICE, IN_LANES // len(plans[0].vehicles))
    for end in sorted({plan.num_ticks for plan in plans}):
        while ticks < end and goes_on and not should_stop():
            stop = min(ticks + slice_, end)
            ticks = int(advance(joined, ticks, stop))
            goes_on = ticks == stop  # else every lane failed
        for k, plan in enumerate(plans):
            if plan.num_ticks == end:
                kept[k] = Flown(plan, leave(k), ticks, stopped=ticks < end)
    # One that fails in a lane goes on until the others are done; alone it ends where it failed.
    return [
        fly(plan, should_stop=should_stop) if trouble_in(plan, kept[k].tables) else kept[k]
        for k, plan in enumerate(plans)
    ]


def trouble_in(plan: Plan, tables: Tables) -> Trouble | None:
    """The first number that was not one, by name."""
    if tables.trouble[CODE] == FINE:
        return None
    vehicle = plan.vehicles[plan.order[int(tables.trouble[VEHICLE])]].name
    return Trouble(vehicle, SIGNALS[tables.trouble[CODE]], float(tables.trouble[TIME]))
