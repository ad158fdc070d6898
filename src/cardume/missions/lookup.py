"""Which law a section names, and which keys that law brings with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING
from typing import Any

from cardume.errors import LawError
from cardume.missions.catalog import Context, Law, Parameter
from cardume.missions.schema import (
    HUGE,
    Bounds,
    Field,
    File,
    Group,
    Kind,
    Laws,
    ListOf,
    Quantity,
    Text,
    Word,
    fields_of,
    records_of,
)
from cardume.missions.tree import Node
from cardume.missions.varying import is_varying
from cardume.missions.vehicle import LawChoice
from cardume.missions.water import CurrentPoint
from cardume.missions.wording import unknown
from cardume.units import printable, show_text
from cardume.world.acoustics.profiles import BURSTS, MODEMS, Profile

TEXT_PARAMETERS: dict[tuple[str, str], tuple[Field, ...]] = {
    ("current", "gridded"): (
        Field("file", File(fixed=True), MISSING, None, False, "CF NetCDF with the velocity of the water"),
        Field("east", Text(fixed=True), None, None, False, "its variable for the velocity to the east"),
        Field("north", Text(fixed=True), None, None, False, "its variable for the velocity to the north"),
        Field("start_time", Text(fixed=True), None, None, False, "date of the mission's start, ISO 8601, UTC"),
    ),
    ("current", "sheared"): (
        Field("profile", ListOf(Group(CurrentPoint), fixed=True), MISSING, None, False, "velocities by depth"),
    ),
    ("acoustics", "modem"): (
        Field("profile", Word(tuple(MODEMS), fixed=True), "evologics_s2c", None, False, "whose modem it is"),
        Field("bursts", Word(tuple(BURSTS), fixed=True), "none", None, False, "how links fail; all but none are ours"),
        Field("codec", Word(("exact", "compact"), fixed=True), "exact", None, False, "whether numbers are rounded"),
    ),
    ("bathymetry", "gridded"): (
        Field("file", File(fixed=True), MISSING, None, False, "CF NetCDF or ESRI ASCII grid of depth or elevation"),
        Field("variable", Text(fixed=True), None, None, False, "of NetCDF, that holds the depth"),
        Field("positive", Word(("up", "down"), fixed=True), None, None, False, "down: depths, up: elevations"),
        Field("coordinates", Word(("geographic", "local"), fixed=True), None, None, False, "degrees, or meters"),
    ),
}
"""What laws take beside numbers: texts and lists, which compiled code does not see."""

PRESETS: dict[tuple[str, str], dict[str, Mapping[str, Profile]]] = {
    ("acoustics", "modem"): {"profile": MODEMS, "bursts": BURSTS},
}
"""Words of a law that set what its other parameters are when they are left out."""


class Chosen:
    """The law that a section names, as the fields it brings."""

    def __init__(
        self, kind: Laws, name: str, law: Law | None, announced: Mapping[str, float], entries: dict[str, Node]
    ) -> None:
        self.kind, self.name = kind, name
        self.fields = () if law is None else law_fields(law, {**announced, **preset_by(law, entries)})

    @property
    def keys(self) -> set[str]:
        """The keys that may stand in the section because of this law."""
        return {self.kind.selector, *(field.key for field in self.fields)}


def choose_law(kind: Laws, entries: dict[str, Node], section: Node, context: Context) -> Chosen:
    """The law that `entries` names, or else the default.

    Raises:
        MissionError: no such law, or the user's law cannot be had.
    """
    named, builtin = entries.get(kind.selector), context.catalog.laws_of(kind.family)
    announced = context.announced.get(kind.family, {})
    if named is None:
        name = kind.default if kind.default in {*builtin, *kind.words} else next(iter(builtin), None)
        if name is None:
            raise section.error(f"there is no law of the family {kind.family} to choose")
        return Chosen(kind, name, builtin.get(name), announced, entries)
    if is_varying(named):
        raise named.error(
            f"a varying law carries its parameters: write the whole section as"
            f" {{sweep: [{{{kind.selector}: ..., ...}}, {{{kind.selector}: ..., ...}}]}}"
        )
    name = named.value
    if isinstance(name, str) and ":" in name:
        return Chosen(kind, name, _user_law(kind, name, named, context), announced, entries)
    if isinstance(name, str) and (name in builtin or isinstance(kind.words.get(name), LawChoice)):
        return Chosen(kind, name, builtin.get(name), announced, entries)
    valid = [*builtin, *(word for word in kind.words if word not in builtin)]
    message = unknown(f"there is no {kind.family} law {named.given()}", str(name), valid)
    raise named.error(f"{message}, or your own law as module:function")


def law_fields(law: Law, announced: Mapping[str, float] | None = None) -> tuple[Field, ...]:
    """A law's parameters, as fields of its section.

    Args:
        law: of any family.
        announced: values that some of them have by default beside another law.
    """
    known = announced or {}

    def field(parameter: Parameter) -> Field:
        number, words = float(known.get(parameter.name, parameter.default)), parameter.words
        kind = Word(words, fixed=True) if words else _quantity(parameter, law.family)
        return Field(parameter.name, kind, words[round(number)] if words else number, None, False, "")

    return TEXT_PARAMETERS.get((law.family, law.name), ()) + tuple(field(p) for p in law.parameters)


def preset_by(law: Law, entries: dict[str, Node]) -> dict[str, float]:
    """What the words in a law's section make of its parameters that are left out.

    Args:
        law: of any family.
        entries: the keys of its section.
    """
    values: dict[str, float] = {}
    for key, presets in PRESETS.get((law.family, law.name), {}).items():
        word = entries[key].value if key in entries else None
        if isinstance(word, str) and word in presets:
            values |= presets[word].values
    return values


def announced_by(choice: Any, node: Node, context: Context) -> Mapping[str, Mapping[str, float]]:
    """What a law that was chosen announces of others' parameters.

    Args:
        choice: the law; or several, of which one is drawn.
        node: where it is chosen.
        context: of the mission.

    Raises:
        MissionError: several laws that announce different numbers.
    """
    options = getattr(choice, "options", (choice,))
    laws = [_law_named(option.family, option.name, context) for option in options]
    found = [getattr(law, "announced", {}) for law in laws]
    if any(numbers != found[0] for numbers in found):
        names = " and ".join(option.name for option in options)
        raise node.error(
            f"{names} want different autopilots and speed readers, so they cannot vary in one mission;"
            f" fly it once with each, as --set {node.position.key}={options[0].name}"
        )
    return found[0]


def _law_named(family: str, name: str, context: Context) -> Law | None:
    return context.catalog.resolve_law(family, name) if ":" in name else context.catalog.laws_of(family).get(name)


def inlined_laws(kind: Kind) -> list[Laws]:
    """The laws whose keys stand directly in a section of this kind."""
    if isinstance(kind, Laws):
        return [kind]
    kinds = [field.kind for record in records_of(kind) for field in fields_of(record)]
    return [inner for inner in kinds if isinstance(inner, Laws) and inner.inlined]


def _quantity(parameter: Parameter, family: str) -> Quantity:
    low, high = max(parameter.low, -HUGE), min(parameter.high, HUGE)
    bounds = Bounds(low, high, parameter.low_open and low == parameter.low, parameter.high_open)
    return Quantity(parameter.unit, bounds, in_ticks=parameter.name == "period" and family != "current")


def _user_law(kind: Laws, name: str, named: Node, context: Context) -> Law:
    try:
        law = context.catalog.resolve_law(kind.family, name)
    except LawError as problem:
        raise named.error(f"{show_text(name)} cannot be used: {printable(str(problem))}") from None
    except Exception as problem:  # whatever importing the user's file raises is the user's to mend
        reason = f"{type(problem).__name__}: {problem}"
        raise named.error(f"{show_text(name)} cannot be imported: {show_text(reason, 300)[1:-1]}") from problem
    if law.family != kind.family:
        raise named.error(f"{show_text(name)} is a {law.family} law; a {kind.family} law is needed here")
    return law
