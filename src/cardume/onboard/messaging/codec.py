"""Messages in few bits: numbers with a range and a resolution, packed one after the other.

Plain Python, for programs on real vehicles; the simulation needs only the sizes and the rounding, rounding.py, which
is the codec's too.

A packet: kind 2, sender 6, sequence 8, time 8 bits, then the sender's own state, then a sighting of each other vehicle
in seven bytes.  Sequence and time are sent modulo 256 and 25.6 s, and made whole again by whoever knows roughly what
they are.  A question is a kind of its own; whom it asks follows from its number.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from cardume.errors import InputError
from cardume.onboard.messaging.polling import asked_in_turn
from cardume.onboard.messaging.rounding import rounded_report, rounded_sighting
from cardume.onboard.mind import UNTOLD, Grid
from cardume.onboard.phases import PHASES
from cardume.signals import NOTHING, Report, Sighting

STATEMENT, QUESTION = 1, 2  # kinds
KIND_BITS, SENDER_BITS, SEQUENCE_BITS, TIME_BITS = 2, 6, 8, 8
PHASE_BITS = 3
TIME_STEP = 0.1  # [s] of a message's time
CLOCK_SLACK = 0.5  # [s] by which the sender's clock may be ahead of the receiver's
MOST_SENDERS = 2**SENDER_BITS


class PacketError(InputError):
    """A packet that is not one of ours, or that says more than it can."""


@dataclass(frozen=True)
class Range:
    """A number as it is sent: a multiple of a step between two ends, or nothing.

    Attributes:
        low: [any] the smallest.
        step: [any] its resolution.
        bits: [-] it takes; the last of its values means nothing.
    """

    low: float
    step: float
    bits: int

    @property
    def high(self) -> float:
        """The largest number that can be said."""
        return self.low + self.step * self.last

    @property
    def last(self) -> float:
        """How many steps the largest is above the smallest [-]."""
        return float(2**self.bits - 2)

    @property
    def nothing(self) -> int:
        """What is sent for no number."""
        return 2**self.bits - 1

    def encode(self, value: float, name: str) -> int:
        """The whole number that is sent.

        Args:
            value: NaN: nothing.
            name: what it is, for the error.

        Raises:
            PacketError: outside the range.
        """
        if math.isnan(value):
            return self.nothing
        code = math.floor((value - self.low) / self.step + 0.5) if math.isfinite(value) else -1
        if not 0 <= code < self.nothing:
            raise PacketError(f"{name} = {value:g} cannot be sent: it must be {self.low:g} to {self.high:g}")
        return code

    def decode(self, code: int) -> float:
        """The number that a code means."""
        return NOTHING if code == self.nothing else self.low + self.step * code


@dataclass(frozen=True)
class Dictionary:
    """What numbers are sent, and how.

    A fix (two coordinates and its age) and a state (coordination state, path speed and phase) take 7 bytes, as the
    latitude and longitude of MEDUSA do.

    Attributes:
        position: [m] north and east from the mission's origin.
        state: [m] coordination state.
        path_speed: [m/s] its rate.
        age: [s] of a sighting when it is said.
    """

    position: Range = field(default_factory=lambda: Range(-3276.6, 0.2, 15))
    state: Range = field(default_factory=lambda: Range(-500.0, 0.25, 14))
    path_speed: Range = field(default_factory=lambda: Range(-0.5, 0.05, 5))
    age: Range = field(default_factory=lambda: Range(0.0, 0.4, 4))

    @property
    def state_bits(self) -> int:
        """Bits of a state: coordination state, path speed and phase."""
        return self.state.bits + self.path_speed.bits + PHASE_BITS

    @property
    def sighting_bits(self) -> int:
        """Bits of a fix and a state."""
        return 2 * self.position.bits + self.age.bits + self.state_bits

    @property
    def grid(self) -> Grid:
        """What is left of the numbers."""
        position, state, speed = (
            (each.low, each.step, each.last) for each in (self.position, self.state, self.path_speed)
        )
        return Grid(TIME_STEP, self.age.step, self.age.last, *position, *state, *speed)

    def size(self, sightings: int) -> int:
        """Bytes of a packet.

        Args:
            sightings: [-] how many vehicles it tells of beside the sender.
        """
        header = KIND_BITS + SENDER_BITS + SEQUENCE_BITS + TIME_BITS
        return math.ceil((header + self.state_bits + sightings * self.sighting_bits) / 8)


COMPACT = Dictionary()


class _Writer:
    def __init__(self) -> None:
        self.value = self.bits = 0

    def put(self, code: int, bits: int) -> None:
        self.value, self.bits = self.value << bits | code, self.bits + bits

    def to_bytes(self) -> bytes:
        padding = -self.bits % 8
        return (self.value << padding).to_bytes((self.bits + padding) // 8, "big")


class _Reader:
    def __init__(self, data: bytes) -> None:
        self.value, self.left = int.from_bytes(data, "big"), 8 * len(data)

    def take(self, bits: int) -> int:
        self.left -= bits
        return self.value >> self.left & (1 << bits) - 1


@dataclass(frozen=True)
class Packet:
    """A message as it was read.

    Attributes:
        sender: [-] its number.
        report: of the sender itself.
        sightings: by the numbers of the other vehicles.
    """

    sender: int
    report: Report
    sightings: Mapping[int, Sighting]


def encode(sender: int, report: Report, sightings: Sequence[Sighting] = (), dictionary: Dictionary = COMPACT) -> bytes:
    """Pack a message; what it says is rounded, and left out where it is too old or out of range.

    Args:
        sender: [-] number of the vehicle, below 64.
        report: what it says of itself.
        sightings: of the other vehicles, in the order of their numbers without the sender's.
        dictionary: how numbers are sent.

    Returns:
        The packet.

    Raises:
        PacketError: a sender, number, time or question that no packet can say.
    """
    if not 0 <= sender < MOST_SENDERS:
        raise PacketError(f"sender = {sender} cannot be sent: it must be 0 to {MOST_SENDERS - 1}")
    for name in ("sequence", "time_of_validity", "phase"):
        if not math.isfinite(value := getattr(report, name)):
            raise PacketError(f"{name} = {value:g} cannot be sent: it must be a number")
    if report.asks not in (-1.0, turn := _asked(report.sequence, sender, len(sightings))):
        raise PacketError(
            f"asks = {report.asks:g} cannot be sent: question {report.sequence:g} of vehicle {sender}, which tells of"
            f" {len(sightings)} others, asks vehicle {turn:g}"
        )
    told = rounded_report(report, dictionary.grid)
    out = _Writer()
    out.put(STATEMENT if told.asks < 0.0 else QUESTION, KIND_BITS)
    out.put(sender, SENDER_BITS)
    out.put(round(told.sequence) % 2**SEQUENCE_BITS, SEQUENCE_BITS)
    out.put(whole_ticks(told.time_of_validity) % 2**TIME_BITS, TIME_BITS)
    _put_state(out, told.coordination_state, told.path_speed, told.phase, dictionary)
    for seen in sightings:
        _put_sighting(out, rounded_sighting(seen, told.time_of_validity, dictionary.grid), told, dictionary)
    return out.to_bytes()


def whole_ticks(time: float) -> int:
    """A time [s] in whole steps of 0.1 s, of which a packet says the last eight bits."""
    return math.floor(time / TIME_STEP + 0.5)


def _asked(sequence: float, sender: int, others: int) -> float:
    """Whom a question asks; -1 where it tells of nobody, who could be asked."""
    return asked_in_turn(sequence, float(sender), others + 1.0) if others else -1.0


def _put_state(out: _Writer, state: float, path_speed: float, phase: float, dictionary: Dictionary) -> None:
    out.put(dictionary.state.encode(state, "coordination_state"), dictionary.state.bits)
    out.put(dictionary.path_speed.encode(path_speed, "path_speed"), dictionary.path_speed.bits)
    out.put(max(0, round(phase)) % len(PHASES), PHASE_BITS)


def _put_sighting(out: _Writer, seen: Sighting, told: Report, dictionary: Dictionary) -> None:
    """A rounded sighting; no path speed means that the vehicle's phase is not known."""
    out.put(dictionary.position.encode(seen.north, "north"), dictionary.position.bits)
    out.put(dictionary.position.encode(seen.east, "east"), dictionary.position.bits)
    out.put(dictionary.age.encode(told.time_of_validity - seen.time_of_validity, "age"), dictionary.age.bits)
    _put_state(out, seen.coordination_state, seen.path_speed, seen.phase, dictionary)


