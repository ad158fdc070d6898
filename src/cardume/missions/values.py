"""Single values of a file: quantities, words, names, files, graphs."""

from __future__ import annotations

import os
from functools import singledispatch
from pathlib import Path
from typing import Any

from cardume.errors import MissionError, UnitError
from cardume.missions.catalog import Context
from cardume.missions.schema import (
    MOST_PROFILE_POINTS,
    PROFILE_UNITS,
    File,
    Graph,
    Kind,
    Member,
    Name,
    Profile,
    Profiled,
    Quantity,
    Text,
    Whole,
    Word,
)
from cardume.missions.source import nearest_file
from cardume.missions.tree import SAFE_NAME, Node
from cardume.missions.wording import unknown, wanted
from cardume.units import parse_quantity, show_text


def refused(kind: Kind, node: Node) -> MissionError:
    """The error that a node is not what its kind wants, to raise."""
    return node.error(f"given {node.given()}; must be {wanted(kind)}")


@singledispatch
def read_value(kind: Kind, node: Node, context: Context) -> Any:
    """The value of a node that is no section.

    Raises:
        MissionError: not such a value.
        TypeError: no such kind.
    """
    raise TypeError(kind)


@read_value.register
def _quantity(kind: Quantity, node: Node, _context: Context) -> float:
    if isinstance(node.value, bool) or not isinstance(node.value, (int, float, str)):
        raise refused(kind, node)
    try:
        value = parse_quantity(node.value, kind.unit)
    except UnitError as problem:
        raise node.error(str(problem)) from None
    if not kind.bounds.contain(value):
        raise refused(kind, node)
    return value


@read_value.register
def _profiled(kind: Profiled, node: Node, context: Context) -> float | Profile:
    if not isinstance(node.value, dict):
        return _quantity(kind, node, context)
    for key, inner in node.value.items():
        if key not in ("profile", "points"):
            raise inner.error(unknown("there is no such key in a profile", key, ["profile", "points"]))
    over, points = node.value.get("profile"), node.value.get("points")
    if over is None or points is None:
        missing = "profile" if over is None else "points"
        raise node.error(f"a profile lacks '{missing}'; must be {wanted(kind)}")
    if not isinstance(over.value, str) or over.value not in PROFILE_UNITS:
        raise over.error(unknown(f"given {over.given()}", str(over.value), list(PROFILE_UNITS)))
    if not isinstance(points.value, list) or not 1 <= len(points.value) <= MOST_PROFILE_POINTS:
        raise points.error(f"given {points.given()}; must be a list of 1 to {MOST_PROFILE_POINTS} points")
    unit = PROFILE_UNITS[over.value]
    read = [_profile_point(Quantity(unit), kind, item, context) for item in points.value]
    for (before, _), (x, _), item in zip(read, read[1:], points.value[1:], strict=False):
        if x <= before:
            raise item.error(f"given {x:g} {unit} after {before:g} {unit}; each point must lie beyond the one before")
    return Profile(over=over.value, points=tuple(read))


def _profile_point(over: Quantity, kind: Quantity, item: Node, context: Context) -> tuple[float, float]:
    if not isinstance(item.value, list) or len(item.value) != 2:
        valid = f"[{'60 s' if over.unit == 's' else '60 m'}, the value there]"
        raise item.error(f"given {item.given()}; a point is a pair, {valid}")
    return _quantity(over, item.value[0], context), _quantity(kind, item.value[1], context)


@read_value.register
def _whole(kind: Whole, node: Node, _context: Context) -> int:
    if isinstance(node.value, bool) or not isinstance(node.value, int) or not kind.low <= node.value <= kind.high:
        raise refused(kind, node)
    return node.value


@read_value.register
def _word(kind: Word, node: Node, _context: Context) -> str:
    if not isinstance(node.value, str) or node.value not in kind.choices:
        raise node.error(unknown(f"given {node.given()}", str(node.value), list(kind.choices)))
    return node.value


@read_value.register
def _name(kind: Name, node: Node, _context: Context) -> str:
    if not isinstance(node.value, str) or not SAFE_NAME.fullmatch(node.value):
        raise refused(kind, node)
    return node.value


@read_value.register
def _member(kind: Member, node: Node, context: Context) -> str:
    if not isinstance(node.value, str) or node.value not in context.fleet:
        raise node.error(unknown(f"there is no vehicle {node.given()}", str(node.value), list(context.fleet)))
    return node.value


@read_value.register
def _text(kind: Text, node: Node, _context: Context) -> str:
    if not isinstance(node.value, str) or not node.value.isprintable() or not 0 < len(node.value) <= 200:
        raise refused(kind, node)
    return node.value


@read_value.register
def _file(kind: File, node: Node, context: Context) -> str:
    if not isinstance(node.value, str) or not node.value.isprintable() or not node.value:
        raise refused(kind, node)
    path = Path(os.path.abspath(context.directory / node.value))
    _refuse_outside(path, node, context.catalog.readable)
    try:
        is_file, is_there = path.is_file(), path.exists()
    except OSError as problem:
        raise node.error(f"{node.given()} cannot be read: {problem.strerror}") from None
    if not is_there:
        raise node.error(f"no such file: {node.given()}{nearest_file(path)}; must be {wanted(kind)}")
    if not is_file:
        raise node.error(f"{node.given()} is not a regular file; must be {wanted(kind)}")
    return str(path)


def _refuse_outside(path: Path, node: Node, readable: tuple[Path, ...] | None) -> None:
    """Before the disk is asked anything about it, so that nobody learns what lies elsewhere."""
    real = Path(os.path.realpath(path))
    if readable is not None and not any(real.is_relative_to(allowed) for allowed in readable):
        folder = show_text(str(readable[0]), 500)
        raise node.error(f"{node.given()} lies outside of {folder}; only files in that folder are read here")


@read_value.register
def _graph(kind: Graph, node: Node, context: Context) -> str | tuple[tuple[float, ...], ...]:
    if isinstance(node.value, str) and node.value not in kind.names:
        raise node.error(unknown(f"given {node.given()}", node.value, list(kind.names)))
    if isinstance(node.value, str):
        return node.value
    size = len(context.fleet)
    rows = [row.value for row in node.value] if isinstance(node.value, list) else []
    if len(rows) != size or not all(isinstance(row, list) and len(row) == size for row in rows):
        raise node.error(f"given {node.given()}; must be {wanted(kind)}: here {size} x {size}")
    weight = Quantity("", kind.weights)
    matrix = tuple(tuple(_quantity(weight, item, context) for item in row) for row in rows)
    for index in range(size):
        if matrix[index][index]:
            raise rows[index][index].error("a vehicle does not listen to itself; the diagonal must be 0")
    return matrix
