"""Messages: readings that wait for them, and how many a channel carries."""

import math
from collections.abc import Iterator

from cardume.missions.checks.finding import Finding, setting, show
from cardume.missions.checks.fixes import has_parameter, travel_time, waiting_time
from cardume.missions.checks.scene import Craft, Scene
from cardume.simulation.sizes import MOST_SLOTS

LONG_WAIT = 0.5  # of the readings' period


def _speakers(scene: Scene) -> list[Craft]:
    """The vehicles that speak at fixed intervals, to a fleet that is there to listen."""
    periodic = [craft for craft in scene.crafts if craft.law("messaging").law.name == "periodic"]
    return periodic if len(scene.crafts) > 1 else []


def check_waiting(scene: Scene) -> Iterator[Finding]:
    """USBL readings that are nearly as old as they get before a message carries them.

    Source: `periodic`, whose offset says when the vehicle speaks.
    """
    tick = scene.mission.tick
    for craft in _speakers(scene):
        usbl = craft.plan.laws.get("usbl")
        if usbl is None:
            continue
        every, period = usbl.value("period"), craft.law("messaging").value("period")
        wait = waiting_time(craft.plan, scene.plan.vehicles, tick)
        is_locked = abs(math.remainder(period, every)) < 0.5 * tick  # else no offset helps
        if not is_locked or wait < max(LONG_WAIT * every, 1.5 * tick):
            continue
        key = scene.key(craft, "messaging.offset")
        offset = tick * math.ceil(usbl.value("latency") / tick - 1e-6)
        message = (
            f"{craft.name} speaks {show(wait, 's')} after each of its USBL readings, one every {show(every, 's')}:"
            " the fixes it gives are that much older, and its own GNSS error is no longer theirs too"
        )
        yield Finding("warning", key, message, setting(key, round(offset, 9), "s"))


def check_load(scene: Scene) -> Iterator[Finding]:
    """More to say than fits: on one acoustic channel vehicles take turns, and each message takes its delay."""
    speakers = _speakers(scene)
    if not speakers or not has_parameter(speakers[0].law("acoustics"), "delay"):
        return
    delay = max(craft.law("acoustics").value("delay") for craft in speakers)
    busy = sum(delay / craft.law("messaging").value("period") for craft in speakers)
    if busy <= 1.0 + 1e-9:
        return
    shortest = min(speakers, key=lambda craft: craft.law("messaging").value("period"))
    key, tick = scene.key(shortest, "messaging.period"), scene.mission.tick
    period = tick * math.ceil(len(speakers) * delay / tick - 1e-6)
    message = (
        f"{len(speakers)} vehicles that speak in turn, {show(delay, 's')} each, need {100.0 * busy:.0f} % of the time:"
        " this channel lets them speak at once, a real one that they share does not"
    )
    yield Finding("warning", key, message, setting(key, round(period, 9), "s"))


def check_slots(scene: Scene) -> Iterator[Finding]:
    """Messages so frequent that the first is forgotten before it arrives."""
    for craft in _speakers(scene):
        period = craft.law("messaging").value("period")
        place = scene.crafts.index(craft)
        ways = [
            travel_time(other.plan, scene.distances[place, k], scene.mission.tick)
            for k, other in enumerate(scene.crafts)
            if other is not craft
        ]
        if max(ways) < MOST_SLOTS * period:
            continue
        key, tick = scene.key(craft, "messaging.period"), scene.mission.tick
        message = (
            f"{craft.name} says something every {show(period, 's')}, and it takes {show(max(ways), 's')} to be heard:"
            f" at most {MOST_SLOTS} of its messages are under way at once, older ones are overwritten"
        )
        needed = tick * (math.floor(max(ways) / MOST_SLOTS / tick + 1e-6) + 1)
        yield Finding("error", key, message, setting(key, round(needed, 9), "s"))
