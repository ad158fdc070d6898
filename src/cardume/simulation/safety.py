"""How near each vehicle came to its limits, and when it first went beyond one; by the truth."""

from typing import NamedTuple

from cardume.compiler import compiled, load, where
from cardume.maths import inside_circle, inside_polygon
from cardume.onboard.mind import FENCE_CORNERS, NEVER, fence_corners, get_orders
from cardume.signals import NOTHING, VesselState
from cardume.simulation.fleet import Fleet, features_of, orders_of
from cardume.simulation.sensing import seabed_below

FAR = 1e300  # [m]


class Safety(NamedTuple):
    """Extremes of one vehicle, its limits, and when it was first beyond them."""

    depth_max: float = 0.0  # [m]
    altitude_min: float = FAR  # [m] above the seabed
    fence_margin_min: float = FAR  # [m] inside the geofence
    depth_limit: float = NEVER  # [m]
    altitude_limit: float = -NEVER  # [m]
    fence_limit: float = -NEVER  # [m] of the margin
    too_deep: float = NOTHING  # [s] when first
    too_low: float = NOTHING  # [s]
    outside: float = NOTHING  # [s]


@compiled
def watch(fleet: Fleet, vehicle: int, vessel: VesselState, before: Safety, time: float) -> Safety:
    """Look at one vehicle for one tick.

    Args:
        fleet: the mission.
        vehicle: which.
        vessel: its true state.
        before: what was seen until now.
        time: [s]
    """
    altitude = seabed_below(fleet, vehicle, vessel).depth - vessel.depth
    margin = fence_margin(fleet, vehicle, vessel)
    return Safety(
        where(vessel.depth > before.depth_max, vessel.depth, before.depth_max),
        where(altitude < before.altitude_min, altitude, before.altitude_min),
        where(margin < before.fence_margin_min, margin, before.fence_margin_min),
        before.depth_limit,
        before.altitude_limit,
        before.fence_limit,
        first(before.too_deep, vessel.depth > before.depth_limit, time),
        first(before.too_low, altitude < before.altitude_limit, time),
        first(before.outside, margin < before.fence_limit, time),
    )


@compiled
def first(when: float, happens: bool, time: float) -> float:
    """The first time [s] at which something happens.

    Args:
        when: [s] it did, NaN: not yet.
        happens: [-] whether it does now.
        time: [s] now.
    """
    return where(happens & (when != when), time, when)


@compiled
def fence_margin(fleet: Fleet, vehicle: int, vessel: VesselState) -> float:
    """How far a vehicle is inside its geofence [m], < 0 outside; far where it has none."""
    orders, features = orders_of(fleet, vehicle), features_of(fleet, vehicle)
    told, corners = get_orders(orders, 0), load(features, FENCE_CORNERS)
    if corners > 0:
        return inside_polygon(fence_corners(orders, features), corners, vessel.north, vessel.east)
    margin = inside_circle(told.fence_radius, vessel.north - told.fence_north, vessel.east - told.fence_east)
    return where(told.fence_radius > 0.0, margin, FAR)
