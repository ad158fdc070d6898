"""Messages that only a vehicle of the fleet can have sent, each once.

A code of a few bytes follows the packet: HMAC-SHA256 over the whole sequence number, the whole time of validity and the
packet, cut short.  The receiver makes number and time whole by what it heard last and by its clock, checks the code,
and takes each number once, within a window that slides with the newest.  Needs the extra `cryptography`.

The code does not hide what is said.  A forger without the key has a chance of 2^(-8 n) with each packet, n the bytes of
the code, once more for every 25.6 s in which its sender was not heard: at the few packets a minute that a modem carries
four bytes take centuries.

What remains possible without the key: to drown messages; to hold one back that the receiver did not hear and to let it
hear it later, up to 25 s after it was sent, when it is read with the time at which it was true; to repeat one within
25 s to a receiver that has started anew; to answer a question in another's place as sound, so that a range is wrong,
though not what is said.  What was recorded in another mission with the same key is let in at the same time of this one:
give each mission a key of its own.  Whoever has the key can speak for every vehicle.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

from cardume.errors import InputError
from cardume.onboard.messaging.codec import (
    KIND_BITS,
    SENDER_BITS,
    SEQUENCE_BITS,
    TIME_BITS,
    Packet,
    PacketError,
    decode,
    whole_sequence,
    whole_ticks,
    whole_time,
)
from cardume.signals import Report

CODE_SIZE = 4  # [-] bytes of the code
WINDOW = 64  # [-] sequence numbers that may come late
LEAST_KEY = 16  # [-] bytes
LARGEST_GAP = 2**20  # [-] messages of a sender that may be missed in a row: a day at ten a second


def seal(packet: bytes, report: Report, key: bytes, code_size: int = CODE_SIZE) -> bytes:
    """A packet and its code.

    Args:
        packet: as `encode` made it.
        report: of which it was made; its sequence number is never used twice with a key.
        key: at least 16 secret bytes, those of the fleet in this mission.
        code_size: [-] bytes, 2 to 32.

    Raises:
        InputError: a key or a code too short, or `cryptography` is not installed.
    """
    return packet + _code(packet, round(report.sequence), whole_ticks(report.time_of_validity), key, code_size)


def _code(packet: bytes, sequence: int, ticks: int, key: bytes, code_size: int) -> bytes:
    if len(key) < LEAST_KEY or not 2 <= code_size <= 32:
        raise InputError(
            f"given a key of {len(key)} and a code of {code_size} bytes; a key has at least {LEAST_KEY}, a code 2 to 32"
        )
    try:
        from cryptography.hazmat.primitives import hashes, hmac
    except ImportError:
        raise InputError("authentication needs the package cryptography: pip install cardume[authentication]") from None
    maker = hmac.HMAC(key, hashes.SHA256())
    maker.update(sequence.to_bytes(8, "big") + ticks.to_bytes(8, "big", signed=True) + packet)
    return maker.finalize()[:code_size]


def _agree(one: bytes, other: bytes) -> bool:
    from cryptography.hazmat.primitives import constant_time

    return constant_time.bytes_eq(one, other)


@dataclass
class Window:
    """Which sequence numbers of a sender were taken.

    Attributes:
        newest: [-] the largest.
        taken: [-] which of those before it, a bit each.
        heard: [-] time of validity of the newest, in steps of 0.1 s.
    """

    newest: int = 0
    taken: int = 0
    heard: int = 0

    def candidates(self, low: int, ticks: int) -> Iterable[int]:
        """What a sequence number can be.

        The one nearest to the next; and, of a sender that was not heard for long, those a cycle of 256 later and so on,
        for it says at most one thing in 0.1 s.

        Args:
            low: [-] its last eight bits.
            ticks: [-] time of its validity, in steps of 0.1 s.
        """
        nearest = round(whole_sequence(low, self.newest))
        latest = self.newest + min(LARGEST_GAP, ticks - self.heard + 1)
        return range(nearest, max(nearest, latest) + 1, 2**SEQUENCE_BITS)

    def is_new(self, sequence: int) -> bool:
        """Whether a number was not taken yet, and is not older than the window."""
        behind = self.newest - sequence
        return sequence > 0 and (behind < 0 or (behind < WINDOW and not self.taken >> behind & 1))

    def take(self, sequence: int, ticks: int) -> None:
        """Note a number.

        Args:
            sequence: [-]
            ticks: [-] time of its validity, in steps of 0.1 s.
        """
        ahead = sequence - self.newest
        if ahead > 0:
            self.taken = (self.taken << ahead | 1) & (1 << WINDOW) - 1 if ahead < WINDOW else 1
            self.newest, self.heard = sequence, ticks
        else:
            self.taken |= 1 << -ahead


@dataclass
class Doorkeeper:
    """Lets in what a vehicle of the fleet said, once; remembers of each sender what was let in.

    Attributes:
        key: of the fleet.
        code_size: [-] bytes of the code.
        windows: by sender.
    """

    key: bytes
    code_size: int = CODE_SIZE
    windows: dict[int, Window] = field(default_factory=dict)

    def open(self, sealed: bytes, time: float) -> Packet:
        """Read a packet that is genuine and new.

        Args:
            sealed: as it came.
            time: [s] now, since the start of the mission; the sender's clock is at most 0.5 s ahead.

        Raises:
            PacketError: forged, damaged, cut short or heard before; nothing of it is to be believed.
        """
        packet, code = sealed[: -self.code_size], sealed[-self.code_size :]
        if len(packet) * 8 < KIND_BITS + SENDER_BITS + SEQUENCE_BITS + TIME_BITS:
            raise PacketError("too short for a packet and its code")
        sender, ticks = packet[0] & (1 << SENDER_BITS) - 1, whole_time(packet[2], time)
        window = self.windows.get(sender, Window())
        genuine = (
            number
            for number in window.candidates(packet[1], ticks)
            if _agree(code, _code(packet, number, ticks, self.key, self.code_size))
        )
        sequence = next(genuine, None)
        if sequence is None:
            raise PacketError("its code is not that of this fleet at this time")
        if not window.is_new(sequence):
            raise PacketError(f"number {sequence} of vehicle {sender} was heard before, or is too old")
        opened = decode(packet, time, sequence - 1.0)
        self.windows.setdefault(sender, window).take(sequence, ticks)
        return opened
