"""Numbers and their bits, for one float64 or eight lanes: whole numbers, exponents, quarter turns, and random words."""

import math
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from cardume.compiler.lanes import BOOLS, DOUBLE, DOUBLES, INT64, LANE_BITS, LANES, WIDTH, WORDS, unary_intrinsic
from cardume.compiler.primitive import primitive


def _constant(kind: Any, value: float) -> Any:
    return ir.Constant(kind, [value] * WIDTH) if isinstance(kind, ir.VectorType) else ir.Constant(kind, value)


def _bit_shapes(x: Any) -> tuple[Any, Any, Any]:
    return (LANES, DOUBLES, WORDS) if x is LANES else (types.float64, DOUBLE, INT64)


# Before AVX-512 no processor converts a register of floats to whole numbers. Whole numbers below 2^52 need no
# conversion: added to 2^52 (1.5 times it, if they may be negative) they are the last bits of the sum.  One number alone
# is converted: the bits of 2^52 in an address would be a constant of 64 bits, loaded anew for each number of a record.
_TWO_52, _THREE_51 = 2.0**52, 1.5 * 2.0**52
_TWO_52_BITS, _THREE_51_BITS = 0x4330000000000000, 0x4338000000000000


def whole(b: Any, number: Any) -> Any:
    """LLVM code for the signed words of whole numbers below 2^51 in size, in one lane or eight."""
    if number.type == DOUBLE:
        return b.fptosi(number, INT64)
    raised = b.bitcast(b.fadd(number, _constant(DOUBLES, _THREE_51)), WORDS)
    return b.sub(raised, _constant(WORDS, _THREE_51_BITS))


@intrinsic
def _power_of_two(context: Any, k: Any) -> Any:
    number, floats, words = _bit_shapes(k)

    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        exponent = b.bitcast(b.fadd(arguments[0], _constant(floats, _THREE_51 + 1023.0)), words)
        return b.bitcast(b.shl(exponent, _constant(words, 52)), floats)

    return number(number), generate


def scale2(x: float, k: float) -> float:
    """x times 2 to the k, for whole k in [-1022, 1023]."""
    return x * math.ldexp(1.0, int(k)) if k == k else math.nan


@overload(scale2, strict=False)
def _scale2(x: Any, k: Any) -> Any:
    return lambda x, k: x * _power_of_two(k)


_HALF_ROOT = 0x3FE6A09E667F3BCD  # bits of 1 / sqrt(2)


@intrinsic
def _split(context: Any, x: Any) -> Any:
    number, floats, words = _bit_shapes(x)

    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        bits = b.add(b.bitcast(arguments[0], words), _constant(words, 0x3FF0000000000000 - _HALF_ROOT))
        raised = b.or_(b.lshr(bits, _constant(words, 52)), _constant(words, _TWO_52_BITS))
        exponent = b.fsub(b.bitcast(raised, floats), _constant(floats, _TWO_52 + 1023.0))
        mantissa = b.add(b.and_(bits, _constant(words, 0x000FFFFFFFFFFFFF)), _constant(words, _HALF_ROOT))
        return c.make_tuple(b, s.return_type, (exponent, b.bitcast(mantissa, floats)))

    return types.UniTuple(number, 2)(number), generate


def split2(x: float) -> tuple[float, float]:
    """(k, m) with x = m 2^k and m in [1/sqrt(2), sqrt(2)); x normal and > 0, else both are meaningless."""
    if not 0.0 < x < math.inf:
        return 0.0, 1.0
    m, k = math.frexp(x)
    return (k - 1.0, 2.0 * m) if m < 0.7071067811865476 else (float(k), m)


@overload(split2, strict=False)
def _split2(x: Any) -> Any:
    return lambda x: _split(x)


def _low_bits(b: Any, x: Any) -> Any:
    return b.xor(b.bitcast(b.fadd(x, _constant(DOUBLES, _TWO_52)), WORDS), _constant(WORDS, _TWO_52_BITS))


def _from_low_bits(b: Any, bits: Any) -> Any:
    return b.fsub(b.bitcast(b.or_(bits, _constant(WORDS, _TWO_52_BITS)), DOUBLES), _constant(DOUBLES, _TWO_52))


_lanes_to_bits = unary_intrinsic(_low_bits, LANES, LANE_BITS)
_lanes_from_bits = unary_intrinsic(_from_low_bits, LANE_BITS, LANES)


def to_bits(x: float) -> np.uint64:
    """A whole number 0 <= x < 2^52 as an unsigned word."""
    return np.uint64(int(x))


@overload(to_bits, strict=False)
def _to_bits(x: Any) -> Any:
    return (lambda x: _lanes_to_bits(x)) if x is LANES else (lambda x: np.uint64(x))


def to_float(bits: np.uint64) -> float:
    """A word below 2^52 as a float, exactly."""
    return float(bits)


@overload(to_float, strict=False)
def _to_float(bits: Any) -> Any:
    return (lambda bits: _lanes_from_bits(bits)) if bits is LANE_BITS else (lambda bits: np.float64(bits))


def turned(quarters: float, sine: float, cosine: float) -> tuple[float, float]:
    """(sin, cos) of an angle and as many quarter turns.

    Args:
        quarters: [-] 1.5 * 2^52 + q, q whole and below 2^51 in size.
        sine: [-] of the angle.
        cosine: [-] of it.
    """
    if not math.isfinite(quarters):
        return sine, cosine
    quarter = int(quarters - _THREE_51) % 4
    return ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarter]


def _turned_type(quarters: Any, sine: Any, cosine: Any) -> Any:
    kind = LANES if quarters is LANES else types.float64
    return types.UniTuple(kind, 2)(kind, kind, kind)


@primitive(turned, _turned_type)
def _turned(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    # The last two bits of the sum are q modulo 4: the first exchanges, the second one is the sign, of q and of q + 1.
    quarters, sine, cosine = arguments
    _, floats, words = _bit_shapes(signature.args[0])
    truths = BOOLS if signature.args[0] is LANES else ir.IntType(1)

    def signed(number: Any, count: Any) -> Any:
        sign = b.and_(b.shl(count, _constant(words, 62)), _constant(words, 1 << 63))
        return b.bitcast(b.xor(b.bitcast(number, words), sign), floats)

    count = b.bitcast(quarters, words)
    is_odd = b.trunc(count, truths)
    sine, cosine = b.select(is_odd, cosine, sine), b.select(is_odd, sine, cosine)
    pair = signed(sine, count), signed(cosine, b.add(count, _constant(words, 1)))
    return c.make_tuple(b, signature.return_type, pair)
