"""From a MEDUSA mission, as written, to a reference path in local axes and the vehicles beside it.

The x and y of a file are UTM grid axes.  Flown where it says, a plan is turned by the convergence of the grid
and scaled to true meters, so that each of its points lies where UTM puts it.  Moved elsewhere, its drawing is
kept as it stands: y is true north there, and a meter a meter.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from cardume.missions.formats.medusa import ALL, Item, MedusaMission, refused
from cardume.missions.formats.plan import Member, Plan
from cardume.missions.geodesy import GeoPoint, grid_scale
from cardume.paths.joining import Section, join
from cardume.paths.segment import GeometryError


def to_plan(mission: MedusaMission, origin: GeoPoint | None = None) -> Plan:
    """The reference path in local axes, and who flies beside it.

    Args:
        mission: as written.
        origin: fly it there instead of at its own reference.

    Raises:
        MissionError: sections that do not join, or paths that differ from vehicle to vehicle.
    """
    notes = _Notes()
    ids = _flying(mission)
    sections = _shared_sections(mission, ids, notes)
    grid = None if origin else grid_scale(mission.reference)
    turn, scale = (grid.convergence, grid.scale) if grid else (0.0, 1.0)
    try:
        segments = join([_section(item, turn, scale) for item in sections])
    except GeometryError as problem:
        line = int(problem.label.split()[-1]) if problem.label else 0
        raise refused(mission.source, line, "", str(problem)) from None
    members = [replace(member, depth=_depth_of(mission, member.id, notes)) for member in _members(mission, ids)]
    if any(item.vehicle != ALL for item in sections) and any(m.starboard or m.ahead for m in members):
        notes.add(sections[0], "is written for one vehicle; it is flown as written, without the offset of FORMATION")
        members = [replace(member, ahead=0.0, starboard=0.0) for member in members]
    _note_the_rest(mission, members, notes)
    return Plan(
        source=mission.source,
        origin=origin or mission.place,
        segments=segments,
        members=tuple(members),
        notes=notes.in_order(),
    )


class _Notes:
    """What of the file is not flown, by line."""

    def __init__(self) -> None:
        self.by_line: dict[tuple[int, str], None] = {}

    def add(self, item: Item, text: str) -> None:
        self.by_line[item.line, f"line {item.line}: {item.keyword} {text}"] = None

    def in_order(self) -> tuple[str, ...]:
        return tuple(text for _, text in sorted(self.by_line))


def _flying(mission: MedusaMission) -> list[int]:
    """Ids of the vehicles: those of the formation, else those that sections name, else 1."""
    named = sorted({item.vehicle for item in mission.items if item.vehicle != ALL})
    return [member.id for member in mission.formation] or named or [1]


def _shared_sections(mission: MedusaMission, ids: Sequence[int], notes: _Notes) -> list[Item]:
    path = [item for item in mission.items if item.is_path]
    for item in path:
        if item.vehicle not in (ALL, *ids):
            notes.add(item, f"is for vehicle {item.vehicle}, which is not in the formation: not flown")
        elif item.vehicle != ALL and len(ids) > 1:
            raise refused(
                mission.source,
                item.line,
                item.keyword,
                f"is for vehicle {item.vehicle} alone, but vehicles {', '.join(map(str, ids))} share one path: write"
                f" {ALL} for all, or give that vehicle a file of its own",
            )
    sections = [item for item in path if item.vehicle in (ALL, *ids)]
    if not sections:
        raise refused(mission.source, 0, "", "holds no LINE and no ARC; a formation needs a path to follow")
    return sections


def _section(item: Item, turn: float, scale: float) -> Section:
    """A LINE or ARC in local axes: the grid turned by its convergence and scaled to true meters."""
    cos_turn, sin_turn = math.cos(turn) / scale, math.sin(turn) / scale

    def place(point: str) -> tuple[float, float]:
        x, y = item.values[f"x{point}"], item.values[f"y{point}"]
        return y * cos_turn - x * sin_turn, y * sin_turn + x * cos_turn

    is_arc = item.keyword == "ARC"
    return Section(
        start=place("Init"),
        end=place("End"),
        center=place("Center") if is_arc else None,
        sense=-item.values["direction"] if is_arc else 0.0,
        speed=item.values["speed"],
        label=f"line {item.line}",
    )


def _members(mission: MedusaMission, ids: Sequence[int]) -> list[Member]:
    if not mission.formation:
        return [Member(id=vehicle) for vehicle in ids]
    if mission.is_biased:
        return [replace(member, starboard=0.0) for member in mission.formation]
    return list(mission.formation)


def _depth_of(mission: MedusaMission, vehicle: int, notes: _Notes) -> float | None:
    """The depth set before the path begins; a vehicle keeps one depth all the way."""
    depth, under_way = None, False
    for item in mission.items:
        under_way = under_way or item.is_path
        if item.keyword != "DEPTH" or item.vehicle not in (ALL, vehicle):
            continue
        if item.values["time"] > 0.0:
            notes.add(item, f"for {item.values['time']:g} s before going on is not flown")
        elif under_way:
            notes.add(item, "comes after the path has begun: not flown, each vehicle keeps its first depth")
        else:
            depth = item.values["depth"]
    return depth


def _note_the_rest(mission: MedusaMission, members: Sequence[Member], notes: _Notes) -> None:
    for item in mission.items:
        if item.keyword == "POINT":
            notes.add(item, "is not flown; a formation follows lines and arcs")
        elif item.keyword == "ALT":
            notes.add(item, "is not flown; vehicles keep a depth, not an altitude")
    if mission.is_biased and any(member.starboard for member in mission.formation):
        notes.by_line[0, "BIAS leaves the paths where they are: its offsets to the side are not flown"] = None
