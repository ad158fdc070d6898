"""Nodes of a file to records: every kind of key read, checked and filled in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import MISSING, replace
from functools import singledispatch
from typing import Any

from cardume.errors import Collector, MissionError, Position, Problem
from cardume.missions.catalog import Context
from cardume.missions.lookup import Chosen, announced_by, choose_law, inlined_laws
from cardume.missions.schema import (
    Field,
    Forms,
    Group,
    Kind,
    Laws,
    ListOf,
    Quantity,
    Requirements,
    Variant,
    fields_of,
)
from cardume.missions.tree import Node, join
from cardume.missions.values import read_value, refused
from cardume.missions.varying import is_varying, read_varying
from cardume.missions.vehicle import LawChoice, Table
from cardume.missions.wording import keys_of, unknown, wanted
from cardume.units import show_text


def read(kind: Kind, node: Node, context: Context) -> Any:
    """The value of a node, of the kind that its key holds.

    Raises:
        MissionError: with every problem below this node.
    """
    if node.value is None:
        raise node.error(f"no value is given; must be {wanted(kind)}")
    if is_varying(node):
        return read_varying(kind, node, lambda inner, item: read(inner, item, context))
    words = getattr(kind, "words", {})
    if isinstance(node.value, str) and node.value in words:
        return words[node.value]
    return _read(kind, node, context)


def plant(value: Any, position: Position) -> Node:
    """Plain Python values as nodes: a default, as if it had been written."""
    if isinstance(value, Mapping):
        value = {key: plant(item, position) for key, item in value.items()}
    elif isinstance(value, (list, tuple)):
        value = [plant(item, position) for item in value]
    return Node(value, position)


@singledispatch
def _read(kind: Kind, node: Node, context: Context) -> Any:
    return read_value(kind, node, context)


@_read.register
def _requirements(kind: Requirements, node: Node, context: Context) -> tuple[Any, ...]:
    if not isinstance(node.value, dict):
        raise refused(kind, node)
    found, collector, metrics = [], Collector(), context.catalog.metrics
    for key, item in node.value.items():
        of_vehicle = isinstance(item.value, dict)
        if of_vehicle and key not in context.fleet:
            collector.add(item.error(unknown("no such vehicle", key, list(context.fleet))))
            continue
        for metric, limit in item.value.items() if of_vehicle else [(key, item)]:
            with collector:
                if metric not in metrics:
                    raise limit.error(unknown("no such metric", metric, sorted(metrics)))
                value = read(Quantity(metrics[metric], fixed=True), limit, context)
                vehicle = key if of_vehicle else None
                found.append(kind.record(metric=metric, limit=value, unit=metrics[metric], vehicle=vehicle))
    collector.finish()
    return tuple(found)


@_read.register
def _list(kind: ListOf, node: Node, context: Context) -> tuple[Any, ...]:
    if not isinstance(node.value, list) or not node.value:
        raise refused(kind, node)
    collector, items = Collector(), []
    for item in node.value:
        with collector:
            items.append(read(kind.item, item, context))
    collector.finish()
    return tuple(items)


@_read.register
def _laws(kind: Laws, node: Node, context: Context) -> Any:
    entries = as_entries(kind, node)
    named = entries.get(kind.selector)
    if len(entries) == 1 and named is not None and isinstance(named.value, str) and named.value in kind.words:
        return kind.words[named.value]
    chosen, collector = choose_law(kind, entries, node, context), Collector()
    _refuse_unknown(entries, chosen.keys, node, collector)
    with collector:
        choice = _choice(chosen, entries, node, context)
    collector.finish()
    return choice


@_read.register
def _group(kind: Group, node: Node, context: Context) -> Any:
    return read_record(kind.record, as_entries(kind, node), node, context)


@_read.register
def _variant(kind: Variant, node: Node, context: Context) -> Any:
    entries = as_entries(kind, node)
    selector = kind.selector
    named = entries.pop(selector, None)
    if named is None:
        collector = Collector()
        collector.add(missing(node, selector, f"must be one of {', '.join(kind.records)}"))
        anywhere = {selector}.union(*(keys_of(record) for record in kind.records.values()))
        _refuse_unknown(entries, anywhere, node, collector)
        raise MissionError(collector.problems)
    if is_varying(named):
        pair = f"{{{selector}: ..., ...}}"
        raise named.error(f"a varying {selector} carries its keys: write {{sweep: [{pair}, {pair}]}}")
    record = kind.records.get(named.value) if isinstance(named.value, str) else None
    if record is None:
        raise named.error(
            unknown(
                f"there is no {node.position.key} of {selector} {named.given()}", str(named.value), list(kind.records)
            )
        )
    return read_record(record, entries, node, context, also=[selector])


@_read.register
def _forms(kind: Forms, node: Node, context: Context) -> Any:
    entries = as_entries(kind, node)
    record = max(kind.records, key=lambda record: len(entries.keys() & set(keys_of(record))))
    others = {key for other in kind.records for key in keys_of(other)} - set(keys_of(record))
    for key in others & entries.keys():
        beside = ", ".join(entries.keys() - others)
        raise entries[key].error(f"does not go with {beside}; must be {wanted(kind)}")
    return read_record(record, entries, node, context)


def as_entries(kind: Kind, node: Node) -> dict[str, Node]:
    """The keys of a section; a word alone is the name of its law.

    Raises:
        MissionError: the node is no section.
    """
    if isinstance(node.value, dict):
        return dict(node.value)
    laws = inlined_laws(kind)
    if not laws or not isinstance(node.value, str):
        raise refused(kind, node)
    return {laws[0].selector: node}


def missing(section: Node, key: str, message: str) -> MissionError:
    """The error that a key is not there, to raise; it stands where its section does."""
    position = section.position
    return MissionError([Problem(position._replace(key=join(position.key, key)), f"missing; {message}")])


def read_record(
    record: type, entries: dict[str, Node], section: Node, context: Context, also: Iterable[str] = ()
) -> Any:
    """One record from the keys of its section; `also` are keys that somebody else reads.

    Raises:
        MissionError: with every problem of the section.
    """
    fields, collector, chosen, values = fields_of(record), Collector(), dict[str, Chosen](), dict[str, Any]()
    for field in fields:
        if isinstance(field.kind, Laws) and field.kind.inlined:
            with collector:
                chosen[field.key] = choose_law(field.kind, entries, section, context)
    if not collector.problems:  # an unknown law says nothing about the other keys
        keys = {field.key for field in fields if field.key not in chosen}.union(
            also, *(law.keys for law in chosen.values())
        )
        _refuse_unknown(entries, keys, section, collector)
        for field in fields:
            with collector:
                if field.key in chosen:
                    values[field.key] = _choice(chosen[field.key], _owned(field.key, chosen, entries), section, context)
                else:
                    values[field.key] = _field(field, entries, section, context, values)
                    if isinstance(field.kind, Laws) and field.kind.announces:
                        told = announced_by(values[field.key], entries.get(field.key, section), context)
                        context = replace(context, announced=told)
    collector.finish()
    return record(**{field.attribute: values[field.key] for field in fields})


def _owned(key: str, chosen: dict[str, Chosen], entries: dict[str, Node]) -> dict[str, Node]:
    """What a section says to one of its laws: a parameter that two of them have is the later one's alone."""
    later = list(chosen)[list(chosen).index(key) + 1 :]
    taken = set[str]().union(*(chosen[name].keys for name in later))
    return {name: node for name, node in entries.items() if name not in taken}


