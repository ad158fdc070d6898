"""Who speaks when, and for how long: message sizes, slots and cycles from modem, range and fleet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from cardume.missions.mission import Mission
from cardume.missions.vehicle import Vehicle
from cardume.onboard.messaging.codec import COMPACT
from cardume.onboard.mind import Grid
from cardume.simulation.plan import Choice, VehiclePlan
from cardume.simulation.sizes import MOST_SLOTS
from cardume.units import show_quantity
from cardume.world.acoustics.medium import Medium, medium_of
from cardume.world.acoustics.modem import airtime


def medium_for(channel: Choice, sightings: int) -> Medium | None:
    """Modem and water of a vehicle; None where its channel is no modem.

    Args:
        channel: its acoustics law.
        sightings: [-] how many other vehicles its messages tell of.
    """
    if channel.law.name != "modem" or not channel.law.is_builtin:
        return None
    medium = medium_of(**{p.name: channel.value(p.name) for p in channel.law.parameters})
    size = medium.payload if medium.payload > 0.0 else COMPACT.size(sightings) + medium.code
    return medium._replace(payload=float(size))


def grid_for(vehicle: Vehicle) -> Grid | None:
    """What is left of the numbers that a vehicle sends; None: all."""
    return COMPACT.grid if vehicle.acoustics.parameters.get("codec") == "compact" else None


def time_on_air(plan: VehiclePlan) -> float:
    """Time [s] that a message of a vehicle is on the air; where its channel does not say, its whole delay."""
    if plan.medium is not None:
        return airtime(plan.medium, plan.medium.payload)
    channel = plan.laws["acoustics"]
    return channel.value_or("delay", 0.0)


def broadcast_slot(sender: VehiclePlan, distance: float, guard: float) -> float:
    """Time [s] that a message needs: on the air, on the way, in the modem that hears it, and a guard.

    Args:
        sender: who speaks.
        distance: [m] that it is to reach.
        guard: [s]
    """
    return time_on_air(sender) + distance / _sound_speed(sender) + _processing(sender) + guard


def two_way_slot(head: VehiclePlan, other: VehiclePlan, distance: float, guard: float) -> float:
    """Time [s] that a question and its answer need: two travels.

    Args:
        head: who asks.
        other: who answers.
        distance: [m] that both are to reach.
        guard: [s]
    """
    way = distance / _sound_speed(head)
    return time_on_air(head) + time_on_air(other) + 2.0 * way + _processing(head) + _processing(other) + guard


def _on_modem(told: Vehicle, vehicle: VehiclePlan, size: int) -> VehiclePlan:
    sightings = size - 1 if "usbl" in vehicle.laws else 0
    return replace(vehicle, medium=medium_for(vehicle.laws["acoustics"], sightings), grid=grid_for(told))


def scheduled(mission: Mission, vehicles: Sequence[VehiclePlan]) -> tuple[VehiclePlan, ...]:
    """Give vehicles the modem that they share the water with, and slots that are left out the length that they need.

    Args:
        mission: with every value fixed.
        vehicles: its fleet.

    Raises:
        MissionError: a schedule that the fleet cannot keep.
    """
    if any(v.laws["acoustics"].law.name == "modem" for v in vehicles):
        vehicles = [_on_modem(told, v, len(vehicles)) for told, v in zip(mission.vehicles, vehicles, strict=True)]
    _refuse_overflow(mission, vehicles)
    names = {v.laws["messaging"].law.name for v in vehicles if v.laws["messaging"].law.is_builtin}
    if not names & {"tdma", "polling"}:
        return tuple(vehicles)
    heads = [v for v in vehicles if "usbl" in v.laws]
    if "polling" in names and (len(heads) != 1 or len(vehicles) < 2 or names != {"polling"}):
        raise mission.error(
            "messaging.schedule",
            f"polling needs one vehicle with a USBL head that asks all the others, which answer; here"
            f" {len(heads)} of {len(vehicles)} have one, and the schedules are {', '.join(sorted(names))}",
        )
    return tuple(_with_slot(v, slot_of(v, vehicles, mission.tick)) for v in vehicles)


def slot_of(vehicle: VehiclePlan, fleet: Sequence[VehiclePlan], tick: float) -> float:
    """The slot [s] of a vehicle that takes turns: given, or what is needed, in whole ticks; NaN of another schedule.

    Args:
        vehicle: one of the fleet.
        fleet: all.
        tick: [s]
    """
    messaging = vehicle.laws["messaging"]
    if messaging.law.name not in ("tdma", "polling") or not messaging.law.is_builtin:
        return math.nan
    given = messaging.value("slot")
    return given if given > 0.0 else needed_slot(messaging, fleet, tick)


def needed_slot(messaging: Choice, fleet: Sequence[VehiclePlan], tick: float) -> float:
    """The slot [s] that a schedule needs, in whole ticks.

    Args:
        messaging: its law, tdma or polling.
        fleet: all that take turns.
        tick: [s]
    """
    distance, guard = messaging.value("range"), messaging.value("guard")
    if messaging.law.name == "tdma":
        needed = max(broadcast_slot(other, distance, guard) for other in fleet)
    else:
        head = next(v for v in fleet if "usbl" in v.laws)
        needed = max(two_way_slot(head, other, distance, guard) for other in fleet if other is not head)
    return tick * math.ceil(needed / tick - 1e-9)


def cycle_of(vehicle: VehiclePlan, fleet: Sequence[VehiclePlan], tick: float) -> float:
    """Time [s] from one turn of a vehicle to its next; of the head that asks, to the same question.

    Args:
        vehicle: one of the fleet.
        fleet: all.
        tick: [s]
    """
    turns = len(fleet) - (vehicle.laws["messaging"].law.name == "polling")
    return turns * slot_of(vehicle, fleet, tick)


def _with_slot(vehicle: VehiclePlan, slot: float) -> VehiclePlan:
    if math.isnan(slot):
        return vehicle
    messaging = vehicle.laws["messaging"]
    told = Choice(messaging.law, {**messaging.parameters, "slot": slot})
    return replace(vehicle, laws={**vehicle.laws, "messaging": told})


def _refuse_overflow(mission: Mission, vehicles: Sequence[VehiclePlan]) -> None:
    """More messages of a sender under way at once than the engine has room for: older ones would be overwritten."""
    for vehicle in vehicles:
        messaging = vehicle.laws["messaging"]
        period = messaging.value_or("period", math.inf)
        delay = max(other.laws["acoustics"].value_or("delay", 0.0) for other in vehicles)
        if len(vehicles) > 1 and delay > MOST_SLOTS * period:
            raise mission.error(
                f"vehicles.{vehicle.name}.messaging.period",
                f"given {show_quantity(period, 's')}; a message takes {show_quantity(delay, 's')} to arrive, and at"
                f" most {MOST_SLOTS} of a vehicle's may be under way: at least"
                f" {show_quantity(mission.tick * math.ceil(delay / MOST_SLOTS / mission.tick - 1e-9), 's')}",
            )


def _sound_speed(plan: VehiclePlan) -> float:
    if plan.medium is not None:
        return plan.medium.sound_speed
    return plan.laws["acoustics"].value_or("sound_speed", 1500.0) or 1500.0


def _processing(plan: VehiclePlan) -> float:
    return plan.medium.processing if plan.medium is not None else 0.0
