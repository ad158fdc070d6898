"""A modem in the sea: time on the air, time of the way, noise, and links that are out for a while."""

from typing import Annotated, NamedTuple

from cardume.compiler import compiled, some, where
from cardume.laws import Once
from cardume.maths import floor
from cardume.signals import Arrival, Link
from cardume.world.acoustics.base import acoustics_law
from cardume.world.acoustics.fsk_error import fsk_packet_error
from cardume.world.acoustics.gilbert_elliott import is_out
from cardume.world.acoustics.medium import HALF, Medium, medium_of
from cardume.world.acoustics.packet_error import packet_error
from cardume.world.acoustics.spreading import transmission_loss

LONG_AGO = -1e9  # [s]


class LinkState(NamedTuple):
    """A link when something was last sent on it."""

    out: float = 0.0  # [-] 1: it was out
    time: float = LONG_AGO  # [s]


@compiled
def bytes_on_air(medium: Medium, payload: float) -> float:
    """Bytes that are sent for a message [-]: whole frames.

    Args:
        medium: of the modem.
        payload: [-] bytes of the message.
    """
    return -medium.frame * floor(-payload / medium.frame)


@compiled
def airtime(medium: Medium, payload: float) -> float:
    """Time that a message is on the air [s]: overhead, and its bytes in whole frames.

    Args:
        medium: of the modem.
        payload: [-] bytes.
    """
    return medium.overhead + medium.byte_time * bytes_on_air(medium, payload)


@compiled
def received_level(medium: Medium, distance: float) -> float:
    """Level at which a message is heard [dB re 1 uPa].

    Args:
        medium: of modem and water.
        distance: [m]
    """
    return medium.source_level - transmission_loss(distance, medium.spreading, medium.absorption)


@compiled
def packet_loss(medium: Medium, ratio_db: float, payload: float) -> float:
    """Probability that noise loses a message [-], by the curve that is chosen.

    Args:
        medium: of the modem.
        ratio_db: [dB] signal to noise in its band.
        payload: [-] bytes.
    """
    loss = packet_error(ratio_db, medium.half, medium.width)
    by_theory = medium.by_theory > HALF
    if some(by_theory):
        loss = where(by_theory, fsk_packet_error(ratio_db + medium.bit_gain, bytes_on_air(medium, payload)), loss)
    return loss


@acoustics_law
def modem(link: Link, memory: LinkState, medium: Annotated[Medium, Once(medium_of)]) -> tuple[Arrival, LinkState]:
    """A message takes its time on the air and on the way; noise loses some, and outages whole runs.

    delay = T + r / c + processing,   T = overhead + byte_time * bytes,   SNR = SL - TL(r) - NL,
    delivered = (draw_1 >= PER(SNR)) and not out and r <= max_range

    PER(SNR) is a logistic curve or, of `packet_errors: fsk`, theory.  Physics alone loses next to nothing below a
    kilometer or two; what is lost at sea is lost in runs, for reasons that no signal-to-noise ratio tells: so there
    are two layers, and the second, a link that is out for `burst` seconds and a share `loss` of the time, is what
    to set.  Both directions of a pair have outages of their own.  That modems cannot hear while they send, and that
    overlapping messages destroy each other, is up to the fleet that shares the water: simulation/contention.py.

    Args:
        link: range r, bytes, time and two uniform draws.
        memory: the link's state when it was last used.
        medium: modem, water and noise, computed once.

    Returns:
        Delay [s] and 1 when delivered or else 0, and the next memory.

    Source: sonar equation, Urick (1983); each part where it is computed; outages after Gilbert (1960).
    """
    delay = airtime(medium, link.payload) + link.range / medium.sound_speed + medium.processing
    ratio = received_level(medium, link.range) - medium.noise_level
    out = is_out(memory.out, link.time - memory.time, medium.share, medium.burst, link.draw_2)
    is_heard = link.draw_1 >= packet_loss(medium, ratio, link.payload)
    delivered = is_heard & (out < 0.5) & (link.range <= medium.max_range)
    after = where(link.sent > 0.5, LinkState(out, link.time + 0.0 * out), memory)
    return Arrival(delay, where(delivered, 1.0, 0.0)), after
