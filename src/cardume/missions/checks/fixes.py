"""Who tells a vehicle where it is, how often, and how late."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
                    _by_usbl(speaker, vehicle, distances[j, k], tick)
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
    channel, way = listener.laws["acoustics"], 0.0
    if has_parameter(channel, "delay"):
        way = channel.value("delay")
    if has_parameter(channel, "sound_speed"):
        way += distance / channel.value("sound_speed")
    return tick * max(1, math.ceil(way / tick - 1e-6))


def _by_usbl(speaker: VehiclePlan, listener: VehiclePlan, distance: float, tick: float) -> Fixes | None:
    usbl, messaging, channel = speaker.laws.get("usbl"), speaker.laws["messaging"], listener.laws["acoustics"]
    if usbl is None or (has_parameter(usbl, "max_range") and distance > usbl.value("max_range")):
        return None
    if messaging.law.name != "periodic":
        return Fixes(source=speaker.name)
    spoken, read = messaging.value("period"), usbl.value("period")
    loss = channel.value("loss") if has_parameter(channel, "loss") else 0.0
    wait = waiting_time(speaker, tick)
    return Fixes(
        source=speaker.name,
        period=max(spoken, read),
        loss=loss ** max(1, math.floor(read / spoken + 1e-6)),  # a reading may be told several times
        wait=wait,
        age=usbl.value("latency") + wait + travel_time(listener, distance, tick),
    )


def waiting_time(speaker: VehiclePlan, tick: float) -> float:
    """How long [s], on average, a USBL reading waits for the message that first carries it.

    Args:
        speaker: with a USBL and a periodic schedule.
        tick: [s]
    """
    usbl, messaging = speaker.laws["usbl"], speaker.laws["messaging"]
    period, every = round(messaging.value("period") / tick), max(1, round(usbl.value("period") / tick))
    latency, first = round(usbl.value("latency") / tick), math.ceil(messaging.value("offset") / tick - 0.5)
    sent = first + max(1, period) * np.arange(EXCHANGES)
    newest = (sent - latency) // every  # number of the last reading delivered by then
    is_new = (newest >= 0) & (np.diff(newest, prepend=-1) > 0)
    waits = (sent - latency - newest * every)[is_new]
    return float(tick * waits.mean()) if len(waits) else 0.0
