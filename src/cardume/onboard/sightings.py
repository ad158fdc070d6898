"""What a vehicle with a USBL head sees of the others: where they are, how sure that is, and how far on their paths."""

from cardume.compiler import at, compiled, load, negate, some, where
from cardume.maths import to_cartesian, to_ned_3d
from cardume.maths.blocks import Spread
from cardume.onboard.mind import (
    LastSeen,
    Mind,
    News,
    get_datasheet,
    get_last_seen,
    get_news,
    get_seen_place,
    get_setup,
    path_of,
    put_last_seen,
    put_seen_place,
)
from cardume.onboard.neighborhood import forget_news, learn
from cardume.onboard.screening import is_believable
from cardume.paths.projection import project
from cardume.paths.table import PathPlace, place_near
from cardume.signals import NOTHING, Measured, Motion, NavigationEstimate, PathError, Place

USBL_WIDTH = 4  # range, azimuth, elevation, age
UNSEEN = 5.0  # [m] of way after which another vehicle may have rounded a bend


@compiled
def look_around(
    mind: Mind, measured: Measured, position: NavigationEstimate, motion: Motion, error: PathError, time: float
) -> None:
    """Begin the tick without news of the others; with a USBL head, turn each new reading into news.

    p_j = p_1 - V_1 age + R_1 r, R_1 the measured attitude, turned back by the yaw rate times the age;
    gamma_j is the projection of p_j on j's own path.
    """
    forget_news(mind)
    shares = some(get_setup(mind.own, 0).shares_sightings > 0.5)
    for vehicle in range(mind.size if shares else 0):
        reading = at(measured.usbl, vehicle * USBL_WIDTH)
        age = load(reading, 3)
        is_new = age == age
        if some(is_new):
            is_new = is_believable(mind, vehicle, is_new, load(reading, 0), load(reading, 1))
            ahead, starboard, down = to_cartesian(load(reading, 0), load(reading, 1), load(reading, 2))
            north, east, down = to_ned_3d(
                measured.roll, measured.pitch, measured.heading - measured.yaw_rate * age, ahead, starboard, down
            )
            spread = spread_of_sighting(mind, position, north, east, down)
            north = north + position.north - age * (motion.north + motion.current_north)
            east = east + position.east - age * (motion.east + motion.current_east)
            nothing = NOTHING * age
            seen = LastSeen(north, east, time - age, spread.nn, spread.ne, spread.ee, nothing, nothing, nothing)
            has_bearing = is_new & (load(reading, 1) == load(reading, 1))
            sight(mind, vehicle, has_bearing, seen, error)
            is_range = is_new & negate(has_bearing)
            if some(is_range):
                ranged = range_from(mind, measured, position, motion, load(reading, 0), age, time)
                put_last_seen(mind.others, vehicle, where(is_range, ranged, get_last_seen(mind.others, vehicle)))


@compiled
def range_from(
    mind: Mind,
    measured: Measured,
    position: NavigationEstimate,
    motion: Motion,
    distance: float,
    age: float,
    time: float,
) -> LastSeen:
    """What is left of a reading without a bearing: from where how far away a vehicle was.

    How the own position and how the range errs are told apart: who knows its depth makes the range level first.

    Args:
        mind: of the one who measured.
        measured: its depth.
        position: its own.
        motion: its own.
        distance: [m] slant range.
        age: [s] of the reading.
        time: [s]
    """
    told = get_datasheet(mind.own, 0)
    own, known = told.gnss * told.gnss, position.north_variance == position.north_variance
    return LastSeen(
        position.north - age * (motion.north + motion.current_north),
        position.east - age * (motion.east + motion.current_east),
        time - age,
        where(known, position.north_variance, own),
        where(known, position.covariance, 0.0),
        where(known, position.east_variance, own),
        distance,
        told.range * told.range,
        measured.depth,
    )


