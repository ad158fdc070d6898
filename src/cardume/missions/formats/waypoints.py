"""From waypoints on the Earth, as most path files give them, to a reference path in local axes.

Local axes begin at the first waypoint, or where the mission says; the waypoints stay where their file puts them.
Legs are straight in local axes, which differ from geodesics by d^3 / (24 R^2): 1 mm over 10 km.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cardume.errors import MissionError, Position, Problem
from cardume.missions.formats.plan import Fence, Member, Plan
from cardume.missions.formats.thinning import thin
from cardume.missions.geodesy import GeoPoint, to_local
from cardume.missions.schema import MOST_PROFILE_POINTS
from cardume.paths.segment import ReferencePath, Segment
from cardume.paths.table import MAX_SEGMENTS

TOGETHER = 0.01  # [m] waypoints nearer than this are one: a step in the last digit of 1e-7 deg
FARTHEST = 200e3  # [m] from the origin; lengths in local axes are true to 2e-4 there
DEEPEST = 12_000.0  # [m]


@dataclass(frozen=True, kw_only=True, slots=True)
class Waypoint:
    """A point of a path.

    Attributes:
        place: where it is.
        speed: [m/s] v_L of the leg that ends here; None: the formation's.
        depth: [m] that the file asks for; None: it asks for none.
        label: what messages call it, such as "item 3".
        position: where in its file it stands.
    """

    place: GeoPoint
    speed: float | None = None
    depth: float | None = None
    label: str = ""
    position: Position = Position("", 0, "")


@dataclass(kw_only=True, slots=True)
class Draft:
    """What a file says, while it is read.

    Attributes:
        source: the file.
        name: what it calls its path.
        waypoints: in the order in which they are passed.
        notes: what is not flown, one sentence each.
        fences: areas that it names.
        locate: finds the line of a position that does not have it yet.
    """

    source: str
    name: str
    waypoints: list[Waypoint]
    notes: list[str]
    fences: tuple[Fence, ...] = ()
    locate: Callable[[Position], Position] = lambda position: position


def to_plan(draft: Draft, origin: GeoPoint | None = None) -> Plan:
    """The reference path in local axes.

    Args:
        draft: at least one waypoint.
        origin: of the local axes; None: the first waypoint.

    Raises:
        MissionError: fewer than two places, or places too far from the origin.
    """
    if not draft.waypoints:
        only = f", only {'; '.join(draft.notes)}" if draft.notes else ""
        raise _error(draft, Position(draft.source, 0, ""), f"holds no waypoint{only}; a path needs at least two")
    home = origin or draft.waypoints[0].place
    places = np.array([waypoint.place for waypoint in draft.waypoints])
    points = np.column_stack(to_local(places[:, 0], places[:, 1], home))
    _refuse_distant(draft, points, is_given=origin is not None)
    kept = _distinct(points)
    if len(kept) < 2:
        raise _error(draft, draft.waypoints[0].position, "is the only place of the file; a path needs at least two")
    kept = _as_many_as_fit(draft, points, kept)
    segments = _legs(points[kept], [draft.waypoints[index] for index in kept])
    depths = _depths(draft, kept, segments)
    return Plan(
        source=draft.source,
        origin=home,
        segments=segments,
        members=(Member(id=1, depth=depths[0][1] if depths else None, depths=depths if len(depths) > 1 else ()),),
        notes=tuple(dict.fromkeys(draft.notes)),
        name=draft.name,
        fences=draft.fences,
    )


def check_place(latitude: float, longitude: float) -> str:
    """What is wrong with a latitude and longitude in degrees; empty if nothing is.

    Args:
        latitude: [deg]
        longitude: [deg]
    """
    if not (math.isfinite(latitude) and math.isfinite(longitude)):
        return f"latitude {latitude:g}, longitude {longitude:g}: both must be finite numbers of degrees"
    if abs(latitude) <= 90.0 and abs(longitude) <= 360.0:
        return ""
    said = f"latitude {latitude:.10g} deg, longitude {longitude:.10g} deg lies nowhere"
    if abs(latitude) <= 180.0 and abs(longitude) <= 90.0:
        return f"{said}; latitudes lie between -90 and 90 deg: perhaps latitude and longitude are exchanged"
    if abs(latitude) <= 90e7 and abs(longitude) <= 180e7 and min(abs(latitude), abs(longitude)) > 1000.0:
        return f"{said}; these look like degrees times 10^7: divide them"
    return f"{said}; latitudes lie between -90 and 90 deg, longitudes between -180 and 180 deg"


def geo(latitude: float, longitude: float) -> GeoPoint:
    """A place given in degrees."""
    return GeoPoint(math.radians(latitude), math.radians(longitude))


def _error(draft: Draft, position: Position, message: str) -> MissionError:
    return MissionError([Problem(draft.locate(position), message)])


def _refuse_distant(draft: Draft, points: np.ndarray, is_given: bool) -> None:
    distances = np.hypot(points[:, 0], points[:, 1])
    worst = int(np.argmax(distances))
    if distances[worst] <= FARTHEST:
        return
    waypoint = draft.waypoints[worst]
    whence = "the origin that the mission gives" if is_given else "the first waypoint"
    advice = "; leave origin out, and the first waypoint is it" if is_given else ""
    raise _error(
        draft,
        waypoint.position,
        f"{waypoint.label} lies {distances[worst] / 1000.0:,.0f} km from {whence}; a path stays within"
        f" {FARTHEST / 1000.0:g} km of it{advice}",
    )


def _distinct(points: np.ndarray) -> list[int]:
    """Indices of the points that are not where the one before them is."""
    kept = [0]
    for index in range(1, len(points)):
        if np.hypot(*(points[index] - points[kept[-1]])) > TOGETHER:
            kept.append(index)
    return kept


def _as_many_as_fit(draft: Draft, points: np.ndarray, kept: list[int]) -> list[int]:
    """Fewer points, where they are more than a path may have; a change of speed stays where it is."""
    if len(kept) <= MAX_SEGMENTS + 1:
        return kept
    speeds = [draft.waypoints[index].speed for index in kept]
    fixed = [k for k in range(len(kept) - 1) if speeds[k] != speeds[k + 1]]
    chosen, tolerance = thin(points[kept], MAX_SEGMENTS + 1, fixed)
    draft.notes.append(
        f"{len(kept):,} points are more than the {MAX_SEGMENTS:,} legs that a path may have: {len(chosen):,} of them"
        f" are kept, so that none of the others is more than {tolerance:.2g} m beside the path"
    )
    return [kept[index] for index in chosen]


def _legs(points: np.ndarray, waypoints: Sequence[Waypoint]) -> ReferencePath:
    steps = np.diff(points, axis=0)
    lengths, courses = np.hypot(steps[:, 0], steps[:, 1]), np.arctan2(steps[:, 1], steps[:, 0])
    return tuple(
        Segment(
            north=float(start[0]),
            east=float(start[1]),
            course=float(course),
            curvature=0.0,
            length=float(length),
            speed=waypoint.speed,
            label=f"leg to {waypoint.label}",
        )
        for start, course, length, waypoint in zip(points, courses, lengths, waypoints[1:], strict=False)
    )


def _depths(draft: Draft, kept: Sequence[int], segments: ReferencePath) -> tuple[tuple[float, float], ...]:
    """Arc length and depth [m] where the depth changes, one pair where it does not, none where none is asked for."""
    ends = [0.0, *itertools.accumulate(segment.length for segment in segments)]
    asked = [(end, draft.waypoints[index].depth) for end, index in zip(ends, kept, strict=True)]
    depths = [(end, depth) for end, depth in asked if depth is not None]
    if not any(depth for _, depth in depths):
        return ()
    flat = [
        0 < k < len(depths) - 1 and depths[k - 1][1] == depth == depths[k + 1][1] for k, (_, depth) in enumerate(depths)
    ]
    bends = [pair for pair, is_flat in zip(depths, flat, strict=True) if not is_flat]
    if len({depth for _, depth in bends}) == 1:
        return tuple(bends[:1])
    if len(bends) > MOST_PROFILE_POINTS:
        draft.notes.append(
            f"depths that change {len(bends):,} times: flown all the way at the first, {bends[0][1]:g} m"
        )
        return tuple(bends[:1])
    return tuple(bends)
