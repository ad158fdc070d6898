"""Where am I, how fast, and where on my path."""

from cardume.compiler import Rows, compiled, load, negate, some, where
from cardume.maths import clip, sqrt, to_ned, to_path
from cardume.onboard.estimation.current import observe
from cardume.onboard.estimation.position import estimate_position
from cardume.onboard.estimation.speed.base import read_shaft
from cardume.onboard.mind import (
    Along,
    Mind,
    Told,
    Whereabouts,
    get_along,
    get_current,
    get_datasheet,
    get_setup,
    get_told,
    get_whereabouts,
    is_fresh,
    message_from,
    path_of,
    put_along,
    put_current,
    put_speed,
    put_told,
    put_whereabouts,
    sighting_in,
)
from cardume.onboard.screening import surge_or_asked
from cardume.paths.base import find_reference_point
from cardume.signals import (
    NOTHING,
    DvlReading,
    Fix,
    Measured,
    Motion,
    NavigationEstimate,
    PathError,
    Place,
    ShaftReading,
    Sighting,
    Water,
)

SAME = 1e-6  # [s] a fix is newer only beyond rounding
FLATTEST = 1e-4  # [-] least square of the level part of a range over that of the range
NEAREST_CENTER = 0.1  # of 1 - c e: nearer the centre of an arc the path's rate has no meaning


@compiled
def speed_through_water(mind: Mind, measured: Measured) -> DvlReading:
    """Surge and sway [m/s]: from the DVL where there is one, else surge by (37) and no sway; if both fail, as asked."""
    shaft = read_shaft(mind.book, 0, ShaftReading(measured.shaft_speed))
    has_dvl = measured.dvl_surge == measured.dvl_surge
    has_shaft = shaft == shaft
    surge = where(has_dvl, measured.dvl_surge, where(has_shaft, shaft, 0.0))
    surge = surge_or_asked(mind.screens, mind, surge, has_dvl | has_shaft)
    speed = DvlReading(surge, where(has_dvl, measured.dvl_sway, 0.0))
    put_speed(mind.own, 0, speed)
    return speed


@compiled
def believed_motion(mind: Mind, measured: Measured, speed: DvlReading) -> Motion:
    """How the vehicle believes it moves, with the current of the last tick."""
    current = get_current(mind.own, 0)
    north, east = to_ned(measured.heading, speed.surge, speed.sway)
    return Motion(
        measured.heading,
        measured.yaw_rate,
        speed.surge,
        speed.sway,
        north,
        east,
        current.north,
        current.east,
    )


@compiled
def navigate(mind: Mind, measured: Measured, heard: Rows, motion: Motion, time: float) -> NavigationEstimate:
    """The believed position: GNSS where there is a reading, else the newest fix that was heard, else reckoning."""
    return work_in(mind, choose_fix(mind, measured, heard, time), motion, time)


@compiled
def choose_fix(mind: Mind, measured: Measured, heard: Rows, time: float) -> Fix:
    """The fix of this tick: by GNSS where there is a reading, else one that was heard, else none."""
    by_gnss = measured.gnss_north == measured.gnss_north
    if some(get_setup(mind.own, 0).takes_old_fixes > 0.5):
        fix = unused_fix(mind, heard, by_gnss, measured.depth, time)
    else:
        fix = newest_fix(mind, heard, time)
    variance = get_datasheet(mind.own, 0).gnss * get_datasheet(mind.own, 0).gnss
    by_satellite = Fix(
        measured.gnss_north, measured.gnss_east, measured.gnss_age, variance, 0.0 * variance, variance, NOTHING
    )
    return where(by_gnss, by_satellite, fix)


@compiled
def work_in(mind: Mind, fix: Fix, motion: Motion, time: float) -> NavigationEstimate:
    """What the position law makes of this tick's fix and of the way made; it is remembered.

    Args:
        mind: of the vehicle.
        fix: of this tick; NaN: none.
        motion: how the vehicle believes it moves.
        time: [s]
    """
    position = estimate_position(mind.book, 0, fix, motion)
    before = get_whereabouts(mind.own, 0).time_of_fix
    valid = time - fix.age
    after = Whereabouts(
        position.north,
        position.east,
        where((fix.north == fix.north) & ((valid > before) | (before > time + SAME)), valid, before),
        position.north_variance,
        position.covariance,
        position.east_variance,
    )
    put_whereabouts(mind.own, 0, after)
    return position


@compiled
def newest_fix(mind: Mind, heard: Rows, time: float) -> Fix:
    """The newest fix of this vehicle among the messages of this tick, unless an even newer one was used."""
    last = get_whereabouts(mind.own, 0)
    valid = last.time_of_fix
    fix = _no_fix(valid)
    for source in range(load(mind.sources, 0)):
        message = message_from(heard, mind.size, source)
        if some(is_fresh(message)):
            seen = sighting_in(message, mind.me)
            last_known = where(valid > time + SAME, time, valid)  # the own clock was set back
            newer = is_fresh(message) & (seen.time_of_fix > last_known + SAME) & negate(seen.range == seen.range)
            fix = where(newer, _fix_told(seen, 0.0 * valid, time), fix)
            valid = where(newer, seen.time_of_fix, valid)
    return fix


