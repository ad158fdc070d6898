"""The words in which the records of `mission.py` say what their keys may hold.

A record's field is `Annotated[type, kind, "a sentence"]`. The kinds below are pure data; three
interpreters read them: `reading` (file to records), `saving` (records to file) and `json_schema`
(for editors). So every key of the mission file is declared once, where its record is.
"""

from __future__ import annotations

import dataclasses
import functools
import keyword
import math
from collections.abc import Callable, Hashable, Mapping
from typing import Annotated, Any, get_args, get_origin, get_type_hints

HUGE = 1e9
"""No quantity of a mission is larger, in SI, unless its field says so; 1e300 m is a slip, not a path."""


@dataclasses.dataclass(frozen=True, slots=True)
class Bounds:
    """An interval of SI numbers; an open end is itself excluded."""

    low: float = -HUGE
    high: float = HUGE
    low_open: bool = False
    high_open: bool = False

    def contain(self, value: float) -> bool:
        """Whether `value` lies inside; never true for NaN."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below and math.isfinite(value)


ANY = Bounds()
POSITIVE = Bounds(0.0, low_open=True)
NOT_NEGATIVE = Bounds(0.0)


@dataclasses.dataclass(frozen=True, slots=True)
class Kind:
    """What a key may hold; a fixed one may be neither drawn nor swept."""

    fixed: bool = dataclasses.field(default=False, kw_only=True)


@dataclasses.dataclass(frozen=True, slots=True)
class Quantity(Kind):
    """A number with a unit, SI inside; `in_ticks`: a whole number of ticks."""

    unit: str = ""
    bounds: Bounds = ANY
    in_ticks: bool = False


@dataclasses.dataclass(frozen=True, slots=True)
class Profiled(Quantity):
    """A quantity, or {profile: time | path, points: [[0 s, ...], ...]}: linear between its points, held beyond."""


PROFILE_UNITS: Mapping[str, str] = {"time": "s", "path": "m"}
MOST_PROFILE_POINTS = 1000


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A quantity that changes with time or along the reference path, SI."""

    over: str
    points: tuple[tuple[float, float], ...]

    @property
    def values(self) -> tuple[float, ...]:
        """The quantity at each point."""
        return tuple(value for _, value in self.points)

    def mean(self, start: float, end: float) -> float:
        """Its mean from `start` to `end`, a straight line between the points.

        Args:
            start: [s] or [m]
            end: [s] or [m] beyond it.
        """
        inner = [x for x, _ in self.points if start < x < end]
        knots = [start, *inner, end]
        values = [self.at(x) for x in knots]
        area = sum(0.5 * (a + b) * (q - p) for p, q, a, b in zip(knots, knots[1:], values, values[1:], strict=False))
        return area / (end - start) if end > start else values[0]

    def at(self, x: float) -> float:
        """The quantity at a time [s] or place [m]."""
        before = max((k for k, (place, _) in enumerate(self.points) if place <= x), default=None)
        if before is None:
            return self.points[0][1]
        if before == len(self.points) - 1:
            return self.points[-1][1]
        (low, first), (high, second) = self.points[before : before + 2]
        return first + (second - first) * (x - low) / (high - low)


@dataclasses.dataclass(frozen=True, slots=True)
class Whole(Kind):
    """A whole number without a unit, low <= value <= high."""

    low: int = 0
    high: int = 2**63 - 1


@dataclasses.dataclass(frozen=True, slots=True)
class Word(Kind):
    """One of a few words."""

    choices: tuple[str, ...]


@dataclasses.dataclass(frozen=True, slots=True)
class Name(Kind):
    """A name that is safe as a file name: letters, digits, - and _, at most 64."""


@dataclasses.dataclass(frozen=True, slots=True)
class Member(Kind):
    """The name of a vehicle of the fleet."""


@dataclasses.dataclass(frozen=True, slots=True)
class Text(Kind):
    """Free text on one line."""


