"""From what a mission says of depth, speed, phases and limits to what a vehicle is told of them."""

from collections.abc import Iterable
from typing import Any, Literal, cast

import numpy as np

from cardume.missions.mission import Mission
from cardume.missions.schema import Profile
from cardume.missions.vehicle import PolygonFence, RoundFence, Vehicle
from cardume.onboard.mind import NEVER, Orders
from cardume.paths import table
from cardume.simulation.memo import NO_MEMO, Memo
from cardume.simulation.plan import OrderBook
from cardume.simulation.safety import Safety

WATCHED = ("depth_max", "altitude_min", "geofence_margin_min", "separation_min")
Over = Literal["time", "path"]


def order_book(mission: Mission, vehicle: Vehicle, path: np.ndarray, memo: Memo = NO_MEMO) -> OrderBook:
    """What a vehicle is told beside its `Setup`.

    Args:
        mission: with every value fixed.
        vehicle: of its fleet.
        path: (n,) its path table.
        memo: of other missions that were drawn from the same one.

    Raises:
        MissionError: what does not go together.
    """
    _check(mission, vehicle)
    speed, depth = mission.formation.speed, vehicle.depth
    fence = vehicle.limits.geofence if vehicle.limits else None
    varies = memo.recall("varies along", (path,), lambda: varies_along(path))
    return OrderBook(
        _orders(vehicle),
        pace=speed.points if isinstance(speed, Profile) else (),
        pace_over=cast(Over, speed.over) if isinstance(speed, Profile) else "time",
        varies_along=speed.over == "path" if isinstance(speed, Profile) else varies,
        depth=depth.points if isinstance(depth, Profile) else (),
        depth_over=cast(Over, depth.over) if isinstance(depth, Profile) else "time",
        keeps_altitude=vehicle.altitude is not None,
        has_phases=bool(vehicle.phases or vehicle.abort),
        fence=tuple((c.north, c.east) for c in fence.polygon) if isinstance(fence, PolygonFence) else (),
    )


def varies_along(path: np.ndarray) -> bool:
    """Whether v_L differs along a path.

    Args:
        path: (n,) path table.
    """
    rows = table.rows_on_path(path)
    return bool(np.ptp(rows[:, table.SPEED]) > 0.0 or rows[:, table.GAINED_SPEED :].any())


def _orders(vehicle: Vehicle) -> Orders:
    told: dict[str, float] = {"altitude": vehicle.altitude or 0.0}
    if phases := vehicle.phases:
        told |= {"circle_radius": phases.circle or 0.0, "hold_time": phases.hold or 0.0}
        if dive := phases.dive:
            told |= {"dives": 1.0, "dive_tolerance": dive.tolerance, "dive_timeout": _or_never(dive.timeout)}
        if gather := phases.gather:
            told |= {"gathers": 1.0, "gather_radius": gather.radius, "gather_timeout": _or_never(gather.timeout)}
    else:
        told |= {"hold_time": 0.0}
    if abort := vehicle.abort:
        told |= {"aborts": 1.0, "abort_surfaces": float(abort.to == "surface")}
        told |= {"silence": _or_never(abort.silence), "latest": _or_never(abort.time)}
    if limits := vehicle.limits:
        told |= {"depth_limit": _or_never(limits.depth)}
        told |= {"altitude_limit": -NEVER if limits.altitude is None else limits.altitude}
        if isinstance(fence := limits.geofence, RoundFence):
            told |= {"fence_radius": fence.radius}
            told |= {"fence_north": fence.centre.north, "fence_east": fence.centre.east}
    if silence := vehicle.coordination.silence:
        shares = {"go_on": 1.0, "slow_down": silence.share, "hold": 0.0}
        told |= {"silent_after": silence.after, "silent_share": shares[silence.do]}
    return Orders(**told)


def _or_never(value: float | None) -> float:
    return NEVER if value is None else value


