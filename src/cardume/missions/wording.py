"""What a kind of key wants, in the words of an error message."""

from __future__ import annotations

from functools import singledispatch

from cardume.missions.schema import (
    HUGE,
    Bounds,
    File,
    Forms,
    Graph,
    Group,
    Kind,
    Laws,
    ListOf,
    Member,
    Name,
    Profiled,
    Quantity,
    Requirements,
    Text,
    Variant,
    Whole,
    Word,
    fields_of,
)
from cardume.units import DEGREE, nearest, show_quantity


@singledispatch
def wanted(kind: Kind) -> str:
    """What is valid here, to follow `must be`.

    Raises:
        TypeError: no such kind.
    """
    raise TypeError(kind)


@wanted.register
def _quantity(kind: Quantity) -> str:
    example = f", as '{_example(kind)}'" if kind.unit else ""
    return f"a number{example}{_limits(kind.bounds, kind.unit)}"


@wanted.register
def _profiled(kind: Profiled) -> str:
    example = f"[[0 s, {_example(kind)}], [60 s, {_example(kind)}]]"
    return f"{_quantity(kind)}; or a profile, as {{profile: time, points: {example}}}, or over the path in meters"


@wanted.register
def _whole(kind: Whole) -> str:
    if kind.low == kind.high:
        return f"{kind.low}"
    return f"a whole number from {kind.low} to {kind.high}"


@wanted.register
def _word(kind: Word) -> str:
    return f"one of {', '.join(kind.choices)}"


@wanted.register
def _name(_kind: Name) -> str:
    return "1 to 64 letters, digits, - and _, first a letter or digit; a number in quotes"


@wanted.register
def _member(_kind: Member) -> str:
    return "the name of a vehicle"


@wanted.register
def _text(_kind: Text) -> str:
    return "a text on one line"


@wanted.register
def _file(_kind: File) -> str:
    return "the name of a file, relative to the mission file"


@wanted.register
def _graph(kind: Graph) -> str:
    return f"one of {', '.join(kind.names)}, or a square matrix of numbers, one row for each vehicle that listens"


@wanted.register
def _requirements(_kind: Requirements) -> str:
    return "a mapping of metrics to limits; of one vehicle, its name and such a mapping"


@wanted.register
def _laws(kind: Laws) -> str:
    return f"the name of a law, or a mapping with {kind.selector}: and its parameters"


@wanted.register
def _group(kind: Group) -> str:
    words = "".join(f", or '{word}'" for word in kind.words)
    return f"a mapping with the keys {', '.join(keys_of(kind.record))}{words}"


@wanted.register
def _variant(kind: Variant) -> str:
    words = "".join(f", or '{word}'" for word in kind.words)
    return f"a mapping with {kind.selector}: one of {', '.join(kind.records)}{words}"


@wanted.register
def _forms(kind: Forms) -> str:
    return f"a mapping with the keys {'; or '.join(', '.join(keys_of(record)) for record in kind.records)}"


@wanted.register
def _list(_kind: ListOf) -> str:
    return "a list with at least one item, each on a line that begins with '- '"


def keys_of(record: type) -> list[str]:
    """The keys of a record's section that do not depend on a law."""
    return [
        field.kind.selector if isinstance(field.kind, Laws) and field.kind.inlined else field.key
        for field in fields_of(record)
    ]


def unknown(what: str, given: str, valid: list[str]) -> str:
    """An unknown name: which is nearest, and which there are."""
    listed = ", ".join(valid[:40]) + (", ..." if len(valid) > 40 else "")
    return f"{what}{nearest(given, valid) or '.'} Valid here: {listed or 'nothing'}"


def _limits(bounds: Bounds, unit: str) -> str:
    ends = []
    if bounds.low > -HUGE:
        ends.append(f"{'above' if bounds.low_open else 'at least'} {show_quantity(bounds.low, unit, 12)}")
    if bounds.high < HUGE:
        ends.append(f"{'below' if bounds.high_open else 'at most'} {show_quantity(bounds.high, unit, 12)}")
    if not ends:
        return f", at most {HUGE:g} {unit}".rstrip() + " in size"
    return f", {' and '.join(ends)}"


def _example(kind: Quantity) -> str:
    for value in (10.0 * DEGREE if kind.unit in ("rad", "rad/s") else 1.0, kind.bounds.low, kind.bounds.high):
        if kind.bounds.contain(value):
            return show_quantity(value, kind.unit)
    return show_quantity((kind.bounds.low + kind.bounds.high) / 2.0, kind.unit)
