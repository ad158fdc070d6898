"""Messages in the water: sent, delayed, lost, heard.

Each sender has a few slots for messages that are under way; each link (a listener and one of its
sources) knows when the message of each slot arrives.
"""

from cardume.compiler import Rows, at, compiled, load, some, store, where
from cardume.maths import hypot
from cardume.maths.random import Key, uniforms
from cardume.onboard.messaging.rounding import rounded_sighting
from cardume.onboard.mind import (
    FLAG,
    HEAD,
    ROUNDS,
    get_grid,
    get_last_seen,
    get_news,
    get_seen,
    get_setup,
    head_of,
    put_head,
    put_seen,
)
from cardume.onboard.telling import Said
from cardume.signals import NOTHING, Link, Sighting
from cardume.simulation.contention import contend
from cardume.simulation.faults import delivered_in_fault, intrude, record_packet, sending_in_fault
from cardume.simulation.fleet import NEVER, Fleet, book_of, features_of, get_medium, get_vessel, sources_of
from cardume.simulation.recording import next_row, write_message
from cardume.simulation.score import note_heard, note_sent
from cardume.simulation.sensing import LINK, key_of
from cardume.world.acoustics.base import propagate


@compiled
def arrived(fleet: Fleet, listener: int, time: float) -> Rows:
    """Bring a listener's inbox up to now and return it."""
    sources = sources_of(fleet, listener)
    for source in range(load(sources, 0)):
        link = listener * fleet.air.widest + source
        store(at(fleet.air.inbox, link * fleet.air.messages), FLAG, 0.0)
        if some(load(fleet.air.due, link) <= time):
            collect(fleet, listener, link, load(sources, source + 1), time)
    intrude(fleet.faults.kinds, fleet, listener, time)
    return inbox_of(fleet, listener)


@compiled
def inbox_of(fleet: Fleet, listener: int) -> Rows:
    """What a listener last heard from each of its sources."""
    return at(fleet.air.inbox, listener * fleet.air.widest * fleet.air.messages)


@compiled
def collect(fleet: Fleet, listener: int, link: int, sender: int, time: float) -> None:
    """Move what has arrived on a link into the inbox; of two, the one sent later."""
    message = at(fleet.air.inbox, link * fleet.air.messages)
    arrivals = at(fleet.air.arrivals, link * fleet.air.slots)
    following = 0.0 * load(message, FLAG) + NEVER
    for slot in range(fleet.air.slots):
        arrival = load(arrivals, slot)
        here = arrival <= time
        if some(here):
            sent = message_in(fleet, sender, slot)
            note_heard(fleet, listener, here, time - head_of(sent).time_of_validity)
            copy_if_newer(message, sent, here, extent_of(fleet, sender))
            store(arrivals, slot, where(here, NEVER, arrival))
        waiting = where(here, NEVER, arrival)
        following = where(waiting < following, waiting, following)
    store(fleet.air.due, link, following)


@compiled
def message_in(fleet: Fleet, sender: int, slot: int) -> Rows:
    """A message under way."""
    return at(fleet.air.outbox, (sender * fleet.air.slots + slot) * fleet.air.messages)


@compiled
def extent_of(fleet: Fleet, sender: int) -> int:
    """How many numbers of a sender's messages are ever written [-]: the head alone where it tells of nobody else."""
    return fleet.air.messages if some(get_setup(fleet.minds, sender).shares_sightings > 0.5) else HEAD


@compiled
def copy_if_newer(message: Rows, sent: Rows, here: bool, width: int) -> None:
    """Copy a message into an inbox entry unless a later one has come in this very tick."""
    newer = here & ((load(message, FLAG) < 0.5) | (head_of(sent).sequence > head_of(message).sequence))
    fresh = where(newer, 1.0, load(message, FLAG))
    for k in range(width):
        store(message, k, where(newer, load(sent, k), load(message, k)))
    store(message, FLAG, fresh)


