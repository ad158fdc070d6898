"""From the faults of a plan to the tables that the engine looks at."""

from typing import Any

import numpy as np

from cardume.maths.random import random_key
from cardume.simulation.faults import CLOCK_COLUMNS
from cardume.simulation.fleet import FAULT_COLUMNS, FAULTS
from cardume.simulation.plan import FaultPlan, Plan
from cardume.world.faults import CLOCK, Fault, Kept


def fault_tables(plan: Plan, message_width: int) -> dict[str, np.ndarray]:
    """The tables of a mission's faults.

    Args:
        plan: the mission, with faults.
        message_width: [-] numbers in a message.
    """
    places = {plan.vehicles[k].name: place for place, k in enumerate(plan.order)}
    rows = [_row(fault, plan) for fault in plan.faults]
    kinds = [[f.kind, -1 if f.vehicle is None else places[f.vehicle], f.sensor] for f in plan.faults]
    clocks = [_clock(f, places) for f in plan.faults if f.kind == CLOCK]
    return {
        "fault_kinds": np.array(kinds, np.int64).reshape(-1, FAULT_COLUMNS).ravel(),
        "faults": np.concatenate(rows),
        "recordings": np.full(len(rows) * message_width, np.nan),
        "clocks": np.array(clocks or [[0.0] * CLOCK_COLUMNS]).ravel(),
    }


def num_clocks(plan: Plan) -> int:
    """How many clocks go wrong [-]."""
    return sum(fault.kind == CLOCK for fault in plan.faults)


def _row(fault: FaultPlan, plan: Plan) -> np.ndarray:
    row = np.zeros(FAULTS.width)
    key = random_key(plan.seed, f"fault {fault.kind}", fault.vehicle or "")
    parts: list[Any] = [fault.numbers, fault.weakness, Kept(np.nan, np.nan) if fault.keeps_reading else Kept(), key]
    for part in parts:
        start = FAULTS.offsets[type(part)]
        row[start : start + len(part)] = part
    return row


def _clock(fault: FaultPlan, places: dict[str, int]) -> list[float]:
    numbers: Fault = fault.numbers
    place = places[fault.vehicle or ""]
    return [float(place), numbers.begin, numbers.end, numbers.size, numbers.more]
