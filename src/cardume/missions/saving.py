"""Missions to files that read back to the same mission, every default written."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from functools import singledispatch
from pathlib import Path
from typing import Any

from cardume.missions.distributions import Choose, Normal, Uniform, Varying
from cardume.missions.lookup import TEXT_PARAMETERS
from cardume.missions.mission import Mission, Requirement
from cardume.missions.schema import (
    PROFILE_UNITS,
    File,
    Forms,
    Group,
    Kind,
    Laws,
    ListOf,
    Profile,
    Profiled,
    Quantity,
    Requirements,
    Variant,
    fields_of,
)
from cardume.missions.source import CONSTANTS, NOT_FINITE, NUMBER
from cardume.missions.vehicle import SHARED, LawChoice
from cardume.units import format_quantity

WIDTH = 110
PLAIN = re.compile(r"-?[A-Za-z0-9_./](?:[A-Za-z0-9_./%^+-]|[ :](?=[A-Za-z0-9_./%^]))*")


def to_yaml(mission: Mission, directory: Path | None = None) -> str:
    """The text of a mission file; see `Mission.to_yaml`.

    Args:
        mission: any mission, drawn or not.
        directory: where the file will lie; files are named relative to it, else absolutely.
    """
    own = _fields(Mission, mission, directory)
    vehicles = own.pop("vehicles")
    common = {key: vehicles[0][key] for key in SHARED if all(vehicle[key] == vehicles[0][key] for vehicle in vehicles)}
    own["vehicles"] = [{k: v for k, v in vehicle.items() if k not in common} for vehicle in vehicles]
    last, faults = own.pop("require"), own.pop("faults")
    ends = {key: value for key, value in (("faults", faults), ("require", last)) if value}
    return "\n".join(_lines({**own, **common, **ends}, 0)) + "\n"


def write(kind: Kind, value: Any, directory: Path | None = None) -> Any:
    """A value as the plain mapping, list, text or number that a file holds."""
    if isinstance(value, Varying):
        return {**_varying(kind, value, directory), "per": value.per}
    for word, meaning in getattr(kind, "words", {}).items():
        if meaning == value:
            return word
    return _write(kind, value, directory)


@singledispatch
def _write(_kind: Kind, value: Any, _directory: Path | None) -> Any:
    return [list(row) for row in value] if isinstance(value, tuple) else value


@_write.register
def _quantity(kind: Quantity, value: float, _directory: Path | None) -> Any:
    return format_quantity(value, kind.unit)


@_write.register
def _profiled(kind: Profiled, value: float | Profile, _directory: Path | None) -> Any:
    if not isinstance(value, Profile):
        return format_quantity(value, kind.unit)
    unit = PROFILE_UNITS[value.over]
    points = [[format_quantity(x, unit), format_quantity(y, kind.unit)] for x, y in value.points]
    return {"profile": value.over, "points": points}


@_write.register
def _file(_kind: File, value: str, directory: Path | None) -> str:
    return value if directory is None else os.path.relpath(value, directory)


@_write.register
def _laws(kind: Laws, value: LawChoice, directory: Path | None) -> Any:
    section = _choice(kind, value, directory)
    return section if value.parameters else value.name


@_write.register
def _section(_kind: Group | Forms, value: Any, directory: Path | None) -> dict[str, Any]:
    return _fields(type(value), value, directory)


@_write.register
def _variant(kind: Variant, value: Any, directory: Path | None) -> dict[str, Any]:
    name = next(name for name, record in kind.records.items() if isinstance(value, record))
    return {kind.selector: name, **_fields(type(value), value, directory)}


@_write.register
def _requirements(_kind: Requirements, value: tuple[Requirement, ...], _directory: Path | None) -> dict[str, Any]:
    limits: dict[str, Any] = {}
    for item in value:
        of = limits if item.vehicle is None else limits.setdefault(item.vehicle, {})
        of[item.metric] = format_quantity(item.limit, item.unit)
    return limits


@_write.register
def _list(kind: ListOf, value: tuple[Any, ...], directory: Path | None) -> list[Any]:
    return [write(kind.item, item, directory) for item in value]


def _fields(record: type, value: Any, directory: Path | None) -> dict[str, Any]:
    """A record as its section; what is None is left out, unless a word says it."""
    section: dict[str, Any] = {}
    for field in fields_of(record):
        item = getattr(value, field.attribute)
        if isinstance(field.kind, Laws) and field.kind.inlined:
            section |= _choice(field.kind, item, directory)
        elif item is not None or None in getattr(field.kind, "words", {}).values():
            section[field.key] = write(field.kind, item, directory)
    return section


def _choice(kind: Laws, choice: LawChoice, directory: Path | None) -> dict[str, Any]:
    texts = {field.key: field.kind for field in TEXT_PARAMETERS.get((choice.family, choice.name), ())}

    def kind_of(key: str) -> Kind:
        return texts.get(key) or (Quantity(choice.units[key]) if key in choice.units else Kind())  # Kind(): a word

    values = {key: write(kind_of(key), value, directory) for key, value in choice.parameters.items()}
    return {kind.selector: choice.name, **values}


def _varying(kind: Kind, value: Varying, directory: Path | None) -> dict[str, Any]:
    if isinstance(value, Uniform):
        return {"uniform": [write(kind, value.low), write(kind, value.high)]}
    if isinstance(value, Normal):
        return {"normal": [write(kind, value.mean), write(kind, value.deviation)]}
    return {"choose" if isinstance(value, Choose) else "sweep": [write(kind, x, directory) for x in value.options]}


def _lines(section: Mapping[str, Any], indent: int) -> list[str]:
    """A section in block style, what fits on a line in flow style."""
    lines: list[str] = []
    for key, value in section.items():
        flow = _flow(value)
        if not value or isinstance(value, (str, int, float)) or (len(flow) + indent < WIDTH and key != "vehicles"):
            lines.append(f"{key}: {flow}")
        elif isinstance(value, dict):
            lines += [f"{key}:", *(f"  {line}" for line in _lines(value, indent + 2))]
        else:
            lines += [f"{key}:", *(line for item in value for line in _item_lines(item, indent + 2))]
    return lines


def _item_lines(item: Any, indent: int) -> list[str]:
    flow = _flow(item)
    if not isinstance(item, dict) or ("name" not in item and len(flow) + indent < WIDTH):
        return [f"  - {flow}"]
    first, *others = _lines(item, indent + 2)
    return [f"  - {first}", *(f"    {line}" for line in others)]


def _flow(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_flow(item)}' for key, item in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(_flow(item) for item in value)}]"
    if not isinstance(value, str):
        return repr(value)
    is_word = PLAIN.fullmatch(value) and value not in CONSTANTS and not NUMBER.fullmatch(value)
    return value if is_word and not NOT_FINITE.fullmatch(value) else json.dumps(value, ensure_ascii=False)