@compiled
def spread_of_sighting(mind: Mind, position: NavigationEstimate, north: float, east: float, down: float) -> Spread:
    """Covariance of where a vehicle is seen: long across the line of sight, where angles and heading go wrong.

    R = P_1 + a l l^T + b (1 - l l^T),   l = (north, east) / h,   h = hypot(north, east),   r = hypot(h, down)
    a = (sigma_r h / r)^2 + (sigma_a down)^2 + t,   b = (sigma_a h)^2 + (sigma_psi h)^2 + t,   t = (sigma_t down)^2

    P_1 is the covariance of the own position, of a vehicle that does not know it that of its GNSS; sigma_r and sigma_a
    are those of the USBL, sigma_psi and sigma_t those of heading and of roll and pitch.

    Args:
        mind: of the one who sees.
        position: its own.
        north: [m] of the target from the head, by measured attitude.
        east: [m]
        down: [m]
    """
    told = get_datasheet(mind.own, 0)
    level, below = north * north + east * east, down * down
    angle, tilt = told.angle * told.angle, below * told.attitude * told.attitude
    slant = where(level + below > 0.0, level + below, 1.0)
    along = told.range * told.range * level / slant + angle * below + tilt
    across = level * (angle + told.heading * told.heading) + tilt
    more = (along - across) / where(level > 0.0, level, 1.0)
    own, known = told.gnss * told.gnss, position.north_variance == position.north_variance
    return Spread(
        where(known, position.north_variance, own) + across + more * north * north,
        where(known, position.covariance, 0.0) + more * north * east,
        where(known, position.east_variance, own) + across + more * east * east,
    )


@compiled
def sight(mind: Mind, vehicle: int, is_new: bool, seen: LastSeen, error: PathError) -> None:
    """Note where a vehicle was seen, and how far along its path the point abeam of it is.

    Args:
        mind: of the one who saw.
        vehicle: who was seen.
        is_new: [-] whether it was, in each lane.
        seen: where and when.
        error: where the one who saw is on its own path.
    """
    before = get_news(mind.others, vehicle)
    seen_at = Place(where(is_new, seen.north, 0.0), where(is_new, seen.east, 0.0), path_of(mind, vehicle))
    state, place = place_of(seen_at, get_seen_place(mind.others, vehicle), before, seen.time_of_fix)
    speed = where(before.state == before.state, before.path_speed, error.speed_profile)
    learn(mind, vehicle, is_new, News(state, speed, seen.time_of_fix, before.phase))
    put_last_seen(mind.others, vehicle, where(is_new, seen, get_last_seen(mind.others, vehicle)))
    put_seen_place(mind.others, vehicle, where(is_new, place, get_seen_place(mind.others, vehicle)))


@compiled
def place_of(seen_at: Place, was: PathPlace, before: News, time: float) -> tuple[float, PathPlace]:
    """How far along a vehicle is [m], and where on its path.

    A foot is looked for from where the vehicle was seen last.  Out of sight it may have rounded a bend meanwhile, and
    from the leg before that the search would not find it: then also from where it is expected by now.  The foot that
    is nearer counts.

    Args:
        seen_at: where it is seen, and its path.
        was: where on the path it was seen last.
        before: what was known of it.
        time: [s] of the sighting.
    """
    found, place = project(seen_at, was)
    state = found.path_parameter
    known = before.state == before.state
    expected = where(known, before.state + before.path_speed * (time - before.time_of_validity), state)
    ahead = place_near(seen_at.path, expected, place.segment)
    unseen = ahead.arc_length - was.arc_length
    strayed = known & ((unseen > UNSEEN) | (unseen < -UNSEEN))
    if some(strayed):
        other, elsewhere = project(seen_at, where(strayed, ahead, was))
        nearer = strayed & (abs(other.cross_track) < abs(found.cross_track))
        state, place = where(nearer, other.path_parameter, state), where(nearer, elsewhere, place)
    return state, place
