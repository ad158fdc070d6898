"""Values that vary, as a file writes them: {uniform: [a, b]}, {choose: [...]}, {sweep: [...]} and so on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cardume.errors import Collector
from cardume.missions.distributions import Choose, Normal, Sweep, Uniform, varying_values
from cardume.missions.schema import NOT_NEGATIVE, Kind, Quantity, Whole
from cardume.missions.tree import Node
from cardume.missions.vehicle import SHARED

WAYS = ("uniform", "normal", "choose", "sweep", "linspace")
SCOPES = ("mission", "vehicle")
MOST_OPTIONS = 10_000

Read = Callable[[Kind, Node], Any]


def is_varying(node: Node) -> bool:
    """Whether a node stands for several values."""
    return isinstance(node.value, dict) and any(way in node.value for way in WAYS)


def read_varying(kind: Kind, node: Node, read: Read) -> Uniform | Normal | Choose | Sweep:
    """The distribution or sweep that a node describes, each of its values checked by `read`.

    Raises:
        MissionError: with every problem found.
    """
    if kind.fixed:
        raise node.error("this value may not vary; give a single one")
    ways = [key for key in node.value if key in WAYS]
    for key, inner in node.value.items():
        if key not in (ways[0], "per"):
            raise inner.error(f"does not belong beside {ways[0]}; valid here: {ways[0]}, per")
    way, given = ways[0], node.value[ways[0]]
    if not isinstance(given.value, list) or not given.value or len(given.value) > MOST_OPTIONS:
        raise given.error(f"given {given.given()}; {way} needs a list of 1 to {MOST_OPTIONS} values")
    per = _scope(node)
    if way == "choose":
        return Choose(options=_options(kind, given, read), per=per)
    if way == "sweep":
        return Sweep(options=_options(kind, given, read), per=per)
    return _numbers(kind, way, given, per, read)


def _numbers(kind: Kind, way: str, given: Node, per: str, read: Read) -> Uniform | Normal | Sweep:
    if not isinstance(kind, Quantity) or (kind.in_ticks and way != "linspace"):
        why = "a value that is a whole number of ticks" if isinstance(kind, Quantity) else "what is not a quantity"
        raise given.error(f"{way} cannot make {why}; list the values with choose or sweep")
    needed = {"uniform": "[low, high]", "normal": "[mean, standard deviation]", "linspace": "[first, last, count]"}[way]
    if len(given.value) != needed.count(",") + 1:
        raise given.error(f"given {len(given.value)} values; {way} needs {needed}")
    kind = Quantity(kind.unit, kind.bounds, kind.in_ticks)  # a profile is no number to draw
    deviation = Quantity(kind.unit, NOT_NEGATIVE, fixed=True)
    kinds = {"uniform": (kind, kind), "normal": (kind, deviation), "linspace": (kind, kind, Whole(2, MOST_OPTIONS))}
    numbers = [_plain(inner, item, read) for inner, item in zip(kinds[way], given.value, strict=True)]
    if way == "normal":
        return Normal(mean=numbers[0], deviation=numbers[1], per=per, bounds=kind.bounds)
    if way == "linspace":
        first, last, count = numbers
        steps = [first + (last - first) * index / (count - 1) for index in range(count - 1)]
        return Sweep(options=(*steps, last), per=per)
    if numbers[0] > numbers[1]:
        raise given.error("given the higher end first; uniform needs [low, high]")
    return Uniform(low=numbers[0], high=numbers[1], per=per)


def _options(kind: Kind, given: Node, read: Read) -> tuple[Any, ...]:
    collector, options = Collector(), []
    for item in given.value:
        with collector:
            options.append(_plain(kind, item, read))
            if any(isinstance(inner, Sweep) for _, inner in varying_values(options[-1])):
                raise item.error("a sweep stands inside a value that varies; sweep whole sections or single values")
    collector.finish()
    return tuple(options)


def _plain(kind: Kind, node: Node, read: Read) -> Any:
    if is_varying(node):
        raise node.error("a value that varies stands inside one that varies; give plain values here")
    return read(kind, node)


def _scope(node: Node) -> str:
    words, per = node.position.key.split("."), node.value.get("per")
    is_vehicles = words[0] == "vehicles"
    if per is None:
        return "vehicle" if is_vehicles else "mission"
    if per.value not in SCOPES:
        raise per.error(f"given {per.given()}; must be one of {', '.join(SCOPES)}")
    if per.value == "vehicle" and not is_vehicles and words[0] not in SHARED:
        raise per.error(f"{words[0]} is one for the whole mission; leave per out")
    return str(per.value)