@compiled
def speak(fleet: Fleet, sender: int, said: Said, time: float) -> None:
    """Put what a vehicle says in this tick, if anything, into the water."""
    sending = said.report.sending
    sending = sending_in_fault(fleet.faults.kinds, fleet, sender, sending, time)
    sends = sending > 0.5
    store(fleet.air.sending, sender, sending)
    if some(sends):
        count = load(fleet.air.sent, sender)
        store(fleet.air.sent, sender, count + 1)
        message = message_in(fleet, sender, count % fleet.air.slots)
        put_head(at(message, 1), 0, where(sends, said.report, head_of(message)))
        tells = sends & (get_setup(fleet.minds, sender).shares_sightings > 0.5)
        if some(tells):
            tell_of_others(fleet, sender, said, at(message, HEAD), tells)
        note_sent(fleet, sender, sends)
        record_packet(fleet.faults.kinds, fleet, sender, message, sends, time)


@compiled
def tell_of_others(fleet: Fleet, sender: int, said: Said, sightings: Rows, tells: bool) -> None:
    """Write into a message what its sender knows of every vehicle.

    Args:
        fleet: the mission.
        sender: who speaks.
        said: what it says.
        sightings: (vehicle, Sighting) of the message.
        tells: [-] whether it does, in each lane.
    """
    for other in range(fleet.size):
        where_seen, news = get_last_seen(said.others, other), get_news(said.others, other)
        seen = Sighting(
            where_seen.north,
            where_seen.east,
            where_seen.time_of_fix,
            news.state,
            news.path_speed,
            news.time_of_validity,
            news.phase,
            where_seen.north_variance,
            where_seen.covariance,
            where_seen.east_variance,
            where_seen.range,
            where_seen.range_variance,
            where_seen.depth,
        )
        if load(features_of(fleet, sender), ROUNDS) > 0:
            seen = rounded_sighting(seen, said.report.time_of_validity, get_grid(fleet.minds, sender))
        put_seen(sightings, other, where(tells, seen, get_seen(sightings, other)))


@compiled
def carry(fleet: Fleet, time: float, now: int) -> None:
    """Let sound travel: decide for every message sent in this tick when, and whether, each link delivers it."""
    for listener in range(fleet.size):
        sources = sources_of(fleet, listener)
        for source in range(load(sources, 0)):
            sender = load(sources, source + 1)
            if some(load(fleet.air.sending, sender) > 0.5):
                transmit(fleet, sender, listener, listener * fleet.air.widest + source, time, now)
    if fleet.air.is_shared > 0:
        contend(fleet, time)


@compiled
def transmit(fleet: Fleet, sender: int, listener: int, link: int, time: float, now: int) -> None:
    """One message on its way to one listener; each pair of vehicles has its own draws."""
    sends = load(fleet.air.sending, sender) > 0.5
    here, there = get_vessel(fleet.vehicles, sender), get_vessel(fleet.vehicles, listener)
    level_distance = hypot(there.north - here.north, there.east - here.east)
    own, others = key_of(fleet, listener, LINK), key_of(fleet, sender, LINK)
    pair = Key(own.seed_low, own.seed_high, own.stream, own.vehicle_low, others.vehicle_low)
    draw_1, draw_2, _, _ = uniforms(pair, now)
    payload = 0.0 * level_distance
    if fleet.air.is_shared > 0:
        payload = get_medium(fleet.air.modems, sender).payload
    slant = Link(hypot(level_distance, there.depth - here.depth), draw_1, draw_2, time, payload, where(sends, 1.0, 0.0))
    arrival = propagate(book_of(fleet, listener, fleet.tick), sender, slant)
    delivered = arrival.delivered > 0.5
    delivered = delivered_in_fault(fleet.faults.kinds, fleet, listener, delivered, time + arrival.delay)
    slot = (load(fleet.air.sent, sender) - 1) % fleet.air.slots
    arrives = where(delivered, time + arrival.delay, NEVER)
    row = link * fleet.air.slots + slot
    store(fleet.air.arrivals, row, where(sends, arrives, load(fleet.air.arrivals, row)))
    due = load(fleet.air.due, link)
    store(fleet.air.due, link, where(sends & (arrives < due), arrives, due))
    validity = head_of(message_in(fleet, sender, slot)).time_of_validity
    if fleet.air.is_shared > 0:
        store(fleet.air.logged, row, next_row(fleet))
    received, lost = where(delivered, arrives, NOTHING), where(delivered, 0.0, 1.0)
    write_message(fleet, time, received, sender, listener, lost, validity)
