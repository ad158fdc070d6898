"""Who tells a vehicle where it is, how often, and how late."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cardume.missions.medium_access import cycle_of, slot_of, time_on_air
from cardume.simulation.plan import Choice, VehiclePlan

EXCHANGES = 200  # messages followed to find how long a reading waits for one


@dataclass(frozen=True, kw_only=True)
class Fixes:
    """The fixes of one vehicle.

    Attributes:
        source: "gnss", or the vehicle whose USBL sees it; None: nobody.
        period: [s] between fixes, if none is lost; NaN: the schedule is a user's own law.
        loss: [-] share of them that is lost.
        wait: [s] from a reading's delivery to the message that carries it, on average.
        age: [s] from a fix's validity to its use, on average.
    """

    source: str | None = None
    period: float = math.nan
    loss: float = 0.0
    wait: float = 0.0
    age: float = 0.0

    @property
    def expected_gap(self) -> float:
        """Mean time [s] between fixes that arrive."""
        return self.period / (1.0 - self.loss)


AT_AN_ALTITUDE = 1.0  # [m] of depth at least, of a vehicle that keeps one


def has_gnss(vehicle: VehiclePlan) -> bool:
    """Whether a vehicle's GNSS works at the depth that it keeps."""
    gnss = vehicle.laws.get("gnss")
    if gnss is None or not has_parameter(gnss, "deepest"):
        return gnss is not None
    least = AT_AN_ALTITUDE if vehicle.orders.keeps_altitude else 0.0
    return max(vehicle.setup.depth, least) <= gnss.value("deepest")


def has_parameter(choice: Choice, name: str) -> bool:
    """Whether a law has a parameter of this name."""
    return any(parameter.name == name for parameter in choice.law.parameters)


def fixes_of(vehicles: Sequence[VehiclePlan], distances: np.ndarray, tick: float) -> list[Fixes]:
    """How each vehicle of a fleet learns where it is.

    A vehicle with a USBL head that has fixes itself gives fixes to all that hear it.

    Args:
        vehicles: the fleet.
        distances: (n, n) [m] largest distance of each pair in the formation and at the start.
        tick: [s]
    """
    found = [_by_gnss(vehicle) if has_gnss(vehicle) else Fixes() for vehicle in vehicles]
    for _ in vehicles:  # each round, those that have fixes give them to others
        for k, vehicle in enumerate(vehicles):
            if found[k].source is None:
                heard = [
                    _by_usbl(speaker, vehicle, vehicles, distances[j, k], tick)
                    for j, speaker in enumerate(vehicles)
                    if j != k and found[j].source is not None and can_hear(speaker, vehicle, distances[j, k])
                ]
                seen = [fixes for fixes in heard if fixes is not None]
                found[k] = min(seen, key=lambda fixes: np.nan_to_num(fixes.expected_gap, nan=1e9), default=Fixes())
    return found


def _by_gnss(vehicle: VehiclePlan) -> Fixes:
    gnss = vehicle.laws["gnss"]
    return Fixes(source="gnss", period=gnss.value("period"), age=gnss.value("latency"))


def can_hear(speaker: VehiclePlan, listener: VehiclePlan, distance: float) -> bool:
    """Whether messages of one vehicle ever reach another.

    Args:
        speaker: who sends.
        listener: whose side the channel's parameters are taken from.
        distance: [m] between them.
    """
    channel = listener.laws["acoustics"]
    if speaker.laws["messaging"].law.name == "silent":
        return False
    is_lost = has_parameter(channel, "loss") and channel.value("loss") >= 1.0
    return not is_lost and (not has_parameter(channel, "max_range") or distance <= channel.value("max_range"))


def travel_time(listener: VehiclePlan, distance: float, tick: float) -> float:
    """Time [s] from the sending of a message to the tick in which it is read.

    Args:
        listener: whose side the channel's parameters are taken from.
        distance: [m] to the speaker.
        tick: [s]
    """
    channel, medium, way = listener.laws["acoustics"], listener.medium, 0.0
    if medium is not None:
        way = time_on_air(listener) + distance / medium.sound_speed + medium.processing
    elif has_parameter(channel, "delay"):
        way = channel.value("delay")
    if medium is None and has_parameter(channel, "sound_speed"):
        way += distance / channel.value("sound_speed")
    return tick * max(1, math.ceil(way / tick - 1e-6))


def speaking(speaker: VehiclePlan, fleet: Sequence[VehiclePlan], tick: float) -> tuple[float, float] | None:
    """Period and offset [s] at which a vehicle speaks; None where its schedule goes by something else than the clock.

    Args:
        speaker: of the fleet.
        fleet: all, in any order.
        tick: [s]
    """
    messaging = speaker.laws["messaging"]
    if messaging.law.name == "periodic":
        return messaging.value("period"), messaging.value("offset")
    slot = slot_of(speaker, fleet, tick)
    if messaging.law.name == "tdma":
        return len(fleet) * slot, slot * sorted(v.name for v in fleet).index(speaker.name)
    if messaging.law.name == "polling":
        return (slot, 0.0) if "usbl" in speaker.laws else (cycle_of(speaker, fleet, tick), 0.0)
    return None


def _by_usbl(
    speaker: VehiclePlan, listener: VehiclePlan, fleet: Sequence[VehiclePlan], distance: float, tick: float
) -> Fixes | None:
    usbl, channel = speaker.laws.get("usbl"), listener.laws["acoustics"]
    if usbl is None or (has_parameter(usbl, "max_range") and distance > usbl.value("max_range")):
        return None
    spoken = speaking(speaker, fleet, tick)
    if spoken is None:
        return Fixes(source=speaker.name)
    loss = channel.value("loss") if has_parameter(channel, "loss") else 0.0
    if speaker.laws["messaging"].law.name == "polling":  # question, answer, and the next questions, of which one tells
        cycle, each = cycle_of(speaker, fleet, tick), spoken[0]
        told = 1.0 - loss ** max(1, round(cycle / each))
        return Fixes(source=speaker.name, period=cycle, loss=1.0 - (1.0 - loss) ** 2 * told, age=each)
    period, read = spoken[0], usbl.value("period")
    wait = waiting_time(speaker, fleet, tick)
    return Fixes(
        source=speaker.name,
        period=max(period, read),
        loss=loss ** max(1, math.floor(read / period + 1e-6)),  # a reading may be told several times
        wait=wait,
        age=usbl.value("latency") + wait + travel_time(listener, distance, tick),
    )


def waiting_time(speaker: VehiclePlan, fleet: Sequence[VehiclePlan], tick: float) -> float:
    """How long [s], on average, a USBL reading waits for the message that first carries it.

    Args:
        speaker: with a USBL, that speaks by the clock.
        fleet: all.
        tick: [s]
    """
    usbl, (period_s, offset) = speaker.laws["usbl"], speaking(speaker, fleet, tick) or (tick, 0.0)
    period, every = round(period_s / tick), max(1, round(usbl.value("period") / tick))
    latency, first = round(usbl.value("latency") / tick), math.ceil(offset / tick - 0.5)
    sent = first + max(1, period) * np.arange(EXCHANGES)
    newest = (sent - latency) // every  # number of the last reading delivered by then
    is_new = (newest >= 0) & (np.diff(newest, prepend=-1) > 0)
    waits = (sent - latency - newest * every)[is_new]
    return float(tick * waits.mean()) if len(waits) else 0.0