def _choice(chosen: Chosen, entries: dict[str, Node], section: Node, context: Context) -> LawChoice:
    collector, values = Collector(), dict[str, Any]()
    for field in chosen.fields:
        with collector:
            values[field.key] = _field(field, entries, section, context, values)
    collector.finish()
    units = {field.key: field.kind.unit for field in chosen.fields if isinstance(field.kind, Quantity)}
    present = {key: value for key, value in values.items() if value is not None}
    return LawChoice(family=chosen.kind.family, name=chosen.name, parameters=Table(present), units=Table(units))


def _field(field: Field, entries: dict[str, Node], section: Node, context: Context, values: Mapping[str, Any]) -> Any:
    if field.key in entries:
        return read(field.kind, entries[field.key], context)
    position = section.position._replace(key=join(section.position.key, field.key))
    if field.written is not None:
        return read(field.kind, plant(field.written.written(values, context), position), context)
    if field.default is not MISSING:
        return field.default
    if isinstance(field.kind, (Group, Laws, Variant)):
        return read(field.kind, Node({}, position), context)
    raise missing(section, field.key, f"{field.doc}: must be {wanted(field.kind)}")


def _refuse_unknown(entries: dict[str, Node], valid: Set[str], section: Node, collector: Collector) -> None:
    for key, node in entries.items():
        if key not in valid:
            within = section.position.key or "the mission"
            message = unknown(f"there is no key {show_text(key)} in {within}", key, sorted(valid))
            collector.add(node.error(message))
