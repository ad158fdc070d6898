"""Calling a law by its machine address, so that laws are data and the kernel never recompiles.

Every law of a family is compiled with one signature, `law(*signals, gains, memory, dt)`, in
Numba's own calling convention, so that exceptions propagate.  A law that does not compile for
lanes is called once per lane; its handle is then negative.  Handles live in one process only.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir
from numba import config, types
from numba.core import cgutils

from cardume.compiler.lanes import INT32, INT64, LANES, WIDTH, widened
from cardume.compiler.primitive import primitive
from cardume.compiler.records import size_of
from cardume.compiler.reference import ReferenceType, put_aside, record_at
from cardume.compiler.rows import (
    ELEMENTS,
    FLAT_ROWS,
    LANE_ROWS,
    ROWS,
    Rows,
    SharedRows,
    as_law_sees,
    lane_of,
    row_address,
)

_python_laws: list[Callable[..., Any]] = []  # NUMBA_DISABLE_JIT: a handle is a place in this list


# How a law is compiled: the table type that it is given.
FLAT, STRIDED, WIDE = FLAT_ROWS, ROWS, LANE_ROWS  # one mission; one lane of eight; eight missions at once


LARGE = 8  # numbers of a record, from which it goes by reference: there are registers for eight


def record_type(kind: Any, rows: Any) -> Any:
    """Numba type of a float, a record, or a tuple of them, as wide as the rows of a table."""
    real = ELEMENTS[rows]
    if kind is float:
        return real
    if isinstance(kind, tuple):
        return types.BaseTuple.from_types([record_type(k, rows) for k in kind])
    tables = {Rows: rows, SharedRows: FLAT_ROWS}
    fields = [tables.get(kind.__annotations__.get(f), real) for f in kind._fields]
    return types.BaseTuple.from_types(fields, kind)


def law_signature(signals: tuple[Any, ...], result: Any, rows: Any) -> Any:
    """Numba signature that all laws of a family share: FLAT, STRIDED or WIDE.

    A large record goes by reference: the law reads what it wants of it, and several laws read the same.
    """
    kinds = [record_type(s, rows) for s in signals]
    arguments = [ReferenceType(k) if size_of(s) >= LARGE else k for s, k in zip(signals, kinds, strict=True)]
    return record_type(result, rows)(*arguments, rows, rows, types.float64)


def define_verb(verb: Callable[..., Any], place: int, signals: tuple[Any, ...], result: Any) -> None:
    """Let compiled code call a verb: look the law up in the book and jump to it.

    Args:
        verb: (book, slot, *signals) in plain Python.
        place: [-] of the family in the book.
        signals: record classes.
        result: float, a record class, or a tuple of them.
    """
    flat, strided, wide = (law_signature(signals, result, rows) for rows in (FLAT, STRIDED, WIDE))

    def typed(book: Any, slot: Any, *given: Any) -> Any:
        law = wide if LANE_ROWS in book.types else flat
        return law.return_type(book, types.int64, *given)

    @primitive(verb, typed)
    def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
        book_type, book, slot = signature.args[0], arguments[0], arguments[1]
        law = wide if LANE_ROWS in book_type.types else flat
        handles, gains, memory, dt = cgutils.unpack_tuple(b, book, len(book_type.types))
        columns = [b.gep(handles, [ir.Constant(INT64, place * 4 + k)]) for k in range(4)]
        handle, gain, first, width = [b.load(column) for column in columns]
        gains = row_address(c, b, book_type.types[1], gains, gain)
        memory = row_address(c, b, book_type.types[2], memory, b.add(first, b.mul(slot, width)))
        parts = [
            _handed(c, b, value, kind, wanted)
            for value, kind, wanted in zip(arguments[2:], signature.args[2:], law.args, strict=False)
        ]
        if law is wide:
            return _call_lanes(c, b, wide, strided, handle, parts, gains, memory, dt)
        return _call(c, b, flat, handle, [*parts, gains, memory, dt])


def _handed(c: Any, b: Any, value: Any, kind: Any, wanted: Any) -> Any:
    """LLVM code that brings a signal to the type that a law's signature asks for, by reference where that does."""
    if kind == wanted:
        return value
    if isinstance(kind, ReferenceType):
        value, kind = record_at(c, b, kind, value), kind.record
    if isinstance(wanted, ReferenceType):
        return put_aside(b, as_law_sees(c, b, value, kind, wanted.record))
    return as_law_sees(c, b, value, kind, wanted)


def _call_lanes(
    c: Any, b: Any, wide: Any, strided: Any, handle: Any, parts: Any, gains: Any, memory: Any, dt: Any
) -> Any:
    """Call a law for eight missions at once, or one after the other where it does not compile for lanes."""
    with b.goto_entry_block():  # not by Numba's own, which sets it to zero each time: both ways write all of it
        answer = b.alloca(c.get_value_type(wide.return_type))
    with b.if_else(b.icmp_signed(">", handle, ir.Constant(INT64, 0))) as (whole, each):
        with whole:
            b.store(_call(c, b, wide, handle, [*parts, gains, memory, dt]), answer)
        with each, cgutils.for_range(b, ir.Constant(INT64, WIDTH)) as loop:
            one = [_lane_value(c, b, p, kind, loop.index) for p, kind in zip(parts, wide.args, strict=False)]
            rows = [lane_of(c, b, gains, loop.index), lane_of(c, b, memory, loop.index)]
            value = _call(c, b, strided, b.neg(handle), [*one, *rows, dt])
            _put_lane(c, b, answer, value, wide.return_type, loop.index)
    return b.load(answer)


