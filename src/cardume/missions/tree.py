"""The values of a mission file as a tree: plain values that know where they stand."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from cardume.errors import MissionError, Position, Problem
from cardume.units import printable, show_text

SAFE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")


@dataclass(frozen=True, slots=True)
class Node:
    """A value of the file: None, bool, int, float, str, a list of nodes, or a dict of nodes."""

    value: Any
    position: Position

    def error(self, message: str) -> MissionError:
        """A `MissionError` about this value, to raise."""
        return MissionError([Problem(self.position, message)])

    def given(self) -> str:
        """What was given, in words for a message."""
        if isinstance(self.value, dict):
            return "a mapping" if self.value else "an empty mapping"
        if isinstance(self.value, list):
            return "a list" if self.value else "an empty list"
        if self.value is None or isinstance(self.value, bool):
            return {None: "nothing", True: "true", False: "false"}[self.value]
        return show_text(self.value)


def all_positions(node: Node) -> dict[str, Position]:
    """The position of every value below a labelled node, by its dotted key; the node itself is ''."""
    found: dict[str, Position] = {}
    waiting = [("", node)]
    while waiting:
        key, node = waiting.pop()
        found[key] = node.position
        waiting += [(join(key, name), child) for name, child in _children(node, key)]
    return found


def join(*words: str) -> str:
    """The dotted key made of these words; empty ones are left out."""
    return ".".join(word for word in words if word)


def item_name(node: Node, index: int, key: str) -> str:
    """How a list item is addressed: a vehicle by its name, if it is a good one, anything else by its index."""
    name = node.value.get("name") if key == "vehicles" and isinstance(node.value, dict) else None
    is_good = name is not None and isinstance(name.value, str) and SAFE_NAME.fullmatch(name.value)
    return name.value if name is not None and is_good else str(index)


def _children(node: Node, key: str) -> list[tuple[str, Node]]:
    if isinstance(node.value, dict):
        return list(node.value.items())
    if isinstance(node.value, list):
        return [(item_name(child, index, key), child) for index, child in enumerate(node.value)]
    return []


def label(node: Node, key: str = "") -> Node:
    """Write the dotted key of every value into its position."""
    value = node.value
    children = [(name, label(child, join(key, name))) for name, child in _children(node, key)]
    if isinstance(value, dict):
        value = type(value)(children)
    elif isinstance(value, list):
        value = [child for _, child in children]
    return Node(value, node.position._replace(key=printable(key)))
