"""The virtual target (27) on a line, for a vehicle that steers by line of sight in still water."""

from typing import NamedTuple

from cardume.laws import Meters, MetersPerSecond, Number, PerSecond, Positive, Seconds
from cardume.maths import sqrt
from cardume.paths.base import reference_point_law
from cardume.paths.projection import project
from cardume.paths.table import PathPlace
from cardume.signals import PathError, Place


class Rabbit(NamedTuple):
    """Where the target is."""

    arc_length: float = 0.0  # [m]
    started: float = 0.0  # [-] 0 before the first tick


@reference_point_law
def rabbit_of_27(
    place: Place,
    memory: Rabbit,
    dt: Seconds,
    behind: Meters = 0.0,
    target_gain: Positive[PerSecond] = 0.1,
    speed: MetersPerSecond = 0.5,
    reach: Positive[Meters] = 5.0,
    literal: Number = 1.0,
) -> tuple[PathError, Rabbit]:
    """s' = u cos(psi - chi) + k2 s_1, with chi the course, psi itself (1), or chi_p (0), as it must be.

    Args:
        place: position and path, a line.
        memory: arc length of the target.
        dt: [s] tick.
        behind: [m] s_1 at the start.
        target_gain: [1/s] k2.
        speed: [m/s] u.
        reach: [m] d of the line of sight that steers, whose psi - chi_p is -atan(e / d).
        literal: [-] 1 as printed, 0 with chi_p.

    Returns:
        The error; path_parameter is the target's arc length. And the next memory.

    Source: paper eq. (27), printed and corrected.
    """
    error, _ = project(place, PathPlace(0.0, memory.arc_length))
    target = memory.arc_length + (1.0 - memory.started) * (error.arc_length - behind)
    ahead = error.arc_length - target
    cosine = reach / sqrt(reach * reach + error.cross_track * error.cross_track)
    rate = speed * (literal + (1.0 - literal) * cosine) + target_gain * ahead
    told = PathError(
        error.path_course,
        error.curvature,
        error.cross_track,
        ahead,
        target,
        error.stretch,
        error.speed_profile,
        error.arc_length,
        error.finished,
        error.speed,
        error.path_speed,
        error.path,
    )
    return told, Rabbit(target + dt * rate, 1.0)
