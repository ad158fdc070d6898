"""Messages that only a vehicle of the fleet can have sent, each once.

A code of a few bytes follows the packet: HMAC-SHA256 over the sender, the whole sequence number and the packet, cut
short.  The receiver makes the sequence number whole, checks the code, and takes each number once, within a window that
slides with the newest.  Needs the extra `cryptography`.

The code does not hide what is said.  A forger without the key has a chance of 2^(-8 n) with each packet that it sends,
n the bytes of the code: at the few packets a minute that a modem carries four bytes take centuries.
"""

from dataclasses import dataclass, field

from cardume.errors import InputError
from cardume.onboard.messaging.codec import (
    KIND_BITS,
    SENDER_BITS,
    SEQUENCE_BITS,
    Packet,
    PacketError,
    decode,
    whole_sequence,
)

CODE_SIZE = 4  # [-] bytes of the code
WINDOW = 64  # [-] sequence numbers that may come late
LEAST_KEY = 16  # [-] bytes


def seal(packet: bytes, sequence: int, key: bytes, code_size: int = CODE_SIZE) -> bytes:
    """A packet and its code.

    Args:
        packet: as `encode` made it.
        sequence: [-] its whole number, never used twice with a key.
        key: at least 16 secret bytes, those of the sender's fleet.
        code_size: [-] bytes, 2 to 32.

    Raises:
        InputError: a key or a code too short, or `cryptography` is not installed.
    """
    return packet + _code(packet, sequence, key, code_size)


def _code(packet: bytes, sequence: int, key: bytes, code_size: int) -> bytes:
    if len(key) < LEAST_KEY or not 2 <= code_size <= 32:
        raise InputError(
            f"given a key of {len(key)} and a code of {code_size} bytes; a key has at least {LEAST_KEY}, a code 2 to 32"
        )
    try:
        from cryptography.hazmat.primitives import hashes, hmac
    except ImportError:
        raise InputError("authentication needs the package cryptography: pip install cardume[authentication]") from None
    maker = hmac.HMAC(key, hashes.SHA256())
    maker.update(sequence.to_bytes(8, "big") + packet)
    return maker.finalize()[:code_size]


def _agree(one: bytes, other: bytes) -> bool:
    from cryptography.hazmat.primitives import constant_time

    return constant_time.bytes_eq(one, other)


@dataclass
class Window:
    """Which sequence numbers of a sender were taken: the newest, and which of those before it, a bit each."""

    newest: int = 0
    taken: int = 0

    def is_new(self, sequence: int) -> bool:
        """Whether a number was not taken yet, and is not older than the window."""
        behind = self.newest - sequence
        return sequence > 0 and (behind < 0 or (behind < WINDOW and not self.taken >> behind & 1))

    def take(self, sequence: int) -> None:
        """Note a number."""
        ahead = sequence - self.newest
        if ahead > 0:
            self.taken = (self.taken << ahead | 1) & (1 << WINDOW) - 1 if ahead < WINDOW else 1
            self.newest = sequence
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
            time: [s] now.

        Raises:
            PacketError: forged, damaged, cut short or heard before; nothing of it is to be believed.
        """
        packet, code = sealed[: -self.code_size], sealed[-self.code_size :]
        if len(packet) * 8 < KIND_BITS + SENDER_BITS + SEQUENCE_BITS:
            raise PacketError("too short for a packet and its code")
        sender = packet[0] & (1 << SENDER_BITS) - 1
        window = self.windows.get(sender, Window())
        sequence = round(whole_sequence(packet[1], window.newest))
        if not _agree(code, _code(packet, sequence, self.key, self.code_size)):
            raise PacketError("its code is not that of this fleet")
        if not window.is_new(sequence):
            raise PacketError(f"number {sequence} of vehicle {sender} was heard before, or is too old")
        opened = decode(packet, time, window.newest)
        self.windows.setdefault(sender, window).take(sequence)
        return opened
