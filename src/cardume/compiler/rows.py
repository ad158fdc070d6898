"""Rows: a column of numbers in a table, one float64 each, or eight missions each.

A mission's state is plain tables of float64.  Compiled code sees a table as `Rows`, a bare
pointer with a stride, or as `LaneRows`, a pointer whose every row is a register of eight missions;
array views in the inner loop cost 15 to 20 %.  Because `Rows` carries its stride, a law that does
not compile for lanes can be shown one lane of a `LaneRows` table.  `Ints` is a table of whole
numbers, the same for all lanes.  In plain Python all of them are one-dimensional numpy arrays.
"""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, overload, register_model, typeof_impl

from cardume.compiler.lanes import DOUBLE, DOUBLES, INT32, INT64, LANES, MASK, WIDTH, is_number, splat

Rows = np.ndarray  # (k,) float64; how laws and records annotate a table


class SharedRows(np.ndarray):  # type: ignore[type-arg]
    """Annotates a table that is the same in all lanes."""


class RowsType(types.Type):
    """Numba type of a strided column of float64."""

    def __init__(self) -> None:
        super().__init__(name="Rows")


class LaneRowsType(types.Type):
    """Numba type of a column of `Lanes`."""

    def __init__(self) -> None:
        super().__init__(name=f"LaneRows{WIDTH}")


class IntsType(types.Type):
    """Numba type of a column of int64."""

    def __init__(self) -> None:
        super().__init__(name="Ints")


ROWS, LANE_ROWS, INTS = RowsType(), LaneRowsType(), IntsType()
TABLES = (ROWS, LANE_ROWS, INTS)


@register_model(RowsType)
class _RowsModel(models.StructModel):  # type: ignore[misc]
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, [("data", types.CPointer(types.float64)), ("stride", types.int64)])


def _register_pointer(kind: type[types.Type], pointee: Any) -> None:
    @register_model(kind)
    class _Model(models.PrimitiveModel):  # type: ignore[misc]
        def __init__(self, manager: Any, fe_type: Any) -> None:
            super().__init__(manager, fe_type, pointee.as_pointer())


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


@intrinsic
def _rows_of_array(context: Any, array: Any) -> Any:
    kind = {(1, types.float64): ROWS, (2, types.float64): LANE_ROWS, (1, types.int64): INTS}[
        (array.ndim, array.dtype)
    ]

    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        data = c.make_array(s.args[0])(c, b, arguments[0]).data
        return make_rows(c, b, data, ir.Constant(INT64, 1)) if kind is ROWS else data

    return kind(array), generate


def rows_of(array: np.ndarray) -> Rows:
    """The rows of a contiguous array, which must stay alive meanwhile.

    Args:
        array: (k,) float64, (k, 8) float64 for eight missions, or (k,) int64.

    Returns:
        Rows, LaneRows or Ints; in plain Python the array itself.
    """
    return array


@overload(rows_of, strict=False)
def _rows_of(array: Any) -> Any:
    return lambda array: _rows_of_array(array)


def _address(c: Any, b: Any, kind: Any, table: Any, k: Any) -> Any:
    """LLVM pointer to row k."""
    if kind is ROWS:
        rows = cgutils.create_struct_proxy(ROWS)(c, b, table)
        return b.gep(rows.data, [b.mul(k, rows.stride)])
    if kind is LANE_ROWS:
        return b.gep(table, [b.mul(k, ir.Constant(INT64, WIDTH))])
    return b.gep(table, [k])


@intrinsic
def _load(context: Any, table: Any, k: Any) -> Any:
    element = {ROWS: types.float64, LANE_ROWS: LANES, INTS: types.int64}[table]

    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        place = _address(c, b, s.args[0], *arguments)
        if s.args[0] is LANE_ROWS:
            return b.load(b.bitcast(place, DOUBLES.as_pointer()), align=8)
        return b.load(place)

    return element(table, types.int64), generate


def load(table: Rows, k: int) -> Any:
    """Row k of a table.

    Args:
        table: (n,) rows.
        k: [-] a whole number, the same in all lanes.

    Returns:
        The number there; eight of them from lane rows.
    """
    return table[k]


@overload(load, strict=False)
def _overload_load(table: Any, k: Any) -> Any:
    return (lambda table, k: _load(table, k)) if table in TABLES else (lambda table, k: table[k])


@intrinsic
def _store(context: Any, table: Any, k: Any, value: Any) -> Any:
    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        place = _address(c, b, s.args[0], *arguments[:2])
        if s.args[0] is LANE_ROWS:
            b.store(arguments[2], b.bitcast(place, DOUBLES.as_pointer()), align=8)
        else:
            b.store(arguments[2], place)
        return c.get_dummy_value()

    element = {ROWS: types.float64, LANE_ROWS: LANES, INTS: types.int64}[table]
    return types.void(table, types.int64, element), generate


