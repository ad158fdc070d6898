"""A JSON schema of the mission file, for editors that complete and check while one types."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import MISSING, replace
from functools import singledispatch
from typing import Any

from cardume.missions.catalog import Catalog
from cardume.missions.lookup import inlined_laws, law_fields
from cardume.missions.mission import Mission
from cardume.missions.schema import (
    MOST_PROFILE_POINTS,
    PROFILE_UNITS,
    Field,
    Forms,
    Graph,
    Group,
    Kind,
    Laws,
    ListOf,
    Member,
    Name,
    Profiled,
    Quantity,
    Requirements,
    Variant,
    Whole,
    Word,
    fields_of,
)
from cardume.missions.tree import SAFE_NAME
from cardume.missions.varying import SCOPES, WAYS
from cardume.missions.vehicle import SHARED
from cardume.units import units_like

NUMBER_TEXT = r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*"
USER_LAW = {"type": "string", "pattern": "^[^:]+:[^:]+$"}
VARYING = {
    "type": "object",
    "properties": {**{way: {"type": "array", "minItems": 1} for way in WAYS}, "per": {"enum": list(SCOPES)}},
    "anyOf": [{"required": [way]} for way in WAYS],
    "additionalProperties": False,
}


def json_schema(catalog: Catalog) -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of the mission files that a catalog allows.

    It is a little wider than the reader: what takes several keys to tell, the reader alone checks.

    Args:
        catalog: the laws and metrics that exist.
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "cardume mission",
        **_section([*fields_of(Mission), *SHARED.values()], catalog, optional=set(SHARED)),
        "$defs": {"varying": VARYING},
    }


def _describe(kind: Kind, catalog: Catalog) -> dict[str, Any]:
    """One kind, with the words it takes and the ways in which it may vary."""
    forms = [_plain(kind, catalog)]
    if words := list(getattr(kind, "words", {})):
        forms.append({"enum": words})
    if not kind.fixed:
        forms.append({"$ref": "#/$defs/varying"})
    return forms[0] if len(forms) == 1 else {"anyOf": forms}


def _section(fields: list[Field], catalog: Catalog, optional: Collection[str] = ()) -> dict[str, Any]:
    """A mapping with these fields; where one of its laws is the user's, any further key is possible."""
    properties: dict[str, list[dict[str, Any]]] = {}
    users_law, required = [], []
    for field in fields:
        if isinstance(field.kind, Laws) and field.kind.inlined:
            selector, laws = field.kind.selector, catalog.laws_of(field.kind.family)
            named = {"enum": [*laws, *field.kind.words]}
            properties[selector] = [{"anyOf": [named, USER_LAW], "description": field.doc or "which law"}]
            users_law.append({"required": [selector], "properties": {selector: USER_LAW}})
            for inner in (inner for law in laws.values() for inner in law_fields(law)):
                described = _describe(inner.kind, catalog)
                if described not in properties.setdefault(inner.key, []):
                    properties[inner.key].append(described)
        else:
            properties[field.key] = [{**_describe(field.kind, catalog), "description": field.doc}]
            if is_required(field) and field.key not in optional:
                required.append(field.key)
    section: dict[str, Any] = {
        "type": "object",
        "properties": {key: forms[0] if len(forms) == 1 else {"anyOf": forms} for key, forms in properties.items()},
    }
    names = {"propertyNames": {"enum": list(properties)}}
    section |= {"if": {"anyOf": users_law}, "else": names} if users_law else names
    return {**section, "required": required} if required else section


def is_required(field: Field) -> bool:
    """Whether a section must hold this key."""
    if isinstance(field.kind, Laws) or field.default is not MISSING or field.written is not None:
        return False
    return not isinstance(field.kind, Group) or any(is_required(inner) for inner in fields_of(field.kind.record))


@singledispatch
def _plain(_kind: Kind, _catalog: Catalog) -> dict[str, Any]:
    return {"type": "string"}


