"""Phases of a mission aboard one vehicle: down, wait for the others, along the path, wait at its end, up; or give up.

    DIVE -> GATHER -> READY -> ASSEMBLED -> GO -> HOLD -> SURFACE,   and from each of them but SURFACE ABORT

A vehicle is READY when it is at its start.  It is ASSEMBLED when all that it hears have said that they are READY, and
goes when all that it hears have said that they are ASSEMBLED, or one that it is gone: so nobody within two hops
is left behind, and every vehicle uses what it was told and nothing else.
"""

from cardume.compiler import Rows, compiled, load, some, where
from cardume.maths import HALF_PI, atan, atan2, clip, hypot, inside_circle, inside_polygon
from cardume.onboard.mind import (
    FENCE_CORNERS,
    HAS_PHASES,
    Journal,
    Mind,
    Orders,
    Progress,
    fence_corners,
    get_journal,
    get_news,
    get_orders,
    get_progress,
    get_setup,
    get_sounding,
    get_whereabouts,
    head_of,
    is_fresh,
    message_from,
    neighbors_of,
    put_journal,
    put_progress,
)
from cardume.paths.projection import point_at
from cardume.paths.table import LENGTH_OWN
from cardume.signals import NOTHING, Demand, Measured, PathError

DIVE, GATHER, READY, ASSEMBLED, GO, HOLD, SURFACE, ABORT = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0
PHASES = ("dive", "gather", "ready", "assembled", "go", "hold", "surface", "abort")
REASONS = ("", "depth limit", "geofence", "altitude limit", "silence", "time")
TOO_DEEP, OUTSIDE, TOO_LOW, UNHEARD, TOO_LATE = 1.0, 2.0, 3.0, 4.0, 5.0
HALF = 0.5  # between two whole numbers
HOLD_RADIUS = 1.0  # [m] within which a vehicle that holds a place rests
HOLD_GAIN = 0.2  # [1/s] speed per distance when it comes back to it
BEND = 0.5  # [-] of the circle's radius: lookahead with which it is followed


@compiled
def is_waiting(phase: float) -> bool:
    """Whether a vehicle in this phase [-] has not set out yet."""
    return phase < GO - HALF


@compiled
def has_told(phase: float) -> bool:
    """Whether a vehicle has ever said its phase [-]; to be seen by a USBL says nothing of it."""
    return phase > DIVE - HALF


@compiled
def takes_part(phase: float) -> bool:
    """Whether a vehicle in this phase [-] counts for the formation."""
    return phase < ABORT - HALF


@compiled
def change_phase(mind: Mind, measured: Measured, heard: Rows, error: PathError, time: float) -> None:
    """Go on to the next phase when this one is over, and note when.

    Args:
        mind: of the vehicle, changed in place.
        measured: what its sensors say.
        heard: (sources, message) its inbox.
        error: where it is on its path.
        time: [s] since the start of the mission.
    """
    if load(mind.features, HAS_PHASES) > 0:
        before, orders = get_progress(mind.own, 0), get_orders(mind.orders, 0)
        last = last_heard(mind, heard, before.heard, time)
        reason = reason_to_give_up(mind, orders, measured, last, time)
        phase = next_phase(mind, orders, measured, error, before, time)
        gives_up = (reason > HALF) & (before.phase < SURFACE - HALF)
        phase = where(gives_up | (before.phase > ABORT - HALF), ABORT, phase)
        changed = (phase > before.phase + HALF) | (phase < before.phase - HALF)
        since = where(changed, time + 0.0 * phase, before.since)
        north, east = anchor(mind, error, before, phase)
        put_progress(mind.own, 0, Progress(phase, since, last, north, east))
        if some(changed):
            note(mind, orders, before, phase, reason, time)


@compiled
def last_heard(mind: Mind, heard: Rows, before: float, time: float) -> float:
    """When [s] this vehicle last heard anybody say something recent: whoever replays old packets is no company.

    Args:
        mind: of the vehicle.
        heard: (sources, message) its inbox.
        before: [s] when it had.
        time: [s] now.
    """
    for source in range(load(mind.sources, 0)):
        message = message_from(heard, mind.size, source)
        is_recent = time - head_of(message).time_of_validity < get_orders(mind.orders, 0).silence
        before = where(is_fresh(message) & is_recent, time + 0.0 * before, before)
    return before


