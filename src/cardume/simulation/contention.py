"""Modems share the water: they cannot hear while they send, and of messages that overlap the louder is heard, or none.

A message sounds at every vehicle, whether that listens or not, from r / c after its sending for as long as it is on
the air.  Where two overlap each is lost unless it is louder by the listener's `capture`; a vehicle's own voice drowns
all.  A modem that is still sending does not send another message.
"""

from cardume.compiler import compiled, load, some, store, where
from cardume.maths import hypot
from cardume.simulation.fleet import (
    NEVER,
    Fleet,
    OnAir,
    get_medium,
    get_on_air,
    get_vessel,
    put_on_air,
    sources_of,
)
from cardume.simulation.recording import note_lost
from cardume.world.acoustics.modem import airtime, received_level

OWN_LEVEL = 1e9  # [dB] of a vehicle's own voice
SILENT = -1.0  # [s] end of what never sounds


@compiled
def contend(fleet: Fleet, time: float) -> None:
    """Let the messages that are sent in this tick sound at all vehicles, and see which destroy which."""
    for sender in range(fleet.size):
        if some(load(fleet.air.sending, sender) > 0.5):
            sound_everywhere(fleet, sender, time)
    for sender in range(fleet.size):
        if some(load(fleet.air.sending, sender) > 0.5):
            for listener in range(fleet.size):
                overlap(fleet, listener, sender)


@compiled
def slot_of(fleet: Fleet, sender: int) -> int:
    """The slot of a vehicle's last message."""
    return (load(fleet.air.sent, sender) - 1) % fleet.air.slots


@compiled
def row_of(fleet: Fleet, listener: int, sender: int, slot: int) -> int:
    """Where it stands how a message sounds at a vehicle."""
    return (listener * fleet.size + sender) * fleet.air.slots + slot


@compiled
def is_speaking(fleet: Fleet, sender: int, slot: int, time: float) -> bool:
    """Whether the modem of a vehicle is still sending a message of its own [-]."""
    own = get_on_air(fleet.air.on_air, row_of(fleet, sender, sender, slot))
    return (own.start <= time) & (time < own.end)


@compiled
def sound_everywhere(fleet: Fleet, sender: int, time: float) -> None:
    """Note when, and how loud, a vehicle's message of this tick is heard by each, itself among them."""
    sends, slot = load(fleet.air.sending, sender) > 0.5, slot_of(fleet, sender)
    medium, here = get_medium(fleet.air.modems, sender), get_vessel(fleet.vehicles, sender)
    lasts, busy = airtime(medium, medium.payload), is_speaking(fleet, sender, 0, time)
    for earlier in range(1, fleet.air.slots):
        busy = busy | is_speaking(fleet, sender, earlier, time)
    for listener in range(fleet.size):
        there, row = get_vessel(fleet.vehicles, listener), row_of(fleet, listener, sender, slot)
        away = hypot(hypot(there.north - here.north, there.east - here.east), there.depth - here.depth)
        start = time + away / medium.sound_speed
        if listener == sender:
            heard = OnAir(start, start + lasts, OWN_LEVEL + 0.0 * away)
        else:
            heard = OnAir(start, start + lasts, received_level(medium, away))
        heard = where(busy, OnAir(SILENT, SILENT, 0.0), heard)
        put_on_air(fleet.air.on_air, row, where(sends, heard, get_on_air(fleet.air.on_air, row)))
        lose(fleet, listener, sender, slot, sends & busy)


@compiled
def overlap(fleet: Fleet, listener: int, sender: int) -> None:
    """Compare a vehicle's message of this tick with all others that sound at a listener."""
    sends, slot = load(fleet.air.sending, sender) > 0.5, slot_of(fleet, sender)
    new = get_on_air(fleet.air.on_air, row_of(fleet, listener, sender, slot))
    capture = get_medium(fleet.air.modems, listener).capture
    for other in range(fleet.size):
        for earlier in range(fleet.air.slots):
            if other != sender or earlier != slot:
                old = get_on_air(fleet.air.on_air, row_of(fleet, listener, other, earlier))
                both = sends & (old.start < new.end) & (new.start < old.end)
                if some(both):
                    lose(fleet, listener, sender, slot, both & (new.level < old.level + capture))
                    lose(fleet, listener, other, earlier, both & (old.level < new.level + capture))


@compiled
def lose(fleet: Fleet, listener: int, sender: int, slot: int, lost: bool) -> None:
    """A message does not reach a listener after all.

    Args:
        fleet: the mission.
        listener: who was to hear it.
        sender: who sent it.
        slot: which of its messages.
        lost: [-] whether it is, in each lane.
    """
    if some(lost):
        sources = sources_of(fleet, listener)
        for source in range(load(sources, 0)):
            if load(sources, source + 1) == sender:
                row = (listener * fleet.air.widest + source) * fleet.air.slots + slot
                pending = load(fleet.air.arrivals, row)
                is_new = lost & (pending < NEVER)
                note_lost(fleet, load(fleet.air.logged, row), is_new)
                store(fleet.air.arrivals, row, where(is_new, NEVER, pending))