def _check(mission: Mission, vehicle: Vehicle) -> None:
    """Refuse what cannot be done.

    Raises:
        MissionError: with the key.
    """
    here, sensors, limits = f"vehicles.{vehicle.name}", vehicle.sensors, vehicle.limits
    needs_seabed = {"altitude": vehicle.altitude, "limits.altitude": limits and limits.altitude}
    for key, value in needs_seabed.items():
        if value is not None and mission.bathymetry is None:
            raise mission.error(
                f"{here}.{key}", "needs a seabed: give bathymetry, such as {type: flat, depth: 20 m}, or leave it out"
            )
    if vehicle.altitude is not None and not (sensors.ideal or (sensors.altimeter and sensors.depth)):
        lacking = "depth" if sensors.altimeter else "altimeter"
        raise mission.error(
            f"{here}.altitude", f"needs sensors.{lacking}, by which the vehicle follows the seabed; carry it"
        )
    if limits and isinstance(limits.geofence, PolygonFence) and len(limits.geofence.polygon) < 3:
        count = len(limits.geofence.polygon)
        raise mission.error(f"{here}.limits.geofence.polygon", f"given {count} corners; a polygon has at least 3")
    if vehicle.abort and vehicle.abort.silence is not None:
        k = [v.name for v in mission.vehicles].index(vehicle.name)
        if not any(mission.adjacency[k]):
            raise mission.error(f"{here}.abort.silence", "it hears nobody, so it is always silent; leave silence out")


def start_depth(vehicle: Vehicle) -> float:
    """The depth [m] at which a vehicle starts."""
    if vehicle.start.depth is not None:
        return vehicle.start.depth
    return 0.0 if vehicle.phases and vehicle.phases.dive else steady_depth(vehicle)


def steady_depth(vehicle: Vehicle) -> float:
    """The depth [m] that a vehicle keeps, at first where it changes."""
    return vehicle.depth.points[0][1] if isinstance(vehicle.depth, Profile) else vehicle.depth


def deepest(vehicle: Vehicle) -> float:
    """The largest depth [m] that a vehicle is told to keep."""
    return max(vehicle.depth.values) if isinstance(vehicle.depth, Profile) else vehicle.depth


def table_speed(mission: Mission, length: float) -> float:
    """v_L [m/s] for the path's table: the mean of a profile of time over the mission; NaN where none is given.

    Args:
        mission: with every value fixed.
        length: [m] of the reference path.
    """
    speed = mission.formation.speed
    if isinstance(speed, Profile):
        return speed.mean(0.0, mission.duration if speed.over == "time" else length)
    return np.nan if speed is None else speed


def safety_of(mission: Mission, vehicle: Vehicle) -> Safety:
    """The limits that a vehicle is measured by: its own and what is required of it, whichever is stricter."""
    limits, most = vehicle.limits, _required(mission, vehicle, "depth_max")
    depth = [*most, *([limits.depth] if limits and limits.depth is not None else [])]
    altitude = _required(mission, vehicle, "altitude_min")
    altitude += [limits.altitude] if limits and limits.altitude is not None else []
    margin = _required(mission, vehicle, "geofence_margin_min") + ([0.0] if limits and limits.geofence else [])
    return Safety(
        depth_limit=min(depth, default=NEVER),
        altitude_limit=max(altitude, default=-NEVER),
        fence_limit=max(margin, default=-NEVER),
    )


def separation_of(mission: Mission) -> float:
    """The distance [m] that is required between vehicles, 0 where none is."""
    return max((r.limit for r in mission.require if r.metric == "separation_min"), default=0.0)


def is_watched(mission: Mission) -> bool:
    """Whether depth, altitude, geofence or separation matter to anybody."""
    return (
        any(r.metric in WATCHED for r in mission.require)
        or any(vehicle.limits is not None for vehicle in mission.vehicles)
        or mission.bathymetry is not None
    )


def _required(mission: Mission, vehicle: Vehicle, metric: str) -> list[float]:
    return [r.limit for r in mission.require if r.metric == metric and r.vehicle in (None, vehicle.name)]


def depths_along(vehicle: Vehicle) -> Iterable[Any]:
    """Every depth [m] that a vehicle is told to keep."""
    return set(vehicle.depth.values) if isinstance(vehicle.depth, Profile) else {vehicle.depth}
