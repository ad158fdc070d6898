"""Paths and places: offsets that do not fit, places too close to one another, aims beyond an arc's center."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cardume.errors import InputError, MissionError, Position, Problem
from cardume.missions.catalog import Catalog
from cardume.missions.checks.abilities import hull_length
from cardume.missions.checks.finding import Finding, Level, Ranked, at_most, setting, setting_word, show, worst
from cardume.missions.checks.scene import Craft, Scene, distance_at_start, distances_in_formation
from cardume.missions.mission import STILL, Mission
from cardume.missions.planning import Planned, make_plan
from cardume.missions.vehicle import Offset, RelativeStart
from cardume.paths import table
from cardume.paths.offset import curve_of, largest_offset, offset_path
from cardume.paths.segment import GeometryError, Segment

SLACK = 1.01
STATIC_ERROR_SHOWN = 0.05  # [m]
SAFE_SHARE = 0.8  # of the lookahead at which the aim comes abeam of the center


def plan_or_problems(mission: Mission, catalog: Catalog) -> tuple[Planned | None, list[Finding]]:
    """Plan a mission, or say everything that forbids it.

    Args:
        mission: with every value fixed.
        catalog: where its laws are found.

    Returns:
        The plan and no finding, or None and errors with their places in the file.
    """
    try:
        return make_plan(mission, catalog), []
    except MissionError as problem:
        problems = list(problem.problems)
    except InputError as problem:
        return None, [Finding("error", "path", str(problem))]
    centered = replace(
        mission,
        current=STILL["none"],
        vehicles=tuple(replace(vehicle, offset=Offset()) for vehicle in mission.vehicles),
    )
    try:
        segments = segments_of(make_plan(centered, catalog).reference)
    except InputError:
        segments = []
    return None, [*_misfits(mission, segments), *(_as_finding(p) for p in problems if not _is_offset(p, segments))]


def segments_of(reference: np.ndarray) -> list[Segment]:
    """The reference path that a table without offset describes.

    Args:
        reference: (n,) [any] its table.
    """
    return [
        Segment(
            north=row[table.START_NORTH],
            east=row[table.START_EAST],
            course=row[table.START_COURSE],
            curvature=row[table.CURVATURE],
            length=row[table.LENGTH],
            speed=None if row[table.IS_CURVE] else row[table.SPEED],
            curve=curve_of(row) if row[table.IS_CURVE] else None,
        )
        for row in table.rows_on_path(reference)
    ]


def _is_offset(problem: Problem, segments: list[Segment]) -> bool:
    return bool(segments) and problem.position.key.endswith(".offset.starboard")


def _misfits(mission: Mission, segments: list[Segment]) -> Iterator[Finding]:
    """Every vehicle whose offset does not fit, not only the first."""
    for vehicle in mission.vehicles if segments else ():
        key, starboard = f"vehicles.{vehicle.name}.offset.starboard", vehicle.offset.starboard
        try:
            offset_path(segments, starboard, vehicle.offset.ahead)
        except GeometryError as problem:
            fits = largest_offset(segments, starboard)
            suggestion = "" if fits is None else setting(key, math.copysign(fits, starboard), "m")
            yield Finding("error", key, _placed(mission.where(key), str(problem)), suggestion)


def _as_finding(problem: Problem) -> Finding:
    return Finding("error", problem.position.key or "path", _placed(problem.position, problem.message))


def _placed(position: Position, message: str) -> str:
    line = f":{position.line}" if position.line else ""
    return f"{position.source}{line}: {message}"


def check_separation(scene: Scene) -> Iterator[Finding]:
    """Vehicles whose places in the formation, or at the start, are closer than their hulls, or than required."""
    required = [r.limit for r in scene.mission.require if r.metric == "separation_min"]
    for i, j in scene.pairs():
        one, other = scene.crafts[i], scene.crafts[j]
        least = max([0.5 * (hull_length(one.plan) + hull_length(other.plan)), *required])
        why = "required by separation_min" if least in required else "the length of a hull"
        apart = distances_in_formation(one, other)
        if apart.size and apart.min() < least:
            yield Finding(
                "warning",
                f"vehicles.{other.name}.offset",
                f"in their places {one.name} and {other.name} come within {show(apart.min(), 'm')};"
                f" at least {show(least, 'm')} ({why}) keeps them apart",
                _outer_place(scene, other, least),
            )
        start = distance_at_start(one.plan, other.plan)
        if start < least:
            yield Finding(
                "warning",
                f"vehicles.{other.name}.start",
                f"{one.name} and {other.name} start {show(start, 'm')} apart; at least {show(least, 'm')} ({why})"
                " keeps them apart",
                _other_start(scene, other, least),
            )


def _outer_place(scene: Scene, craft: Craft, least: float) -> str:
    """A place outside of all others, on the side where that is less far out."""
    key = f"vehicles.{craft.name}.offset.starboard"
    others = [c.vehicle.offset.starboard for c in scene.crafts if c is not craft]
    sides = [max(others) + SLACK * least, min(others) - SLACK * least]
    best = min(sides, key=abs)
    return setting(key, math.copysign(math.ceil(abs(best) * 100.0) / 100.0, best), "m")


def _other_start(scene: Scene, craft: Craft, least: float) -> str:
    """A start further along, or back, that is clear of all others."""
    start, state = craft.vehicle.start, craft.plan.state
    is_relative = isinstance(start, RelativeStart)
    course = craft.stations.course[0] if is_relative else 0.0
    name, given = ("along_track", start.along_track) if isinstance(start, RelativeStart) else ("north", start.north)
    for steps in (-1, 1, -2, 2, -3, 3):
        shift = round(steps * SLACK * least, 2) + 0.01 * steps
        moved = state._replace(north=state.north + shift * math.cos(course), east=state.east + shift * math.sin(course))
        trial = replace(craft.plan, state=moved)
        if all(distance_at_start(trial, c.plan) >= least for c in scene.crafts if c is not craft):
            return setting(f"vehicles.{craft.name}.start.{name}", given + shift, "m")
    return ""


def check_aim(scene: Scene) -> list[Finding]:
    """Law (18) on arcs: it needs d / R < pi / 2, and settles at -R (1 - cos(d / R)).

    Source: theory of eq. (18), domain and static error.
    """
    return worst(ranked for craft in scene.crafts for ranked in _aims_of(scene, craft))


def _aims_of(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    law = craft.law("guidance")
    if law.law.name != "along_path":
        return
    lookahead, key = law.value("lookahead"), scene.key(craft, "guidance.lookahead")
    for row in table.rows_on_path(craft.plan.path):
        radius, length = _tightest(row), row[table.LENGTH]
        if not radius:
            continue
        ratio = lookahead / radius
        kind = "curve, which bends to a" if row[table.IS_CURVE] else "arc of"
        where = f"{craft.name}, on its {kind} radius {show(radius, 'm')}"
        if ratio >= 0.5 * math.pi:
            # after a right angle the aim is astern of the way the path goes; a shorter arc is but cut
            level: Level = "error" if length / radius > 0.5 * math.pi * SLACK else "warning"
            message = (
                f"{where}: the aim {show(lookahead, 'm')} ahead lies beyond the arc's center (d / R ="
                f" {ratio:.3g}, below {0.5 * math.pi:.4g} the law holds): it is drawn inside, by up to the radius"
            )
            yield Ranked(ratio, Finding(level, key, message, at_most(key, SAFE_SHARE * 0.5 * math.pi * radius, "m")))
        elif radius * (1.0 - math.cos(ratio)) >= STATIC_ERROR_SHOWN:
            error = radius * (1.0 - math.cos(ratio))
            message = (
                f"{where}: along_path settles {show(error, 'm')} inside, R (1 - cos(d / R)), where the arc is long"
                " enough; line_of_sight does not"
            )
            suggestion = setting_word(scene.key(craft, "guidance.law"), "line_of_sight")
            yield Ranked(error, Finding("note", key, message, suggestion))


def _tightest(row: np.ndarray) -> float:
    """Smallest radius [m] of a segment of an own path; 0 where it is straight."""
    if not row[table.IS_CURVE]:
        return float(row[table.RADIUS])
    own = [abs(c / (1.0 - c * row[table.OFFSET])) for c in curve_of(row).bends]
    return 1.0 / max(own) if max(own) else 0.0
