"""Play what a vehicle measured and heard through its own navigation, with no world around it."""

from typing import NamedTuple

import numpy as np

from cardume.compiler import Layout, Rows, at, compiled, entry, load, passing, rows_of, store
from cardume.laws import COLUMNS, FAMILIES, MEMORY, WIDTH
from cardume.onboard.estimation.position import estimate_position
from cardume.onboard.mind import Asked, Mind, put_asked
from cardume.onboard.navigation import believed_motion, choose_fix, observe_current, speed_through_water, work_in
from cardume.onboard.screening import screen
from cardume.signals import NOTHING, Fix, Measured, Motion, NavigationEstimate, Water
from cardume.simulation.faults import clock_of
from cardume.simulation.fleet import Fleet, Held, Satellite, Tables, fleet_of, mind_of

POSITION = FAMILIES.index("position") * COLUMNS


class Before(NamedTuple):
    """Where a vehicle would believe it is in this tick without the fix of this tick."""

    north: float = NOTHING  # [m]
    east: float = NOTHING  # [m]
    north_variance: float = NOTHING  # [m^2]
    covariance: float = NOTHING  # [m^2]
    east_variance: float = NOTHING  # [m^2]


READINGS = Layout(Held, Satellite, Asked)
get_held, get_satellite = READINGS.reader(Held), READINGS.reader(Satellite)
get_asked_before = READINGS.reader(Asked)
PLAYED = Layout(NavigationEstimate, Water, Motion, Before, Fix)
PLAYED_WIDTH = PLAYED.width
put_estimate, put_water, put_motion = (PLAYED.writer(record) for record in (NavigationEstimate, Water, Motion))
put_before, put_fix = PLAYED.writer(Before), PLAYED.writer(Fix)


@entry
def navigate_through(
    tables: Tables,
    vehicle: int,
    first: int,
    readings: np.ndarray,
    inboxes: np.ndarray,
    kept: np.ndarray,
    played: np.ndarray,
) -> None:
    """Let one vehicle navigate through a part of a recording, tick by tick, by the functions that `decide` calls.

    Args:
        tables: (n,) arrays of a mission in which the vehicle has the laws that are to be judged; changed in place.
        vehicle: [-] its place in the engine's order.
        first: [ticks] at which the part begins.
        readings: [any] (n,) rows of READINGS: what its sensors say in each tick, NaN for nothing, a fix only when it
            is new; and what it had asked of its autopilot in the tick before.
        inboxes: [any] (n,) its inbox in each tick.
        kept: [any] (n,) room for the memory of the position law.
        played: [any] (n,) rows of PLAYED, filled with what it believes in each tick.
    """
    fleet = passing(fleet_of(tables))
    mind = passing(mind_of(fleet, vehicle))
    inbox_width = fleet.air.widest * fleet.air.messages
    for tick in range(len(played) // PLAYED_WIDTH):
        heard = at(rows_of(inboxes), tick * inbox_width)
        time = clock_of(fleet, vehicle, (first + tick) * fleet.tick)
        put_asked(mind.own, 0, get_asked_before(rows_of(readings), tick))
        measured = _measured(fleet, vehicle, rows_of(readings), tick)
        _step(mind, measured, heard, time, rows_of(kept), rows_of(played), tick)


@compiled
def _step(mind: Mind, measured: Measured, heard: Rows, time: float, kept: Rows, played: Rows, tick: int) -> None:
    measured = screen(mind, measured, time)
    motion = believed_motion(mind, measured, speed_through_water(mind, measured))
    put_motion(played, tick, motion)
    put_before(played, tick, _without_fix(mind, motion, kept))
    fix = choose_fix(mind, measured, heard, time)
    put_fix(played, tick, fix)
    position = work_in(mind, fix, motion, time)
    put_estimate(played, tick, position)
    put_water(played, tick, observe_current(mind, position, motion))


@compiled
def _measured(fleet: Fleet, vehicle: int, readings: Rows, tick: int) -> Measured:
    held, satellite = get_held(readings, tick), get_satellite(readings, tick)
    return Measured(
        held.heading,
        held.yaw_rate,
        held.roll,
        held.pitch,
        held.depth,
        held.shaft_speed,
        held.dvl_surge,
        held.dvl_sway,
        held.altitude,
        satellite.north,
        satellite.east,
        satellite.age,
        at(fleet.usbl, vehicle * fleet.size * 4),
    )


@compiled
def _without_fix(mind: Mind, motion: Motion, kept: Rows) -> Before:
    """Ask the position law what it would say of no fix, and make it forget the question."""
    handles = mind.book.handles
    memory, width = at(mind.book.memory, load(handles, POSITION + MEMORY)), load(handles, POSITION + WIDTH)
    for k in range(width):
        store(kept, k, load(memory, k))
    nothing = NOTHING * motion.north
    none = Fix(nothing, nothing, nothing, nothing, nothing, nothing, nothing)
    said = estimate_position(mind.book, 0, none, motion)
    for k in range(width):
        store(memory, k, load(kept, k))
    return Before(said.north, said.east, said.north_variance, said.covariance, said.east_variance)
