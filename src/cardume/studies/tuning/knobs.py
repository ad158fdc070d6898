"""The keys that a tuning varies: where they stand in a mission, in which unit, and from where to where."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from typing import Any, NamedTuple, cast

from cardume.errors import InputError, UnitError
from cardume.missions.catalog import Catalog
from cardume.missions.distributions import Varying, parts_of, rebuild
from cardume.missions.mission import Mission
from cardume.missions.rules import RECURRING, check_rules
from cardume.missions.schema import HUGE, Quantity, fields_of
from cardume.missions.tree import join
from cardume.missions.vehicle import LawChoice
from cardume.units import nearest, parse_quantity, printable, show_quantity

AROUND = 5.0  # times less and more than the start, where a law has no bounds of its own
LOGARITHMIC = 8.0  # ratio of the ends from which steps are equal in proportion
WORDS = ("law", "type", "channel", "schedule", "reader")  # keys that name a law
DIGITS = 4  # that a recommended value has


@dataclass(frozen=True)
class Knob:
    """A number of a mission that may be changed.

    Attributes:
        key: in the mission file.
        unit: of its value, SI.
        start: [unit] that the mission has.
        low: [unit] the least that is tried.
        high: [unit] the most.
        is_given: whether the user gave these two.
    """

    key: str
    unit: str
    start: float
    low: float
    high: float
    is_given: bool

    @property
    def is_logarithmic(self) -> bool:
        """Whether equal steps are equal proportions."""
        return self.low > 0.0 and self.high / self.low >= LOGARITHMIC

    def at(self, share: float) -> float:
        """The value [unit] at a share [-] of the way from `low` to `high`, in digits that people read."""
        share = min(max(share, 0.0), 1.0)
        value = self.low + share * (self.high - self.low)
        if self.is_logarithmic:
            value = self.low * (self.high / self.low) ** share
        value = float(f"{value:.{DIGITS}g}")
        return min(max(value, self.low), self.high)

    def share(self, value: float) -> float:
        """The way from `low` to `high`, as a share [-], on which a value [unit] lies."""
        if self.is_logarithmic:
            return math.log(max(value, self.low) / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


class _Number(NamedTuple):
    """A number in a mission, and what is known of it."""

    value: Any
    unit: str
    low: float
    high: float
    low_open: bool
    high_open: bool

    def accepts(self, value: float) -> bool:
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below


def make_knobs(mission: Mission, texts: Sequence[str], catalog: Catalog) -> tuple[Knob, ...]:
    """What --vary asks for.

    Args:
        mission: that is tuned.
        texts: each `key` or `key=low..high`.
        catalog: where its laws are found.

    Raises:
        InputError: a key that is none or no number, or ends that cannot be.
    """
    if not texts:
        raise InputError("nothing to tune is given; say which key, as --vary guidance.lookahead=2..15")
    numbers: dict[str, list[_Number]] = {}
    for key, number in _numbers(mission, "", catalog):
        for name in {key, _of_fleet(key)}:
            numbers.setdefault(name, []).append(number)
    knobs = [_knob(text, mission, numbers) for text in texts]
    for knob in knobs:
        if sum(other.key == knob.key for other in knobs) > 1:
            raise InputError(f"--vary {knob.key}: is given twice; give each key once")
    return tuple(knobs)


def with_values(mission: Mission, knobs: Sequence[Knob], values: Sequence[float]) -> Mission:
    """The mission with other values of its knobs.

    Args:
        mission: that is tuned.
        knobs: of it.
        values: [unit] one for each.

    Raises:
        MissionError: values that do not fit one another.
    """
    given: Mapping[str, float] = {knob.key: value for knob, value in zip(knobs, values, strict=True)}

    def visit(key: str, value: Any) -> Any:
        name = key if key in given else _of_fleet(key)
        return given[name] if name in given and isinstance(value, (int, float)) else value

    changed = cast(Mission, rebuild(mission, visit))
    check_rules(changed)
    return changed


def _of_fleet(key: str) -> str:
    """The key under which a value may stand for all vehicles."""
    words = key.split(".")
    return ".".join(words[2:]) if words[0] == "vehicles" and len(words) > 2 else key


def _numbers(value: Any, key: str, catalog: Catalog) -> Iterator[tuple[str, _Number]]:
    if isinstance(value, LawChoice):
        yield from _law_numbers(value, key, catalog)
        return
    if isinstance(value, Varying):
        return
    quantities = {f.key: f.kind for f in fields_of(type(value))} if is_dataclass(value) else {}
    for name, part, part_key in parts_of(value, key):
        kind = quantities.get(str(name))
        if isinstance(kind, Quantity):
            unit, b = kind.unit, kind.bounds
            yield part_key, _Number(part, unit, b.low, b.high, b.low_open, b.high_open)
        else:
            yield from _numbers(part, part_key, catalog)


def _law_numbers(chosen: LawChoice, key: str, catalog: Catalog) -> Iterator[tuple[str, _Number]]:
    laws = catalog.laws_of(chosen.family)
    law = laws.get(chosen.name)
    if law is None and ":" in chosen.name:
        law = catalog.resolve_law(chosen.family, chosen.name)
    known = {p.name: p for p in law.parameters} if law else {}
    for name, value in chosen.parameters.items():
        if name in known and (value is None or isinstance(value, (int, float, *Varying.__args__))):
            p = known[name]
            yield join(key, name), _Number(value, p.unit, p.low, p.high, p.low_open, p.high_open)


def _knob(text: str, mission: Mission, numbers: Mapping[str, list[_Number]]) -> Knob:
    key, equals, ends = text.partition("=")
    key, said = key.strip(), f"--vary {printable(text)}"
    if key not in numbers:
        raise InputError(f"{said}: {_no_number(key, mission, numbers)}")
    if key.rpartition(".")[2] in RECURRING:
        raise InputError(f"{said}: is a whole number of ticks; try a few with cardume compare --vary {key}=...")
    found = numbers[key]
    values = {number.value for number in found}
    if any(isinstance(value, Varying) for value in values):
        raise InputError(f"{said}: the mission draws or sweeps this value; fix it, as --set {key}=..., to tune it")
    if None in values:
        raise InputError(f"{said}: the mission has no value there to begin with; give one, as --set {key}=...")
    if len(values) > 1:
        listed = ", ".join(show_quantity(value, found[0].unit) for value in sorted(values))
        raise InputError(
            f"{said}: the vehicles begin with different values, {listed}; tune one of them, as vehicles.NAME.{key}"
        )
    (start,) = values
    low, high = _given_ends(said, ends, found[0], key) if equals else _own_ends(said, float(start), found[0], key)
    return Knob(key, found[0].unit, float(start), low, high, bool(equals))


def _no_number(key: str, mission: Mission, numbers: Mapping[str, list[_Number]]) -> str:
    from cardume.missions.distributions import values_of

    there = {name for k, _ in values_of(mission) for name in (k, _of_fleet(k))}
    section, _, word = key.rpartition(".")
    if key in there or (section in there and word in WORDS):
        return "is no number with a range; several words or laws are compared by cardume compare"
    last = key.rpartition(".")[2]
    alike = sorted(name for name in numbers if name.rpartition(".")[2] == last and not name.startswith("vehicles."))
    hint = f". Did you mean '{alike[0]}'?" if alike else nearest(key, sorted(numbers))
    return f"the mission has no number of that name{hint or '; cardume run keeps all of them in mission.yaml'}"


def _given_ends(said: str, ends: str, number: _Number, key: str) -> tuple[float, float]:
    first, dots, last = ends.partition("..")
    if not dots:
        raise InputError(f"{said}: write the least and the most to try, as {key}=2..15, or leave them out")
    try:
        low, high = (parse_quantity(end.strip(), number.unit) for end in (first, last))
    except UnitError as problem:
        raise InputError(f"{said}: {problem}") from None
    if not low < high:
        raise InputError(
            f"{said}: the first end must be less than the second; write {key}={last.strip()}..{first.strip()}"
        )
    for end in (low, high):
        if not number.accepts(end):
            raise InputError(
                f"{said}: {show_quantity(end, number.unit)} is not allowed there; valid: {_range_words(number)}"
            )
    return low, high


def _own_ends(said: str, start: float, number: _Number, key: str) -> tuple[float, float]:
    """Those that the law declares, or else several times less and more than the start."""
    is_closed = abs(number.low) < HUGE and abs(number.high) < HUGE and not (number.low_open or number.high_open)
    if is_closed:
        return number.low, number.high
    if start == 0.0:
        raise InputError(f"{said}: begins at 0 and has no bounds of its own; say from where to where, as {key}=0..1")
    low, high = sorted((start / AROUND, start * AROUND))
    return max(low, number.low), min(high, number.high)


def _range_words(number: _Number) -> str:
    low = f"{'above' if number.low_open else 'from'} {show_quantity(number.low, number.unit)}"
    high = f"{'below' if number.high_open else 'up to'} {show_quantity(number.high, number.unit)}"
    return " ".join([*([low] if abs(number.low) < HUGE else []), *([high] if abs(number.high) < HUGE else [])])
