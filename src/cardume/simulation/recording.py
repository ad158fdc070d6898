"""The log: one record of the fleet per log period, and every message."""

from typing import NamedTuple

from cardume.compiler import Layout, at, compiled, load, scatter, store, where
from cardume.maths import atan2, hypot, to_ned
from cardume.onboard.mind import (
    HAS_PHASES,
    OTHERS_WIDTH,
    get_along,
    get_correction,
    get_current,
    get_outlook,
    get_progress,
    get_setup,
    get_whereabouts,
)
from cardume.onboard.phases import GO, HOLD, SURFACE
from cardume.signals import NOTHING
from cardume.simulation.fleet import Fleet, features_of, get_on_path, get_reference, get_vessel, get_water
from cardume.simulation.sensing import seabed_below


class Truth(NamedTuple):
    """What is true of a vehicle, as it is logged."""

    north: float  # [m]
    east: float  # [m]
    depth: float  # [m]
    heading: float  # [rad]
    surge: float  # [m/s]
    sway: float  # [m/s]
    yaw_rate: float  # [rad/s]
    course: float  # [rad]
    speed: float  # [m/s]
    current_north: float  # [m/s]
    current_east: float  # [m/s]
    cross_track: float  # [m]
    along_track: float  # [m]
    path_course: float  # [rad]
    curvature: float  # [1/m]
    coordination_state: float  # [m]
    shaft_speed: float  # [rad/s]
    thrust: float  # [N]
    yaw_moment: float  # [N m]
    altitude: float  # [m]


class Thought(NamedTuple):
    """What it believes and wants, as it is logged."""

    north_estimate: float  # [m]
    east_estimate: float  # [m]
    current_north_estimate: float  # [m/s]
    current_east_estimate: float  # [m/s]
    cross_track_estimate: float  # [m]
    coordination_state_estimate: float  # [m]
    course_desired: float  # [rad]
    heading_desired: float  # [rad]
    speed_desired: float  # [m/s]
    speed_correction: float  # [m/s]
    depth_desired: float  # [m]
    phase: float  # [-]
    north_variance: float  # [m^2] NaN: its position law does not say
    north_east_covariance: float  # [m^2]
    east_variance: float  # [m^2]


class MessageRow(NamedTuple):
    """One message to one receiver."""

    time_sent: float  # [s]
    time_received: float  # [s] NaN: lost
    sender: float  # [-] place in the fleet
    receiver: float  # [-]
    lost: float  # [-]
    time_of_validity: float  # [s]


LOG, MESSAGE_LOG = Layout(Truth, Thought), Layout(MessageRow)
CHANNELS = (*Truth._fields, *Thought._fields)
put_truth, put_thought, put_message = LOG.writer(Truth), LOG.writer(Thought), MESSAGE_LOG.writer(MessageRow)
RECEIVED, LOST = MESSAGE_LOG.column(MessageRow, "time_received"), MESSAGE_LOG.column(MessageRow, "lost")
MESSAGE_WIDTH = 1.0 * MESSAGE_LOG.width
RECORDS, MESSAGES, RECORD_ROOM, MESSAGE_ROOM, TICKS_PER_RECORD, NUM_COUNTS = range(6)  # columns of Fleet.counts


@compiled
def record(fleet: Fleet, now: int) -> None:
    """Write a record of the fleet when one is due and there is room for it."""
    index = load(fleet.counts, RECORDS)
    if now % load(fleet.counts, TICKS_PER_RECORD) == 0 and index < load(fleet.counts, RECORD_ROOM):
        store(fleet.counts, RECORDS, index + 1)
        for vehicle in range(fleet.size):
            write_truth(fleet, index * fleet.size + vehicle, vehicle)
            write_thought(fleet, index * fleet.size + vehicle, vehicle)
            write_predictions(fleet, index * fleet.size + vehicle, vehicle)


