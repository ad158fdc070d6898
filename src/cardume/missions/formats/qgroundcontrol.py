"""QGroundControl plans: JSON with a list of MAVLink commands, an optional geofence and rally points.

A survey or corridor scan is flown by the items that QGroundControl worked out and wrote into it; nothing is
worked out again from its polygon.

Source: docs.qgroundcontrol.com, Plan File Format; mavlink/qgroundcontrol, src/MissionManager.
"""

from __future__ import annotations

import json
import math
from typing import Any

from cardume.errors import MissionError
from cardume.missions.formats.commands import (
    CHANGE_SPEED,
    WAYPOINT,
    Command,
    speed_changes,
    to_waypoints,
    written_place,
)
from cardume.missions.formats.document import Document, Path, described
from cardume.missions.formats.plan import Fence
from cardume.missions.formats.sampling import Course
from cardume.missions.formats.waypoints import Draft, check_place, geo
from cardume.missions.geodesy import GeoPoint

PLAN_VERSION, MISSION_VERSION = 1, 2
WITH_ITEMS = {"survey": (4, 5), "CorridorScan": (2, 3)}
"""Complex items that hold their own flattened items, and the versions that do."""
PATTERNS = ("fwLandingPattern", "vtolLandingPattern")
BOAT, SUBMARINE, ARDUPILOT = 11, 12, 3
RELATIVE, NO_PLACE = 3, 2  # MAV_FRAME


def read_qgroundcontrol(text: str, source: str) -> Draft:
    """Read a plan.

    Args:
        text: its contents.
        source: what messages call it.

    Raises:
        MissionError: no plan, a version that is not known, or items that cannot be flown.
    """
    document = Document(text, source)
    _check_versions(document)
    commands: list[Command] = []
    notes: list[str] = []
    for index, item in enumerate(document.items(("mission", "items"))):
        path: Path = ("mission", "items", index)
        if not isinstance(item, dict):
            raise document.error(path, f"is {described(item)}; it must be an item, {{...}}")
        if item.get("type") == "SimpleItem":
            commands.append(_command(document, path, len(commands) + 1))
        elif item.get("type") == "ComplexItem":
            commands += _flattened(document, path, len(commands) + 1, notes)
        else:
            raise document.error(
                (*path, "type"), f"is {described(item.get('type'))}; it must be 'SimpleItem' or 'ComplexItem'"
            )
    if not commands:
        raise document.error(("mission", "items"), "is empty; a plan needs at least one item to be flown")
    try:
        waypoints, not_flown = to_waypoints(commands)
    except MissionError as error:
        raise MissionError(p._replace(position=document.located(p.position)) for p in error.problems) from None
    fences = _fences(document)
    unused = len(fences) - any(fence.is_inclusion for fence in fences)
    if unused:
        notes.append(f"areas of the geofence to keep out of, or beside the first ({unused}): not used")
    if rallies := document.get(("rallyPoints", "points")):
        notes.append(f"rally points ({len(rallies) if isinstance(rallies, list) else 1}): not used")
    notes = [*not_flown, *notes]
    return Draft(source=source, name="", waypoints=waypoints, notes=notes, fences=fences, locate=document.located)


def write_qgroundcontrol(course: Course) -> bytes:
    """A plan that QGroundControl opens: a DO_CHANGE_SPEED wherever the speed changes, depths as negative altitudes.

    Args:
        course: what to write.
    """
    depth = course.depth or 0.0
    items: list[dict[str, Any]] = []
    for speed, point in zip(speed_changes(course.speeds), course.points, strict=True):
        if speed is not None:
            items.append(_item(len(items) + 1, CHANGE_SPEED, NO_PLACE, [1, speed, -1, 0, 0, 0, 0]))
        place = [0, 0, 0, None, *written_place(point.degrees), 0.0 - depth]
        altitude = {"AMSLAltAboveTerrain": None, "Altitude": 0.0 - depth, "AltitudeMode": 1}
        items.append({**altitude, **_item(len(items) + 1, WAYPOINT, RELATIVE, place)})
    slowest = min((speed for speed in course.speeds if speed is not None), default=0.5)
    mission = {
        "cruiseSpeed": slowest,
        "firmwareType": ARDUPILOT,
        "globalPlanAltitudeMode": 1,
        "hoverSpeed": slowest,
        "items": items,
        "plannedHomePosition": [*course.points[0].degrees, 0.0],
        "vehicleType": SUBMARINE if depth else BOAT,
        "version": MISSION_VERSION,
    }
    plan = {
        "fileType": "Plan",
        "geoFence": {**_written_fences(course.fences), "version": 2},
        "groundStation": "QGroundControl",
        "mission": mission,
        "rallyPoints": {"points": [], "version": 2},
        "version": PLAN_VERSION,
    }
    return (json.dumps(plan, indent=4, sort_keys=True, allow_nan=False) + "\n").encode()