def decode(data: bytes, time: float, last_sequence: float = 0.0, dictionary: Dictionary = COMPACT) -> Packet:
    """Read a packet.

    Args:
        data: as it came; of a packet with a code, what stands before the code.
        time: [s] now; the packet was sent less than 25 s before, by a clock at most 0.5 s ahead of this one.
        last_sequence: [-] the last that was read of this sender.
        dictionary: how numbers are sent.

    Returns:
        What it says.

    Raises:
        PacketError: not a packet of this kind and length.
    """
    body = 8 * len(data) - 8 * dictionary.size(0)
    count = round(body / dictionary.sighting_bits) if data else 0
    if not data or count < 0 or dictionary.size(count) != len(data):
        raise PacketError(f"{len(data)} bytes are no packet: one has {dictionary.size(0)}, {dictionary.size(1)}, ...")
    read = _Reader(data)
    kind = read.take(KIND_BITS)
    if kind not in (STATEMENT, QUESTION):
        raise PacketError("not a packet of this kind")
    sender = read.take(SENDER_BITS)
    sequence = whole_sequence(read.take(SEQUENCE_BITS), last_sequence)
    valid = TIME_STEP * whole_time(read.take(TIME_BITS), time)
    state, speed, phase = _take_state(read, dictionary)
    asks = _asked(sequence, sender, count) if kind == QUESTION else -1.0
    report = Report(1.0, sequence, valid, state, speed, phase, asks)
    others = [_take_sighting(read, valid, dictionary) for _ in range(count)]
    if read.value & (1 << read.left) - 1:
        raise PacketError("bits after the end of the packet")
    numbers = [k for k in range(count + 1) if k != sender] if sender <= count else list(range(count))
    return Packet(sender, report, dict(zip(numbers, others, strict=False)))