@compiled
def next_phase(
    mind: Mind, orders: Orders, measured: Measured, error: PathError, before: Progress, time: float
) -> float:
    """The phase that follows, or the same."""
    phase, waited = before.phase, time - before.since
    wanted = get_sounding(mind.own, 0).wanted
    is_down = abs(measured.depth - wanted) < orders.dive_tolerance
    phase = where((phase < DIVE + HALF) & (is_down | (waited > orders.dive_timeout)), GATHER, phase)
    north, east = off_anchor(mind, before)
    is_there = hypot(north, east) < orders.gather_radius + orders.circle_radius
    phase = where((phase > DIVE + HALF) & (phase < GATHER + HALF) & is_there, READY, phase)
    least, is_gone = what_others_say(mind)
    phase = where((phase > GATHER + HALF) & (phase < READY + HALF) & (least > READY - HALF), ASSEMBLED, phase)
    all_know = (phase > READY + HALF) & ((least > ASSEMBLED - HALF) | is_gone)
    left_behind = (phase > GATHER + HALF) & is_gone
    began = get_journal(mind.own, 0).gather
    late = (phase > DIVE + HALF) & (time - began > orders.gather_timeout)
    is_free = (phase > DIVE + HALF) & (orders.gathers < HALF)
    phase = where(is_waiting(phase) & (all_know | left_behind | late | is_free), GO, phase)
    stays = get_setup(mind.own, 0).stays > HALF
    phase = where((phase > GO - HALF) & (phase < GO + HALF) & (error.finished > HALF) & stays, HOLD, phase)
    rises = (get_setup(mind.own, 0).surfaces > HALF) & (waited > orders.hold_time)
    return where((before.phase > HOLD - HALF) & (phase < HOLD + HALF) & rises, SURFACE, phase)


@compiled
def what_others_say(mind: Mind) -> tuple[float, bool]:
    """The least phase [-] that those it coordinates with have said, and whether one of them is gone.

    Whoever has given up is not waited for; whoever was never heard is still on its way down.
    """
    listed, me = neighbors_of(mind, mind.me), get_progress(mind.own, 0).phase
    least, is_gone = ABORT + 0.0 * me, me != me
    for k in range(1, load(listed, 0) + 1):
        said = get_news(mind.others, load(listed, k)).phase
        least = where(said < least, said, least)
        is_gone = is_gone | ((said > GO - HALF) & takes_part(said))
    return least, is_gone


@compiled
def reason_to_give_up(mind: Mind, orders: Orders, measured: Measured, last: float, time: float) -> float:
    """Why this vehicle gives up, a place in REASONS [-]; 0: it does not.

    Args:
        mind: of the vehicle.
        orders: with the limits.
        measured: depth and altitude; what is not measured is no reason.
        last: [s] when it last heard anybody.
        time: [s] now.
    """
    reason = where(time > orders.latest, TOO_LATE, 0.0 * orders.latest)
    reason = where(time - last > orders.silence, UNHEARD, reason)
    reason = where(measured.altitude < orders.altitude_limit, TOO_LOW, reason)
    place = get_whereabouts(mind.own, 0)
    reason = where(inside_fence(mind, orders, place.north, place.east) < 0.0, OUTSIDE, reason)
    reason = where(measured.depth > orders.depth_limit, TOO_DEEP, reason)
    return where(orders.aborts > HALF, reason, 0.0)


@compiled
def inside_fence(mind: Mind, orders: Orders, north: float, east: float) -> float:
    """How far [m] a place is inside the geofence; far where there is none.

    Args:
        mind: of the vehicle.
        orders: with a round geofence.
        north: [m]
        east: [m]
    """
    corners = load(mind.features, FENCE_CORNERS)
    if corners > 0:
        return inside_polygon(fence_corners(mind.orders, mind.features), corners, north, east)
    round_one = inside_circle(orders.fence_radius, north - orders.fence_north, east - orders.fence_east)
    return where(orders.fence_radius > 0.0, round_one, 1.0)