@cache
def law_answer(result: Any, plain: str | None = None, may_leave_out: bool = False) -> Callable[..., Any]:
    """A function (rows, answer) that makes what a law returned as wide as the rows it was given.

    Args:
        result: float, a record class, or a tuple of them.
        plain: the field that a law means which returns one number; the others are then NaN. None: it may not.
        may_leave_out: whether a law may leave out the last fields that have defaults.
    """
    fields = result._fields if plain else ()
    # compiled records lack what a law leaves out
    defaults = getattr(result, "_field_defaults", {}) if may_leave_out else {}

    def as_answer(rows: Rows, answer: Any) -> Any:
        if plain is None or isinstance(answer, tuple):
            return answer
        return result(*[answer if field == plain else math.nan for field in fields])

    def typed(rows: Any, answer: Any) -> Any:
        wanted = record_type(result, rows)
        fits = not isinstance(wanted, types.BaseTuple) or (
            0 <= len(wanted) - len(answer) <= len(defaults)
            if isinstance(answer, types.BaseTuple)
            else plain is not None
        )
        return wanted(rows, answer) if fits else None

    @primitive(as_answer, typed)
    def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
        (_, given), wanted, answer = signature.args, signature.return_type, arguments[1]
        if isinstance(given, types.BaseTuple) and len(given) < len(wanted):
            told = [(b.extract_value(answer, k), kind) for k, kind in enumerate(given.types)]
            rest = [ir.Constant(ir.DoubleType(), defaults[field]) for field in result._fields[len(given) :]]
            known = [*told, *((number, types.float64) for number in rest)]
            return c.make_tuple(b, wanted, [widened(c, b, *part, wanted.types[0]) for part in known])
        if plain is None or isinstance(given, types.BaseTuple):
            return as_law_sees(c, b, answer, given, wanted)
        number, nothing = ir.Constant(ir.DoubleType(), math.nan), types.float64
        parts = [(answer, given) if field == plain else (number, nothing) for field in fields]
        return c.make_tuple(b, wanted, [widened(c, b, *part, wanted.types[0]) for part in parts])

    return as_answer


def call_python(handle: int, arguments: tuple[Any, ...]) -> Any:
    """Call a law in plain Python, under NUMBA_DISABLE_JIT."""
    return _python_laws[handle](*arguments)


def address(dispatcher: Any, signature: Any) -> int:
    """Where the code of a compiled law lives in this process; under NUMBA_DISABLE_JIT its place in a list."""
    if config.DISABLE_JIT:
        _python_laws.append(dispatcher)
        return len(_python_laws) - 1
    result = dispatcher.get_compile_result(signature)
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _call(c: Any, b: Any, signature: Any, handle: Any, arguments: Any) -> Any:
    """Numba's own call, but for setting the answer to zero first: a law that returns writes all of it."""
    convention = c.call_conv
    kind = convention.get_function_type(signature.return_type, signature.args)
    with b.goto_entry_block():
        answer, trouble = (b.alloca(kind.args[k].pointee) for k in range(2))
    given = c.get_arg_packer(signature.args).as_arguments(b, arguments)
    code = b.call(b.inttoptr(handle, kind.as_pointer()), [answer, trouble, *given])
    with cgutils.if_unlikely(b, b.icmp_signed("!=", code, code.type(0))):
        convention.return_status_propagate(b, convention._get_return_status(b, code, b.load(trouble)))
    return c.get_returned_value(b, signature.return_type, b.load(answer))


def _lane_value(c: Any, b: Any, value: Any, kind: Any, lane: Any) -> Any:
    """One lane of a number, a table or a record."""
    if kind is LANES:
        return b.extract_element(value, b.trunc(lane, INT32))
    if kind is LANE_ROWS:
        return lane_of(c, b, value, lane)
    if isinstance(kind, ReferenceType):
        return put_aside(b, _lane_value(c, b, record_at(c, b, kind, value), kind.record, lane))
    if isinstance(kind, types.BaseTuple):
        scalars = [{LANES: types.float64, LANE_ROWS: ROWS}.get(k, k) for k in kind.types]
        parts = [_lane_value(c, b, b.extract_value(value, at), k, lane) for at, k in enumerate(kind.types)]
        return c.make_tuple(b, types.Tuple(scalars), parts)
    return value


def _put_lane(c: Any, b: Any, answer: Any, value: Any, kind: Any, lane: Any) -> None:
    """Store one lane of a result in place."""
    if kind is LANES:
        place = b.gep(b.bitcast(answer, ir.DoubleType().as_pointer()), [lane])
        b.store(value, place)
    elif kind is LANE_ROWS:
        # A lane's rows begin `lane` numbers into the table of all of them.
        data = cgutils.create_struct_proxy(ROWS)(c, b, value).data
        b.store(b.gep(data, [b.neg(lane)]), answer)
    else:
        for k, part in enumerate(kind.types):
            place = b.gep(answer, [ir.Constant(INT32, 0), ir.Constant(INT32, k)])
            _put_lane(c, b, place, b.extract_value(value, k), part, lane)
