"""Depths, the seabed and the limits: what a vehicle cannot follow, where it runs aground, what it is told to exceed."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from cardume.maths import inside_circle, inside_polygon
from cardume.missions.checks.finding import Finding, at_least, at_most, setting_word, show
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.orders import start_depth
from cardume.missions.schema import Profile
from cardume.onboard.depths import SMOOTHING
from cardume.signals import Spot

STEEPEST_SHARE = 0.8  # of the largest heave: the rest is for corrections


FINEST = 2.0  # [m] between places at which the seabed is looked at
MOST_PLACES = 20_000


class Places(NamedTuple):
    """Places along a vehicle's path, closer together than its stations."""

    north: np.ndarray  # (n,) [m]
    east: np.ndarray  # (n,) [m]
    time: np.ndarray  # (n,) [s]
    state: np.ndarray  # (n,) [m]


def places_of(craft: Craft) -> Places:
    """The stations of a vehicle, and more between them where they are far apart."""
    s = craft.stations
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(s.north), np.diff(s.east)))])
    count = min(int(gone[-1] / FINEST) + 1, MOST_PLACES)
    knots = np.union1d(gone, np.linspace(0.0, gone[-1], count + 1))
    return Places(*(np.interp(knots, gone, column) for column in (s.north, s.east, s.time, s.state)))


def seabed_at(scene: Scene, craft: Craft) -> np.ndarray | None:
    """Depth of the seabed [m] at each of a vehicle's places; None where the mission has none that is known here.

    Args:
        scene: with the table of a gridded seabed.
        craft: the vehicle.
    """
    choice = craft.plan.laws.get("bathymetry")
    if choice is None or not choice.law.is_builtin:
        return None
    given = {p.name: choice.value(p.name) for p in choice.law.parameters}
    field: Any = scene.plan.seabed
    here = places_of(craft)
    places = zip(here.north, here.east, strict=True)
    return np.array([choice.law.function(Spot(n, e, field), **given) for n, e in places], float)


def wanted_depth(scene: Scene, craft: Craft) -> np.ndarray:
    """The depth [m] that a vehicle is to keep at each of its places; NaN where the seabed is not known."""
    vehicle, places = craft.vehicle, places_of(craft)
    seabed = seabed_at(scene, craft)
    if vehicle.altitude is not None and seabed is not None:
        return np.maximum(seabed - vehicle.altitude, 0.0)
    if isinstance(vehicle.depth, Profile):
        x = places.time if vehicle.depth.over == "time" else places.state + vehicle.offset.ahead
        return np.array([vehicle.depth.at(float(value)) for value in x])
    return np.full(len(places.state), vehicle.depth)


def fastest_change(scene: Scene, craft: Craft) -> float:
    """How fast [m/s] the depth to keep changes at most."""
    depth = craft.vehicle.depth
    if craft.vehicle.altitude is None and isinstance(depth, Profile):
        x, z = np.array(depth.points).T
        rates = np.abs(np.diff(z) / np.diff(x))
        per_second = 1.0 if depth.over == "time" else float(craft.stations.speed.max())
        return float(rates.max(initial=0.0)) * per_second
    steps = np.diff(places_of(craft).time)
    rates = np.abs(np.diff(wanted_depth(scene, craft)))[steps > 0.0] / steps[steps > 0.0]
    return float(np.nan_to_num(rates).max(initial=0.0))


