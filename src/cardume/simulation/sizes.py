"""How much room a mission needs: messages under way, ticks that sensors look back, rows of the log of messages."""

import math
from collections.abc import Callable, Sequence

from cardume.signals import Forecast, Question
from cardume.simulation.fleet import SENSORS
from cardume.simulation.memo import Memo
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.world.acoustics.modem import airtime

FARTHEST_ANSWER = 3.0  # [s] on the way, beyond which an answer gives no USBL reading
MOST_SLOTS = 64  # messages of one sender under way at once


def sensors_of(vehicle: VehiclePlan) -> tuple[Choice | None, ...]:
    """The sensors of a vehicle in the order of SENSORS; None where it has none."""
    return tuple(vehicle.laws.get(sensor) for sensor in SENSORS)


def asks_for_fixes(vehicles: Sequence[VehiclePlan]) -> bool:
    """Whether a USBL reading comes with the answer to a question."""
    return any("usbl" in v.laws and v.laws["messaging"].law.asks_for(Question) for v in vehicles)


def num_slots(vehicles: Sequence[VehiclePlan], tick: float, memo: Memo) -> int:
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
    return vehicle.laws["acoustics"].value_or("delay", 2.0)


def _interval(vehicle: VehiclePlan, tick: float) -> float:
    """Shortest time [s] between two messages of a vehicle, the same in all lanes."""
    messaging = vehicle.laws["messaging"]
    if messaging.law.asks_for(Question) or messaging.law.asks_for(Forecast):
        return tick
    given = messaging.value_or("period", messaging.value_or("slot", 0.5))
    return max(tick, given)  # a slot of 0 is one that nobody has worked out; no law speaks twice in a tick


def past_ticks(vehicles: Sequence[VehiclePlan], tick: float, memo: Memo) -> int:
    """How many ticks sensors look back, and this one."""

    def longest(vehicle: VehiclePlan) -> float:
        sensors = [choice for choice in sensors_of(vehicle) if choice is not None]
        return memo.recall("latency", tuple(sensors), lambda: max([0.0, *(c.value("latency") for c in sensors)]))

    answer = max(_delay(v) for v in vehicles) + FARTHEST_ANSWER if asks_for_fixes(vehicles) else 0.0
    return 1 + max(math.ceil(answer / tick - 1e-9), *(round(longest(vehicle) / tick) for vehicle in vehicles))


def message_room(plan: Plan, vehicles: Sequence[VehiclePlan], widest: int) -> int:
    """How many rows the log of messages needs at most [-].

    Args:
        plan: for its duration.
        vehicles: in the order of the engine.
        widest: [-] links per listener, at most.
    """
    messaging = [v.laws["messaging"] for v in vehicles]
    periods = [choice.value_or("period", choice.value_or("slot", plan.tick)) for choice in messaging]
    return int(len(vehicles) * widest * (plan.duration / max(plan.tick, min(periods)) + 2))
