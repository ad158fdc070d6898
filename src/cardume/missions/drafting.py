"""The text of a mission that flies a path with defaults: one MEDUSA for each member of its formation."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence

import numpy as np

from cardume.missions.formats.plan import Fence, Member, Plan
from cardume.missions.geodesy import GeoPoint, to_local
from cardume.paths.segment import Segment, end_of
from cardume.units import format_quantity

SLOWEST = 0.5  # [-] of its planned speed, for the time that a path by itself is given
USUAL_SPEED = 0.5  # [m/s] of a MEDUSA, where neither file nor user says one
LONGEST = 30 * 86_400  # [s]
SMOOTH = 1e-7  # [rad]


def draft_mission(plan: Plan, path: Sequence[str], name: str, speed: float | None = None) -> str:
    """A mission of defaults.

    Args:
        plan: what it flies.
        path: the lines of its section `path`.
        name: of the mission.
        speed: [m/s] where the path has none; None: the usual one.

    Returns:
        YAML.
    """
    length = sum(segment.length for segment in plan.segments)
    speeds = [segment.speed or speed or USUAL_SPEED for segment in plan.segments]
    seconds = 60.0 + length / (SLOWEST * min(speeds))
    lines = ["cardume: 1", f"name: {safe_name(name)}", f"duration: {min(round(seconds), LONGEST)} s"]
    if "type: file" not in path[0]:
        lines.append(place_section(plan.origin))
    lines += path
    if any(segment.speed is None for segment in plan.segments) or path[1:2] == ["  type: waypoints"]:
        lines.append(f"formation: {{speed: {format_quantity(speeds[0], 'm/s')}}}")
    lines.append("vehicles:")
    for number, member in enumerate(plan.members):
        lines += _vehicle(member, has_usbl=number == 0 and len(plan.members) > 1)
    if plan.region is not None:
        lines.append(_limits(plan.region, plan.origin))
    lines += ["compensation: {law: crab}", "current_observer: {law: complementary}"]
    return "\n".join(lines) + "\n"


def safe_name(name: str) -> str:
    """A name that a mission may have, made from any text; quoted where YAML would take it for no text."""
    kept = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name).strip("-_")[:64] or "mission"
    is_text = kept[0].isalpha() and kept.lower() not in ("true", "false", "null")
    return kept if is_text else f"'{kept}'"


def file_section(file: str) -> list[str]:
    """A section `path` that names a path file.

    Args:
        file: relative to the mission.
    """
    return [f"path: {{type: file, file: {json.dumps(file, ensure_ascii=False)}}}"]


def place_section(origin: GeoPoint) -> str:
    """The section `origin`."""
    latitude, longitude = (f"{round(math.degrees(angle), 10):.12g} deg" for angle in origin)
    return f"origin: {{latitude: {latitude}, longitude: {longitude}}}"


def is_smooth(segments: Sequence[Segment]) -> bool:
    """Whether each segment goes on in the direction of the one before."""
    ends = (end_of(segment).course for segment in segments)
    turns = (math.remainder(s.course - end, 2.0 * math.pi) for s, end in zip(segments[1:], ends, strict=False))
    return all(abs(turn) < SMOOTH for turn in turns)


def segments_section(segments: Sequence[Segment]) -> list[str]:
    """A section `path` of lines and arcs that go on from one another."""
    first = segments[0]
    start = f"north: {_meters(first.north)}, east: {_meters(first.east)}, course: {_degrees(first.course)}"
    lines = ["path:", "  type: segments", f"  start: {{{start}}}", "  segments:"]
    for segment in segments:
        speed = "" if segment.speed is None else f", speed: {format_quantity(segment.speed, 'm/s')}"
        if segment.curvature == 0.0:
            shape = f"line: {_meters(segment.length)}"
        else:
            turn = "starboard" if segment.curvature > 0.0 else "port"
            angle = _degrees(segment.length * abs(segment.curvature))
            shape = f"arc: {_meters(1.0 / abs(segment.curvature))}, turn: {turn}, angle: {angle}"
        lines.append(f"    - {{{shape}{speed}}}")
    return lines


def waypoints_section(segments: Sequence[Segment]) -> list[str]:
    """A section `path` of straight legs that meet at corners."""
    last = end_of(segments[-1])
    points = [(segment.north, segment.east) for segment in segments] + [(last.north, last.east)]
    places = [f"    - {{north: {_meters(north)}, east: {_meters(east)}}}" for north, east in points]
    return ["path:", "  type: waypoints", "  points:", *places]


def _vehicle(member: Member, has_usbl: bool) -> list[str]:
    sensors = "gnss: {}, ahrs: {}, depth: {}, thruster_speed: {}"
    carried = f"{sensors}, usbl: {{}}" if has_usbl else sensors
    return [
        f"  - name: vehicle-{member.id}",
        f"    depth: {_depth(member)}",
        f"    offset: {{ahead: {_meters(member.ahead)}, starboard: {_meters(member.starboard)}}}",
        f"    sensors: {{{carried}}}",
    ]


def _depth(member: Member) -> str:
    if not member.depths:
        return _meters(member.depth or 0.0)
    points = ", ".join(f"[{_meters(length)}, {_meters(depth)}]" for length, depth in member.depths)
    return f"{{profile: path, points: [{points}]}}"


def _limits(region: Fence, origin: GeoPoint) -> str:
    """The section `limits` that keeps vehicles in a region."""
    latitudes, longitudes = np.array(region.corners).T
    corners = [
        f"{{north: {_meters(n)}, east: {_meters(e)}}}"
        for n, e in zip(*to_local(latitudes, longitudes, origin), strict=True)
    ]
    if region.radius:
        return f"limits: {{geofence: {{centre: {corners[0]}, radius: {_meters(region.radius)}}}}}"
    return f"limits: {{geofence: {{polygon: [{', '.join(corners)}]}}}}"


def _meters(value: float) -> str:
    """To a micrometer."""
    return f"{round(value, 6) + 0.0:.12g} m"


def _degrees(angle: float) -> str:
    """To 1e-11 degrees, a micrometer at 6,000 km."""
    return f"{round(math.degrees(angle), 11) + 0.0:.14g} deg"
