"""Polynomials whose coefficients stand in one table of the program."""

import hashlib
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from cardume.compiler.fusing import multiply_add
from cardume.compiler.lanes import DOUBLE, DOUBLES, INT32, LANES, spread
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