def store(table: Rows, k: int, value: float) -> None:
    """Put a number into row k of a table.

    Args:
        table: (n,) rows, changed in place.
        k: [-] a whole number, the same in all lanes.
        value: [any] a number for one mission or for all lanes, or lanes.
    """
    table[k] = value


@overload(store, strict=False)
def _overload_store(table: Any, k: Any, value: Any) -> Any:
    if table is LANE_ROWS and is_number(value):
        return lambda table, k, value: _store(table, k, splat(float(value)))
    if table is ROWS and isinstance(value, types.Integer):
        return lambda table, k, value: _store(table, k, float(value))
    if table in TABLES:
        return lambda table, k, value: _store(table, k, value)

    def into_array(table: Any, k: Any, value: Any) -> None:
        table[k] = value

    return into_array


@intrinsic
def _at(context: Any, table: Any, offset: Any) -> Any:
    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        place = _address(c, b, s.args[0], *arguments)
        if s.args[0] is not ROWS:
            return place
        return make_rows(c, b, place, cgutils.create_struct_proxy(ROWS)(c, b, arguments[0]).stride)

    return table(table, types.int64), generate


def at(table: Rows, offset: int) -> Rows:
    """The table from row `offset` on: load(at(t, 3), 0) is load(t, 3)."""
    return table[offset:]


@overload(at, strict=False)
def _overload_at(table: Any, offset: Any) -> Any:
    return (
        (lambda table, offset: _at(table, offset)) if table in TABLES else (lambda table, offset: table[offset:])
    )


@intrinsic
def _lane_gather(context: Any, table: Any, index: Any) -> Any:
    """Each lane reads a row of its own choice; a NaN index reads row 0."""

    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        ordered = b.fcmp_ordered("ord", arguments[1], arguments[1])
        safe = b.select(ordered, arguments[1], ir.Constant(DOUBLES, [0.0] * WIDTH))
        numbers = b.fptosi(safe, ir.VectorType(INT64, WIDTH))
        result = ir.Constant(DOUBLES, ir.Undefined)
        for lane in range(WIDTH):
            which = ir.Constant(INT32, lane)
            place = _address(c, b, s.args[0], arguments[0], b.extract_element(numbers, which))
            if s.args[0] is LANE_ROWS:
                place = b.gep(place, [which])
            result = b.insert_element(result, b.load(place), which)
        return result

    return LANES(table, LANES), generate


def gather(table: Rows, index: float) -> float:
    """The row whose number is a signal and may differ from lane to lane.

    Args:
        table: (n,) rows.
        index: [-] a whole number as a float; NaN reads row 0.

    Returns:
        The number there.
    """
    return table[int(index) if index == index else 0]


@overload(gather, strict=False)
def _overload_gather(table: Any, index: Any) -> Any:
    if index is LANES:
        return lambda table, index: _lane_gather(table, index)
    return lambda table, index: load(table, np.int64(index) if index == index else 0)


@intrinsic
def _lane_scatter(context: Any, table: Any, index: Any, mask: Any, value: Any) -> Any:
    def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
        rows, index, mask, value = arguments
        numbers = b.fptosi(index, ir.VectorType(INT64, WIDTH))
        for lane in range(WIDTH):
            which = ir.Constant(INT32, lane)
            with b.if_then(b.extract_element(mask, which)):
                place = b.gep(_address(c, b, LANE_ROWS, rows, b.extract_element(numbers, which)), [which])
                b.store(b.extract_element(value, which), place)
        return c.get_dummy_value()

    return types.void(LANE_ROWS, LANES, MASK, LANES), generate


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


@overload(scatter, strict=False)
def _overload_scatter(table: Any, index: Any, condition: Any, value: Any) -> Any:
    if table is LANE_ROWS:
        return lambda table, index, condition, value: _lane_scatter(
            table, as_real(table, index), as_mask(table, condition), as_real(table, value)
        )

    def scalar(table: Any, index: Any, condition: Any, value: Any) -> None:
        if condition:
            store(table, np.int64(index), value)

    return scalar


def as_real(table: Rows, value: Any) -> Any:
    """A number as wide as the rows of a table: itself, or the same in all lanes."""
    return value


@overload(as_real, strict=False)
def _as_real(table: Any, value: Any) -> Any:
    if value in TABLES:
        return lambda table, value: value
    if table is LANE_ROWS:
        return (lambda table, value: value) if value is LANES else (lambda table, value: splat(float(value)))
    return lambda table, value: float(value)


def as_mask(table: Rows, condition: bool) -> Any:
    """A truth value as wide as the rows of a table."""
    return condition


@overload(as_mask, strict=False)
def _as_mask(table: Any, condition: Any) -> Any:
    if table is LANE_ROWS and condition is not MASK:
        return lambda table, condition: splat(1.0 if condition else 0.0) > 0.5
    return lambda table, condition: condition


@typeof_impl.register(RowsType)
def _typeof_rows(value: Any, context: Any) -> Any:
    return value
