"""Speak in turn: each vehicle has a slot of a cycle."""

from cardume.compiler import where
from cardume.laws import Meters, NotNegative, Positive, Seconds
from cardume.maths import floor
from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Outbox


@messaging_law
def tdma(
    outbox: Outbox,
    dt: Seconds,
    slot: NotNegative[Seconds] = 0.0,
    range: Positive[Meters] = 500.0,
    guard: NotNegative[Seconds] = 0.1,
) -> float:
    """Send at the beginning of one's own slot, which comes once in a cycle of as many slots as there are vehicles.

    send = t - place slot in {0, n slot, 2 n slot, ...}, to half a tick;   place: by name, from 0

    A slot that is left out is as long as the longest message of the fleet needs: time on the air, range over the speed
    of sound, the modem's processing and the guard, rounded up to whole ticks.  Clocks must agree to within the guard.

    Args:
        outbox: time, place and number of vehicles.
        dt: [s] tick.
        slot: [s] 0: what modem, message, range and guard need.
        range: [m] up to which a message is to have passed before the next slot.
        guard: [s] silence at the end of each slot, for clocks and echoes.

    Returns:
        1 to send, else 0.

    Source: time-division multiple access; the slot as in `missions/medium_access.py`.
    """
    each = where(slot > 0.0, slot, 1.0)
    cycle, since = outbox.size * each, outbox.time - outbox.place * each + 0.5 * dt
    begins = floor(since / cycle) > floor((since - dt) / cycle)
    return where(begins & (since > 0.0), 1.0, 0.0)
