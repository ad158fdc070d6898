"""Records in tables: accessors that compile to plain loads and stores.

A record is a `NamedTuple` of floats.  A `Layout` says at which rows of an owner's part of a table
each record lies, and makes the functions that read and write it there; raw indices live only here.
"""

import typing
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from cardume.compiler.lanes import INT64, LANES, widened
from cardume.compiler.primitive import primitive
from cardume.compiler.reference import ReferenceType
from cardume.compiler.rows import ELEMENTS, FLAT_ROWS, LANE_ROWS, gathered, load_row, row_address, store_row


class Layout:
    """The records that one owner (a vehicle, a link, a mission) has in a table, one after the other."""

    def __init__(self, *records: type[Any], width: int = 0) -> None:
        """Lay records out.

        Args:
            records: in their order.
            width: [-] numbers of an owner, where they are more than those of the records.
        """
        self.offsets: dict[type[Any], int] = {}
        self.width = 0
        for record in records:
            self.offsets[record] = self.width
            self.width += len(record._fields)
        self.width = max(self.width, width)

    def lay_over(self, record: type[Any], first: str, *parts: type[Any]) -> None:
        """Let records stand for some of the numbers of another, one after the other from a field of it on."""
        offset = self.column(record, first)
        for part in parts:
            self.offsets[part] = offset
            offset += len(part._fields)

    def reader(self, record: type[Any]) -> Callable[..., Any]:
        """A function (table, owner) -> record."""
        width, start, size = self.width, self.offsets[record], len(record._fields)

        def get(table: Any, owner: int) -> Any:
            first = owner * width + start
            return record(*table[first : first + size])

        def typed(table: Any, owner: Any) -> Any:
            if table not in ELEMENTS:
                return None
            return types.BaseTuple.from_types([ELEMENTS[table]] * size, record)(table, types.int64)

        @primitive(get, typed)
        def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
            kind, places = signature.args[0], _places(c, b, signature, arguments, width, start, size)
            return c.make_tuple(b, signature.return_type, [load_row(b, kind, place) for place in places])

        return get

    def viewer(self, record: type[Any]) -> Callable[..., Any]:
        """A function (table, owner) -> record by reference, read before the table changes: plain Python has a copy."""
        width, start, size = self.width, self.offsets[record], len(record._fields)
        get = self.reader(record)

        def view(table: Any, owner: int) -> Any:
            return get(table, owner)

        def typed(table: Any, owner: Any) -> Any:
            if table not in (FLAT_ROWS, LANE_ROWS):
                return None
            kind = ReferenceType(types.BaseTuple.from_types([ELEMENTS[table]] * size, record))
            return kind(table, types.int64)

        @primitive(view, typed)
        def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
            first = _places(c, b, signature, arguments, width, start, 1)[0]
            return b.bitcast(first, c.get_value_type(signature.return_type))

        return view

    def writer(self, record: type[Any]) -> Callable[..., Any]:
        """A function (table, owner, record) that stores the record."""
        width, start, size = self.width, self.offsets[record], len(record._fields)

        def put(table: Any, owner: int, value: Any) -> None:
            first = owner * width + start
            table[first : first + size] = value

        def typed(table: Any, owner: Any, value: Any) -> Any:
            fits = isinstance(value, types.BaseTuple) and len(value) == size and table in ELEMENTS
            return types.void(table, types.int64, value) if fits else None

        @primitive(put, typed)
        def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
            kind, _, given = signature.args
            for k, place in enumerate(_places(c, b, signature, arguments, width, start, size)):
                part = b.extract_value(arguments[2], k)
                store_row(b, kind, place, widened(c, b, part, given.types[k], ELEMENTS[kind]))
            return c.get_dummy_value()

        return put

    def picker(self, record: type[Any]) -> Callable[..., Any]:
        """A function (table, owner) -> record whose owner is a signal and may differ from lane to lane."""
        width, start, size = self.width, self.offsets[record], len(record._fields)

        def pick(table: Any, owner: float) -> Any:
            first = (int(owner) if owner == owner else 0) * width + start
            return record(*table[first : first + size])

        def typed(table: Any, owner: Any) -> Any:
            if table not in ELEMENTS:
                return None
            result = LANES if owner is LANES else ELEMENTS[table]
            return types.BaseTuple.from_types([result] * size, record)(
                table, LANES if owner is LANES else types.float64
            )

        @primitive(pick, typed)
        def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
            numbers = gathered(c, b, signature.args, arguments, width, start, size)
            return c.make_tuple(b, signature.return_type, numbers)

        return pick

    def column(self, record: type[Any], field: str) -> int:
        """The row of one field, counted from the owner's first."""
        return self.offsets[record] + record._fields.index(field)


def _places(c: Any, b: Any, signature: Any, arguments: Any, width: int, start: int, size: int) -> list[Any]:
    """LLVM addresses of the rows of a record."""
    table, owner = arguments[:2]
    first = b.add(b.mul(owner, ir.Constant(INT64, width)), ir.Constant(INT64, start))
    rows = [b.add(first, ir.Constant(INT64, k)) for k in range(size)]
    return [row_address(c, b, signature.args[0], table, row) for row in rows]


def size_of(kind: Any) -> int:
    """How many numbers a record holds, those of records in it counted one by one."""
    return sum(size_of(inner) for inner in typing.get_type_hints(kind).values()) if hasattr(kind, "_fields") else 1


def flattened(value: Any) -> list[float]:
    """The numbers of a record, those of records in it one by one."""
    return [x for part in value for x in flattened(part)] if isinstance(value, tuple) else [float(value)]


def read_record(kind: Any, table: str, first: int, scope: dict[str, Any]) -> str:
    """Source text that reads a record, of numbers and of records, from a table.

    Args:
        kind: the class of the record; its fields' names are in the text, so that one of other fields is another text.
        table: [-] name of the table in the text.
        first: [-] row of its first number.
        scope: [-] where the text finds the classes; they are added.
    """
    if not hasattr(kind, "_fields"):
        return f"load_fixed({table}, {first})"
    name = f"{kind.__name__}_{len(scope)}"
    scope[name] = kind
    parts = []
    for field, inner in typing.get_type_hints(kind).items():
        parts.append(f"{field}={read_record(inner, table, first, scope)}")
        first += size_of(inner)
    return f"{name}({', '.join(parts)})"
