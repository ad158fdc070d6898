"""From plans to tables: numpy arrays that hold one mission."""

import math
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import Any

import numpy as np

from cardume.compiler import Layout
from cardume.compiler.reach import fields_read
from cardume.laws import COLUMNS, FAMILIES, Law
from cardume.maths.random import Key, random_key
from cardume.onboard.mind import (
    OTHERS,
    OWN,
    Fresh,
    Grid,
    Journal,
    LastSeen,
    News,
    Outlook,
    Progress,
    Sounding,
    Speech,
    Told,
    Whereabouts,
    inbox_width,
)
from cardume.onboard.phases import DIVE, GATHER, GO, PHASES
from cardume.paths.along import arc_length_at
from cardume.paths.projection import point_at
from cardume.paths.table import PathPlace
from cardume.signals import Forecast, Noise, Question
from cardume.simulation.fleet import (
    KEY,
    MODEM,
    NEVER,
    NUM_SENSORS,
    SEEN,
    SENSORS,
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
from cardume.simulation.memo import NO_MEMO, Memo
from cardume.simulation.noise import NOISE_WIDTH
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.simulation.recording import LOG, MESSAGE_LOG, NUM_COUNTS
from cardume.simulation.score import BINS, FLEET_SCORES, HISTOGRAMS, RULES, SCORES, FleetScore
from cardume.simulation.tick import TROUBLE_WIDTH
from cardume.world.acoustics.modem import airtime

FARTHEST_ANSWER = 3.0  # [s] on the way, beyond which an answer gives no USBL reading
MOST_SLOTS = 64  # messages of one sender under way at once
USBL_COLUMNS = 4
CHANCES = ("sigma", "invalid")  # parts of the names of parameters of which chance takes no part where they are 0
IN_PLANT_STEPS = ("autopilot", "model")  # called once a plant step, the others once a tick
# Families that keep one memory for each vehicle of the fleet.
PER_OTHER = frozenset({"coordination", "neighbors", "usbl", "acoustics"})


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
    gains, memory = _gains(plan, vehicles, memo), _memories(vehicles, memo)
    graph, list_width, widest = memo.recall(
        "graph",
        (plan.hears, *(v.setup for v in vehicles)),
        lambda: _graph(plan, vehicles),
    )
    slots, past_size = _slots(vehicles, plan.tick, memo), _past_size(vehicles, plan.tick, memo)
    paths, path_starts = memo.recall("paths", tuple(v.path for v in vehicles), lambda: _paths(vehicles))
    records = math.ceil(plan.num_ticks * plan.tick / plan.log_period - 1e-9) + 1 if plan.log_period > 0 else 0
    room = _message_room(plan, vehicles, widest) if records else 0
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
        int(_asks(vehicles)),
    )
    blank = memo.recall("blank", (), lambda: _blank(whole, records, room), (whole, records, room))
    tables = blank._replace(
        tick=plan.tick,
        handles=_handles(vehicles, lanes, memo) if with_laws else blank.handles,
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
    return tables._replace(**_rows(plan, vehicles, memo))


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
        "timings": table(
            "timing row", [(_sensors_of(v), tick) for v in vehicles], lambda v: _timing_row(v, tick, memo)
        ),
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
    return (vehicle.setup, vehicle.datasheet, vehicle.orders, vehicle.path), (_estimate(vehicle), vehicle.grid)


def _mind_row(vehicle: VehiclePlan) -> np.ndarray:
    believed = vehicle.setup, vehicle.datasheet, Whereabouts(*_estimate(vehicle)), Speech(), _first_phase(vehicle)
    return _row(OWN, *believed, *_unwritten(vehicle))


def _first_phase(vehicle: VehiclePlan) -> Progress:
    """What a vehicle begins with, and where it waits: its place in the formation when that is at the start."""
    orders = vehicle.orders.orders
    start = point_at(vehicle.path, arc_length_at(vehicle.path, 0.0))
    phase = DIVE if orders.dives else GATHER if orders.gathers else GO
    return Progress(phase, 0.0, 0.0, start.north, start.east)


def _unwritten(vehicle: VehiclePlan) -> tuple[Journal, Sounding, Grid]:
    begun = PHASES[round(_first_phase(vehicle).phase)]
    return Journal(**{begun: 0.0}), Sounding(), vehicle.grid or Grid()


def _orders(vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, np.ndarray]:
    """The orders of all vehicles, one after the other, and (vehicle, NUM_FEATURES) whole numbers."""
    numbers = [v.orders.numbers for v in vehicles]
    starts = np.cumsum([0, *map(len, numbers)])[:-1]
    features = [[*v.orders.features(int(start)), *_talk(v)] for v, start in zip(vehicles, starts, strict=True)]
    return np.concatenate(numbers), np.array(features, np.int64).ravel()


def _talk(vehicle: VehiclePlan) -> list[int]:
    """Whether a vehicle answers questions, foresees what others make of its words, and rounds them."""
    law = vehicle.laws["messaging"].law
    return [int(law.asks_for(Question)), int(law.asks_for(Forecast)), int(vehicle.grid is not None)]


def _asks(vehicles: Sequence[VehiclePlan]) -> bool:
    """Whether a USBL reading comes with the answer to a question."""
    return any("usbl" in v.laws and v.laws["messaging"].law.asks_for(Question) for v in vehicles)


def _known_of(vehicle: VehiclePlan) -> np.ndarray:
    """All that the others know of a vehicle before the mission: where on its path it starts."""
    return _row(OTHERS, News(), Fresh(), Outlook(), LastSeen(), Told(), vehicle.place)


def _estimate(vehicle: VehiclePlan) -> tuple[float, float]:
    return vehicle.estimate or (vehicle.state.north, vehicle.state.east)


def _sensors_of(vehicle: VehiclePlan) -> tuple[Choice | None, ...]:
    return tuple(vehicle.laws.get(sensor) for sensor in SENSORS)


def _timing_row(vehicle: VehiclePlan, tick: float, memo: Memo) -> np.ndarray:
    def timing(choice: Choice | None) -> np.ndarray:
        return memo.recall("timing", (choice,), lambda: _row(TIMING, _timing(choice, tick, memo)), tick)

    return np.concatenate([timing(choice) for choice in _sensors_of(vehicle)])


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


def _handles(vehicles: Sequence[VehiclePlan], lanes: bool, memo: Memo) -> np.ndarray:
    """(vehicle, family, 4) whole numbers: handle, first gain, first memory row, memory width."""
    laws = [[(f, v.laws[f].law) for f in FAMILIES if f in v.laws] for v in vehicles]
    parts = tuple(law for own in laws for _, law in own)
    return memo.recall("handles", parts, lambda: _handles_of(laws, lanes), lanes)


def _handles_of(laws: Sequence[Sequence[tuple[str, Law]]], lanes: bool) -> np.ndarray:
    size = len(laws)
    table = np.zeros((size, len(FAMILIES), COLUMNS), np.int64)
    for row, own in zip(table, laws, strict=True):
        gain = memory = 0
        for family, law in own:
            width = law.initial_memory().size
            row[FAMILIES.index(family)] = law.handle(lanes), gain, memory, width
            gain += law.gains_width
            memory += width * _copies(family, size)
    return table.ravel()


def _gains(plan: Plan, vehicles: Sequence[VehiclePlan], memo: Memo) -> np.ndarray:
    steps = dict.fromkeys(FAMILIES, plan.tick) | dict.fromkeys(IN_PLANT_STEPS, plan.tick / plan.substeps)

    def gains(choice: Choice, step: float) -> np.ndarray:
        return memo.recall("gains", (choice,), lambda: choice.law.gains(step, **choice.parameters), step)

    def row(vehicle: VehiclePlan) -> np.ndarray:
        parts = tuple(gains(vehicle.laws[f], steps[f]) for f in FAMILIES if f in vehicle.laws)
        return memo.recall("all gains", parts, lambda: np.concatenate(parts or (np.zeros(0),)))

    return _stacked([row(vehicle) for vehicle in vehicles], memo)


def _memories(vehicles: Sequence[VehiclePlan], memo: Memo) -> np.ndarray:
    size = len(vehicles)

    def row(vehicle: VehiclePlan) -> np.ndarray:
        parts = (vehicle.place, *(choice.law for choice in vehicle.laws.values()))
        return memo.recall("memory", parts, lambda: _memory_row(vehicle, size), (size, _estimate(vehicle)))

    return _stacked([row(vehicle) for vehicle in vehicles], memo)


def _memory_row(vehicle: VehiclePlan, size: int) -> np.ndarray:
    parts = [np.zeros(0)]
    for family in FAMILIES:
        if family in vehicle.laws:
            start = _initial_memory(vehicle, family, vehicle.laws[family])
            parts += [start] * _copies(family, size)
    return np.concatenate(parts)


def _copies(family: str, size: int) -> int:
    """How many memories a law has: of coordination, one more for what the others think it does."""
    return size + (family == "coordination") if family in PER_OTHER else 1


def _initial_memory(vehicle: VehiclePlan, family: str, choice: Choice) -> np.ndarray:
    """The law's own start; a place on the path is the vehicle's, a position law starts at its initial estimate."""
    start = choice.law.initial_memory()
    if family == "reference_point" and choice.law.memory_type is PathPlace:
        start = np.array(vehicle.place)
    if family == "position" and choice.law.memory_type is not None:
        fields = choice.law.memory_type._fields
        for name, value in zip(("north", "east"), _estimate(vehicle), strict=True):
            if name in fields:
                start[fields.index(name)] = value
    return start


def _stacked(rows: Sequence[np.ndarray], memo: Memo) -> np.ndarray:
    """Rows under one another, filled up with zeros to the longest."""

    def stack() -> np.ndarray:
        table = np.zeros((len(rows), max(1, *(row.size for row in rows))))
        for place, row in zip(table, rows, strict=True):
            place[: row.size] = row
        return table

    return memo.recall("stacked", tuple(rows), stack)


def _paths(vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(v.path.size for v in vehicles)])[:-1]
    return np.concatenate([v.path for v in vehicles]), starts.astype(np.int64)


