"""Values that are not fixed yet: drawn from a distribution, or swept by a study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, is_dataclass, replace
from typing import Any

from cardume.missions.schema import ANY, Bounds, Field, Laws, fields_of
from cardume.missions.tree import join
from cardume.missions.vehicle import LawChoice, Table, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform:
    """Any number from `low` to `high`, all as likely; `per` is mission or vehicle."""

    low: float
    high: float
    per: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Normal:
    """A normal distribution, cut off at the bounds of the key that holds it."""

    mean: float
    deviation: float
    per: str
    bounds: Bounds = ANY


@dataclass(frozen=True, slots=True, kw_only=True)
class Choose:
    """One of several values or whole sections, all as likely."""

    options: tuple[Any, ...]
    per: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Several values or whole sections, each of which a study flies."""

    options: tuple[Any, ...]
    per: str


Varying = Uniform | Normal | Choose | Sweep


def rebuild(value: Any, visit: Callable[[str, Any], Any], key: str = "") -> Any:
    """A record with every value in it replaced by what `visit(key, value)` gives, from the outside in."""
    value = visit(key, value)
    if isinstance(value, LawChoice):
        items = {name: visit(join(key, name), item) for name, item in value.parameters.items()}
        return replace(value, parameters=Table(items))
    changes = {name: rebuild(part, visit, part_key) for name, part, part_key in parts_of(value, key)}
    if isinstance(value, tuple):
        return tuple(changes.values())
    return replace(value, **changes) if changes else value


def values_of(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """Every value in a record, records included, with its dotted key."""
    yield key, value
    if isinstance(value, LawChoice):
        for name, item in value.parameters.items():
            yield join(key, name), item
        return
    for _, inner, inner_key in parts_of(value, key):
        yield from values_of(inner, inner_key)


def parts_of(value: Any, key: str = "") -> list[tuple[Any, Any, str]]:
    """What a record or a tuple of them is made of: the name or place of each part, the part, and its dotted key."""
    if isinstance(value, tuple):
        return [(index, item, join(key, _item_key(item, index))) for index, item in enumerate(value)]
    return [
        (field.attribute, getattr(value, field.attribute), _field_key(key, field))
        for field in (fields_of(type(value)) if is_dataclass(value) else ())
    ]


def varying_values(record: Any) -> list[tuple[str, Varying]]:
    """Every value that varies, by the key under which it is drawn or swept, each key once."""
    found = {shared_key(key, value): value for key, value in values_of(record) if isinstance(value, Varying)}
    return list(found.items())


def units_of_varying(value: Any, key: str = "", unit: str = "") -> Iterator[tuple[str, Varying, str]]:
    """Every value that varies, also inside the options of another, with its shared key and its SI unit.

    Args:
        value: a record.
        key: under which it stands.
        unit: that it has, if it is a quantity.

    Yields:
        Key, value and unit; a key as often as it stands there.
    """
    if isinstance(value, Varying):
        yield shared_key(key, value), value, unit
        items = [(key, option, unit) for option in getattr(value, "options", ())]
    elif isinstance(value, LawChoice):
        items = [(join(key, name), item, value.units.get(name, "")) for name, item in value.parameters.items()]
    elif isinstance(value, tuple):
        items = [(join(key, _item_key(item, index)), item, unit) for index, item in enumerate(value)]
    else:
        items = [
            (_field_key(key, field), getattr(value, field.attribute), getattr(field.kind, "unit", ""))
            for field in (fields_of(type(value)) if is_dataclass(value) else ())
        ]
    for inner, item, of in items:
        yield from units_of_varying(item, inner, of)


def shared_key(key: str, value: Varying) -> str:
    """The key under which a value varies: that of the fleet's section if all vehicles share it."""
    words = key.split(".")
    is_shared = value.per == "mission" and words[0] == "vehicles"
    return ".".join(words[2:]) if is_shared else key


def _field_key(key: str, field: Field) -> str:
    """The keys of an inlined law stand among those of its record."""
    return key if isinstance(field.kind, Laws) and field.kind.inlined else join(key, field.key)


def _item_key(item: Any, index: int) -> str:
    return item.name if isinstance(item, Vehicle) else str(index)