def check_slope(scene: Scene) -> Iterator[Finding]:
    """Depths that change faster than the vehicle dives or rises, or so fast that it lags into the seabed.

    w = |dz/ds| h v_L <= heave_max;   lag on a slope: w (1 / k + T), k the depth gain, T the filter's time constant.
    """
    for craft in scene.crafts:
        autopilot = craft.law("autopilot")
        names = {p.name for p in autopilot.law.parameters}
        if not {"heave_max", "depth_gain"} <= names:
            continue
        rate, most = fastest_change(scene, craft), STEEPEST_SHARE * autopilot.value("heave_max")
        key = f"vehicles.{craft.name}.{'depth' if craft.vehicle.altitude is None else 'altitude'}"
        lag = rate * (1.0 / autopilot.value("depth_gain") + SMOOTHING)
        slower = 0.98 * float(craft.stations.speed.max()) * most / rate if rate > 0.0 else math.inf
        by_time = isinstance(craft.vehicle.depth, Profile) and craft.vehicle.depth.over == "time"
        if rate > most:
            yield Finding(
                "warning",
                key,
                f"{craft.name} is to change its depth by up to {show(rate, 'm/s')}; it dives and rises at most"
                f" {show(autopilot.value('heave_max'), 'm/s')}, so it cannot follow",
                at_most("formation.speed", slower, "m/s") if scene.sets_speed and not by_time else "",
            )
        elif craft.vehicle.altitude is not None and lag >= craft.vehicle.altitude:
            yield Finding(
                "warning",
                key,
                f"{craft.name} follows a slope of {show(rate, 'm/s')} up to {show(lag, 'm')} late, which is all of its"
                f" altitude of {show(craft.vehicle.altitude, 'm')}",
                at_least(key, 2.0 * lag, "m"),
            )


def check_aground(scene: Scene) -> Iterator[Finding]:
    """A depth to keep that is below the seabed, and a seabed that is not known along the path."""
    for craft in scene.crafts:
        seabed = seabed_at(scene, craft)
        if seabed is None:
            continue
        key = f"vehicles.{craft.name}.{'depth' if craft.vehicle.altitude is None else 'altitude'}"
        room, here = seabed - wanted_depth(scene, craft), places_of(craft)
        if craft.vehicle.altitude is None and np.nanmin(room, initial=math.inf) <= 0.0:
            k = int(np.nanargmin(room))
            yield Finding(
                "error",
                key,
                f"{craft.name} runs aground: at north {here.north[k]:.0f} m, east"
                f" {here.east[k]:.0f} m the seabed is {show(seabed[k], 'm')} deep, and it is to keep"
                f" {show(seabed[k] - room[k], 'm')}",
                at_most(key, 0.9 * float(np.nanmin(seabed)), "m"),
            )
        unknown = np.isnan(seabed)
        if craft.vehicle.altitude is not None and unknown.any():
            k = int(np.argmax(unknown))
            yield Finding(
                "warning",
                "bathymetry",
                f"{craft.name}: no seabed is known at north {here.north[k]:.0f} m, east {here.east[k]:.0f} m; without"
                " an echo it keeps the depth it had",
            )


def check_echo(scene: Scene) -> Iterator[Finding]:
    """An altitude that the altimeter does not measure, or a start from which it hears no seabed."""
    for craft in scene.crafts:
        altimeter, altitude = craft.plan.laws.get("altimeter"), craft.vehicle.altitude
        if altitude is None or altimeter is None or "range" not in {p.name for p in altimeter.law.parameters}:
            continue
        reach, key = altimeter.value("range"), f"vehicles.{craft.name}.altitude"
        if not altimeter.value("nearest") <= altitude <= reach:
            yield Finding(
                "error",
                key,
                f"{craft.name} is to keep {show(altitude, 'm')} above the seabed; its altimeter measures from"
                f" {show(altimeter.value('nearest'), 'm')} to {show(reach, 'm')}",
                at_most(key, 0.8 * reach, "m"),
            )
        seabed = seabed_at(scene, craft)
        lowest = max(start_depth(craft.vehicle), craft.plan.setup.depth)
        if seabed is not None and len(seabed) and seabed[0] - lowest > reach:
            yield Finding(
                "warning",
                f"vehicles.{craft.name}.depth",
                f"{craft.name} starts where the seabed is {show(seabed[0], 'm')} deep and goes to {show(lowest, 'm')}"
                f" until it hears it, {show(seabed[0] - reach - lowest, 'm')} out of the reach of its altimeter",
                at_least(f"vehicles.{craft.name}.depth", float(seabed[0]) - 0.8 * reach, "m"),
            )