def _graph(plan: Plan, vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, int, int]:
    """Lists after their length: neighbors, then whose states matter, then whose messages are read."""
    hears = np.asarray(plan.hears)[np.ix_(plan.order, plan.order)] != 0.0
    np.fill_diagonal(hears, False)
    size = len(vehicles)
    neighbors: list[list[int]] = [np.flatnonzero(row).tolist() for row in hears]
    known = [sorted({*n, *(k for j in n for k in neighbors[j])} - {i}) for i, n in enumerate(neighbors)]
    sharers = {k for k, v in enumerate(vehicles) if v.setup.shares_sightings > 0.5}
    sources = [sorted({*n, *sharers} - {i}) for i, n in enumerate(neighbors)]
    width = 1 + max(len(x) for lists in (neighbors, known, sources) for x in lists)
    table = np.zeros((3, size, width), np.int64)
    for kind, lists in enumerate((neighbors, known, sources)):
        for vehicle, members in enumerate(lists):
            table[kind, vehicle, : 1 + len(members)] = [len(members), *members]
    return table.ravel(), width, max(len(x) for x in sources)


def _slots(vehicles: Sequence[VehiclePlan], tick: float, memo: Memo) -> int:
    """How many messages of one sender can be under way: the longest delay over the shortest time between two.

    Lanes share the places; where they may speak in different ticks there is one for every tick.
    """

    def value(vehicle: VehiclePlan, family: str, what: str, make: Callable[[VehiclePlan], float]) -> float:
        return memo.recall(what, (vehicle.laws[family], vehicle.medium), lambda: make(vehicle), tick)

    delays = [value(v, "acoustics", "longest delay", _delay) for v in vehicles]
    intervals = [value(v, "messaging", "shortest interval", lambda v: _interval(v, tick)) for v in vehicles]
    return min(MOST_SLOTS, math.ceil((max(delays) + 2.0) / min(intervals)) + 2)


