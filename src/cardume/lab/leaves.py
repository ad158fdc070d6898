"""Every number, word and law that a mission says, with the key that changes it: the records, walked."""

from collections.abc import Iterator
from dataclasses import MISSING
from typing import Any, NamedTuple

from cardume.errors import CardumeError
from cardume.missions.catalog import Catalog
from cardume.missions.descriptions import describe
from cardume.missions.distributions import Choose, Normal, Uniform
from cardume.missions.lookup import TEXT_PARAMETERS, law_fields
from cardume.missions.mission import Mission
from cardume.missions.route import Point
from cardume.missions.schema import (
    ANY,
    NOT_NEGATIVE,
    Forms,
    Graph,
    Group,
    Kind,
    Laws,
    ListOf,
    Profile,
    Quantity,
    Requirements,
    Variant,
    Whole,
    Word,
    fields_of,
)
from cardume.missions.tree import join
from cardume.missions.vehicle import Vehicle
from cardume.units import show_quantity

MOST_ITEMS = 12  # of a list, beyond which its numbers are not shown one by one


class Leaf(NamedTuple):
    """One value of a mission."""

    key: str
    kind: Kind
    value: Any
    meaning: str
    given: str = ""  # how it is drawn, where it is
    options: tuple[str, ...] = ()
    law: str = ""  # key of the law whose parameter it is


class Walk:
    """Goes through a mission's records.

    Args:
        catalog: where its laws are found.
    """

    def __init__(self, catalog: Catalog) -> None:
        self.catalog = catalog

    def record(self, value: Any, drawn: Any, key: str = "", leave_out: frozenset[str] = frozenset()) -> Iterator[Leaf]:
        """The leaves of a record.

        Args:
            value: the record, as written.
            drawn: the same with everything drawn.
            key: its own.
            leave_out: names of fields.
        """
        for field in fields_of(type(drawn)):
            if field.key in leave_out:
                continue
            is_inlined = isinstance(field.kind, Laws) and field.kind.inlined
            own = key if is_inlined else join(key, field.key)
            inner, now = getattr(value, field.attribute, None), getattr(drawn, field.attribute)
            yield from self.field(field.kind, own, inner, now, field.doc)

    def field(self, kind: Kind, key: str, value: Any, drawn: Any, meaning: str) -> Iterator[Leaf]:
        """The leaves of one field.

        Args:
            kind: what it may hold.
            key: its own.
            value: as written.
            drawn: what it is.
            meaning: what it is for.
        """
        if isinstance(kind, Laws):
            yield from self._law(kind, key, value, drawn, meaning)
        elif drawn is None or isinstance(drawn, Profile):
            return
        elif isinstance(kind, Quantity | Whole):
            yield Leaf(key, kind, drawn, meaning, told(value, getattr(kind, "unit", "")))
        elif isinstance(kind, Word):
            yield Leaf(key, kind, drawn, meaning, told(value), kind.choices)
        elif isinstance(kind, Graph):
            if isinstance(drawn, str):
                yield Leaf(key, kind, drawn, meaning, told(value), kind.names)
        elif isinstance(kind, Group | Variant | Forms):
            yield from self.record(value, drawn, key)
        elif isinstance(kind, Requirements):
            for item in drawn:
                yield Leaf(
                    join(key, item.vehicle or "", item.metric),
                    Quantity(item.unit, NOT_NEGATIVE if item.limit >= 0.0 else ANY),
                    item.limit,
                    f"{item.metric.replace('_', ' ')}{f' of {item.vehicle}' if item.vehicle else ''}, required",
                )
        elif isinstance(kind, ListOf) and 0 < len(drawn) <= MOST_ITEMS and not isinstance(drawn[0], Point):
            written = value if isinstance(value, tuple) else drawn
            for index, (one, now) in enumerate(zip(written, drawn, strict=False)):
                yield from self.field(kind.item, join(key, str(index)), one, now, meaning)

    def _law(self, kind: Laws, key: str, value: Any, drawn: Any, meaning: str) -> Iterator[Leaf]:
        options = [law for law in self.catalog.laws_of(kind.family) if not _needs_more(kind.family, law)]
        options += [word for word in kind.words if word not in options]
        name = "none" if drawn is None else drawn.name
        if name not in options:
            options.append(name)  # a law of the user's
        chooser = join(key, kind.selector) if kind.inlined else key
        yield Leaf(chooser, kind, name, meaning or f"the law of {kind.family.replace('_', ' ')}", "", tuple(options))
        law = None if drawn is None else self._law_named(kind.family, name)
        if law is None:
            return
        said = {parameter["name"]: parameter["meaning"] for parameter in describe(law)["parameters"]}
        written = getattr(value, "parameters", {})
        for field in law_fields(law):
            if field.key in drawn.parameters:
                inner, now = written.get(field.key), drawn.parameters[field.key]
                own, told_of = join(key, field.key), said.get(field.key, field.doc)
                for leaf in self.field(field.kind, own, inner, now, told_of):
                    yield leaf._replace(law=chooser)

    def _law_named(self, family: str, name: str) -> Any:
        try:
            return self.catalog.resolve_law(family, name) if ":" in name else self.catalog.laws_of(family).get(name)
        except CardumeError:
            return None


def _needs_more(family: str, law: str) -> bool:
    """Whether a law cannot be chosen by its name alone, as one that reads a file."""
    return any(field.default is MISSING for field in TEXT_PARAMETERS.get((family, law), ()))


def told(value: Any, unit: str = "") -> str:
    """How a value is drawn, in words; nothing where it is a plain one.

    Args:
        value: as written.
        unit: SI, of a number.
    """
    if isinstance(value, Uniform):
        return f"uniform from {show_quantity(value.low, unit)} to {show_quantity(value.high, unit)}"
    if isinstance(value, Normal):
        return f"normal, {show_quantity(value.mean, unit)} +- {show_quantity(value.deviation, unit)}"
    if isinstance(value, Choose):
        return f"one of {len(value.options)}"
    return ""


# Periods are counted in ticks, and ticks in plant steps: no slider finds values that fit together.
OF_THE_FLEET = frozenset({"cardume", "name", "seed", "vehicles", "origin", "tick", "plant_step"})
OF_A_VEHICLE = frozenset({"name"})


def mission_leaves(mission: Mission, drawn: Mission, walk: Walk) -> list[Leaf]:
    """What is said once for the whole mission.

    Args:
        mission: as written.
        drawn: the same with everything drawn.
        walk: through its laws.
    """
    return list(walk.record(mission, drawn, leave_out=OF_THE_FLEET))


def vehicle_leaves(vehicle: Vehicle, drawn: Vehicle, walk: Walk) -> list[Leaf]:
    """What is said of one vehicle, by keys that begin at the vehicle.

    Args:
        vehicle: as written.
        drawn: the same with everything drawn.
        walk: through its laws.
    """
    if drawn.sensors.ideal:
        return list(walk.record(vehicle, drawn, leave_out=OF_A_VEHICLE | {"sensors"}))
    return list(walk.record(vehicle, drawn, leave_out=OF_A_VEHICLE))
