"""Shared water: the cycle that a fleet gets, how old what it hears is, and who speaks while another does."""

import math
from collections.abc import Iterator

from cardume.missions.checks.finding import Finding, Ranked, at_least, setting, setting_word, show, smallest, worst
from cardume.missions.checks.fixes import travel_time
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.medium_access import broadcast_slot, cycle_of, needed_slot, slot_of
from cardume.onboard.messaging.codec import COMPACT
from cardume.world.acoustics.modem import packet_loss, received_level

IN_TURN = ("tdma", "polling")
CLEAR = 0.02  # [-] share of packets that noise may take
MOST_GAIN = 300.0  # [dB]


def _in_turn(scene: Scene) -> list[Craft]:
    """The vehicles that take turns; those of one fleet have one kind of schedule."""
    return [craft for craft in scene.crafts if craft.law("messaging").law.name in IN_TURN]


def check_cycle(scene: Scene) -> Iterator[Finding]:
    """How often each vehicle's turn comes, and how old what is known of it is.

    Source: mean age tau + T (1 + p) / (2 (1 - p)) of messages every T that take tau, each lost with p; closed
        form S (docs/theory/closed-forms.md).
    """
    crafts = _in_turn(scene)
    if len(crafts) < 2:
        return
    fleet, tick = scene.plan.vehicles, scene.mission.tick
    slot, cycle = slot_of(crafts[0].plan, fleet, tick), cycle_of(crafts[0].plan, fleet, tick)
    place = scene.crafts.index(crafts[0])
    way = travel_time(crafts[0].plan, float(scene.distances[place].max()), tick)
    medium = crafts[0].plan.medium
    loss = medium.share if medium is not None else 0.0
    mean = way + cycle * (1.0 + loss) / (2.0 * (1.0 - loss))
    asked = crafts[0].law("messaging").law.name == "polling"
    lost = f", {100.0 * loss:.0f} % being lost" if loss > 0.0 else ""
    message = (
        f"each {'question and answer take' if asked else 'vehicle has'} a slot of {show(slot, 's')}, and a cycle takes"
        f" {show(cycle, 's')}: what is known of a vehicle was true {show(way, 's')} before it is heard and, on average,"
        f" {show(mean, 's')} ago{lost}"
    )
    if asked:
        message += f"; a fix is {show(slot, 's')} old, a question and its answer, when the vehicle below gets it"
    yield Finding("note", "messaging.schedule", message)


def check_slot(scene: Scene) -> Iterator[Finding]:
    """A slot that is given, and shorter than what is said in it."""
    crafts = _in_turn(scene)
    if len(crafts) < 2:
        return
    messaging, fleet, tick = crafts[0].law("messaging"), scene.plan.vehicles, scene.mission.tick
    given, needed = slot_of(crafts[0].plan, fleet, tick), needed_slot(messaging, fleet, tick)
    if given >= needed - 1e-9:
        return
    message = (
        f"a slot of {show(given, 's')} is shorter than modem, message, guard and {show(messaging.value('range'), 'm')}"
        f" of range need, {show(needed, 's')}: messages of one slot reach into the next"
    )
    yield Finding("warning", "messaging.slot", message, setting("messaging.slot", round(needed, 9), "s"))


def check_talking_at_once(scene: Scene) -> Iterator[Finding]:
    """Vehicles that share a modem's water and speak by their clocks, more than fits, or at the same time."""
    speakers = [craft for craft in scene.crafts if craft.law("messaging").law.name == "periodic" and craft.plan.medium]
    if len(speakers) < 2:
        return
    tick, reach = scene.mission.tick, float(scene.distances.max())
    slots = [tick * math.ceil(broadcast_slot(craft.plan, reach, 0.0) / tick - 1e-9) for craft in speakers]
    period = min(craft.law("messaging").value("period") for craft in speakers)
    shortest = min(speakers, key=lambda craft: craft.law("messaging").value("period"))
    key = scene.key(shortest, "messaging.period")
    if sum(slots) > period + 1e-9:
        message = (
            f"{len(speakers)} vehicles that share the water need {show(sum(slots), 's')} for one message each, on the"
            f" air and over {show(reach, 'm')}; they speak every {show(period, 's')}, and what overlaps is lost"
        )
        yield Finding("warning", key, message, setting(key, round(sum(slots), 9), "s"))
    elif both := _overlapping(speakers, max(slots), period):
        message = (
            f"{both[0]} and {both[1]} speak at the same time, every {show(period, 's')}: neither hears the other, and"
            " nobody hears both; give them offsets, or take turns"
        )
        yield Finding("error", "messaging.schedule", message, setting_word("messaging.schedule", "tdma"))


def _overlapping(speakers: list[Craft], slot: float, period: float) -> tuple[str, str] | None:
    """Two vehicles of one period whose messages always meet."""
    for k, one in enumerate(speakers):
        for other in speakers[:k]:
            first, second = one.law("messaging"), other.law("messaging")
            if first.value("period") == second.value("period") == period:
                apart = abs(math.remainder(first.value("offset") - second.value("offset"), period))
                if apart < slot - 1e-9:
                    return other.name, one.name
    return None


def check_noise(scene: Scene) -> list[Finding]:
    """Vehicles so far apart that noise drowns what they say."""
    return worst(ranked for k in range(len(scene.crafts)) for ranked in _drowned(scene, k))


def _drowned(scene: Scene, place: int) -> Iterator[Ranked]:
    craft, away = scene.crafts[place], float(scene.distances[place].max())
    medium = craft.plan.medium
    if medium is None or len(scene.crafts) < 2 or away > medium.max_range:
        return
    ratio = received_level(medium, away) - medium.noise_level
    loss = packet_loss(medium, ratio, medium.payload)
    if loss > CLEAR:
        lacking = smallest(lambda gain: packet_loss(medium, ratio + gain, medium.payload) <= CLEAR, 0.0, MOST_GAIN)
        key = scene.key(craft, "acoustics.source_level_db")
        message = (
            f"{craft.name} hears what is {show(away, 'm')} away {ratio:.1f} dB above the noise, at which its modem"
            f" loses {100.0 * loss:.0f} % of the packets"
        )
        yield Ranked(lacking, Finding("warning", key, message, at_least(key, medium.source_level + lacking, "dB")))


def check_codec(scene: Scene) -> list[Finding]:
    """Paths that lead where the compact codec has no numbers for."""
    if len(scene.crafts) < 2:
        return []
    return worst(ranked for craft in scene.crafts if craft.plan.grid is not None for ranked in _unsaid(scene, craft))


def _unsaid(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    key, stations = scene.key(craft, "acoustics.codec"), craft.stations
    numbers = (
        ("north", stations.north, COMPACT.position, "its fixes are not told"),
        ("east", stations.east, COMPACT.position, "its fixes are not told"),
        ("coordination state", stations.state, COMPACT.state, "coordination does without it"),
    )
    for name, values, said, consequence in numbers:
        beyond = max(float(values.max()) - said.high, said.low - float(values.min()))
        if beyond > 0.0:
            message = (
                f"{craft.name} comes {show(beyond, 'm')} beyond the numbers for {name} that a compact packet has,"
                f" {show(said.low, 'm')} to {show(said.high, 'm')}: there {consequence}"
            )
            yield Ranked(beyond, Finding("warning", key, message, setting_word(key, "exact")))
