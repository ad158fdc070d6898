"""Rows: a column of numbers in a table, one float64 each, or eight missions each.

A mission's state is plain tables of float64.  Compiled code sees a table as `FlatRows`, a bare
pointer, or as `LaneRows`, a pointer whose every row is a register of eight missions; array views in
the inner loop cost 15 to 20 %.  A law that does not compile for lanes is shown one lane of such a
table as `Rows`, a pointer with a stride.  `Ints` is a table of whole numbers,
the same for all lanes.  In plain Python all of them are one-dimensional numpy arrays.
"""

import functools
import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import models, overload, register_model

from cardume.compiler.bits import whole
from cardume.compiler.compiled import INLINED
from cardume.compiler.lanes import DOUBLE, DOUBLES, INT32, INT64, LANES, MASK, WIDTH, WORDS, spread, widened
from cardume.compiler.primitive import primitive

Rows = np.ndarray  # (k,) float64; how laws and records annotate a table


class SharedRows(np.ndarray):
    """Annotates a table that is the same in all lanes."""


class RowsType(types.Type):
    """Numba type of a strided column of float64."""

    def __init__(self) -> None:
        super().__init__(name="Rows")


class FlatRowsType(types.Type):
    """Numba type of a column of float64 without gaps."""

    def __init__(self) -> None:
        super().__init__(name="FlatRows")


class LaneRowsType(types.Type):
    """Numba type of a column of `Lanes`."""

    def __init__(self) -> None:
        super().__init__(name=f"LaneRows{WIDTH}")


class IntsType(types.Type):
    """Numba type of a column of int64."""

    def __init__(self) -> None:
        super().__init__(name="Ints")


ROWS, FLAT_ROWS, LANE_ROWS, INTS = RowsType(), FlatRowsType(), LaneRowsType(), IntsType()
ELEMENTS: dict[Any, Any] = {ROWS: types.float64, FLAT_ROWS: types.float64, LANE_ROWS: LANES, INTS: types.int64}


@register_model(RowsType)
class _RowsModel(models.StructModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, [("data", types.CPointer(types.float64)), ("stride", types.int64)])


def _register_pointer(kind: type[types.Type], pointee: Any) -> None:
    @register_model(kind)
    class _Model(models.PrimitiveModel):
        def __init__(self, manager: Any, fe_type: Any) -> None:
            super().__init__(manager, fe_type, pointee.as_pointer())


_register_pointer(FlatRowsType, DOUBLE)
_register_pointer(LaneRowsType, DOUBLE)
_register_pointer(IntsType, INT64)


def make_rows(context: Any, builder: Any, data: Any, stride: Any) -> Any:
    """LLVM value of a Rows."""
    rows = cgutils.create_struct_proxy(ROWS)(context, builder)
    rows.data, rows.stride = data, stride
    return rows._getvalue()


def lane_of(context: Any, builder: Any, lane_rows: Any, lane: Any) -> Any:
    """LLVM value of the Rows that one lane of a LaneRows is."""
    return make_rows(context, builder, builder.gep(lane_rows, [lane]), ir.Constant(INT64, WIDTH))


def rows_of(array: np.ndarray) -> Rows:
    """The rows of a contiguous array, which must stay alive meanwhile.

    Args:
        array: (k,) float64, (k, 8) float64 for eight missions, or (k,) int64.

    Returns:
        FlatRows, LaneRows or Ints; in plain Python the array itself.
    """
    return array


def _rows_type(array: Any) -> Any:
    kinds: dict[Any, Any] = {(1, types.float64): FLAT_ROWS, (2, types.float64): LANE_ROWS, (1, types.int64): INTS}
    kind = kinds.get((array.ndim, array.dtype)) if array.layout == "C" else None
    return kind(array) if kind else None


