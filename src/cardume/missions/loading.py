"""Mission files to missions: the way in."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Set
from pathlib import Path
from typing import Any, cast

from cardume.errors import Collector
from cardume.missions.catalog import Catalog, Context
from cardume.missions.drawing import MOST_PROBES, probes
from cardume.missions.mission import Mission
from cardume.missions.overrides import apply_overrides, merge
from cardume.missions.reading import read, read_record
from cardume.missions.rules import check_rules
from cardume.missions.source import parse_yaml, read_text
from cardume.missions.tree import Node, all_positions, item_name, label
from cardume.missions.varying import is_varying
from cardume.missions.vehicle import SHARED
from cardume.units import printable


def load_mission(path: str | Path, catalog: Catalog, overrides: Iterable[str] = ()) -> Mission:
    """The mission in a file.

    Args:
        path: of the file.
        catalog: the laws and metrics that exist.
        overrides: what `--set` gives, as `vehicles.port.depth=5 m`.

    Raises:
        MissionError: with the file, line and key of every problem.
    """
    path = Path(path)
    return parse_mission(read_text(path), catalog, overrides, source=printable(str(path)), directory=path.parent)


def parse_mission(
    text: str,
    catalog: Catalog,
    overrides: Iterable[str] = (),
    *,
    source: str = "<text>",
    directory: str | Path = ".",
) -> Mission:
    """The mission in a text.

    Args:
        text: YAML.
        catalog: the laws and metrics that exist.
        overrides: what `--set` gives, as `vehicles.port.depth=5 m`.
        source: name of the text, for messages.
        directory: what file names in the mission are relative to.

    Raises:
        MissionError: with the source, line and key of every problem.
    """
    return mission_of_tree(parse_yaml(text, source), catalog, overrides, directory=directory)


def mission_of_tree(
    tree: Node, catalog: Catalog, overrides: Iterable[str] = (), *, directory: str | Path = "."
) -> Mission:
    """The mission in a tree of values, which stays as it is.

    Args:
        tree: as `parse_yaml` gives it.
        catalog: the laws and metrics that exist.
        overrides: what `--set` gives, as `vehicles.port.depth=5 m`.
        directory: what file names in the mission are relative to.

    Raises:
        MissionError: with the source, line and key of every problem.
    """
    if not isinstance(tree.value, dict):
        raise tree.error(f"given {tree.given()}; a mission is a mapping, a line 'key: value' for each key")
    if is_varying(tree):
        raise tree.error("a mission cannot vary as a whole; let its values or sections vary")
    context = Context(catalog=catalog, directory=Path(directory))
    tree = label(apply_overrides(tree, overrides, context))
    mission = _read_tree(tree, dataclasses.replace(context, fleet=_fleet(tree)))
    mission = dataclasses.replace(mission, positions=all_positions(tree))
    check_rules(mission)
    for probe in itertools.islice(probes(mission), MOST_PROBES):
        check_rules(probe)
    return mission


def _fleet(tree: Node) -> tuple[str, ...]:
    """The names of the vehicles, as far as they can be read."""
    vehicles = tree.value.get("vehicles")
    items = vehicles.value if vehicles is not None and isinstance(vehicles.value, list) else []
    return tuple(item_name(item, index, "vehicles") for index, item in enumerate(items))


def _read_tree(tree: Node, context: Context) -> Mission:
    entries, collector = dict(tree.value), Collector()
    fleet_wide = {key: entries.pop(key) for key in SHARED if key in entries}
    good: dict[str, Node] = {}
    for key, node in fleet_wide.items():
        with collector:
            read(SHARED[key].kind, node, context)
            good[key] = node
    vehicles = entries.get("vehicles")
    if vehicles is not None and isinstance(vehicles.value, list):
        with collector:
            _refuse_equal_names(vehicles.value, context.fleet)
        with collector:
            # What is wrong for the fleet is told once, not again for each vehicle.
            whole = [_without(item, fleet_wide.keys() - good.keys()) for item in vehicles.value]
            whole = [_equip(_inherit(item, good, context), context) for item in whole]
            entries["vehicles"] = Node(whole, vehicles.position)
    mission: Any = None
    with collector:
        mission = read_record(Mission, entries, tree, context, also=SHARED)
    collector.finish()
    return cast(Mission, mission)


def _inherit(vehicle: Node, fleet_wide: dict[str, Node], context: Context) -> Node:
    """A vehicle with the fleet's sections under its own."""
    if not isinstance(vehicle.value, dict):
        return vehicle
    entries = dict(vehicle.value)
    for key, node in fleet_wide.items():
        entries[key] = merge(SHARED[key].kind, node, entries[key], context) if key in entries else node
    return Node(entries, vehicle.position)


def _equip(vehicle: Node, context: Context) -> Node:
    """A vehicle whose list of sensors also has those that its model always carries; `none` leaves one out."""
    entries = vehicle.value if isinstance(vehicle.value, dict) else {}
    sensors, model, depth, altitude = (entries.get(key) for key in ("sensors", "model", "depth", "altitude"))
    if sensors is None or not isinstance(sensors.value, dict) or is_varying(sensors):
        return vehicle
    named = model.value.get("law", model) if model is not None and isinstance(model.value, dict) else model
    is_submerged = altitude is not None or (depth is not None and str(depth.value).split()[:1] not in (["0"], ["0.0"]))
    kinds = context.catalog.default_sensors("medusa" if named is None else str(named.value), is_submerged)
    if isinstance(kinds, str):
        return vehicle
    kinds = kinds if altitude is None else (*kinds, "altimeter")
    carried = sensors.value | {kind: Node({}, sensors.position) for kind in kinds if kind not in sensors.value}
    return Node(entries | {"sensors": Node(carried, sensors.position)}, vehicle.position)


def _without(vehicle: Node, keys: Set[str]) -> Node:
    if not isinstance(vehicle.value, dict):
        return vehicle
    return Node({key: node for key, node in vehicle.value.items() if key not in keys}, vehicle.position)


def _refuse_equal_names(vehicles: list[Node], names: tuple[str, ...]) -> None:
    lines: dict[str, int] = {}
    collector = Collector()
    for vehicle, name in zip(vehicles, names, strict=True):
        if name in lines:
            both = f"on lines {lines[name]} and {vehicle.position.line}"
            collector.add(vehicle.error(f"two vehicles are named '{name}', {both}; give each its own name"))
        lines.setdefault(name, vehicle.position.line)
    collector.finish()