@dataclasses.dataclass(frozen=True, slots=True)
class File(Kind):
    """An existing file, given relative to the mission file; absolute inside."""


@dataclasses.dataclass(frozen=True, slots=True)
class Graph(Kind):
    """Who hears whom: the name of a graph, or its adjacency matrix, rows are listeners."""

    names: tuple[str, ...] = ("complete", "star", "path", "ring")
    weights: Bounds = NOT_NEGATIVE


@dataclasses.dataclass(frozen=True, slots=True)
class Requirements(Kind):
    """Limits on metrics, of the fleet or of a named vehicle; each becomes one record."""

    record: type


@dataclasses.dataclass(frozen=True, slots=True)
class Laws(Kind):
    """A law of a family with its parameters; `selector` is the key that names the law.

    An inlined choice has no section of its own: its keys stand among those of its record.
    `default` None means the family's first law; `words` are texts that stand for a whole record. A law that `announces`
    sets what the parameters of others, read after it, are when they are left out.
    """

    family: str
    selector: str = "law"
    default: str | None = None
    inlined: bool = False
    words: Mapping[str, Any] = dataclasses.field(default_factory=dict, hash=False)
    announces: bool = False


@dataclasses.dataclass(frozen=True, slots=True)
class Group(Kind):
    """A section that becomes one record; `words` are texts that stand for a whole record."""

    record: type
    words: Mapping[str, Any] = dataclasses.field(default_factory=dict, hash=False)


@dataclasses.dataclass(frozen=True, slots=True)
class Variant(Kind):
    """A section that becomes the record named by its selector; `words` are texts that stand for a whole record."""

    records: Mapping[str, type] = dataclasses.field(hash=False)
    selector: str = "type"
    words: Mapping[str, Any] = dataclasses.field(default_factory=dict, hash=False)


@dataclasses.dataclass(frozen=True, slots=True)
class Forms(Kind):
    """A section that becomes the first of the records that owns most of the keys given."""

    records: tuple[type, ...]


@dataclasses.dataclass(frozen=True, slots=True)
class ListOf(Kind):
    """At least one item of one kind."""

    item: Kind


@dataclasses.dataclass(frozen=True, slots=True)
class Default:
    """What a key left out stands for, as if written in the file, from the values read before it."""

    written: Callable[[Mapping[str, Any], Any], Any]


@dataclasses.dataclass(frozen=True, slots=True)
class Shared:
    """Marks a vehicle's section that may also stand at the top of the file, for the whole fleet."""


@dataclasses.dataclass(frozen=True, slots=True)
class Field:
    """One key of a record, as its annotation declares it; one that Python keeps for itself has a _ behind it there."""

    key: str
    kind: Kind
    default: Any
    written: Default | None
    shared: bool
    doc: str

    @property
    def attribute(self) -> str:
        """The record's name for it."""
        return f"{self.key}_" if keyword.iskeyword(self.key) else self.key


def fields_of(record: type) -> tuple[Field, ...]:
    """The keys of a record, in order; fields without a kind are not part of the file."""
    return _fields_of(record)


@functools.cache
def _fields_of(record: Hashable) -> tuple[Field, ...]:
    assert isinstance(record, type)
    hints = get_type_hints(record, include_extras=True)
    return tuple(
        _field(item, get_args(hints[item.name])[1:])
        for item in dataclasses.fields(record)
        if get_origin(hints[item.name]) is Annotated
    )


def records_of(kind: Kind) -> tuple[type, ...]:
    """The records that a section of this kind may become."""
    if isinstance(kind, Group):
        return (kind.record,)
    if isinstance(kind, Variant):
        return tuple(kind.records.values())
    return kind.records if isinstance(kind, Forms) else ()


def _field(item: dataclasses.Field[Any], marks: tuple[Any, ...]) -> Field:
    def first(of: type) -> Any:
        return next((mark for mark in marks if isinstance(mark, of)), None)

    return Field(
        item.name.rstrip("_"), first(Kind), item.default, first(Default), first(Shared) is not None, first(str) or ""
    )
