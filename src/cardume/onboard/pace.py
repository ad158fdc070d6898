"""The speed v_L of the formation where it is no constant: over time by the clock, along the path where it is."""

from cardume.compiler import compiled, load, where
from cardume.maths import interpolate
from cardume.onboard.mind import (
    OVER_PATH,
    OVER_TIME,
    PACE_OVER,
    PACE_POINTS,
    VARIES_ALONG,
    Mind,
    Outlook,
    pace_points,
    path_of,
)
from cardume.paths.projection import formation_speed
from cardume.paths.table import REFERENCE_START, segment_at
from cardume.signals import PathError


@compiled
def keep_pace(mind: Mind, error: PathError, time: float) -> PathError:
    """The path error with the v_L of here and now, where the mission gives a profile of it.

    Along the path it is read at the formation's point, path_parameter, so that vehicles side by side agree.

    Args:
        mind: of the vehicle.
        error: with the v_L of the path's table.
        time: [s] since the start of the mission, which all vehicles know alike.
    """
    speed = error.speed_profile
    if load(mind.features, PACE_OVER) > 0:
        is_along = load(mind.features, PACE_OVER) == OVER_PATH
        x = error.path_parameter if is_along else time + 0.0 * speed
        speed = interpolate(pace_points(mind), load(mind.features, PACE_POINTS), x)
    return PathError(
        error.path_course,
        error.curvature,
        error.cross_track,
        error.along_track,
        error.path_parameter,
        error.stretch,
        speed,
        error.arc_length,
        error.finished,
        error.speed,
        error.path_speed,
        error.path,
    )


@compiled
def pace_gained(mind: Mind, since: float, time: float) -> float:
    """By how much [m/s] another vehicle has gone faster on the mean than when it said how fast it goes.

    Args:
        mind: whose view it is.
        since: [s] when it said so.
        time: [s] now.
    """
    gained = 0.0 * since
    if load(mind.features, PACE_OVER) == OVER_TIME:
        points, count = pace_points(mind), load(mind.features, PACE_POINTS)
        gained = 0.5 * (interpolate(points, count, time + gained) - interpolate(points, count, since))
    return gained


@compiled
def pace_of_neighbor(mind: Mind, outlook: Outlook, error: PathError, time: float) -> float:
    """v_L [m/s] that another vehicle went by since the last tick: of when that was, and of where it was.

    Args:
        mind: whose view it is.
        outlook: what the other was thought to do, predicted for the last tick.
        error: with its own v_L.
        time: [s] since the start of the mission.
    """
    speed = error.speed_profile
    if load(mind.features, PACE_OVER) == OVER_TIME:
        before = time - mind.book.dt + 0.0 * speed
        speed = interpolate(pace_points(mind), load(mind.features, PACE_POINTS), before)
    if load(mind.features, VARIES_ALONG) > 0:
        path = path_of(mind, mind.me)
        state = where(outlook.state == outlook.state, outlook.state, error.path_parameter)
        if load(mind.features, PACE_OVER) == OVER_PATH:
            speed = interpolate(pace_points(mind), load(mind.features, PACE_POINTS), state)
        else:
            speed = formation_speed(path, segment_at(path, state, REFERENCE_START), state)
    return speed
