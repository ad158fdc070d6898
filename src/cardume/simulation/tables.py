"""From plans to tables: numpy arrays that hold one mission."""

import math
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import Any

import numpy as np

from cardume.compiler import Layout
from cardume.compiler.reach import fields_read
from cardume.laws import COLUMNS, FAMILIES
from cardume.maths.random import Key, random_key
from cardume.onboard.mind import (
    NEVER as NEVER_TOLD,
    OTHERS,
    OWN,
    Asked,
    Echo,
    Fresh,
    Grid,
    Journal,
    LastSeen,
    News,
    Outlook,
    Progress,
    Sounding,
    Speech,
    Stop,
    Told,
    Trusted,
    Watches,
    Way,
    Whereabouts,
    inbox_width,
)
from cardume.onboard.phases import DIVE, GATHER, GO, PHASES
from cardume.paths.along import arc_length_at
from cardume.paths.projection import point_at
from cardume.signals import Forecast, Noise, Question
from cardume.simulation.fault_tables import fault_tables, num_clocks
from cardume.simulation.fleet import (
    KEY,
    MODEM,
    NEVER,
    NUM_SENSORS,
    SEEN,
    STREAMS,
    TIMING,
    VEHICLE,
    Held,
    OnAir,
    Satellite,
    Tables,
    Timing,
    Whole,
)
from cardume.simulation.law_tables import gain_table, handle_table, memory_table
from cardume.simulation.memo import NO_MEMO, Memo
from cardume.simulation.noise import NOISE_WIDTH
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.simulation.recording import LOG, MESSAGE_LOG, NUM_COUNTS
from cardume.simulation.score import BINS, FLEET_SCORES, HISTOGRAMS, RULES, SCORES, FleetScore
from cardume.simulation.sizes import asks_for_fixes, message_room, num_slots, past_ticks, sensors_of
from cardume.simulation.tick import TROUBLE_WIDTH

USBL_COLUMNS = 4
CHANCES = ("sigma", "invalid")  # parts of the names of parameters of which chance takes no part where they are 0


def make_tables(plan: Plan, lanes: bool = False, with_laws: bool = True, memo: Memo = NO_MEMO) -> Tables:
    """Write the tables of one mission.

    Args:
        plan: the mission.
        lanes: [-] look the laws up for the lanes kernel; `side_by_side.join` then puts eight missions together.
        with_laws: [-] False leaves their addresses out, and compiles none: such tables have the right types, no more.
        memo: of missions that are nearly the same, with which these tables then share arrays; `own` copies them.

    Returns:
        Tables of (n,) arrays.
    """
    vehicles = [plan.vehicles[k] for k in plan.order]
    size = len(vehicles)
    gains, memory = gain_table(plan, vehicles, memo), memory_table(vehicles, memo)
    graph, list_width, widest = memo.recall(
        "graph",
        (plan.hears, *(v.setup for v in vehicles)),
        lambda: _graph(plan, vehicles),
    )
    slots, past_size = num_slots(vehicles, plan.tick, memo), past_ticks(vehicles, plan.tick, memo)
    paths, path_starts = memo.recall("paths", tuple(v.path for v in vehicles), lambda: _paths(vehicles))
    records = math.ceil(plan.num_ticks * plan.tick / plan.log_period - 1e-9) + 1 if plan.log_period > 0 else 0
    room = message_room(plan, vehicles, widest) if records else 0
    whole = Whole(
        size,
        plan.substeps,
        gains.shape[1],
        memory.shape[1],
        past_size,
        list_width,
        slots,
        inbox_width(size),
        widest,
        int(any("bathymetry" in v.laws for v in vehicles)),
        int(any(v.orders.has_phases for v in vehicles)),
        int(plan.is_watched),
        int(any(_noise_pairs(v.laws["current"], memo) for v in vehicles if "current" in v.laws)),
        int(any(v.medium for v in vehicles)),
        int(asks_for_fixes(vehicles)),
        len(plan.faults),
        num_clocks(plan),
    )
    blank = memo.recall("blank", (), lambda: _blank(whole, records, room), (whole, records, room))
    tables = blank._replace(
        tick=plan.tick,
        handles=handle_table(vehicles, lanes, memo) if with_laws else blank.handles,
        gains=gains.ravel(),
        memory=memory.ravel(),
        paths=paths,
        path_starts=path_starts,
        graph=graph,
        keys=_keys(vehicles, plan.seed, memo),
        # never read-only: that would be another type, and compile the engine again
        field=memo.recall("field table", (plan.field,), lambda: np.array(plan.field, float)),
        seabed=memo.recall("seabed table", (plan.seabed,), lambda: np.array(plan.seabed, float)),
        counts=memo.recall(
            "counts", (), lambda: _counts(records, room, plan), (records, room, plan.log_period, plan.tick)
        ),
    )
    faults: dict[str, Any] = fault_tables(plan, whole.message_width) if plan.faults else {}
    return tables._replace(**_rows(plan, vehicles, memo), **faults)


