"""Polynomials whose coefficients stand in one table of the program, and angles turned by quarters."""

import hashlib
import math
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from cardume.compiler.fusing import multiply_add
from cardume.compiler.lanes import BOOLS, DOUBLE, DOUBLES, INT32, INT64, LANES, WIDTH, WORDS, spread
from cardume.compiler.primitive import primitive


def polynomial(*coefficients: float) -> Callable[[float], float]:
    """A function of one number, summed by Horner's rule, each step rounded once.

    c0 + x (c1 + x (c2 + ...))

    Args:
        coefficients: [any] c0, c1, ... by rising power.
    """

    def value(x: float) -> float:
        *rest, total = coefficients
        for coefficient in reversed(rest):
            total = total * x + coefficient
        return total

    kind = ir.ArrayType(DOUBLE, len(coefficients))
    name = f"polynomial.{hashlib.blake2s(repr(coefficients).encode(), digest_size=8).hexdigest()}"

    @primitive(value, lambda x: (LANES if x is LANES else types.float64)(x))
    def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
        # As constants each would stand alone in the pool of the just-in-time compiler, and its address be loaded anew
        # each time, 10 bytes of code; a table is addressed once. A weak one, or its numbers would be folded in.
        table = b.module.globals.get(name)
        if table is None:
            table = ir.GlobalVariable(b.module, kind, name)
            table.linkage, table.global_constant = "weak", True
            table.initializer = ir.Constant(kind, list(coefficients))

        def coefficient(k: int) -> Any:
            number = b.load(b.gep(table, [ir.Constant(INT32, 0), ir.Constant(INT32, k)], inbounds=True))
            return spread(b, number, DOUBLES) if signature.args[0] is LANES else number

        total = coefficient(len(coefficients) - 1)
        for k in reversed(range(len(coefficients) - 1)):
            total = multiply_add(b, total, arguments[0], coefficient(k))
        return total

    return value


_ROUNDER = 6755399441055744.0  # 1.5 * 2^52


def turned(quarters: float, sine: float, cosine: float) -> tuple[float, float]:
    """(sin, cos) of an angle and as many quarter turns.

    Args:
        quarters: [-] 1.5 * 2^52 + q, q whole and below 2^51 in size.
        sine: [-] of the angle.
        cosine: [-] of it.
    """
    if not math.isfinite(quarters):
        return sine, cosine
    quarter = int(quarters - _ROUNDER) % 4
    return ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarter]


def _turned_type(quarters: Any, sine: Any, cosine: Any) -> Any:
    kind = LANES if quarters is LANES else types.float64
    return types.UniTuple(kind, 2)(kind, kind, kind)


@primitive(turned, _turned_type)
def _turned(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    # The last two bits of the sum are q modulo 4: the first exchanges, the second one is the sign, of q and of q + 1.
    quarters, sine, cosine = arguments
    wide = signature.args[0] is LANES
    words, floats, truths = (WORDS, DOUBLES, BOOLS) if wide else (INT64, DOUBLE, ir.IntType(1))

    def word(value: int) -> Any:
        return ir.Constant(words, [value] * WIDTH) if wide else ir.Constant(words, value)

    def signed(number: Any, count: Any) -> Any:
        sign = b.and_(b.shl(count, word(62)), word(1 << 63))
        return b.bitcast(b.xor(b.bitcast(number, words), sign), floats)

    count = b.bitcast(quarters, words)
    is_odd = b.trunc(count, truths)
    sine, cosine = b.select(is_odd, cosine, sine), b.select(is_odd, sine, cosine)
    pair = signed(sine, count), signed(cosine, b.add(count, word(1)))
    return c.make_tuple(b, signature.return_type, pair)
