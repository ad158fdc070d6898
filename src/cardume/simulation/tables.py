"""From plans to tables: numpy arrays that hold one mission, or eight side by side in lanes."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.compiler import WIDTH, Layout
from cardume.compiler.reach import fields_read
from cardume.laws import COLUMNS, FAMILIES
from cardume.maths.random import random_key
from cardume.onboard.mind import (
    OTHERS,
    OWN,
    Fresh,
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
from cardume.signals import Noise
from cardume.simulation.air import NEVER
from cardume.simulation.fleet import (
    NUM_SENSORS,
    SEEN,
    SENSORS,
    STREAMS,
    TIMING,
    VEHICLE,
    Held,
    Satellite,
    Tables,
    Timing,
    Whole,
)
from cardume.simulation.noise import NOISE_WIDTH
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.simulation.recording import LOG, MESSAGE_LOG, NUM_COUNTS
from cardume.simulation.score import BINS, FLEET_SCORES, HISTOGRAMS, RULES, SCORES, FleetScore
from cardume.simulation.tick import TROUBLE_WIDTH

MOST_SLOTS = 64  # messages of one sender under way at once
USBL_COLUMNS = 4
CHANCES = ("sigma", "invalid")  # parts of the names of parameters of which chance takes no part where they are 0
IN_PLANT_STEPS = ("autopilot", "model")  # called once a plant step, the others once a tick
# Families that keep one memory for each vehicle of the fleet.
PER_OTHER = frozenset({"coordination", "neighbors", "usbl", "acoustics"})


def make_tables(plan: Plan, lanes: bool = False, with_laws: bool = True) -> Tables:
    """Write the tables of one mission.

    Args:
        plan: the mission.
        lanes: [-] look the laws up for the lanes kernel; `join` then puts eight missions together.
        with_laws: [-] False leaves their addresses out, and compiles none: such tables have the right types, no more.

    Returns:
        Tables of (n,) arrays.
    """
    vehicles = [plan.vehicles[k] for k in plan.order]
    size = len(vehicles)
    gains, memory = _gains(plan, vehicles), _memories(vehicles)
    graph, list_width, widest = _graph(plan, vehicles)
    slots, past_size = _slots(vehicles), _past_size(vehicles, plan.tick)
    paths, path_starts = _paths(vehicles)
    records = math.ceil(plan.num_ticks * plan.tick / plan.log_period - 1e-9) + 1 if plan.log_period > 0 else 0
    room = _message_room(plan, vehicles, widest) if records else 0
    messages = inbox_width(size)
    links = max(1, size * widest)
    return Tables(
        Whole(
            size,
            plan.substeps,
            gains.shape[1],
            memory.shape[1],
            past_size,
            list_width,
            slots,
            messages,
            widest,
            int(any("bathymetry" in v.laws for v in vehicles)),
            int(any(v.orders.has_phases for v in vehicles)),
            int(plan.is_watched),
            int(any(_noise_pairs(v.laws["current"]) for v in vehicles if "current" in v.laws)),
        ),
        plan.tick,
        _handles(vehicles, size, lanes) if with_laws else np.zeros(size * len(FAMILIES) * COLUMNS, np.int64),
        gains.ravel(),
        memory.ravel(),
        np.concatenate([_vehicle_row(v) for v in vehicles]),
        np.concatenate([_mind_row(v) for v in vehicles]),
        np.tile(np.concatenate([_known_of(v) for v in vehicles]), size),
        np.full(size * size * USBL_COLUMNS, np.nan),
        np.concatenate([_timing_row(v, plan.tick) for v in vehicles]),
        np.concatenate([*(_key_row(v, plan.seed) for v in vehicles), random_key(plan.seed, "current")]),
        np.zeros((size * NUM_SENSORS + 1) * NOISE_WIDTH),
        np.zeros(max(1, size * past_size * SEEN.width)),
        paths,
        path_starts,
        graph,
        *_orders(vehicles),
        np.array(plan.field, float),  # never read-only: that would be another type, and compile the engine again
        np.array(plan.seabed, float),
        np.full(size * slots * messages, np.nan),
        np.zeros(size),
        np.zeros(size, np.int64),
        np.full(links, NEVER),
        np.full(links * slots, NEVER),
        np.full(links * messages, np.nan),
        np.concatenate([_row(SCORES, v.safety) for v in vehicles]),
        _row(FLEET_SCORES, FleetScore(separation_limit=plan.separation)),
        np.zeros(size * HISTOGRAMS * BINS),
        np.zeros(TROUBLE_WIDTH),
        np.full(max(1, records * size * LOG.width), np.nan),
        np.full(max(1, records * size * size), np.nan),
        np.full(max(1, room * MESSAGE_LOG.width), np.nan),
        _counts(records, room, plan),
        _row(RULES, plan.rules),
    )


def join(tables: Sequence[Tables]) -> Tables:
    """Put up to eight missions of the same shape side by side; missing ones repeat the last.

    Args:
        tables: of missions with the same laws and sizes, made for lanes.

    Returns:
        Tables of (n, 8) arrays; whole numbers and the gridded current are the first mission's.

    Raises:
        ValueError: missions that differ in what all lanes share, or in the size of a table.
    """
    full = [*tables, *[tables[-1]] * (WIDTH - len(tables))]
    noisy = max(t.whole.has_weather for t in full)  # a drawn variation of zero does not keep missions apart
    full = [t._replace(whole=t.whole._replace(has_weather=noisy)) for t in full]
    first = full[0]
    joined = []
    for name in Tables._fields:
        parts = [getattr(t, name) for t in full]
        is_shared = name in ("field", "seabed") or not isinstance(parts[0], np.ndarray) or parts[0].dtype == np.int64
        if not all(_fit(part, parts[0], is_shared) for part in parts):
            raise ValueError(f"missions in lanes must have the same laws, sizes and graph; these differ in '{name}'")
        joined.append(getattr(first, name) if is_shared else np.ascontiguousarray(np.stack(parts, axis=-1)))
    return Tables._make(joined)


def _fit(part: Any, first: Any, is_shared: bool) -> bool:
    """Whether a mission's part can stand beside the first one's: equal, or of its shape."""
    if not is_shared:
        return bool(part.shape == first.shape)
    return part is first or np.array_equal(part, first, equal_nan=True)


def lane(tables: Tables, which: int) -> Tables:
    """One mission out of eight."""
    parts = [getattr(tables, name) for name in Tables._fields]
    return Tables._make(np.ascontiguousarray(p[:, which]) if np.ndim(p) == 2 else p for p in parts)


def _row(layout: Layout, *records: Any) -> np.ndarray:
    row = np.zeros(layout.width)
    for record in records:
        start = layout.offsets[type(record)]
        row[start : start + len(record)] = record
    return row


def _vehicle_row(vehicle: VehiclePlan) -> np.ndarray:
    return _row(VEHICLE, vehicle.state, vehicle.place, Held(), Satellite())


def _mind_row(vehicle: VehiclePlan) -> np.ndarray:
    believed = vehicle.setup, vehicle.datasheet, Whereabouts(*_estimate(vehicle)), Speech(), _first_phase(vehicle)
    return _row(OWN, *believed, *_unwritten(vehicle))


def _first_phase(vehicle: VehiclePlan) -> Progress:
    """What a vehicle begins with, and where it waits: its place in the formation when that is at the start."""
    orders = vehicle.orders.orders
    start = point_at(vehicle.path, arc_length_at(vehicle.path, 0.0))
    phase = DIVE if orders.dives else GATHER if orders.gathers else GO
    return Progress(phase, 0.0, 0.0, start.north, start.east)


def _unwritten(vehicle: VehiclePlan) -> tuple[Journal, Sounding]:
    begun = PHASES[round(_first_phase(vehicle).phase)]
    return Journal(**{begun: 0.0}), Sounding()


def _orders(vehicles: Sequence[VehiclePlan]) -> tuple[np.ndarray, np.ndarray]:
    """The orders of all vehicles, one after the other, and (vehicle, NUM_FEATURES) whole numbers."""
    numbers = [v.orders.numbers for v in vehicles]
    starts = np.cumsum([0, *map(len, numbers)])[:-1]
    features = [v.orders.features(int(start)) for v, start in zip(vehicles, starts, strict=True)]
    return np.concatenate(numbers), np.array(features, np.int64).ravel()


def _known_of(vehicle: VehiclePlan) -> np.ndarray:
    """All that the others know of a vehicle before the mission: where on its path it starts."""
    return _row(OTHERS, News(), Fresh(), Outlook(), LastSeen(), Told(), vehicle.place)


def _estimate(vehicle: VehiclePlan) -> tuple[float, float]:
    return vehicle.estimate or (vehicle.state.north, vehicle.state.east)


def _timing_row(vehicle: VehiclePlan, tick: float) -> np.ndarray:
    row = []
    for sensor in SENSORS:
        timing = Timing()
        if sensor in vehicle.laws:
            choice = vehicle.laws[sensor]
            latency = float(round(choice.value("latency") / tick))
            period = float(max(1, round(choice.value("period") / tick)))
            timing = Timing(latency, 0.0, period, latency, float(_noise_pairs(choice)))
        row.append(_row(TIMING, timing))
    return np.concatenate(row)


def _noise_pairs(choice: Choice) -> int:
    """How many pairs of random numbers a law reads in a tick; none where it is told that all its noise is zero.

    Of a user's law it is never known that its noise is zero.
    """
    sizes = [p.name for p in choice.law.parameters if any(part in p.name for part in CHANCES)]
    if choice.law.is_builtin and sizes and not any(choice.value(name) for name in sizes):
        return 0
    read = fields_read(choice.law.function, Noise)
    return 2 if read & {"c", "d"} else 1 if read else 0


def _key_row(vehicle: VehiclePlan, seed: int) -> np.ndarray:
    return np.concatenate([random_key(seed, stream, vehicle.name) for stream in STREAMS])


def _handles(vehicles: Sequence[VehiclePlan], size: int, lanes: bool) -> np.ndarray:
    """(vehicle, family, 4) whole numbers: handle, first gain, first memory row, memory width."""
    table = np.zeros((size, len(FAMILIES), COLUMNS), np.int64)
    for row, vehicle in zip(table, vehicles, strict=True):
        gain = memory = 0
        for place, family in enumerate(FAMILIES):
            if family in vehicle.laws:
                law = vehicle.laws[family].law
                width = law.initial_memory().size
                row[place] = law.handle(lanes), gain, memory, width
                gain += law.gains_width
                memory += width * (size if family in PER_OTHER else 1)
    return table.ravel()


def _gains(plan: Plan, vehicles: Sequence[VehiclePlan]) -> np.ndarray:
    steps = dict.fromkeys(FAMILIES, plan.tick) | dict.fromkeys(IN_PLANT_STEPS, plan.tick / plan.substeps)
    rows = [[v.laws[f].law.gains(steps[f], **v.laws[f].parameters) for f in FAMILIES if f in v.laws] for v in vehicles]
    return _stacked([np.concatenate(row or [np.zeros(0)]) for row in rows])


def _memories(vehicles: Sequence[VehiclePlan]) -> np.ndarray:
    rows = []
    for vehicle in vehicles:
        parts = [np.zeros(0)]
        for family in FAMILIES:
            if family in vehicle.laws:
                start = _initial_memory(vehicle, family, vehicle.laws[family])
                parts += [start] * (len(vehicles) if family in PER_OTHER else 1)
        rows.append(np.concatenate(parts))
    return _stacked(rows)


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


def _stacked(rows: Sequence[np.ndarray]) -> np.ndarray:
    width = max(1, *(row.size for row in rows))
    return np.stack([np.pad(row, (0, width - row.size)) for row in rows])


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


def _slots(vehicles: Sequence[VehiclePlan]) -> int:
    """How many messages of one sender can be under way: the longest delay over the shortest period."""
    delays = [_parameter(v.laws["acoustics"], "delay", 2.0) for v in vehicles]
    periods = [_parameter(v.laws["messaging"], "period", 0.5) for v in vehicles]
    return min(MOST_SLOTS, math.ceil((max(delays) + 2.0) / min(periods)) + 2)


def _parameter(choice: Choice, name: str, otherwise: float) -> float:
    return choice.value(name) if any(p.name == name for p in choice.law.parameters) else otherwise


def _past_size(vehicles: Sequence[VehiclePlan], tick: float) -> int:
    latencies = [v.laws[s].value("latency") for v in vehicles for s in SENSORS if s in v.laws]
    return 1 + max([0, *(round(latency / tick) for latency in latencies)])


def _message_room(plan: Plan, vehicles: Sequence[VehiclePlan], widest: int) -> int:
    periods = [_parameter(v.laws["messaging"], "period", plan.tick) for v in vehicles]
    return int(len(vehicles) * widest * (plan.duration / max(plan.tick, min(periods)) + 2))


def _counts(records: int, room: int, plan: Plan) -> np.ndarray:
    counts = np.zeros(NUM_COUNTS, np.int64)
    counts[2:] = records, room, max(1, round(plan.log_period / plan.tick)) if records else 1
    return counts