def check_bottom_track(scene: Scene) -> Iterator[Finding]:
    """A bottom track that hears no seabed on some of the way."""
    for craft in scene.crafts:
        if not craft.tracks_bottom:
            continue
        key, seabed = scene.key(craft, "sensors.dvl"), seabed_at(scene, craft)
        if "bathymetry" not in craft.plan.laws:
            message = f"{craft.name} measures its velocity over a seabed, and the mission has none"
            yield Finding("error", "bathymetry", message, setting_word("bathymetry", "{type: flat, depth: 20 m}"))
        elif seabed is not None:
            altitude = seabed - wanted_depth(scene, craft)
            reach, nearest = craft.law("dvl").value("range"), craft.law("dvl").value("nearest")
            deaf = ~((altitude >= nearest) & (altitude <= reach))
            if deaf.any():
                farthest = float(np.nan_to_num(altitude).max())
                message = (
                    f"{craft.name} hears the seabed from {show(nearest, 'm')} to {show(reach, 'm')} below it, and on"
                    f" {100.0 * deaf.mean():.0f} % of its way it is not there (up to {show(farthest, 'm')}): then its"
                    " speed comes from the shafts, through the water, and it knows of no current"
                )
                wider = at_least(f"{key}.range", farthest, "m") if farthest > reach else ""
                yield Finding("warning", key, message, wider)


def check_limits(scene: Scene) -> Iterator[Finding]:
    """Limits that the mission itself goes beyond."""
    for craft in scene.crafts:
        limits, depth = craft.vehicle.limits, wanted_depth(scene, craft)
        if limits is None:
            continue
        deepest = float(np.nanmax(depth, initial=start_depth(craft.vehicle)))
        if limits.depth is not None and deepest > limits.depth:
            what = "is held at the limit" if craft.vehicle.phases or craft.vehicle.abort else "goes beyond it"
            yield Finding(
                "warning",
                scene.key(craft, "limits.depth"),
                f"{craft.name} is to go {show(deepest, 'm')} deep; its limit is {show(limits.depth, 'm')}: it {what}",
                at_least(scene.key(craft, "limits.depth"), deepest, "m"),
            )
        if limits.geofence is not None:
            yield from _out_of_fence(scene, craft)


def _out_of_fence(scene: Scene, craft: Craft) -> Iterator[Finding]:
    book, state = craft.plan.orders, craft.plan.state
    north = np.append(craft.stations.north, state.north)
    east = np.append(craft.stations.east, state.east)
    if book.fence:
        corners = np.ravel(book.fence)
        margin = np.array([inside_polygon(corners, len(book.fence), n, e) for n, e in zip(north, east, strict=True)])
    else:
        o = book.orders
        margin = np.array(
            [
                inside_circle(o.fence_radius, n - o.fence_north, e - o.fence_east)
                for n, e in zip(north, east, strict=True)
            ]
        )
    k = int(np.argmin(margin))
    if margin[k] < 0.0:
        where = "starts" if k == len(margin) - 1 else "is to go"
        key = scene.key(craft, "limits.geofence")
        radius = book.orders.fence_radius - float(margin[k])
        yield Finding(
            "error",
            key,
            f"{craft.name} {where} {show(-float(margin[k]), 'm')} outside its geofence, at north {north[k]:.0f} m, east"
            f" {east[k]:.0f} m",
            "" if book.fence else at_least(f"{key}.radius", radius, "m"),
        )


def check_dive(scene: Scene) -> Iterator[Finding]:
    """A dive that no depth sensor ever tells to be over."""
    for craft in scene.crafts:
        phases = craft.vehicle.phases
        if phases and phases.dive and phases.dive.timeout is None and "depth" not in craft.plan.laws:
            yield Finding(
                "error",
                scene.key(craft, "phases.dive"),
                f"{craft.name} has no depth sensor, so it never knows that it is down, and never sets out",
                setting_word(f"vehicles.{craft.name}.sensors.depth", "{}"),
            )