@primitive(rows_of, _rows_type)
def _rows_of(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return c.make_array(signature.args[0])(c, b, arguments[0]).data


def row_address(c: Any, b: Any, kind: Any, table: Any, k: Any) -> Any:
    """LLVM pointer to row k."""
    if kind is ROWS:
        rows = cgutils.create_struct_proxy(ROWS)(c, b, table)
        return b.gep(rows.data, [b.mul(k, rows.stride)])
    if kind is LANE_ROWS:
        return b.gep(table, [b.mul(k, ir.Constant(INT64, WIDTH))])
    return b.gep(table, [k])


def load(table: Rows, k: int) -> Any:
    """Row k of a table.

    Args:
        table: (n,) rows.
        k: [-] a whole number, the same in all lanes.

    Returns:
        The number there; eight of them from lane rows.
    """
    return table[k]


@primitive(load, lambda table, k: ELEMENTS[table](table, types.int64) if table in ELEMENTS else None)
def _load(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return load_row(b, signature.args[0], row_address(c, b, signature.args[0], *arguments))


def load_row(b: Any, kind: Any, place: Any, is_fixed: bool = False) -> Any:
    """LLVM code that reads the row at an address; a fixed one may be read again instead of kept in a register."""
    value = b.load(b.bitcast(place, DOUBLES.as_pointer()), align=8) if kind is LANE_ROWS else b.load(place)
    if is_fixed:
        value.set_metadata("invariant.load", b.module.add_metadata([]))
    return value


def load_fixed(table: Rows, k: int) -> Any:
    """Row k of a table that nobody writes during a mission.

    Args:
        table: (n,) rows.
        k: [-] a whole number, the same in all lanes.

    Returns:
        The number there; eight of them from lane rows.
    """
    return table[k]


@primitive(load_fixed, lambda table, k: ELEMENTS[table](table, types.int64) if table in ELEMENTS else None)
def _load_fixed(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return load_row(b, signature.args[0], row_address(c, b, signature.args[0], *arguments), is_fixed=True)


def store_row(b: Any, kind: Any, place: Any, value: Any) -> None:
    """LLVM code that writes the row at an address."""
    if kind is LANE_ROWS:
        b.store(value, b.bitcast(place, DOUBLES.as_pointer()), align=8)
    else:
        b.store(value, place)


def store(table: Rows, k: int, value: float) -> None:
    """Put a number into row k of a table.

    Args:
        table: (n,) rows, changed in place.
        k: [-] a whole number, the same in all lanes.
        value: [any] a number for one mission or for all lanes, or lanes.
    """
    table[k] = value


def _store_type(table: Any, k: Any, value: Any) -> Any:
    return types.void(table, types.int64, value) if table in ELEMENTS else None


@primitive(store, _store_type)
def _store(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    kind, _, value_type = signature.args
    value = widened(c, b, arguments[2], value_type, ELEMENTS[kind])
    store_row(b, kind, row_address(c, b, kind, *arguments[:2]), value)
    return c.get_dummy_value()


def at(table: Rows, offset: int) -> Rows:
    """The table from row `offset` on: load(at(t, 3), 0) is load(t, 3)."""
    return table[offset:]


@primitive(at, lambda table, offset: table(table, types.int64) if table in ELEMENTS else None)
def _at(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    kind = signature.args[0]
    place = row_address(c, b, kind, *arguments)
    if kind is not ROWS:
        return place
    return make_rows(c, b, place, cgutils.create_struct_proxy(ROWS)(c, b, arguments[0]).stride)


def gather(table: Rows, index: float) -> float:
    """The row whose number is a signal and may differ from lane to lane.

    Args:
        table: (n,) rows.
        index: [-] a whole number as a float; NaN reads row 0.

    Returns:
        The number there.
    """
    return table[int(index) if index == index else 0]


def _gather_type(table: Any, index: Any) -> Any:
    if table not in ELEMENTS:
        return None
    result = LANES if index is LANES else ELEMENTS[table]
    return result(table, LANES if index is LANES else types.float64)


@primitive(gather, _gather_type)
def _gather(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return gathered(c, b, signature.args, arguments, 1, 0, 1)[0]


def gathered(c: Any, b: Any, kinds: Any, arguments: Any, width: int, start: int, size: int) -> list[Any]:
    """LLVM code that reads rows start, start + 1, ... of an owner that each lane chooses; of a NaN owner those of 0.

    Lanes that agree, as most do, read whole rows at once; that is asked once for all of them.

    Args:
        c: context.
        b: builder.
        kinds: Numba types of the table and of the owner's number, a float.
        arguments: the two.
        width: [-] rows of an owner.
        start: [-] the first that is read.
        size: [-] how many are.
    """
    (kind, owner_type), (table, owner) = kinds, arguments
    wide = owner_type is LANES
    zero = ir.Constant(DOUBLES, [0.0] * WIDTH) if wide else ir.Constant(DOUBLE, 0.0)
    numbers = whole(b, b.select(b.fcmp_ordered("ord", owner, owner), owner, zero))

    def place(number: Any, k: int) -> Any:
        first = b.mul(number, ir.Constant(INT64, width))
        return row_address(c, b, kind, table, b.add(first, ir.Constant(INT64, start + k)))

    if not wide:
        return [load_row(b, kind, place(numbers, k)) for k in range(size)]
    answers = [cgutils.alloca_once(b, DOUBLES) for _ in range(size)]
    common, is_same = _same_in_all(b, numbers)
    with b.if_else(is_same, likely=True) as (together, apart):
        with together:
            for k, answer in enumerate(answers):
                value = load_row(b, kind, place(common, k))
                b.store(value if kind is LANE_ROWS else spread(b, value, DOUBLES), answer)
        with apart:
            lanes = [ir.Constant(INT32, lane) for lane in range(WIDTH)]
            own = [b.extract_element(numbers, lane) for lane in lanes]
            for k, answer in enumerate(answers):
                result = ir.Constant(DOUBLES, ir.Undefined)
                for number, lane in zip(own, lanes, strict=True):
                    row = place(number, k)
                    row = b.gep(row, [lane]) if kind is LANE_ROWS else row
                    result = b.insert_element(result, b.load(row), lane)
                b.store(result, answer)
    return [b.load(answer) for answer in answers]


def _same_in_all(b: Any, numbers: Any) -> tuple[Any, Any]:
    """LLVM code: the first lane, and whether all lanes have its number."""
    first = b.extract_element(numbers, ir.Constant(INT32, 0))
    apart = b.icmp_unsigned("!=", numbers, spread(b, first, WORDS))
    return first, b.icmp_unsigned("==", b.bitcast(apart, ir.IntType(WIDTH)), ir.Constant(ir.IntType(WIDTH), 0))


def scatter(table: Rows, index: float, condition: bool, value: float) -> None:
    """Where the condition holds, put a number into the row whose number is a signal.

    Args:
        table: (n,) rows, changed in place.
        index: [-] a whole number as a float.
        condition: [-] a truth value or mask; elsewhere nothing is written.
        value: [any] the number.
    """
    if condition:
        table[int(index)] = value


def _scatter_type(table: Any, index: Any, condition: Any, value: Any) -> Any:
    if table not in ELEMENTS:
        return None
    truth = MASK if condition is MASK else types.boolean
    return types.void(table, index if index is LANES else types.float64, truth, value)


@primitive(scatter, _scatter_type)
def _scatter(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    (kind, index_type, truth_type, value_type), (table, index, condition, value) = signature.args, arguments
    if kind is not LANE_ROWS:
        with b.if_then(condition):
            place = row_address(c, b, kind, table, whole(b, index))
            b.store(widened(c, b, value, value_type, types.float64), place)
        return c.get_dummy_value()
    numbers = whole(b, widened(c, b, index, index_type, LANES))
    mask = widened(c, b, condition, truth_type, MASK)
    values = widened(c, b, value, value_type, LANES)
    first, is_same = _same_in_all(b, numbers)
    writes = b.icmp_unsigned("!=", b.bitcast(mask, ir.IntType(WIDTH)), ir.Constant(ir.IntType(WIDTH), 0))
    with b.if_else(b.and_(is_same, writes), likely=True) as (together, apart):
        with together:
            row = row_address(c, b, kind, table, first)
            store_row(b, kind, row, b.select(mask, values, load_row(b, kind, row)))
        with apart:
            for lane in range(WIDTH):
                which = ir.Constant(INT32, lane)
                with b.if_then(b.extract_element(mask, which)):
                    row = row_address(c, b, kind, table, b.extract_element(numbers, which))
                    b.store(b.extract_element(values, which), b.gep(row, [which]))
    return c.get_dummy_value()


def as_law_sees(c: Any, b: Any, value: Any, kind: Any, wanted: Any) -> Any:
    """LLVM code that brings a number, a table or a record to the type that a law's signature asks for."""
    if kind == wanted:
        return value
    if isinstance(wanted, types.BaseTuple):
        parts = [
            as_law_sees(c, b, b.extract_value(value, k), kind.types[k], part) for k, part in enumerate(wanted.types)
        ]
        return c.make_tuple(b, wanted, parts)
    return widened(c, b, value, kind, wanted)


def optional(otherwise: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Decorate a compiled function that only missions with a certain table of whole numbers need.

    It is then called with that table before its own arguments.  Where a table of other numbers stands in its place the
    answer is one of the arguments as it is: the type of the table decides, so that the function is not even compiled.

    Args:
        otherwise: name of that argument.
    """

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        names = list(inspect.signature(function).parameters)
        place, given = names.index(otherwise), ", ".join(names)
        present = eval(f"lambda table, {given}: function({given})", {"function": function})
        absent = eval(f"lambda table, {given}: {otherwise}")

        @functools.wraps(function)
        def choose(table: Any, *arguments: Any) -> Any:
            return function(*arguments) if table.dtype.kind == "i" else arguments[place]

        @overload(choose, strict=False, jit_options=INLINED)
        def specialized(table: Any, *arguments: Any) -> Any:
            return present if table is INTS else absent

        return choose

    return decorate


def ramp(first: float, step: float) -> Any:
    """first, first + step, ... in eight lanes; for code that computes ahead, in compiled code only."""
    return first + step * np.arange(WIDTH)


@primitive(ramp, lambda first, step: LANES(types.float64, types.float64))
def _ramp(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    first, step = (spread(b, value, DOUBLES) for value in arguments)
    return b.fadd(first, b.fmul(step, ir.Constant(DOUBLES, [float(k) for k in range(WIDTH)])))


def spill(table: Rows, k: int, values: Any) -> None:
    """Store eight lanes into eight rows from row k on; in compiled code only."""
    table[k : k + WIDTH] = values


@primitive(spill, lambda table, k, values: types.void(FLAT_ROWS, types.int64, LANES))
def _spill(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    place = row_address(c, b, FLAT_ROWS, *arguments[:2])
    store_row(b, LANE_ROWS, place, arguments[2])
    return c.get_dummy_value()


def by_width(flat: Callable[..., Any], lanes: Callable[..., Any]) -> Callable[..., Any]:
    """One function for two kinds of tables: `flat` for one mission, `lanes` for eight and in plain Python.

    Both take a table first and must give the same numbers.
    """

    def choose(table: Rows, *arguments: Any) -> Any:
        return lanes(table, *arguments)

    @overload(choose, strict=False, jit_options=INLINED)
    def specialized(table: Any, *arguments: Any) -> Any:
        return flat if table is FLAT_ROWS else lanes

    return choose
