"""A path in any of our formats, and what of it the format cannot keep."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from cardume.errors import InputError
from cardume.missions.formats.content import GEOJSON, GPX, MEDUSA, QGC, WPL
from cardume.missions.formats.geojson import write_geojson
from cardume.missions.formats.gpx import write_gpx
from cardume.missions.formats.medusa_text import write_medusa
from cardume.missions.formats.plan import Plan
from cardume.missions.formats.qgroundcontrol import write_qgroundcontrol
from cardume.missions.formats.sampling import TOLERANCE, Course, speed_on, to_course
from cardume.missions.formats.wpl import write_wpl
from cardume.units import show_quantity

MOST_POINTS = 20_000
FINEST, COARSEST = 0.001, 100.0  # [m] of tolerances

WRITERS: dict[str, Callable[[Course], bytes]] = {
    QGC: write_qgroundcontrol,
    WPL: write_wpl,
    GPX: write_gpx,
    GEOJSON: write_geojson,
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Written:
    """A path in a format.

    Attributes:
        content: of the file.
        points: how many it has, of MEDUSA text its lines and arcs.
        lost: what the format does not keep, one sentence each.
    """

    content: bytes
    points: int
    lost: tuple[str, ...]


def write_plan(plan: Plan, kind: str, name: str, tolerance: float = TOLERANCE) -> Written:
    """Write a path.

    Args:
        plan: the path; segments without a speed go at one that is not known.
        kind: of the format: medusa, plan, wpl, gpx or geojson.
        name: what to call it.
        tolerance: [m] how far a straight leg may lie from the arc that it stands for.

    Raises:
        InputError: a path that the format cannot hold.
    """
    if not FINEST <= tolerance <= COARSEST:
        raise InputError(f"the tolerance is {tolerance:g} m; it lies between {FINEST:g} and {COARSEST:g} m")
    if kind == MEDUSA:
        _refuse_unknown_speed(plan)
        content = write_medusa(plan, name, tolerance)
        lost = _lost_shapes(0, sum(segment.curve is not None for segment in plan.segments), tolerance)
        lost += ["the geofence"] if plan.fences else []
        return Written(content=content, points=content.count(b"\nLINE ") + content.count(b"\nARC "), lost=tuple(lost))
    course = to_course(plan, name, tolerance, MOST_POINTS)
    return Written(
        content=WRITERS[kind](course), points=len(course.points), lost=tuple(_lost(plan, course, kind, tolerance))
    )


def _refuse_unknown_speed(plan: Plan) -> None:
    if any(speed_on(segment, 0.0) is None for segment in plan.segments):
        raise InputError("MEDUSA text needs a speed on every line and arc, and the path has none; give --speed, as 0.5")


def _lost(plan: Plan, course: Course, kind: str, tolerance: float) -> list[str]:
    """What the format does not keep, in sentences."""
    lost = []
    lost += _lost_shapes(course.arcs, course.curves, tolerance)
    lost += _lost_of_formation(plan.members)
    if course.depth is None and any(member.depth for member in plan.members):
        lost.append("the depths, for they differ from vehicle to vehicle")
    if kind == GPX and any(speed is not None for speed in course.speeds):
        lost.append("speeds, for other programs: GPX has none for routes; cardume reads them from an extension")
    if plan.fences and kind != QGC:
        lost.append("the geofence")
    return lost


def _lost_shapes(arcs: int, curves: int, tolerance: float) -> list[str]:
    counted = [f"{count} {name}{'s' * (count > 1)}" for count, name in ((arcs, "arc"), (curves, "curve")) if count]
    if not counted:
        return []
    within = show_quantity(tolerance, "m")
    return [f"{' and '.join(counted)} became straight legs, nowhere more than {within} beside the path"]


def _lost_of_formation(members: Sequence[object]) -> list[str]:
    if len(members) < 2:
        return []
    return [f"the formation: the file has one path, not {len(members)} vehicles; --vehicle NAME writes that of one"]


def with_speed(plan: Plan, speed: float | None) -> Plan:
    """The same with a speed where its segments have none.

    Args:
        plan: any.
        speed: [m/s] None: leave them so.
    """
    if speed is None:
        return plan
    segments = tuple(replace(s, speed=speed) if speed_on(s, 0.0) is None else s for s in plan.segments)
    return replace(plan, segments=segments)