def _rows(plan: Plan, vehicles: Sequence[VehiclePlan], memo: Memo) -> dict[str, Any]:
    """The tables that hold records of vehicles, one vehicle after the other."""

    def table(
        name: str, keys: Sequence[tuple[tuple[Any, ...], Hashable]], make: Callable[[VehiclePlan], np.ndarray]
    ) -> np.ndarray:
        """One row for each vehicle, made of the parts and values of its key."""
        made = zip(vehicles, keys, strict=True)
        rows = tuple(memo.recall(name, parts, partial(make, v), values) for v, (parts, values) in made)
        return memo.recall(f"all {name}", rows, lambda: np.concatenate(rows))

    tick = plan.tick
    known = table("known row", [((v.place,), None) for v in vehicles], _known_of)
    orders = tuple(v.orders for v in vehicles)
    talk = tuple(tuple(_talk(v)) for v in vehicles)
    numbers, features = memo.recall("orders", orders, lambda: _orders(vehicles), talk)
    media = tuple(v.medium for v in vehicles if v.medium)
    modems = {"modems": np.concatenate([_row(MODEM, medium) for medium in media])} if media else {}
    return {
        **modems,
        "vehicles": table("vehicle row", [((v.state, v.place), None) for v in vehicles], _vehicle_row),
        "minds": table("mind row", [_told(v) for v in vehicles], _mind_row),
        "others": memo.recall("others", (known,), lambda: np.tile(known, len(vehicles))),
        "timings": table("timing row", [(sensors_of(v), tick) for v in vehicles], lambda v: _timing_row(v, tick, memo)),
        "orders": numbers,
        "features": features,
        "scores": table("score row", [((v.safety,), None) for v in vehicles], lambda v: _row(SCORES, v.safety)),
        "fleet_score": memo.recall(
            "fleet score",
            (),
            lambda: _row(FLEET_SCORES, FleetScore(separation_limit=plan.separation)),
            plan.separation,
        ),
        "requirements": memo.recall("rules", (), lambda: _row(RULES, plan.rules), plan.rules),
    }