def _delay(vehicle: VehiclePlan) -> float:
    """Longest time [s] from the sending of a message until it is read, but for the way."""
    if vehicle.medium is not None:
        return airtime(vehicle.medium, vehicle.medium.payload) + vehicle.medium.processing
    return _parameter(vehicle.laws["acoustics"], "delay", 2.0)


def _interval(vehicle: VehiclePlan, tick: float) -> float:
    """Shortest time [s] between two messages of a vehicle, the same in all lanes."""
    law = vehicle.laws["messaging"].law
    if law.asks_for(Question) or law.asks_for(Forecast):
        return tick
    return _parameter(vehicle.laws["messaging"], "period", _parameter(vehicle.laws["messaging"], "slot", 0.5))


def _parameter(choice: Choice, name: str, otherwise: float) -> float:
    return choice.value(name) if any(p.name == name for p in choice.law.parameters) else otherwise


def _past_size(vehicles: Sequence[VehiclePlan], tick: float, memo: Memo) -> int:
    """How many ticks sensors look back, and this one."""

    def longest(vehicle: VehiclePlan) -> float:
        sensors = [choice for choice in _sensors_of(vehicle) if choice is not None]
        return memo.recall("latency", tuple(sensors), lambda: max([0.0, *(c.value("latency") for c in sensors)]))

    answer = max(_delay(v) for v in vehicles) + FARTHEST_ANSWER if _asks(vehicles) else 0.0
    return 1 + max(math.ceil(answer / tick - 1e-9), *(round(longest(vehicle) / tick) for vehicle in vehicles))


def _message_room(plan: Plan, vehicles: Sequence[VehiclePlan], widest: int) -> int:
    messaging = [v.laws["messaging"] for v in vehicles]
    periods = [_parameter(choice, "period", _parameter(choice, "slot", plan.tick)) for choice in messaging]
    return int(len(vehicles) * widest * (plan.duration / max(plan.tick, min(periods)) + 2))


def _counts(records: int, room: int, plan: Plan) -> np.ndarray:
    counts = np.zeros(NUM_COUNTS, np.int64)
    counts[2:] = records, room, max(1, round(plan.log_period / plan.tick)) if records else 1
    return counts
