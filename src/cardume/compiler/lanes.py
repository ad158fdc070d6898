"""Lanes: one number that holds eight missions, a SIMD register of float64.

The same scalar source compiles for float64 and for `Lanes`: arithmetic and comparisons are
overloaded here, a comparison gives a `Mask`, and `where` chooses by lane.  Nothing is left to an
auto-vectorizer.  No fast-math: each lane gets the bits that the scalar code would compute.
"""

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, overload, register_model

from cardume.compiler.primitive import primitive

WIDTH = 8

DOUBLE, INT64, INT32 = ir.DoubleType(), ir.IntType(64), ir.IntType(32)
DOUBLES = ir.VectorType(DOUBLE, WIDTH)
BOOLS = ir.VectorType(ir.IntType(1), WIDTH)
WORDS = ir.VectorType(INT64, WIDTH)


class LanesType(types.Type):
    """Numba type of eight float64."""

    def __init__(self) -> None:
        super().__init__(name=f"Lanes{WIDTH}")


class MaskType(types.Type):
    """Numba type of eight truth values."""

    def __init__(self) -> None:
        super().__init__(name=f"Mask{WIDTH}")


class LaneBitsType(types.Type):
    """Numba type of eight unsigned 64-bit words, for random numbers."""

    def __init__(self) -> None:
        super().__init__(name=f"Bits{WIDTH}")


LANES, MASK, LANE_BITS = LanesType(), MaskType(), LaneBitsType()


def _register(kind: type[types.Type], vector: ir.VectorType) -> None:
    @register_model(kind)
    class _Model(models.PrimitiveModel):
        def __init__(self, manager: Any, fe_type: Any) -> None:
            super().__init__(manager, fe_type, vector)


_register(LanesType, DOUBLES)
_register(MaskType, BOOLS)
_register(LaneBitsType, WORDS)


def is_number(kind: object) -> bool:
    """Whether a Numba type is an ordinary scalar number."""
    return isinstance(kind, (types.Float, types.Integer))


def spread(builder: Any, value: Any, vector: ir.VectorType) -> Any:
    """LLVM code that puts one value in every lane."""
    undefined = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(undefined, value, ir.Constant(INT32, 0))
    return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(INT32, WIDTH), [0] * WIDTH))


def _binary_intrinsic(generate: Callable[..., Any], left: Any, right: Any, result: Any) -> Any:
    @intrinsic
    def operation(context: Any, x: Any, y: Any) -> Any:
        return result(left, right), lambda c, b, s, arguments: generate(b, *arguments)

    return operation


def unary_intrinsic(generate: Callable[..., Any], argument: Any, result: Any) -> Any:
    """A function of one argument that is LLVM code: generate(builder, value) -> value."""

    @intrinsic
    def operation(context: Any, x: Any) -> Any:
        return result(argument), lambda c, b, s, arguments: generate(b, arguments[0])

    return operation


splat = unary_intrinsic(lambda b, x: spread(b, x, DOUBLES), types.float64, LANES)
splat_bits = unary_intrinsic(lambda b, x: spread(b, x, WORDS), types.uint64, LANE_BITS)


def _overload_lanes(python_operator: Any, operation: Any) -> None:
    @overload(python_operator, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if a is LANES and b is LANES:
            return lambda a, b: operation(a, b)
        if a is LANES and is_number(b):
            return lambda a, b: operation(a, splat(float(b)))
        if is_number(a) and b is LANES:
            return lambda a, b: operation(splat(float(a)), b)
        return None


for _python, _llvm in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
    (operator.iadd, "fadd"),  # x += y, which a user may write
    (operator.isub, "fsub"),
    (operator.imul, "fmul"),
    (operator.itruediv, "fdiv"),
):
    _overload_lanes(_python, _binary_intrinsic(lambda b, x, y, m=_llvm: getattr(b, m)(x, y), LANES, LANES, LANES))
for _python, _llvm in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
):
    _overload_lanes(_python, _binary_intrinsic(lambda b, x, y, m=_llvm: b.fcmp_ordered(m, x, y), LANES, LANES, MASK))
# NaN != NaN must hold, as in scalar code: an unordered comparison.
_overload_lanes(operator.ne, _binary_intrinsic(lambda b, x, y: b.fcmp_unordered("!=", x, y), LANES, LANES, MASK))