def _blank(whole: Whole, records: int, room: int) -> Tables:
    """Tables in which nothing is said or measured yet; what depends on more than sizes is left empty."""
    size, links = whole.size, max(1, whole.size * whole.widest)
    none, nothing = np.zeros(0), np.zeros(0, np.int64)
    return Tables(
        whole=whole,
        tick=0.0,
        handles=np.zeros(size * len(FAMILIES) * COLUMNS, np.int64),
        gains=none,
        memory=none,
        vehicles=none,
        minds=none,
        others=none,
        usbl=np.full(size * size * USBL_COLUMNS, np.nan),
        timings=none,
        keys=none,
        noise=np.zeros((size * NUM_SENSORS + 1) * NOISE_WIDTH),
        past=np.zeros(max(1, size * whole.past_size * SEEN.width)),
        aside=np.zeros(size * SEEN.width),
        paths=none,
        path_starts=nothing,
        graph=nothing,
        orders=none,
        features=nothing,
        field=none,
        seabed=none,
        outbox=np.full(size * whole.slots * whole.message_width, np.nan),
        sending=np.zeros(size),
        sent=np.zeros(size, np.int64),
        due=np.full(links, NEVER),
        arrivals=np.full(links * whole.slots, NEVER),
        inbox=np.full(links * whole.message_width, np.nan),
        modems=np.zeros(size * MODEM.width),
        on_air=np.tile(np.array(OnAir()), size * size * whole.slots if whole.is_shared else 1),
        logged=np.full(links * whole.slots if whole.is_shared else 1, -1.0),
        fault_kinds=none,
        faults=none,
        recordings=none,
        clocks=none,
        scores=none,
        fleet_score=none,
        histograms=np.zeros(size * HISTOGRAMS * BINS),
        trouble=np.zeros(TROUBLE_WIDTH),
        log=np.full(max(1, records * size * LOG.width), np.nan),
        predictions=np.full(max(1, records * size * size), np.nan),
        messages=np.full(max(1, room * MESSAGE_LOG.width), np.nan),
        counts=nothing,
        requirements=none,
    )


def _row(layout: Layout, *records: Any) -> np.ndarray:
    row = np.zeros(layout.width)
    for record in records:
        start = layout.offsets[type(record)]
        row[start : start + len(record)] = record
    return row


def _vehicle_row(vehicle: VehiclePlan) -> np.ndarray:
    return _row(VEHICLE, vehicle.state, vehicle.place, Held(), Satellite())


def _told(vehicle: VehiclePlan) -> tuple[tuple[Any, ...], Hashable]:
    """The parts and values of which a mind's row is made."""
    return (vehicle.setup, vehicle.datasheet, vehicle.orders, vehicle.path), (vehicle.believed_start, vehicle.grid)


def _mind_row(vehicle: VehiclePlan) -> np.ndarray:
    believed = vehicle.setup, vehicle.datasheet, Whereabouts(*vehicle.believed_start), Speech(), _first_phase(vehicle)
    return _row(OWN, *believed, *_unwritten(vehicle))


def _first_phase(vehicle: VehiclePlan) -> Progress:
    """What a vehicle begins with, and where it waits: its place in the formation when that is at the start."""
    orders = vehicle.orders.orders
    start = point_at(vehicle.path, arc_length_at(vehicle.path, 0.0))
    phase = DIVE if orders.dives else GATHER if orders.gathers else GO
    return Progress(phase, 0.0, 0.0, start.north, start.east)


def _unwritten(vehicle: VehiclePlan) -> tuple[Any, ...]:
    begun = PHASES[round(_first_phase(vehicle).phase)]
    return Journal(**{begun: 0.0}), Sounding(), vehicle.grid or Grid(), Trusted(), Asked(), Watches(), Way(), Stop()


def _orders(vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, np.ndarray]:
    """The orders of all vehicles, one after the other, and (vehicle, NUM_FEATURES) whole numbers."""
    numbers = [v.orders.numbers for v in vehicles]
    starts = np.cumsum([0, *map(len, numbers)])[:-1]
    features = [[*v.orders.features(int(start)), *_talk(v)] for v, start in zip(vehicles, starts, strict=True)]
    return np.concatenate(numbers), np.array(features, np.int64).ravel()


def _talk(vehicle: VehiclePlan) -> list[int]:
    """Whether a vehicle answers questions, foresees what others make of its words, rounds them, heeds silence."""
    law = vehicle.laws["messaging"].law
    return [
        int(law.asks_for(Question)),
        int(law.asks_for(Forecast)),
        int(vehicle.grid is not None),
        int(vehicle.orders.orders.silent_after < NEVER_TOLD),
    ]


