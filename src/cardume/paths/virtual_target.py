"""The virtual target, or rabbit: a point that runs along the path with the vehicle."""

from typing import Annotated, NamedTuple

from cardume.compiler import Rows, compiled, load, where
from cardume.laws import Bounds, Number, PerSecond, Positive, Seconds
from cardume.maths import clip, exp, sincos
from cardume.paths.base import reference_point_law
from cardume.paths.on_curve import is_curve, reference_along, share_of, turning
from cardume.paths.projection import formation_speed, point_on
from cardume.paths.table import (
    AHEAD,
    ARC_START,
    CURVATURE,
    LENGTH_OWN,
    OFFSET,
    REFERENCE_LENGTH,
    REFERENCE_RATE,
    REFERENCE_START,
    STRETCH,
    PathPlace,
    has_curves,
    segment_near,
    segment_value,
)
from cardume.signals import Motion, PathError, Place

Share = Annotated[Number, Bounds(0.0, 1.0)]


class Bend(NamedTuple):
    """How a vehicle's own path runs at one of its points."""

    gained: float  # [m] gamma since the start of the segment
    curvature: float  # [1/m] > 0 to starboard
    stretch: float  # [-] own length per reference length; 1 round a corner
    rate: float  # [-] reference length per own length; 0 round a corner


@compiled
def bend_at(path: Rows, segment: float, along: float) -> Bend:
    """How the own path runs at a point of a segment; beyond the path's ends a curve goes on straight.

    Args:
        path: (n,) path table.
        segment: [-] its number.
        along: [m] on the own path, from its start.
    """
    rate = segment_value(path, segment, REFERENCE_RATE)
    bend = Bend(along * rate, segment_value(path, segment, CURVATURE), segment_value(path, segment, STRETCH), rate)
    if has_curves(path):
        gained, length = reference_along(path, segment, along), segment_value(path, segment, REFERENCE_LENGTH)
        _, c = turning(path, segment, share_of(path, segment, clip(gained, 0.0, length)))
        c = where((gained < 0.0) | (gained > length), 0.0, c)
        stretch = 1.0 - c * segment_value(path, segment, OFFSET)
        bend = where(is_curve(path, segment), Bend(gained, c / stretch, stretch, 1.0 / stretch), bend)
    return bend


@compiled
def run_along(
    place: Place, motion: Motion, memory: PathPlace, dt: float, target_gain: float, through_water: float
) -> tuple[PathError, PathPlace]:
    """Compare the vehicle with its target, and send that on; see `virtual_target`.

    Args:
        place: position [m] and path table of the vehicle.
        motion: that it believes to have.
        memory: the target's place on the path.
        dt: [s] tick.
        target_gain: [1/s] k2, how fast the target comes back to abeam.
        through_water: [-] 1: by heading and speed through the water; 0: over ground.

    Returns:
        The path error, and the target's next place.
    """
    path, s = place.path, memory.arc_length
    segment = segment_near(path, s, ARC_START, memory.segment)
    along = s - segment_value(path, segment, ARC_START)
    target, bend = point_on(path, segment, s), bend_at(path, segment, along)
    north, east = place.north - target.north, place.east - target.east
    ahead = north * target.cos_course + east * target.sin_course
    over_north, over_east = motion.north + motion.current_north, motion.east + motion.current_east
    over_ground = over_north * target.cos_course + over_east * target.sin_course
    sine, cosine = sincos(motion.heading)
    in_water = motion.surge * (cosine * target.cos_course + sine * target.sin_course)
    carried = over_ground + through_water * (in_water - over_ground)
    path_parameter = segment_value(path, segment, REFERENCE_START) + bend.gained - load(path, AHEAD)
    error = PathError(
        target.course,
        bend.curvature,
        east * target.cos_course - north * target.sin_course,
        ahead,
        path_parameter,
        bend.stretch,
        formation_speed(path, segment, path_parameter),
        s,
        where(s >= load(path, LENGTH_OWN), 1.0, 0.0),
        0.0 * ahead,
        (carried + target_gain * ahead) * bend.rate,
        path,
    )
    after = s + dt * carried + (1.0 - exp(-target_gain * dt)) * ahead
    # A position that is not a number must not be remembered.
    return error, PathPlace(segment, where(after == after, after, s))


@reference_point_law
def virtual_target(
    place: Place,
    motion: Motion,
    memory: PathPlace,
    dt: Seconds,
    target_gain: Positive[PerSecond] = 0.5,
    through_water: Share = 0.0,
) -> tuple[PathError, PathPlace]:
    """Compare the vehicle with a point of its path that runs along with it, and waits for it.

    [s1, e] = R(chi_p)^T (p - p_t),   s' = U cos(chi - chi_p) + k2 s1

    U and chi are speed and course over ground, chi_p the path's course at the target, s the target's arc
    length on the vehicle's own path.  On a line s1 = s1(0) exp(-k2 t).  The target runs back where
    s1 < -U cos(chi - chi_p) / k2.  It never leaves the path, so it needs no nearest point: not at the
    center of an arc, nor where the path crosses itself.  A vehicle whose start is given by north and east
    starts with its target at the start of the path.  Over a tick the pull k2 s1 is followed exactly, 1 - exp(-k2 dt).

    Args:
        place: position [m] and path table of the vehicle.
        motion: velocity that it believes to have, [m/s], and its heading [rad].
        memory: the target's place on the path.
        dt: [s] tick.
        target_gain: [1/s] k2 > 0, how fast the target comes back to abeam.
        through_water: [-] 1: u cos(psi - chi_p) in the place of U cos(chi - chi_p), as (27) was meant without a
            current and without sway; 0: over ground.

    Returns:
        The path error at the target, with `path_speed` = s' / h, and the target's next place.

    Source: paper eqs. (24)-(27), with chi_p where (27) prints chi; course and ground speed instead of
    heading and speed through the water.
    """
    return run_along(place, motion, memory, dt, target_gain, through_water)
