"""What the observer and consensus oracles share: flights to a moment, and what a law remembers then."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from cardume.laws import COLUMNS, FAMILIES
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.signals import VesselState
from cardume.simulation.fleet import VEHICLE
from cardume.simulation.fly import Flown, fly
from cardume.simulation.plan import Plan
from cardume.simulation.warming import warm_up
from flying import LAWS, limit


def plan_of(text: str) -> Plan:
    """The plan of a mission in a text, compiled; its laws written as `module:function` come from tests/laws."""
    known = catalog([LAWS])
    plan = make_plan(parse_mission(text, known), known).plan
    warm_up(plan)
    return plan


def fly_plan(text: str) -> Flown:
    """Fly the mission in a text and keep the engine's tables as they are at its end."""
    return fly(plan_of(text))


def memory_of(flown: Flown, family: str, vehicle: int = 0) -> np.ndarray:
    """What a law of one vehicle remembers after the flight; vehicles in the order of their names."""
    tables = flown.tables
    columns = tables.handles.reshape(tables.whole.size, len(FAMILIES), COLUMNS)[vehicle, FAMILIES.index(family)]
    _, _, first, width = columns
    start = vehicle * tables.whole.memory_width + int(first)
    return tables.memory[start : start + int(width)].copy()


def vessel_of(flown: Flown, vehicle: int = 0) -> VesselState:
    """The truth of one vehicle after the flight; vehicles in the order of their names."""
    start = vehicle * VEHICLE.width + VEHICLE.offsets[VesselState]
    return VesselState(*flown.tables.vehicles[start : start + len(VesselState._fields)])


def uniform(north: float, east: float) -> str:
    """A uniform current by its components [m/s]."""
    return f"{{type: uniform, speed: {math.hypot(north, east)!r}, towards: {math.atan2(east, north) % math.tau!r} rad}}"


def halved(tick: float, times: int = 3) -> tuple[float, ...]:
    """A tick and the halves that `limit` wants."""
    return tuple(tick / 2.0**k for k in range(times))


def relative(value: np.ndarray | Sequence[float], wanted: np.ndarray | Sequence[float]) -> float:
    """Distance of two values, or vectors, over the size of the wanted one."""
    return float(np.linalg.norm(np.subtract(value, wanted)) / np.linalg.norm(wanted))


def check_limit(
    value: Callable[[float], np.ndarray], wanted: np.ndarray, ticks: Sequence[float], accuracy: float = 1e-5
) -> None:
    """The Richardson limit of a vector is the wanted one, relative to its size, and it is approached at first order."""
    coarse, middle, fine = flown = [np.asarray(value(tick), float) for tick in ticks]
    by_tick = dict(zip(ticks, flown, strict=True))
    found = [limit(lambda tick, k=k: float(by_tick[tick][k]), ticks)[0] for k in range(len(wanted))]
    order = math.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine))
    print(f"relative error {relative(found, wanted):.1e}, order {order:.3f}")
    assert relative(found, wanted) < accuracy
    assert abs(order - 1.0) < 0.15
