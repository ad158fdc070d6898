"""The order in which a vehicle thinks.  The engine and the bridges both call `decide`."""

from cardume.compiler import Rows, compiled, load, passing, some, where
from cardume.maths import atan2, clip, hypot
from cardume.onboard.compensation import compensate as choose_heading
from cardume.onboard.coordination import correct_speed
from cardume.onboard.depths import choose_depth
from cardume.onboard.guidance import guide as ask_guidance
from cardume.onboard.mind import (
    Correction,
    Mind,
    get_setup,
    get_whereabouts,
    put_correction,
)
from cardume.onboard.navigation import (
    believed_motion,
    locate,
    navigate,
    observe_current,
    speed_through_water,
)
from cardume.onboard.neighborhood import predict_neighbors
from cardume.onboard.pace import keep_pace
from cardume.onboard.phases import HOLD_GAIN, HOLD_RADIUS, change_phase, wait_or_go
from cardume.onboard.screening import screen, stop_if_lost
from cardume.onboard.sightings import look_around
from cardume.onboard.silence import hold_place, yield_to_silence
from cardume.onboard.telling import Said, report
from cardume.paths.projection import point_at
from cardume.paths.table import LENGTH_OWN
from cardume.signals import (
    NOTHING,
    Course,
    Demand,
    Disagreement,
    Measured,
    Motion,
    Pace,
    PathError,
    Reference,
)


@compiled
def decide(mind: Mind, measured: Measured, heard: Rows, time: float) -> tuple[Reference, Said]:
    """All guidance aboard one vehicle, once a tick.

    Args:
        mind: its laws, setup and memories, changed in place.
        measured: what its sensors say in this tick.
        heard: (sources, message) its inbox.
        time: [s] since the start of the mission.

    Returns:
        What to ask of the autopilot, and what to tell the others.

    Source: paper section 4; (37), (49), (33), (5)-(8), (53)-(55), (3)-(18), (44)-(45), (36).
    """
    measured = passing(screen(mind, measured, time))
    speed = speed_through_water(mind, measured)
    motion = passing(believed_motion(mind, measured, speed))
    position = navigate(mind, measured, heard, motion, time)
    current = observe_current(mind, position, motion)
    error = passing(keep_pace(mind, locate(mind, position, motion, current), time))
    look_around(mind, measured, position, motion, error, time)
    others = predict_neighbors(mind, heard, error, time)
    change_phase(mind, measured, heard, error, time)
    along = yield_to_silence(mind, progress(mind, error, coordinate(mind, others)), error, time)
    demand = guide(mind, error, motion, along)
    demand, along = hold_place(mind, *wait_or_go(mind, demand, along, error), error)
    depth = choose_depth(mind, measured, error, time)
    reference = stop_if_lost(mind, compensate(mind, demand, along, depth, motion))
    return reference, report(mind, heard, time)


@compiled
def coordinate(mind: Mind, others: Disagreement) -> float:
    """Correction of the formation's speed [m/s]: (44), (45)."""
    correction = correct_speed(mind.book, mind.me, others)
    put_correction(mind.own, 0, Correction(correction))
    return correction


@compiled
def guide(mind: Mind, error: PathError, motion: Motion, along: float) -> Demand:
    """What the guidance law asks for; past the end, if the vehicle stays, the bearing of the end point.

    Args:
        mind: of the vehicle.
        error: where it is on its path.
        motion: how it believes it moves.
        along: [m/s] how fast it is to go along its path.
    """
    demand = ask_guidance(mind.book, 0, error, motion, Pace(along))
    stays = _stays(mind, error)
    if some(stays):
        _, bearing = _to_the_end(mind, error)
        demand = where(stays, Demand(bearing, NOTHING, NOTHING, NOTHING), demand)
    return demand


@compiled
def progress(mind: Mind, error: PathError, correction: float) -> float:
    """Desired speed along the path [m/s], h (v_L + correction), never astern; past the end, back to it.

    Args:
        mind: of the vehicle.
        error: where it is on its path.
        correction: [m/s] of coordination.
    """
    along = clip(error.stretch * (error.speed_profile + correction), 0.0, 1e9)
    stays = _stays(mind, error)
    if some(stays):
        distance, _ = _to_the_end(mind, error)
        homing = where(distance > HOLD_RADIUS, clip(HOLD_GAIN * distance, 0.0, error.speed_profile), 0.0)
        along = where(stays, homing, along)
    return along


@compiled
def compensate(mind: Mind, demand: Demand, along: float, depth: float, motion: Motion) -> Reference:
    """Heading and speed that give the course and the speed in this current, (36) corrected, and the depth.

    A heading, a yaw rate or a speed that guidance asked for itself stays as it is. Where it asked for
    nothing the course is not a number, which ends the mission.

    Args:
        mind: of the vehicle.
        demand: of guidance.
        along: [m/s] wanted along the path.
        depth: [m] to keep.
        motion: how it believes it moves.
    """
    setup = get_setup(mind.own, 0)
    turns = demand.yaw_rate == demand.yaw_rate
    course = given(demand.course, where(turns, motion.heading, demand.heading))
    steering = choose_heading(mind.book, 0, Course(course, along, setup.over_ground), motion)
    heading = where(turns, motion.heading, given(demand.heading, steering.heading))
    return Reference(course, heading, given(demand.speed, steering.speed), depth, demand.yaw_rate)


@compiled
def given(value: float, otherwise: float) -> float:
    """A number if it is one, else another.

    Args:
        value: [any] NaN where nothing is asked for.
        otherwise: [any] what stands in then.
    """
    return where(value == value, value, otherwise)


@compiled
def _stays(mind: Mind, error: PathError) -> bool:
    return (error.finished > 0.5) & (get_setup(mind.own, 0).stays > 0.5)


@compiled
def _to_the_end(mind: Mind, error: PathError) -> tuple[float, float]:
    """Distance [m] and bearing [rad] of the end of the path."""
    end = point_at(error.path, load(error.path, LENGTH_OWN))
    believed = get_whereabouts(mind.own, 0)
    north, east = end.north - believed.north, end.east - believed.east
    return hypot(north, east), atan2(east, north)