def whole_sequence(low: int, last: float) -> float:
    """A sequence number, of which the last eight bits are known: the one nearest to the next.

    Args:
        low: [-] its last eight bits.
        last: [-] the last that was read.
    """
    cycle = 2**SEQUENCE_BITS
    expected = round(last) + 1
    return float(max(low, expected + (low - expected + cycle // 2) % cycle - cycle // 2))


def whole_time(low: int, time: float) -> int:
    """A time in steps of 0.1 s, of which the last eight bits are known: the latest one that is not after now.

    Args:
        low: [-] its last eight bits.
        time: [s] now.
    """
    cycle, latest = 2**TIME_BITS, whole_ticks(time + CLOCK_SLACK)
    return low + cycle * ((latest - low) // cycle)


def _take_state(read: _Reader, dictionary: Dictionary) -> tuple[float, float, float]:
    state = dictionary.state.decode(read.take(dictionary.state.bits))
    speed = dictionary.path_speed.decode(read.take(dictionary.path_speed.bits))
    return state, speed, float(read.take(PHASE_BITS))


def _take_sighting(read: _Reader, valid: float, dictionary: Dictionary) -> Sighting:
    north = dictionary.position.decode(read.take(dictionary.position.bits))
    east = dictionary.position.decode(read.take(dictionary.position.bits))
    age = dictionary.age.decode(read.take(dictionary.age.bits))
    state, speed, phase = _take_state(read, dictionary)
    seen = valid - age
    fixed = seen if not math.isnan(north) else NOTHING
    return Sighting(north, east, fixed, state, speed, seen, UNTOLD if math.isnan(speed) else phase)