def _known_of(vehicle: VehiclePlan) -> np.ndarray:
    """All that the others know of a vehicle before the mission: where on its path it starts."""
    return _row(OTHERS, News(), Fresh(), Outlook(), LastSeen(), Told(), vehicle.place, Echo())


def _timing_row(vehicle: VehiclePlan, tick: float, memo: Memo) -> np.ndarray:
    def timing(choice: Choice | None) -> np.ndarray:
        return memo.recall("timing", (choice,), lambda: _row(TIMING, _timing(choice, tick, memo)), tick)

    return np.concatenate([timing(choice) for choice in sensors_of(vehicle)])


def _timing(choice: Choice | None, tick: float, memo: Memo) -> Timing:
    if choice is None:
        return Timing()
    latency = float(round(choice.value("latency") / tick))
    period = float(max(1, round(choice.value("period") / tick)))
    return Timing(latency, 0.0, period, latency, float(_noise_pairs(choice, memo)))


def _noise_pairs(choice: Choice, memo: Memo) -> int:
    """How many pairs of random numbers a law reads in a tick; none where it is told that all its noise is zero.

    Of a user's law it is never known that its noise is zero.
    """
    law = choice.law
    sizes = memo.recall(
        "chances", (law,), lambda: [p.name for p in law.parameters if any(c in p.name for c in CHANCES)]
    )
    if law.is_builtin and sizes and not any(choice.value(name) for name in sizes):
        return 0
    read = memo.recall("noise read", (law,), lambda: fields_read(law.function, Noise))
    return 2 if read & {"c", "d"} else 1 if read else 0


def _keys(vehicles: Sequence[VehiclePlan], seed: int, memo: Memo) -> np.ndarray:
    """The keys of all streams of all vehicles, then the fleet's own."""
    names = tuple(v.name for v in vehicles)
    keys = memo.recall("keys", (), lambda: _keys_without_seed(names), names).copy()
    seeded = random_key(seed, "current")
    for field in ("seed_low", "seed_high"):
        keys[KEY.column(Key, field) :: KEY.width] = getattr(seeded, field)
    return keys


def _keys_without_seed(names: Sequence[str]) -> np.ndarray:
    keys = [random_key(0, stream, name) for name in names for stream in STREAMS]
    return np.concatenate([*keys, random_key(0, "current")])


def _paths(vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(v.path.size for v in vehicles)])[:-1]
    return np.concatenate([v.path for v in vehicles]), starts.astype(np.int64)


def _graph(plan: Plan, vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, int, int]:
    """Lists after their length: neighbors, then whose states matter, then whose messages are read.

    The state of a neighbor's neighbor matters too, where somebody sees it and tells; nobody else ever learns of it.
    """
    hears = np.asarray(plan.hears)[np.ix_(plan.order, plan.order)] != 0.0
    np.fill_diagonal(hears, False)
    size = len(vehicles)
    neighbors: list[list[int]] = [np.flatnonzero(row).tolist() for row in hears]
    sharers = {k for k, v in enumerate(vehicles) if v.setup.shares_sightings > 0.5}
    beyond = [{k for j in n for k in neighbors[j]} if sharers else set() for n in neighbors]
    known = [sorted({*n, *b} - {i}) for i, (n, b) in enumerate(zip(neighbors, beyond, strict=True))]
    sources = [sorted({*n, *sharers} - {i}) for i, n in enumerate(neighbors)]
    width = 1 + max(len(x) for lists in (neighbors, known, sources) for x in lists)
    table = np.zeros((3, size, width), np.int64)
    for kind, lists in enumerate((neighbors, known, sources)):
        for vehicle, members in enumerate(lists):
            table[kind, vehicle, : 1 + len(members)] = [len(members), *members]
    return table.ravel(), width, max(len(x) for x in sources)


def _counts(records: int, room: int, plan: Plan) -> np.ndarray:
    counts = np.zeros(NUM_COUNTS, np.int64)
    counts[2:] = records, room, max(1, round(plan.log_period / plan.tick)) if records else 1
    return counts
