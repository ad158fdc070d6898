"""What a vehicle takes for its place on an arc, as the paper prints it.  For paths that are one arc."""

from typing import NamedTuple

from cardume.compiler import load, where
from cardume.laws import Number, PerSecond, Seconds
from cardume.maths import atan2, sincos
from cardume.paths.base import reference_point_law
from cardume.paths.projection import project
from cardume.paths.table import (
    CENTER_EAST,
    CENTER_NORTH,
    COS_COURSE,
    HEADER_WIDTH,
    RADIUS,
    SIN_COURSE,
    START_EAST,
    START_NORTH,
    PathPlace,
)
from cardume.paths.virtual_target import run_along
from cardume.signals import Motion, PathError, Place


class Odometer(NamedTuple):
    """Where the vehicle was, and how far along it takes itself to be."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    arc_length: float = 0.0  # [m]
    started: float = 0.0  # [-] 0 before the first position


@reference_point_law
def odometer_of_5(place: Place, memory: Odometer, mixed: Number = 1.0) -> tuple[PathError, Odometer]:
    """Count the way along the path by (5), from displacements.

    ds = dp . t / (1 - c e)

    Args:
        place: position and path.
        memory: the last position.
        mixed: [-] 1: e is the rho - R of (19), on which the sign of c does not fit; 0: e is to starboard.

    Returns:
        The path error, gamma counted, and the next memory.

    Source: paper eq. (5), and (5) with the e of (19).
    """
    error, _ = project(place, PathPlace(0.0, memory.arc_length))
    sine, cosine = sincos(error.path_course)
    moved = (place.north - memory.north) * cosine + (place.east - memory.east) * sine
    e_of_19 = where(error.curvature > 0.0, -error.cross_track, error.cross_track)
    e = error.cross_track + mixed * (e_of_19 - error.cross_track)
    counted = memory.arc_length + memory.started * moved / (1.0 - error.curvature * e)
    return _told(error, error.cross_track, counted), Odometer(place.north, place.east, counted, 1.0)


@reference_point_law
def polar_of_51_and_52(
    place: Place, memory: PathPlace, without_radius: Number = 0.0, in_radians: Number = 0.0
) -> tuple[PathError, PathPlace]:
    """The errors of an arc from the bearing and the distance of its center.

    gamma = beta - beta_0  [rad],   e = rho

    Args:
        place: position and path.
        memory: where on the path the vehicle was.
        without_radius: [-] 1: e as (52) prints it, rho; 0: e = sigma (R - rho).
        in_radians: [-] 1: gamma as (51) prints it, an angle between -2 pi and 2 pi; 0: meters, unwrapped.

    Returns:
        The path error and the next memory.

    Source: paper eqs. (51), (52) as printed.
    """
    error, after = project(place, memory)
    path = place.path
    north, east = load(path, HEADER_WIDTH + CENTER_NORTH), load(path, HEADER_WIDTH + CENTER_EAST)
    start_north, start_east = load(path, HEADER_WIDTH + START_NORTH), load(path, HEADER_WIDTH + START_EAST)
    bearing = atan2(place.east - east, place.north - north)
    turned = bearing - atan2(start_east - east, start_north - north)
    rho = load(path, HEADER_WIDTH + RADIUS) - where(error.curvature > 0.0, error.cross_track, -error.cross_track)
    e = error.cross_track + without_radius * (rho - error.cross_track)
    return _told(error, e, error.path_parameter + in_radians * (turned - error.path_parameter)), after


@reference_point_law
def virtual_target_of_27(
    place: Place, motion: Motion, memory: PathPlace, dt: Seconds, target_gain: PerSecond = 0.5
) -> tuple[PathError, PathPlace]:
    """The virtual target by (27) to the letter, where chi is the heading: it never looks at the path's course.

    s' = u cos(psi - psi) + k2 s1 = u + k2 s1

    Args:
        place: position and path, a line.
        motion: of the vehicle.
        memory: the target's place.
        dt: [s] tick.
        target_gain: [1/s] k2.

    Returns:
        The path error and the target's next place.

    Source: paper eq. (27) as printed.
    """
    sine, cosine = load(place.path, HEADER_WIDTH + SIN_COURSE), load(place.path, HEADER_WIDTH + COS_COURSE)
    along = Motion(
        motion.heading, motion.yaw_rate, motion.surge, 0.0, motion.surge * cosine, motion.surge * sine, 0.0, 0.0
    )
    return run_along(place, along, memory, dt, target_gain, 0.0)


def _told(error: PathError, cross_track: float, path_parameter: float) -> PathError:
    return PathError(
        error.path_course,
        error.curvature,
        cross_track,
        error.along_track,
        path_parameter,
        error.stretch,
        error.speed_profile,
        error.arc_length,
        error.finished,
        error.speed,
        error.path_speed,
        error.path,
    )
