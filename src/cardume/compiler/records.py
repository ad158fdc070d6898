"""Records in tables: accessors that compile to plain loads and stores.

A record is a `NamedTuple` of floats.  A `Layout` says at which rows of a vehicle's table each
record lies, and writes the functions that read and write it there; raw indices live only here.
"""

from collections.abc import Callable
from typing import Any

from cardume.compiler.compiled import compiled
from cardume.compiler.rows import at, gather, load, store


class Layout:
    """The records that one owner (a vehicle, a link, a mission) has in a table, one after the other."""

    def __init__(self, *records: type[Any]) -> None:
        self.offsets: dict[type[Any], int] = {}
        self.width = 0
        for record in records:
            self.offsets[record] = self.width
            self.width += len(record._fields)

    def reader(self, record: type[Any]) -> Callable[..., Any]:
        """A compiled function (table, owner) -> record."""
        start = self.offsets[record]
        fields = ", ".join(f"load(rows, {start + k})" for k in range(len(record._fields)))
        return self._write(
            f"def get(table, owner):\n    rows = at(table, owner * {self.width})\n    return Record({fields})",
            record,
        )

    def writer(self, record: type[Any]) -> Callable[..., Any]:
        """A compiled function (table, owner, record) that stores the record."""
        start = self.offsets[record]
        stores = "\n".join(
            f"    store(rows, {start + k}, record.{field})" for k, field in enumerate(record._fields)
        )
        return self._write(
            f"def put(table, owner, record):\n    rows = at(table, owner * {self.width})\n{stores}", record
        )

    def picker(self, record: type[Any]) -> Callable[..., Any]:
        """A compiled function (table, owner) -> record whose owner is a signal and may differ by lane."""
        start = self.offsets[record]
        fields = ", ".join(f"gather(table, row + {start + k}.0)" for k in range(len(record._fields)))
        return self._write(
            f"def get(table, owner):\n    row = owner * {self.width}.0\n    return Record({fields})", record
        )

    def column(self, record: type[Any], field: str) -> int:
        """The row of one field, counted from the owner's first."""
        return self.offsets[record] + record._fields.index(field)

    def _write(self, source: str, record: type[Any]) -> Callable[..., Any]:
        scope: dict[str, Any] = {"Record": record, "load": load, "store": store, "at": at, "gather": gather}
        exec(compile(source, f"<{record.__name__} in a table>", "exec"), scope)
        return compiled(scope["get" if "get" in scope else "put"])