def _overload_bits(python_operator: Any, method: str) -> None:
    operation = _binary_intrinsic(lambda b, x, y: getattr(b, method)(x, y), LANE_BITS, LANE_BITS, LANE_BITS)

    @overload(python_operator, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if a is LANE_BITS and b is LANE_BITS:
            return lambda a, b: operation(a, b)
        if a is LANE_BITS and is_number(b):
            return lambda a, b: operation(a, splat_bits(np.uint64(b)))
        if is_number(a) and b is LANE_BITS:
            return lambda a, b: operation(splat_bits(np.uint64(a)), b)
        return None


for _python, _llvm in (
    (operator.add, "add"),
    (operator.mul, "mul"),
    (operator.xor, "xor"),
    (operator.and_, "and_"),
    (operator.or_, "or_"),
    (operator.rshift, "lshr"),
    (operator.lshift, "shl"),
):
    _overload_bits(_python, _llvm)

_both = _binary_intrinsic(lambda b, x, y: b.and_(x, y), MASK, MASK, MASK)
_either = _binary_intrinsic(lambda b, x, y: b.or_(x, y), MASK, MASK, MASK)
_spread_truth = unary_intrinsic(lambda b, x: spread(b, x, BOOLS), types.boolean, MASK)


def _overload_mask(python_operator: Any, operation: Any) -> None:
    @overload(python_operator, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if a is MASK and b is MASK:
            return lambda a, b: operation(a, b)
        if a is MASK and isinstance(b, types.Boolean):
            return lambda a, b: operation(a, _spread_truth(b))
        if isinstance(a, types.Boolean) and b is MASK:
            return lambda a, b: operation(_spread_truth(a), b)
        return None


_overload_mask(operator.and_, _both)
_overload_mask(operator.or_, _either)
_minus = unary_intrinsic(lambda b, x: b.fneg(x), LANES, LANES)


@overload(operator.neg, strict=False)
def _negative(a: Any) -> Any:
    return (lambda a: _minus(a)) if a is LANES else None


def _llvm_call(name: str) -> Any:
    def generate(b: Any, x: Any) -> Any:
        kind = ir.FunctionType(DOUBLES, [DOUBLES])
        function = cgutils.get_or_insert_function(b.module, kind, f"llvm.{name}.v{WIDTH}f64")
        return b.call(function, [x])

    return unary_intrinsic(generate, LANES, LANES)


_lane_sqrt, _lane_floor, _lane_abs = _llvm_call("sqrt"), _llvm_call("floor"), _llvm_call("fabs")


@overload(abs, strict=False)
def _absolute(x: Any) -> Any:
    return (lambda x: _lane_abs(x)) if x is LANES else None


def sqrt(x: float) -> float:
    """Square root; NaN below zero.  The processor's own, correctly rounded everywhere."""
    return math.sqrt(x) if x >= 0.0 else math.nan


@overload(sqrt, strict=False)
def _sqrt(x: Any) -> Any:
    return (lambda x: _lane_sqrt(x)) if x is LANES else (lambda x: np.sqrt(x))


def floor(x: float) -> float:
    """The largest whole number not above x, as a float; NaN and infinities pass through."""
    return float(np.floor(x))


@overload(floor, strict=False)
def _floor(x: Any) -> Any:
    return (lambda x: _lane_floor(x)) if x is LANES else (lambda x: np.floor(x))


def where(condition: bool, chosen: Any, otherwise: Any) -> Any:
    """`chosen` where the condition holds, else `otherwise`: numbers, or equal records field by field.

    Args:
        condition: [-] a truth value, or a mask of lanes.
        chosen: [any] a number or record.
        otherwise: [any] the same kind.

    Returns:
        A value of that kind; both sides are computed, so neither may have an effect.
    """
    return chosen if condition else otherwise


def _common_type(condition: Any, chosen: Any, otherwise: Any) -> Any:
    """What `where` gives: as wide as the widest of the three; tables are the same on both sides."""
    if isinstance(chosen, types.BaseNamedTuple):
        pairs = zip(chosen.types, otherwise.types, strict=True)
        fields = [_common_type(condition, a, b) for a, b in pairs]
        return types.BaseTuple.from_types(fields, chosen.instance_class)
    numbers = [chosen, otherwise]
    if LANES in numbers or (condition is MASK and all(is_number(n) for n in numbers)):
        return LANES
    if MASK in numbers or (condition is MASK and isinstance(chosen, types.Boolean)):
        return MASK
    if any(isinstance(n, types.Float) for n in numbers):
        return types.float64
    return types.int64 if isinstance(chosen, types.Integer) else chosen


def _where_type(condition: Any, chosen: Any, otherwise: Any) -> Any:
    truth = MASK if condition is MASK else types.boolean
    return _common_type(condition, chosen, otherwise)(truth, chosen, otherwise)


@primitive(where, _where_type)
def _where(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    condition, chosen, otherwise = arguments
    _, chosen_type, otherwise_type = signature.args

    def choose(x: Any, x_type: Any, y: Any, y_type: Any, result: Any) -> Any:
        if isinstance(result, types.BaseTuple):
            parts = [
                choose(b.extract_value(x, k), x_type.types[k], b.extract_value(y, k), y_type.types[k], kind)
                for k, kind in enumerate(result.types)
            ]
            return c.make_tuple(b, result, parts)
        if result in (LANES, MASK) or is_number(result) or isinstance(result, types.Boolean):
            return b.select(condition, widened(c, b, x, x_type, result), widened(c, b, y, y_type, result))
        return x

    return choose(chosen, chosen_type, otherwise, otherwise_type, signature.return_type)


def widened(c: Any, b: Any, value: Any, kind: Any, wanted: Any) -> Any:
    """LLVM code that makes a number as wide as wanted: itself, or the same in all lanes."""
    if kind == wanted:
        return value
    if wanted is LANES:
        return spread(b, c.cast(b, value, kind, types.float64), DOUBLES)
    if wanted is MASK:
        return spread(b, value, BOOLS)
    return c.cast(b, value, kind, wanted)


def negate(condition: bool) -> bool:
    """True where the condition does not hold."""
    return not condition


@primitive(negate, lambda condition: condition(condition))
def _negate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return b.not_(arguments[0])


def some(condition: bool) -> bool:
    """Whether the condition holds in any lane: the one thing an `if` may ask of a signal."""
    return condition


@primitive(some, lambda condition: types.boolean(condition))
def _some(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    if signature.args[0] is not MASK:
        return arguments[0]
    packed = b.bitcast(arguments[0], ir.IntType(WIDTH))
    return b.icmp_unsigned("!=", packed, ir.Constant(ir.IntType(WIDTH), 0))
