"""The tables of laws: where the code of each is, its gains, and its memory at the start."""

from collections.abc import Sequence

import numpy as np

from cardume.laws import COLUMNS, FAMILIES, Law
from cardume.paths.table import PathPlace
from cardume.simulation.memo import Memo
from cardume.simulation.plan import Choice, Plan, VehiclePlan

IN_PLANT_STEPS = ("autopilot", "model")  # called once a plant step, the others once a tick
# Families that keep one memory for each vehicle of the fleet.
PER_OTHER = frozenset({"coordination", "neighbors", "usbl", "acoustics"})


def handle_table(vehicles: Sequence[VehiclePlan], lanes: bool, memo: Memo) -> np.ndarray:
    """(vehicle, family, 4) whole numbers, flat: handle, first gain, first memory row, memory width.

    Args:
        vehicles: in the order of the engine.
        lanes: [-] look the laws up for the lanes kernel.
        memo: of missions that are nearly the same.
    """
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


def gain_table(plan: Plan, vehicles: Sequence[VehiclePlan], memo: Memo) -> np.ndarray:
    """(vehicle, gains) what the laws of each vehicle read in flight, family after family.

    Args:
        plan: for the steps at which laws are called.
        vehicles: in the order of the engine.
        memo: of missions that are nearly the same.
    """
    steps = dict.fromkeys(FAMILIES, plan.tick) | dict.fromkeys(IN_PLANT_STEPS, plan.tick / plan.substeps)

    def gains(choice: Choice, step: float) -> np.ndarray:
        return memo.recall("gains", (choice,), lambda: choice.law.gains(step, **choice.parameters), step)

    def row(vehicle: VehiclePlan) -> np.ndarray:
        parts = tuple(gains(vehicle.laws[f], steps[f]) for f in FAMILIES if f in vehicle.laws)
        return memo.recall("all gains", parts, lambda: np.concatenate(parts or (np.zeros(0),)))

    return _stacked([row(vehicle) for vehicle in vehicles], memo)


def memory_table(vehicles: Sequence[VehiclePlan], memo: Memo) -> np.ndarray:
    """(vehicle, memory) what the laws of each vehicle remember at the start, family after family.

    Args:
        vehicles: in the order of the engine.
        memo: of missions that are nearly the same.
    """
    size = len(vehicles)

    def row(vehicle: VehiclePlan) -> np.ndarray:
        parts = (vehicle.place, *(choice.law for choice in vehicle.laws.values()))
        return memo.recall("memory", parts, lambda: _memory_row(vehicle, size), (size, vehicle.believed_start))

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
        for name, value in zip(("north", "east"), vehicle.believed_start, strict=True):
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
