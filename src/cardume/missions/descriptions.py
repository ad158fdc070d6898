"""Laws in plain values, read from their signatures and docstrings: for `cardume list`, the laboratory and the docs."""

import inspect
import math
import re
import textwrap
import typing
from collections.abc import Mapping
from typing import Any

from cardume.parameters import Once, note_in
from cardume.units import show_quantity

SECTIONS = "Args|Returns|Raises|Source"
OF_ALL_SENSORS = {"period": "between readings", "latency": "from the measurement until it is there"}


def describe(law: Any) -> dict[str, Any]:
    """A law in plain values: its one line, equation, source, and parameters with unit, default and bounds.

    Args:
        law: of any family.
    """
    paragraphs = [part.strip() for part in re.split(r"\n\s*\n", law.doc)]
    equations = [part for part in paragraphs[1:] if "=" in part and not re.match(rf"({SECTIONS})\b", part)]
    source = re.search(r"^\s*Source:\s*(.+?)\s*\Z", law.doc, re.DOTALL | re.MULTILINE)
    said = OF_ALL_SENSORS | _meanings_of_parts(law) | meanings(law.doc)
    return {
        "name": law.name,
        "summary": " ".join(paragraphs[0].split()),
        "equation": textwrap.dedent(equations[0]) if equations else "",
        "parameters": [_parameter(parameter, said) for parameter in law.parameters],
        "source": " ".join(source[1].split()) if source else "",
    }


def ends_of(parameter: Mapping[str, Any]) -> list[str]:
    """The bounds of a parameter in words, as "above 0 m" and "at most 5 m"; none where it has none.

    Args:
        parameter: one of those that `describe` gives.
    """
    unit, ends = parameter["unit"], []
    if parameter["low"] is not None:
        ends.append(f"{'above' if parameter['low_open'] else 'at least'} {show_quantity(parameter['low'], unit)}")
    if parameter["high"] is not None:
        ends.append(f"{'below' if parameter['high_open'] else 'at most'} {show_quantity(parameter['high'], unit)}")
    return ends


def _meanings_of_parts(law: Any) -> dict[str, str]:
    """Of the parameters that come from what is computed once, before a mission."""
    hints = typing.get_type_hints(law.function, include_extras=True) if hasattr(law, "function") else {}
    parts = [part for part in (note_in(hint, Once) for hint in hints.values()) if part is not None]
    found: dict[str, str] = {}
    for part in parts:
        found |= meanings(inspect.getdoc(part.function) or "")
    return found


def meanings(doc: str) -> dict[str, str]:
    """What a docstring says of each argument, without its unit.

    Args:
        doc: as `inspect.cleandoc` leaves it.
    """
    section = re.search(rf"^\s*Args:\s*\n(.*?)(?=^\s*(?:{SECTIONS}):|\Z)", doc, re.DOTALL | re.MULTILINE)
    if section is None:
        return {}
    found: dict[str, str] = {}
    for entry in re.split(r"\n(?=\w)", textwrap.dedent(section[1]).strip()):
        names, colon, text = entry.partition(":")
        if colon and re.fullmatch(r"\w+(, \w+)*", names):
            said = re.sub(r"^\s*\[[^\]]*\]\s*", "", " ".join(text.split()))
            found |= dict.fromkeys(names.split(", "), said)
    return found


def _parameter(parameter: Any, said: Mapping[str, str]) -> dict[str, Any]:
    return {
        "name": parameter.name,
        "meaning": said.get(parameter.name, ""),
        "default": parameter.words[round(parameter.default)] if parameter.words else parameter.default,
        "unit": parameter.unit,
        "low": parameter.low if math.isfinite(parameter.low) else None,
        "high": parameter.high if math.isfinite(parameter.high) else None,
        "low_open": parameter.low_open,
        "high_open": parameter.high_open,
        "words": list(parameter.words),
    }