@_plain.register
def _quantity(kind: Quantity, _catalog: Catalog) -> dict[str, Any]:
    bounds = kind.bounds
    low = "exclusiveMinimum" if bounds.low_open else "minimum"
    high = "exclusiveMaximum" if bounds.high_open else "maximum"
    units = "|".join(re.escape(name) for name in units_like(kind.unit))
    text = {"type": "string", "pattern": f"{NUMBER_TEXT}({units})?$"}
    return {"anyOf": [{"type": "number", low: bounds.low, high: bounds.high}, text]}


@_plain.register
def _profiled(kind: Profiled, catalog: Catalog) -> dict[str, Any]:
    value = _quantity(kind, catalog)
    forms = []
    for over, unit in PROFILE_UNITS.items():
        point = {"type": "array", "prefixItems": [_quantity(Quantity(unit), catalog), value], "items": False}
        points = {"type": "array", "minItems": 1, "maxItems": MOST_PROFILE_POINTS, "items": point}
        keys = {"profile": {"const": over}, "points": points}
        forms.append({"type": "object", "properties": keys, "required": list(keys), "additionalProperties": False})
    return {"anyOf": [*value["anyOf"], *forms]}


@_plain.register
def _whole(kind: Whole, _catalog: Catalog) -> dict[str, Any]:
    return {"type": "integer", "minimum": kind.low, "maximum": kind.high}


@_plain.register
def _word(kind: Word, _catalog: Catalog) -> dict[str, Any]:
    return {"enum": list(kind.choices)}


@_plain.register
def _name(_kind: Name, _catalog: Catalog) -> dict[str, Any]:
    return {"type": "string", "pattern": f"^{SAFE_NAME.pattern}$"}


@_plain.register
def _member(_kind: Member, _catalog: Catalog) -> dict[str, Any]:
    return _name(Name(), _catalog)


@_plain.register
def _graph(kind: Graph, _catalog: Catalog) -> dict[str, Any]:
    row = {"type": "array", "items": {"type": "number", "minimum": kind.weights.low}}
    return {"anyOf": [{"enum": list(kind.names)}, {"type": "array", "items": row}]}


@_plain.register
def _requirements(_kind: Requirements, catalog: Catalog) -> dict[str, Any]:
    limits = {name: _plain(Quantity(unit), catalog) for name, unit in catalog.metrics.items()}
    of_vehicle = {"type": "object", "properties": limits, "additionalProperties": False}
    return {"type": "object", "properties": limits, "additionalProperties": of_vehicle}


@_plain.register
def _laws(kind: Laws, catalog: Catalog) -> dict[str, Any]:
    chosen = Field("law", replace(kind, inlined=True), MISSING, None, False, "")
    names = {"enum": list(catalog.laws_of(kind.family))}
    return {"anyOf": [names, USER_LAW, _section([chosen], catalog)]}


@_plain.register
def _group(kind: Group, catalog: Catalog) -> dict[str, Any]:
    section = _section(list(fields_of(kind.record)), catalog)
    laws = inlined_laws(kind)
    return {"anyOf": [{"enum": list(catalog.laws_of(laws[0].family))}, USER_LAW, section]} if laws else section


@_plain.register
def _variant(kind: Variant, catalog: Catalog) -> dict[str, Any]:
    forms = []
    for name, record in kind.records.items():
        named = Field(kind.selector, Word((name,), fixed=True), MISSING, None, False, "which form")
        forms.append(_section([named, *fields_of(record)], catalog))
    return {"anyOf": forms}


@_plain.register
def _forms(kind: Forms, catalog: Catalog) -> dict[str, Any]:
    return {"anyOf": [_section(list(fields_of(record)), catalog) for record in kind.records]}


@_plain.register
def _list(kind: ListOf, catalog: Catalog) -> dict[str, Any]:
    return {"type": "array", "minItems": 1, "items": _describe(kind.item, catalog)}