@compiled
def write_truth(fleet: Fleet, row: int, vehicle: int) -> None:
    """Log what is true of a vehicle."""
    vessel, water = get_vessel(fleet.vehicles, vehicle), get_water(fleet.vehicles, vehicle)
    on_path = get_on_path(fleet.vehicles, vehicle)
    north, east = to_ned(vessel.heading, vessel.surge, vessel.sway)
    truth = Truth(
        vessel.north,
        vessel.east,
        vessel.depth,
        vessel.heading,
        vessel.surge,
        vessel.sway,
        vessel.yaw_rate,
        atan2(east + water.east, north + water.north),
        hypot(north + water.north, east + water.east),
        water.north,
        water.east,
        on_path.cross_track,
        on_path.along_track,
        on_path.path_course,
        on_path.curvature,
        on_path.coordination_state,
        vessel.shaft_speed,
        vessel.thrust,
        vessel.yaw_moment,
        seabed_below(fleet, vehicle, vessel).depth - vessel.depth,
    )
    put_truth(fleet.log, row, truth)


@compiled
def write_thought(fleet: Fleet, row: int, vehicle: int) -> None:
    """Log what a vehicle believes and wants."""
    place, current = get_whereabouts(fleet.minds, vehicle), get_current(fleet.minds, vehicle)
    along = get_along(fleet.minds, vehicle)
    reference = get_reference(fleet.vehicles, vehicle)
    thought = Thought(
        place.north,
        place.east,
        current.north,
        current.east,
        along.cross_track,
        along.coordination_state,
        reference.course,
        reference.heading,
        reference.speed,
        get_correction(fleet.minds, vehicle).speed,
        reference.depth,
        phase_of(fleet, vehicle),
        place.north_variance,
        place.covariance,
        place.east_variance,
    )
    put_thought(fleet.log, row, thought)


@compiled
def phase_of(fleet: Fleet, vehicle: int) -> float:
    """The phase of a vehicle's mission [-]; of one that only follows its path, by what it does at its end."""
    if load(features_of(fleet, vehicle), HAS_PHASES) > 0:
        return get_progress(fleet.minds, vehicle).phase
    setup = get_setup(fleet.minds, vehicle)
    at_end = where(setup.surfaces > 0.5, SURFACE, where(setup.stays > 0.5, HOLD, GO))
    return where(get_along(fleet.minds, vehicle).finished > 0.5, at_end, GO + 0.0 * at_end)


@compiled
def write_predictions(fleet: Fleet, row: int, vehicle: int) -> None:
    """Log where a vehicle takes the others to be along the formation."""
    others = at(fleet.others, vehicle * fleet.size * OTHERS_WIDTH)
    for other in range(fleet.size):
        store(fleet.predictions, row * fleet.size + other, get_outlook(others, other).state)


@compiled
def next_row(fleet: Fleet) -> float:
    """The row of the next message in the log [-]; -1 where there is no room."""
    index = load(fleet.counts, MESSAGES)
    return 1.0 * index if index < load(fleet.counts, MESSAGE_ROOM) else -1.0


@compiled
def note_lost(fleet: Fleet, row: float, lost: bool) -> None:
    """Correct the log where a message that was on its way is lost all the same.

    Args:
        fleet: the mission.
        row: [-] of the log; below 0: none.
        lost: [-] whether it is, in each lane.
    """
    is_there = lost & (row > -0.5)
    first = where(is_there, row, 0.0) * MESSAGE_WIDTH
    scatter(fleet.messages, first + RECEIVED, is_there, NOTHING)
    scatter(fleet.messages, first + LOST, is_there, 1.0)


@compiled
def write_message(
    fleet: Fleet, sent: float, received: float, sender: int, receiver: int, lost: float, validity: float
) -> None:
    """Log what became of a message on its way to one receiver, while there is room.

    Args:
        fleet: the mission.
        sent: [s]
        received: [s] NaN when it was lost.
        sender: place in the fleet.
        receiver: place in the fleet.
        lost: [-] 1 when it was lost.
        validity: [s] of what it says.
    """
    index = load(fleet.counts, MESSAGES)
    if index < load(fleet.counts, MESSAGE_ROOM):
        store(fleet.counts, MESSAGES, index + 1)
        put_message(fleet.messages, index, MessageRow(sent, received, sender, receiver, lost, validity))
