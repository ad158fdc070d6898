"""Path files that other programs wrote and read: MEDUSA text, QGroundControl plans, WPL lists, GPX, GeoJSON."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

from cardume.missions.formats.content import GEOJSON, GPX, QGC, WPL, format_of, read_text
from cardume.units import printable

if TYPE_CHECKING:
    from cardume.missions.formats.plan import Plan
    from cardume.missions.geodesy import GeoPoint

# Each reader is loaded where it is needed: commands start faster.
READERS = {
    QGC: ("qgroundcontrol", "read_qgroundcontrol"),
    WPL: ("wpl", "read_wpl"),
    GPX: ("gpx", "read_gpx"),
    GEOJSON: ("geojson", "read_geojson"),
}


def read_plan(file: Path, origin: GeoPoint | None = None) -> Plan:
    """Read a path file in whatever format it is.

    Args:
        file: where it is.
        origin: of the local axes. A drawing in local coordinates (MEDUSA) is moved there; places given in latitude
            and longitude stay where they are.

    Raises:
        MissionError: no such file, a format that is not read, or contents that cannot be flown.
    """
    return parse_plan(read_text(file), printable(str(file)), origin=origin)


def parse_plan(text: str, source: str, *, named: str = "", origin: GeoPoint | None = None) -> Plan:
    """Read the text of a path file.

    Args:
        text: its contents.
        source: what messages call it.
        named: its format, if it is known: medusa, plan, wpl, gpx or geojson.
        origin: see `read_plan`.

    Raises:
        MissionError: contents that cannot be flown.
    """
    kind = named or format_of(text, source)
    if kind in READERS:
        from cardume.missions.formats.waypoints import to_plan

        module, function = READERS[kind]
        draft = getattr(importlib.import_module(f"{__name__}.{module}"), function)(text, source)
        return to_plan(draft, origin)
    from cardume.missions.formats import medusa_plan
    from cardume.missions.formats.medusa import parse_medusa

    return medusa_plan.to_plan(parse_medusa(text, source), origin)
