"""Random numbers without a generator: a pure function of seed, stream, vehicle name and tick.

Philox4x32-10 enciphers the counter (tick, stream, vehicle, vehicle) under the seed, and the four words that come out
are the noise of that stream of that vehicle in that tick.  Nothing is shared and nothing advances, so one more sensor,
vehicle, thread or worker changes no other number, and two laws compared under one seed meet the same noise.

Source: Salmon, Moraes, Dror & Shaw (2011), Parallel random numbers: as easy as 1, 2, 3, SC '11; the known answers of
their library Random123 are in the tests.
"""

import hashlib
from operator import index
from typing import NamedTuple

import numpy as np

from cardume.compiler import compiled, sqrt, to_bits, to_float
from cardume.errors import InputError
from cardume.maths.elementary import log
from cardume.maths.trigonometry import sincos_turns

__all__ = ["Key", "Noise", "normal_pair", "normals", "philox", "random_key", "stream_id", "uniforms", "vehicle_id"]

WORD = np.uint64(0xFFFFFFFF)
HALF = np.uint64(32)
MULTIPLIER_0, MULTIPLIER_1 = np.uint64(0xD2511F53), np.uint64(0xCD9E8D57)
WEYL_0, WEYL_1 = np.uint64(0x9E3779B9), np.uint64(0xBB67AE85)
ROUNDS = 10
TWO_TO_MINUS_32 = 2.3283064365386963e-10


class Key(NamedTuple):
    """What names a sequence of random numbers: [-] whole numbers below 2^32, as floats because tables hold floats."""

    seed_low: float = 0.0
    seed_high: float = 0.0
    stream: float = 0.0
    vehicle_low: float = 0.0
    vehicle_high: float = 0.0


class Noise(NamedTuple):
    """Four independent standard normal numbers [-]."""

    a: float = 0.0
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0


def stream_id(name: str) -> float:
    """Number of a stream: a hash of its name, so that it depends on no order.

    Args:
        name: what the numbers are for, such as "gnss" or "usbl.range".

    Returns:
        A whole number below 2^32.
    """
    return float(_hash(name, b"stream", 4))


def vehicle_id(name: str) -> tuple[float, float]:
    """Number of a vehicle: a hash of its name, never of its place in the fleet.

    Args:
        name: as in the mission file; "" for what belongs to no vehicle.

    Returns:
        (low, high), whole numbers below 2^32: 64 bits, so no two names of a fleet meet.
    """
    words = _hash(name, b"vehicle", 8)
    return float(words & 0xFFFFFFFF), float(words >> 32)


def random_key(seed: int, stream: str, vehicle: str = "") -> Key:
    """The key of one stream of one vehicle in one mission, to be stored when the mission is built.

    Args:
        seed: [-] 0 <= seed < 2^64.
        stream: what the numbers are for.
        vehicle: name of the vehicle; "" for what belongs to none.

    Returns:
        The key for `uniforms` and `normals`.

    Raises:
        InputError: the seed is not a whole number in that range.
    """
    try:
        number = index(seed)
    except TypeError:
        number = -1
    if not 0 <= number < 2**64:
        raise InputError(f"seed: {seed!r} is not a whole number from 0 to {2**64 - 1}")
    return Key(float(number & 0xFFFFFFFF), float(number >> 32), stream_id(stream), *vehicle_id(vehicle))


def _hash(name: str, purpose: bytes, size: int) -> int:
    return int.from_bytes(hashlib.blake2s(name.encode(), digest_size=size, person=purpose).digest(), "little")


Bits = np.uint64  # in compiled code also a register of eight


@compiled
def philox(c0: Bits, c1: Bits, c2: Bits, c3: Bits, k0: Bits, k1: Bits) -> tuple[Bits, Bits, Bits, Bits]:
    """Encipher a counter of four 32-bit words under a key of two: Philox4x32, ten rounds.

    Args:
        c0: [-] first word of the counter, below 2^32, held in 64 bits as all the others.
        c1: [-] second word.
        c2: [-] third word.
        c3: [-] fourth word.
        k0: [-] first word of the key.
        k1: [-] second word.

    Returns:
        Four words below 2^32.

    Source: Random123, `philox.h`: `_philox4x32round`, `_philox4x32bumpkey`.
    """
    for _ in range(ROUNDS):
        product_0 = MULTIPLIER_0 * c0
        product_1 = MULTIPLIER_1 * c2
        c0 = (product_1 >> HALF) ^ c1 ^ k0
        c1 = product_1 & WORD
        c2 = (product_0 >> HALF) ^ c3 ^ k1
        c3 = product_0 & WORD
        k0 = (k0 + WEYL_0) & WORD
        k1 = (k1 + WEYL_1) & WORD
    return c0, c1, c2, c3


@compiled
def _unit(bits: Bits) -> float:
    """A 32-bit word as a number in (0, 1): the middles of 2^32 equal cells."""
    return (to_float(bits) + 0.5) * TWO_TO_MINUS_32


@compiled
def uniforms(key: Key, tick: float) -> tuple[float, float, float, float]:
    """Four independent numbers, uniform in the open interval (0, 1), of 32 bits each.

    Args:
        key: the stream.
        tick: [-] whole, 0 <= tick < 2^32.

    Returns:
        Four numbers between 2^-33 and 1 - 2^-33; the mean of all that can come is exactly 1/2.
    """
    c0, c1, k0, k1 = to_bits(tick), to_bits(key.stream), to_bits(key.seed_low), to_bits(key.seed_high)
    c2, c3 = to_bits(key.vehicle_low), to_bits(key.vehicle_high)
    zero = (c0 ^ c0) | (c1 ^ c1) | (c2 ^ c2) | (c3 ^ c3) | (k0 ^ k0) | (k1 ^ k1)
    # One lane-valued word makes all of them lane-valued: the tick, say, is the same in all lanes. The compiler
    # multiplies halves instead of whole words where it sees that they are below 2^32.
    c0, c1, c2, c3 = (c0 | zero) & WORD, (c1 | zero) & WORD, (c2 | zero) & WORD, (c3 | zero) & WORD
    c0, c1, c2, c3 = philox(c0, c1, c2, c3, (k0 | zero) & WORD, (k1 | zero) & WORD)
    return _unit(c0), _unit(c1), _unit(c2), _unit(c3)


@compiled
def normal_pair(chance: float, turns: float) -> tuple[float, float]:
    """Two independent standard normal numbers of two uniform ones.

    a + i b = sqrt(-2 log chance) exp(2 pi i turns)   (Box and Muller)

    Args:
        chance: [-] in (0, 1).
        turns: [-] in (0, 1).

    Returns:
        (a, b) [-].
    """
    size = sqrt(-2.0 * log(chance))
    sine, cosine = sincos_turns(turns)
    return size * cosine, size * sine


@compiled
def normals(key: Key, tick: float) -> Noise:
    """Four independent standard normal numbers: two pairs, see `normal_pair`.

    Args:
        key: the stream.
        tick: [-] whole, 0 <= tick < 2^32.

    Returns:
        The noise; none exceeds sqrt(66 log 2) = 6.76 in size, because u_1 >= 2^-33.
    """
    u, v, w, x = uniforms(key, tick)
    a, b = normal_pair(u, v)
    c, d = normal_pair(w, x)
    return Noise(a, b, c, d)
