"""The path of a mission, as path files hold one."""

import math
from collections.abc import Sequence
from dataclasses import replace

from cardume.errors import InputError
from cardume.missions.drawing import draw
from cardume.missions.formats.plan import Member, Plan
from cardume.missions.formats.writing import with_speed
from cardume.missions.geodesy import GeoPoint
from cardume.missions.mission import Mission
from cardume.missions.orders import steady_depth, table_speed
from cardume.missions.planning import reference_path
from cardume.missions.schema import Profile
from cardume.missions.wording import unknown
from cardume.paths.corner import OwnSegment
from cardume.paths.offset import own_path
from cardume.paths.segment import Segment
from cardume.units import printable


def plan_of_mission(opened: Mission, source: str, origin: GeoPoint | None) -> tuple[Plan, list[str], list[str]]:
    """The path of a mission, the names of its vehicles, and what is lost of it in any path file.

    Args:
        opened: values that vary are drawn by its seed.
        source: what messages call it.
        origin: of its local axes; None: its own.

    Raises:
        MissionError: no origin is known, or the path cannot be built.
    """
    mission = opened if opened.is_fixed else draw(opened, opened.seed)
    given = GeoPoint(mission.origin.latitude, mission.origin.longitude) if mission.origin else None
    segments, origin = reference_path(mission, origin or given)
    if origin is None:
        raise mission.error(
            "origin",
            "is not given, and a path file needs places on the Earth; say where north = east = 0 lies with"
            " --origin LATITUDE,LONGITUDE in degrees, or in the mission",
        )
    lost = ["the rest of the mission: vehicles, laws, sensors, current, what is required"]
    segments = tuple(segment for segment in segments if not segment.beyond)
    plan = Plan(source=source, origin=origin, segments=segments, members=_members(mission), name=mission.name)
    lost += [f"the profile of {key}: {kept} is kept" for key, kept in _profiles(mission)]
    lost += [f"{v.name}'s maneuver: it gets the formation's own path" for v in mission.vehicles if v.maneuver]
    mean = table_speed(mission, sum(segment.length for segment in plan.segments))
    plan = with_speed(plan, None if math.isnan(mean) else mean)
    return _whole_laps(plan, mission, lost), [vehicle.name for vehicle in mission.vehicles], lost


def _profiles(mission: Mission) -> list[tuple[str, str]]:
    """What of a mission changes with time or along the path, and what of it a path file gets."""
    found = [("formation.speed", "its mean")] if isinstance(mission.formation.speed, Profile) else []
    return found + [(f"{v.name}'s depth", "its start") for v in mission.vehicles if isinstance(v.depth, Profile)]


def _members(mission: Mission) -> tuple[Member, ...]:
    return tuple(
        Member(id=number, ahead=v.offset.ahead, starboard=v.offset.starboard, depth=steady_depth(v))
        for number, v in enumerate(mission.vehicles, 1)
    )


def _whole_laps(plan: Plan, mission: Mission, lost: list[str]) -> Plan:
    """A circle is flown until the mission ends: as many laps as that may be."""
    (first, *rest) = plan.segments
    lap = 2.0 * math.pi / abs(first.curvature) if first.curvature else math.inf
    if rest or first.length <= 2.0 * lap or first.speed is None:
        return plan
    laps = min(math.ceil(first.speed * mission.duration / lap), round(first.length / lap))
    lost.append(f"laps beyond the {laps} that the mission's duration allows")
    return replace(plan, segments=(replace(first, length=laps * lap),))


def own_plan(plan: Plan, names: Sequence[str], vehicle: str) -> Plan:
    """One vehicle's own path, at its own speeds: an outer vehicle is faster in an arc.

    Args:
        plan: of the formation.
        names: of its members.
        vehicle: one of them.

    Raises:
        InputError: it is none of them, or its offset does not fit.
    """
    if vehicle not in names:
        raise InputError(f"--vehicle {printable(vehicle)}: {unknown('no such vehicle', vehicle, list(names))}")
    member = plan.members[names.index(vehicle)]
    segments = tuple(_at_own_speed(own) for own in own_path(plan.segments, member.starboard))
    alone = replace(member, ahead=0.0, starboard=0.0)
    return replace(plan, segments=segments, members=(alone,), name=f"{plan.name}-{vehicle}")


def _at_own_speed(own: OwnSegment) -> Segment:
    """A segment of a vehicle's own path with its speed there, of a curve the mean stretch for all of it."""
    shape, curve = own.shape, own.shape.curve
    stretch = shape.length / own.reference_length if own.reference_length else 1.0
    if shape.speed is not None:
        return replace(shape, speed=shape.speed * stretch)
    if curve is None or curve.speed is None:
        return shape
    gained = tuple(stretch * coefficient for coefficient in curve.gained_speed)
    return replace(shape, curve=replace(curve, speed=stretch * curve.speed, gained_speed=gained))