@compiled
def anchor(mind: Mind, error: PathError, before: Progress, phase: float) -> tuple[float, float]:
    """North and east [m] of where it waits: its start; then the end of the path, or where it gave up.

    Args:
        mind: of the vehicle.
        error: holds its path.
        before: with the anchor so far.
        phase: [-] now.
    """
    arrives = (phase > HOLD - HALF) & takes_part(phase) & (before.phase < HOLD - HALF)
    gives_up = (phase > ABORT - HALF) & takes_part(before.phase)
    north, east = before.anchor_north, before.anchor_east
    if some(arrives | gives_up):
        end, here = point_at(error.path, load(error.path, LENGTH_OWN)), get_whereabouts(mind.own, 0)
        north = where(gives_up, here.north, where(arrives, end.north, north))
        east = where(gives_up, here.east, where(arrives, end.east, east))
    return north, east


@compiled
def note(mind: Mind, orders: Orders, before: Progress, phase: float, reason: float, time: float) -> None:
    """Write the phases that were entered into the journal, and why.

    Args:
        mind: of the vehicle, changed in place.
        orders: with the timeouts.
        before: before the change.
        phase: [-] after it.
        reason: [-] to give up.
        time: [s]
    """
    kept, was = get_journal(mind.own, 0), before.phase
    began = where(was < DIVE + HALF, time, kept.gather)
    gives_up = takes_part(was) & (phase > ABORT - HALF)
    dive_late = (was < DIVE + HALF) & takes_part(phase) & (time - before.since > orders.dive_timeout)
    waited = is_waiting(was) & (phase > GO - HALF) & takes_part(phase)
    after = Journal(
        kept.dive,
        entered(kept.gather, was, phase, GATHER, time),
        entered(kept.ready, was, phase, READY, time),
        entered(kept.assembled, was, phase, ASSEMBLED, time),
        entered(kept.go, was, phase, GO, time),
        entered(kept.hold, was, phase, HOLD, time),
        entered(kept.surface, was, phase, SURFACE, time),
        where(gives_up, time, kept.abort),
        where(dive_late, 1.0, kept.dive_late),
        where(waited & (time - began > orders.gather_timeout), 1.0, kept.gather_late),
        where(gives_up, reason, kept.reason),
    )
    put_journal(mind.own, 0, after)


@compiled
def entered(kept: float, was: float, phase: float, which: float, time: float) -> float:
    """When a phase was entered [s].

    Args:
        kept: [s] as the journal has it.
        was: [-] phase before.
        phase: [-] phase after.
        which: [-] the phase that is asked for.
        time: [s] now.
    """
    return where((was < which - HALF) & (phase > which - HALF) & takes_part(phase), time, kept)


@compiled
def off_anchor(mind: Mind, progress: Progress) -> tuple[float, float]:
    """How far [m] north and east the anchor is of where the vehicle believes it is."""
    here = get_whereabouts(mind.own, 0)
    return progress.anchor_north - here.north, progress.anchor_east - here.east


@compiled
def wait_or_go(mind: Mind, demand: Demand, along: float, error: PathError) -> tuple[Demand, float]:
    """What guidance asks for and the speed along the path while it is on it; else those that keep it at its anchor.

    It goes back to the anchor in proportion to the distance and rests near it, or circles it clockwise:
    chi = bearing - pi/2 + atan((rho - R) / d).

    Args:
        mind: of the vehicle.
        demand: of guidance.
        along: [m/s] along the path.
        error: its v_L.
    """
    if load(mind.features, HAS_PHASES) > 0:
        progress, orders = get_progress(mind.own, 0), get_orders(mind.orders, 0)
        waits = (progress.phase < GO - HALF) | (progress.phase > GO + HALF)
        if some(waits):
            north, east = off_anchor(mind, progress)
            distance, bearing = hypot(north, east), atan2(east, north)
            rests = distance <= HOLD_RADIUS
            speed = where(rests, 0.0, clip(HOLD_GAIN * distance, 0.0, error.speed_profile))
            course = where(rests & is_waiting(progress.phase), error.path_course, bearing)
            circles, radius = orders.circle_radius > 0.0, orders.circle_radius
            away = (distance - radius) / where(circles, BEND * radius, 1.0)
            course = where(circles, bearing - HALF_PI + atan(away), course)
            speed = where(circles, error.speed_profile, speed)
            demand = where(waits, Demand(course, NOTHING, NOTHING, NOTHING), demand)
            along = where(waits, speed, along)
    return demand, along