def _item(number: int, command: int, frame: int, parameters: list[Any]) -> dict[str, Any]:
    fixed = {"autoContinue": True, "type": "SimpleItem"}
    return {**fixed, "command": command, "doJumpId": number, "frame": frame, "params": parameters}


def _check_versions(document: Document) -> None:
    kind = document.get(("fileType",))
    if kind != "Plan":
        older = "; a file of an older QGroundControl: open it there and save it again" if kind == "Mission" else ""
        raise document.error(("fileType",), f"is {described(kind)}; it must be 'Plan'{older}")
    version = document.get(("version",))
    if version != PLAN_VERSION or isinstance(version, bool):
        raise document.error(("version",), f"is {described(version)}; plans of version {PLAN_VERSION} are read")
    if document.get(("mission",)) is None:
        raise document.error(("mission",), "is missing; the plan holds no mission, only a geofence or rally points")
    document.section(("mission",))
    version = document.get(("mission", "version"))
    if version != MISSION_VERSION or isinstance(version, bool):
        raise document.error(
            ("mission", "version"),
            f"is {described(version)}; missions of version {MISSION_VERSION} are read: open the plan in a current"
            " QGroundControl and save it again",
        )


def _command(document: Document, path: Path, number: int) -> Command:
    """A simple item."""
    parameters = document.items((*path, "params"))
    if len(parameters) != 7:
        raise document.error((*path, "params"), f"has {len(parameters)} values; a command has 7")
    values = [document.number((*path, "params", k), math.nan) for k in range(7)]
    number = _whole(document, (*path, "doJumpId"), number)
    return Command(
        number=number,
        code=_whole(document, (*path, "command")),
        frame=_whole(document, (*path, "frame")),
        parameters=(values[0], values[1], values[2], values[3], values[4], values[5], values[6]),
        label=f"item {number}",
        position=document.position(path),
    )


def _whole(document: Document, path: Path, default: int | None = None) -> int:
    number = document.number(path, default)
    if number != int(number) or not 0 <= number < 2**31:
        raise document.error(path, f"is {number:.10g}; it must be a whole number, 0 or more")
    return int(number)


def _flattened(document: Document, path: Path, number: int, notes: list[str]) -> list[Command]:
    """The items that a complex item holds ready."""
    kind = document.get((*path, "complexItemType"))
    if kind in PATTERNS:
        notes.append(f"item {number}: the landing pattern is not flown")
        return []
    if kind not in WITH_ITEMS:
        known = ", ".join(WITH_ITEMS)
        raise document.error(
            (*path, "complexItemType"),
            f"is {described(kind)}, which does not hold the items to be flown; {known} do: replace it by waypoints",
        )
    version = document.get((*path, "version"))
    if version not in WITH_ITEMS[kind]:
        known = " and ".join(map(str, WITH_ITEMS[kind]))
        raise document.error(
            (*path, "version"), f"is {described(version)}; a {kind} of version {known} is read: save the plan again"
        )
    inner = (*path, "TransectStyleComplexItem")
    document.section(inner)
    if not document.get((*inner, "Items")):
        raise document.error((*inner, "Items"), f"is missing or empty; a {kind} flies them: save the plan again")
    count = len(document.items((*inner, "Items")))
    return [_command(document, (*inner, "Items", k), number + k) for k in range(count)]


def _fences(document: Document) -> tuple[Fence, ...]:
    """The areas of the geofence."""
    fences: list[Fence] = []
    for name in ("polygons", "circles"):
        areas = document.get(("geoFence", name), [])
        for index, area in enumerate(areas if isinstance(areas, list) else []):
            path: Path = ("geoFence", name, index)
            is_inclusion = not (isinstance(area, dict) and area.get("inclusion") is False)
            if name == "polygons":
                corners = document.items((*path, "polygon"))
                places = tuple(_place(document, (*path, "polygon", k)) for k in range(len(corners)))
                fences.append(Fence(corners=places, is_inclusion=is_inclusion))
            else:
                center = _place(document, (*path, "circle", "center"))
                radius = document.number((*path, "circle", "radius"))
                fences.append(Fence(corners=(center,), radius=radius, is_inclusion=is_inclusion))
    return tuple(fences)


def _place(document: Document, path: Path) -> GeoPoint:
    latitude, longitude = document.number((*path, 0)), document.number((*path, 1))
    problem = check_place(latitude, longitude)
    if problem:
        raise document.error(path, problem)
    return geo(latitude, longitude)


def _written_fences(fences: tuple[Fence, ...]) -> dict[str, list[dict[str, Any]]]:
    polygons: list[dict[str, Any]] = []
    circles: list[dict[str, Any]] = []
    for fence in fences:
        corners = [[round(math.degrees(angle), 10) for angle in corner] for corner in fence.corners]
        if fence.radius:
            circle = {"center": corners[0], "radius": fence.radius}
            circles.append({"circle": circle, "inclusion": fence.is_inclusion, "version": 1})
        else:
            polygons.append({"polygon": corners, "inclusion": fence.is_inclusion, "version": 1})
    return {"circles": circles, "polygons": polygons}