@compiled
def unused_fix(mind: Mind, heard: Rows, by_gnss: bool, depth: float, time: float) -> Fix:
    """A fix of this vehicle, or only a range, that somebody told and that was not used yet; of several one in a tick.

    One that comes and is older than the last is used too: the last may have been of a clock that was wrong, or forged.

    Args:
        mind: of the vehicle.
        heard: (sources, message) its inbox, with what each said last.
        by_gnss: [-] whether a GNSS reading comes first in this tick.
        depth: [m] of this vehicle, as measured.
        time: [s]
    """
    fix = _no_fix(get_whereabouts(mind.own, 0).time_of_fix)
    for source in range(load(mind.sources, 0)):
        sender, message = load(mind.sources, source + 1), message_from(heard, mind.size, source)
        seen = sighting_in(message, mind.me)
        used = get_told(mind.others, sender)
        free = negate(by_gnss | (fix.north == fix.north))
        is_other = (seen.time_of_fix < used.time_of_fix - SAME) | (seen.north != used.north)
        comes = is_fresh(message) & (seen.time_of_fix == seen.time_of_fix)
        is_unused = free & ((seen.time_of_fix > used.time_of_fix + SAME) | (comes & is_other))
        if some(is_unused):
            fix = where(is_unused, _fix_told(seen, depth, time), fix)
            put_told(mind.others, sender, where(is_unused, Told(seen.time_of_fix, seen.north), used))
    return fix


@compiled
def _fix_told(seen: Sighting, depth: float, time: float) -> Fix:
    """A sighting as a fix; of a slant range the level part, at least a hundredth of it, with the variance of that.

    h = sqrt(r^2 - z^2), so dh = (r / h) dr: the steeper a range, the less it tells of the level distance.  No fix is of
    the future.
    """
    age = time - seen.time_of_fix
    below, slant = where(seen.depth == seen.depth, depth - seen.depth, depth), seen.range * seen.range
    rest = slant - where(depth == depth, below * below, 0.0)
    level = where(rest < FLATTEST * slant, FLATTEST * slant, rest)
    of_range = where(seen.range == seen.range, seen.range_variance * slant / level, 0.0)
    return Fix(
        seen.north,
        seen.east,
        where(age < -SAME, 0.0, age),
        seen.north_variance + of_range,
        seen.covariance,
        seen.east_variance + of_range,
        sqrt(level),
    )


@compiled
def _no_fix(like: float) -> Fix:
    nothing = NOTHING * like
    return Fix(nothing, nothing, nothing, nothing, nothing, nothing, nothing)


@compiled
def observe_current(mind: Mind, position: NavigationEstimate, motion: Motion) -> Water:
    """The current that explains why position and velocity through the water disagree."""
    current = observe(mind.book, 0, position, motion)
    put_current(mind.own, 0, current)
    return current


@compiled
def locate(mind: Mind, position: NavigationEstimate, motion: Motion, current: Water) -> PathError:
    """The path as the vehicle sees it, and how fast it comes along: (5)-(8), (25)-(27) and (53) corrected.

    gamma' = (V . t) / ((1 - c e) h), V the velocity over ground, t the path's tangent, h the stretch,
    where the reference point is the one abeam; a virtual target says itself how fast it goes.
    """
    moving = _in_current(motion, current)
    found = find_reference_point(mind.book, 0, Place(position.north, position.east, path_of(mind, mind.me)), moving)
    finished = where(found.finished > 0.5, 1.0, get_along(mind.own, 0).finished)
    error = PathError(
        found.path_course,
        found.curvature,
        found.cross_track,
        found.along_track,
        found.path_parameter,
        found.stretch,
        found.speed_profile,
        found.arc_length,
        finished,
        motion.surge,
        where(found.path_speed == found.path_speed, found.path_speed, rate_along(found, moving)),
        found.path,
    )
    put_along(mind.own, 0, Along(error.cross_track, error.path_parameter, error.path_speed, finished))
    return error


@compiled
def _in_current(motion: Motion, current: Water) -> Motion:
    """The motion with the current as it is known now."""
    return Motion(
        motion.heading,
        motion.yaw_rate,
        motion.surge,
        motion.sway,
        motion.north,
        motion.east,
        current.north,
        current.east,
    )


@compiled
def rate_along(error: PathError, motion: Motion) -> float:
    """Rate of the coordination state [m/s] of the point abeam."""
    along, _ = to_path(error.path_course, motion.north + motion.current_north, motion.east + motion.current_east)
    room = clip(1.0 - error.curvature * error.cross_track, NEAREST_CENTER, 1e9)
    return along / (room * error.stretch)
