"""What one section puts over another: a vehicle over the fleet, `--set` over the file.

An override merges with what it overrides. One that names another law or type replaces the old one
with all its parameters; what does not belong to that law (`reference_point`, `topology`) stays.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable

from cardume.errors import MissionError, Position, Problem
from cardume.missions.catalog import Context
from cardume.missions.lookup import choose_law, inlined_laws
from cardume.missions.mission import Mission
from cardume.missions.reading import as_entries
from cardume.missions.schema import Forms, Group, Kind, Laws, ListOf, Variant, fields_of, records_of
from cardume.missions.source import parse_yaml
from cardume.missions.tree import Node, item_name, label
from cardume.missions.varying import is_varying
from cardume.missions.vehicle import SHARED
from cardume.missions.wording import unknown
from cardume.units import printable, show_text


class Partial(dict[str, Node]):
    """A section of which only some keys are given, on the command line; the others stay."""


def apply_overrides(tree: Node, overrides: Iterable[str], context: Context) -> Node:
    """The file's tree under overrides such as `vehicles.port.depth=5 m`, whose value is YAML.

    Raises:
        MissionError: an override that cannot be read, or that names a vehicle or item that is not there.
    """
    together = functools.reduce(_combine, map(parse_override, overrides), Node(Partial(), tree.position))
    return merge(Group(Mission), tree, together, context)


def parse_override(text: str) -> Node:
    """`key.path=value` as the sections around that value.

    Raises:
        MissionError: no `=`, an empty name, or a value that is not YAML.
    """
    source = f"--set {printable(text)}"
    key, equals, value = text.partition("=")
    words = [word.strip() for word in key.split(".")]
    if not equals or not all(words) or not value.strip():
        example = "write key.path=value, as --set vehicles.port.depth='5 m'"
        raise MissionError([Problem(Position(source, 0, ""), f"given {show_text(text)}; {example}")])
    position = Position(source, 0, key.strip())
    try:
        node = _without_lines(parse_yaml(value, source))
    except MissionError as error:
        raise MissionError(problem._replace(position=position) for problem in error.problems) from None
    for word in reversed(words):
        node = Node(Partial({word: node}), node.position)
    return label(node)


def merge(kind: Kind | None, base: Node, over: Node, context: Context) -> Node:
    """`over` laid over `base`, both of one kind.

    Raises:
        MissionError: keys for a section that is a single word, or for an item that is not there.
    """
    if isinstance(kind, ListOf) and isinstance(base.value, list) and isinstance(over.value, Partial):
        return _merge_items(kind, base, over, context)
    if kind is None or _is_whole(kind, over):
        return over
    if _is_whole(kind, base):
        if isinstance(over.value, Partial):
            key = next(iter(over.value))
            raise over.error(f"the section is {base.given()} as a whole, so {key} cannot be set; give all of it")
        return over
    entries, changes = as_entries(kind, base), as_entries(kind, over)
    for laws in inlined_laws(kind):
        _drop_replaced_law(laws, entries, changes, base, context)
    if isinstance(kind, Variant):
        named = kind.selector
        entries = {} if named in changes and _value(entries, named) != _value(changes, named) else entries
    for key, node in changes.items():
        entries[key] = merge(_kind_at(kind, key), entries[key], node, context) if key in entries else node
    return Node(entries, base.position if isinstance(over.value, Partial) else over.position)


def _combine(one: Node, other: Node) -> Node:
    """Two overrides as one, so that their order does not matter; of the same key the last counts."""
    if not isinstance(one.value, Partial) or not isinstance(other.value, Partial):
        return other
    entries = Partial(one.value)
    for key, node in other.value.items():
        entries[key] = _combine(entries[key], node) if key in entries else node
    return Node(entries, one.position)


def _merge_items(kind: ListOf, base: Node, over: Node, context: Context) -> Node:
    items, key = list(base.value), base.position.key
    names = [item_name(item, index, key) for index, item in enumerate(items)]
    for name, node in over.value.items():
        index = names.index(name) if name in names else int(name) if name.isdigit() and len(name) < 9 else len(items)
        if index >= len(items):
            raise node.error(unknown(f"there is no {show_text(name)} in {key}", name, names))
        items[index] = merge(kind.item, items[index], node, context)
    return Node(items, base.position)


def _is_whole(kind: Kind, node: Node) -> bool:
    """Whether a node has no keys that could be merged one by one."""
    if not isinstance(kind, (Group, Laws, Variant, Forms)) or is_varying(node):
        return True
    if isinstance(node.value, str):
        return not inlined_laws(kind) or node.value in getattr(kind, "words", {})
    return not isinstance(node.value, dict)


def _drop_replaced_law(
    laws: Laws, entries: dict[str, Node], changes: dict[str, Node], section: Node, context: Context
) -> None:
    if laws.selector not in changes:
        return
    try:
        old = choose_law(laws, entries, section, context)
    except MissionError:
        return  # reading the section tells what is wrong with it
    if old.name != changes[laws.selector].value:
        for key in old.keys & entries.keys():
            del entries[key]


def _kind_at(kind: Kind, key: str) -> Kind | None:
    """The kind of a key of a section, if it has a kind of its own."""
    fields = [field for record in records_of(kind) for field in fields_of(record)]
    if isinstance(kind, Group) and kind.record is Mission:
        fields += SHARED.values()
    kinds = {field.key: field.kind for field in reversed(fields)}
    found = kinds.get(key)
    return None if isinstance(found, Laws) and found.inlined else found


def _value(entries: dict[str, Node], key: str) -> object:
    return entries[key].value if key in entries else None


def _without_lines(node: Node) -> Node:
    value = node.value
    if isinstance(value, dict):
        value = {key: _without_lines(item) for key, item in value.items()}
    elif isinstance(value, list):
        value = [_without_lines(item) for item in value]
    return Node(value, node.position._replace(line=0))
