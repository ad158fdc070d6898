"""Metrics, summed tick by tick as the mission flies; nothing needs hindsight.

A vehicle's transient is over when |e| has been below the threshold for the hold time; until then
only `settling_time` and `cross_track_iae` count, and after the end of its path nothing about the
path does.
"""

from typing import NamedTuple

from cardume.compiler import Layout, at, compiled, gather, load, negate, scatter, some, where
from cardume.maths import clip, floor, sqrt
from cardume.onboard.mind import get_current, get_progress, get_whereabouts
from cardume.onboard.phases import is_waiting
from cardume.paths.projection import point_of_formation
from cardume.signals import NOTHING, VesselState
from cardume.simulation.fleet import (
    Fleet,
    OnPath,
    get_on_path,
    get_true_place,
    get_vessel,
    get_water,
)
from cardume.simulation.safety import Safety, watch

BINS = 512  # of a histogram; bin k holds e with 512 e / (1 + e) in [k, k + 1)
CROSS_TRACK, FORMATION, HISTOGRAMS = range(3)
FAR = 1e300  # [m^2] beyond any two vehicles
ROUNDING = 1e-6  # [m] more than all rounding of distances


class Rules(NamedTuple):
    """What the metrics count."""

    threshold: float = 0.5  # [m] of |e| for the transient to end
    hold: float = 10.0  # [s] below it
    swath: float = 0.0  # [m] width; 0: no swath coverage


class Score(NamedTuple):
    """Sums of one vehicle."""

    below: float = 0.0  # [s] |e| has been below the threshold
    settled: float = 0.0  # [-] 1 once the transient is over
    settling_time: float = 0.0  # [s]
    line_time: float = 0.0  # [s] counted on lines
    line_squares: float = 0.0  # [m^2 s] of the cross-track error
    arc_time: float = 0.0  # [s]
    arc_squares: float = 0.0  # [m^2 s]
    cross_track_max: float = 0.0  # [m]
    flown: float = 0.0  # [s] counted for beliefs
    position_squares: float = 0.0  # [m^2 s] of the position estimate's error
    current_squares: float = 0.0  # [m^2/s] of the current estimate's error
    first_state: float = 0.0  # [m] coordination state when the transient ended
    progress: float = 0.0  # [m] of the coordination state since then
    energy: float = 0.0  # [J]
    yaw_effort: float = 0.0  # [rad^2/s^3]
    last_yaw_rate: float = 0.0  # [rad/s]
    swept: float = 0.0  # [m] length of path, weighted by how much of its swath was swept
    farthest: float = 0.0  # [m] coordination state so far
    absolute_error: float = 0.0  # [m s] of the cross-track error, from the start


class Formation(NamedTuple):
    """Sums of one vehicle's distance from its place in the formation."""

    time: float = 0.0  # [s] counted
    squares: float = 0.0  # [m^2 s]
    relative_squares: float = 0.0  # [m^2 s] with the fleet's common displacement removed


class Talk(NamedTuple):
    """Messages of one vehicle."""

    sent: float = 0.0  # [-]
    delivered: float = 0.0  # [-] to it
    age_sum: float = 0.0  # [s] of information, when it arrived
    age_max: float = 0.0  # [s]


class Deviation(NamedTuple):
    """Where a vehicle is, less its place in the formation."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]


class Step(NamedTuple):
    """How far a vehicle has come since the tick before."""

    north: float = 0.0  # [m] where it was last
    east: float = 0.0  # [m]
    depth: float = 0.0  # [m]
    squared: float = 0.0  # [m^2]


class FleetScore(NamedTuple):
    """Sums of the fleet."""

    time: float = 0.0  # [s] counted: all transients over, nobody finished
    coordination_squares: float = 0.0  # [m^2 s] of the largest difference of two coordination states
    coordination_max: float = 0.0  # [m]
    separation_squared: float = FAR  # [m^2] smallest distance of two vehicles
    separation_limit: float = 0.0  # [m] that two vehicles are not to come nearer
    too_near: float = NOTHING  # [s] when they first did
    one: float = 0.0  # [-] who did, by place in the engine
    other: float = 0.0  # [-]
    room: float = 0.0  # [m] by which every pair must close before two can be nearer than any were


SCORES = Layout(Score, Formation, Talk, Deviation, Safety, Step)
get_score, put_score = SCORES.reader(Score), SCORES.writer(Score)
get_formation, put_formation = SCORES.reader(Formation), SCORES.writer(Formation)
get_talk, put_talk = SCORES.reader(Talk), SCORES.writer(Talk)
get_deviation, put_deviation = SCORES.reader(Deviation), SCORES.writer(Deviation)
get_step, put_step = SCORES.reader(Step), SCORES.writer(Step)
get_safety, put_safety = SCORES.reader(Safety), SCORES.writer(Safety)
FLEET_SCORES = Layout(FleetScore)
get_fleet_score, put_fleet_score = FLEET_SCORES.reader(FleetScore), FLEET_SCORES.writer(FleetScore)
RULES = Layout(Rules)
get_rules = RULES.reader(Rules)


@compiled
def score(fleet: Fleet, vehicle: int, vessel: VesselState, on_path: OnPath, time: float) -> None:
    """Count one tick of one vehicle."""
    before, rules, dt = get_score(fleet.scores, vehicle), get_rules(fleet.requirements, 0), fleet.tick
    error = abs(on_path.cross_track)
    below = where(error < rules.threshold, before.below + dt, 0.0)
    if fleet.has_phases > 0:
        below = where(is_waiting(get_progress(fleet.minds, vehicle).phase), 0.0, below)
    ends = (before.settled < 0.5) & (below >= rules.hold - 0.5 * dt)
    settled = where(ends, 1.0, before.settled)
    counted = where((settled > 0.5) & (on_path.finished < 0.5), dt, 0.0)
    curved = on_path.curvature != 0.0
    on_arc, on_line = where(curved, counted, 0.0), where(curved, 0.0, counted)
    squared = error * error
    first_state = where(ends, on_path.coordination_state, before.first_state)
    believed, current = believed_errors(fleet, vehicle, vessel)
    state = on_path.coordination_state
    starts_there = (before.flown == 0.0) & (state > 0.0)  # nothing is swept by starting there
    farthest = where(starts_there, state, before.farthest)
    advance = where(state > farthest, state - farthest, 0.0)
    covers = where(rules.swath > 0.0, clip(1.0 - error / where(rules.swath > 0.0, rules.swath, 1.0), 0.0, 1.0), 0.0)
    yaw_acceleration = (vessel.yaw_rate - before.last_yaw_rate) / dt
    after = Score(
        below,
        settled,
        where(ends, clip(time - rules.hold + dt, 0.0, 1e9), before.settling_time),
        before.line_time + on_line,
        before.line_squares + on_line * squared,
        before.arc_time + on_arc,
        before.arc_squares + on_arc * squared,
        where((counted > 0.0) & (error > before.cross_track_max), error, before.cross_track_max),
        before.flown + dt,
        before.position_squares + dt * believed,
        before.current_squares + dt * current,
        first_state,
        where(counted > 0.0, on_path.coordination_state - first_state, before.progress),
        before.energy + dt * vessel.power,
        before.yaw_effort + dt * yaw_acceleration * yaw_acceleration,
        vessel.yaw_rate,
        before.swept + advance * covers,
        where(advance > 0.0, state, farthest),
        before.absolute_error + where(on_path.finished < 0.5, dt * error, 0.0),
    )
    put_score(fleet.scores, vehicle, after)
    put_step(fleet.scores, vehicle, step_to(vessel, get_step(fleet.scores, vehicle)))
    tally(fleet, vehicle, CROSS_TRACK, error, counted > 0.0)
    if fleet.is_watched > 0:
        put_safety(fleet.scores, vehicle, watch(fleet, vehicle, vessel, get_safety(fleet.scores, vehicle), time))


@compiled
def step_to(vessel: VesselState, last: Step) -> Step:
    """The step of this tick.

    Args:
        vessel: where the vehicle is.
        last: where it was.
    """
    north, east, down = vessel.north - last.north, vessel.east - last.east, vessel.depth - last.depth
    return Step(vessel.north, vessel.east, vessel.depth, north * north + east * east + down * down)


@compiled
def believed_errors(fleet: Fleet, vehicle: int, vessel: VesselState) -> tuple[float, float]:
    """Squared errors of the believed position [m^2] and current [m^2/s^2]."""
    place, current = get_whereabouts(fleet.minds, vehicle), get_current(fleet.minds, vehicle)
    water = get_water(fleet.vehicles, vehicle)
    north, east = place.north - vessel.north, place.east - vessel.east
    flow_north, flow_east = current.north - water.north, current.east - water.east
    return north * north + east * east, flow_north * flow_north + flow_east * flow_east


@compiled
def tally(fleet: Fleet, vehicle: int, histogram: int, size: float, counts: bool) -> None:
    """Add one to the bin of an error, finer for small errors.

    Args:
        fleet: the mission.
        vehicle: whose error it is.
        histogram: CROSS_TRACK or FORMATION.
        size: [m] of the error.
        counts: [-] whether it does, in each lane.
    """
    bins = at(fleet.histograms, (vehicle * HISTOGRAMS + histogram) * BINS)
    index = clip(floor(BINS * (size / (1.0 + size))), 0.0, BINS - 1.0)
    index = where(counts & (index == index), index, 0.0)
    scatter(bins, index, counts, gather(bins, index) + 1.0)


@compiled
def note_sent(fleet: Fleet, vehicle: int, sends: bool) -> None:
    """Count a message that a vehicle sent."""
    talk = get_talk(fleet.scores, vehicle)
    put_talk(
        fleet.scores,
        vehicle,
        Talk(talk.sent + where(sends, 1.0, 0.0), talk.delivered, talk.age_sum, talk.age_max),
    )


@compiled
def note_heard(fleet: Fleet, vehicle: int, here: bool, age: float) -> None:
    """Count a message that reached a vehicle, and how old its news was.

    Args:
        fleet: the mission.
        vehicle: the receiver.
        here: [-] whether it arrived, in each lane.
        age: [s] of what it says.
    """
    talk = get_talk(fleet.scores, vehicle)
    after = Talk(talk.sent, talk.delivered + 1.0, talk.age_sum + age, where(age > talk.age_max, age, talk.age_max))
    put_talk(fleet.scores, vehicle, where(here, after, talk))


@compiled
def score_fleet(fleet: Fleet, time: float) -> None:
    """Count one tick of the fleet: coordination, formation and separation."""
    first = get_on_path(fleet.vehicles, 0).coordination_state
    lowest, highest, total = first, first, 0.0 * first
    counts, longest = first == first, 0.0 * first
    for vehicle in range(fleet.size):
        on_path, settled = get_on_path(fleet.vehicles, vehicle), get_score(fleet.scores, vehicle).settled
        step = get_step(fleet.scores, vehicle).squared
        longest = where(step > longest, step, longest)
        state = on_path.coordination_state
        lowest, highest = where(state < lowest, state, lowest), where(state > highest, state, highest)
        total = total + state
        counts = counts & (settled > 0.5) & (on_path.finished < 0.5)
    before = get_fleet_score(fleet.fleet_score, 0)
    spread = highest - lowest
    dt = where(counts, fleet.tick, 0.0)
    nearest, room = nearest_pair(fleet, before.separation_squared, before.room - 2.0 * sqrt(longest))
    after = FleetScore(
        before.time + dt,
        before.coordination_squares + dt * spread * spread,
        where(counts & (spread > before.coordination_max), spread, before.coordination_max),
        nearest,
        before.separation_limit,
        before.too_near,
        before.one,
        before.other,
        room,
    )
    put_fleet_score(fleet.fleet_score, 0, after)
    if fleet.is_watched > 0:
        note_too_near(fleet, time)
    if some(counts) and fleet.size > 1:
        score_formation(fleet, total / fleet.size, counts)


@compiled
def nearest_pair(fleet: Fleet, nearest: float, room: float) -> tuple[float, float]:
    """The smallest squared distance so far between two vehicles [m^2], and the room left until it can fall [m].

    Two vehicles close by no more than the sum of their steps, so while the room is more than rounding no pair is
    looked at: a fleet of N costs N, not N^2, but while two are as near as they ever were.

    Args:
        fleet: the mission.
        nearest: [m^2] until now.
        room: [m] that the last look left, less twice the longest step of each tick since.
    """
    is_due = negate(room > ROUNDING)
    if some(is_due):
        now = nearest_now(fleet)
        nearest = where(now < nearest, now, nearest)
        room = where(is_due, sqrt(now) - sqrt(nearest), room)
    return nearest, room


@compiled
def nearest_now(fleet: Fleet) -> float:
    """The smallest squared distance between two vehicles in this tick [m^2]."""
    nearest = FAR + 0.0 * get_vessel(fleet.vehicles, 0).north
    for one in range(fleet.size):
        here = get_vessel(fleet.vehicles, one)
        for other in range(one):
            there = get_vessel(fleet.vehicles, other)
            north, east, down = there.north - here.north, there.east - here.east, there.depth - here.depth
            apart = north * north + east * east + down * down
            nearest = where(apart < nearest, apart, nearest)
    return nearest


@compiled
def note_too_near(fleet: Fleet, time: float) -> None:
    """Note the first time [s] at which two vehicles came nearer than they are to, and which."""
    for one in range(fleet.size):
        here = get_vessel(fleet.vehicles, one)
        for other in range(one):
            there, kept = get_vessel(fleet.vehicles, other), get_fleet_score(fleet.fleet_score, 0)
            north, east, down = there.north - here.north, there.east - here.east, there.depth - here.depth
            apart = north * north + east * east + down * down
            limit = kept.separation_limit
            now = (apart < limit * limit) & (kept.too_near != kept.too_near)
            after = FleetScore(
                kept.time,
                kept.coordination_squares,
                kept.coordination_max,
                kept.separation_squared,
                limit,
                where(now, time, kept.too_near),
                where(now, one * 1.0, kept.one),
                where(now, other * 1.0, kept.other),
                kept.room,
            )
            put_fleet_score(fleet.fleet_score, 0, after)


@compiled
def score_formation(fleet: Fleet, mean_state: float, counts: bool) -> None:
    """Distance of each vehicle from the point of its own path at the fleet's mean coordination state.

    Args:
        fleet: the mission.
        mean_state: [m] of the fleet.
        counts: [-] whether this tick does, in each lane.
    """
    north, east = 0.0 * mean_state, 0.0 * mean_state
    for vehicle in range(fleet.size):
        path = at(fleet.paths, load(fleet.path_starts, vehicle))
        wanted = point_of_formation(path, mean_state, get_true_place(fleet.vehicles, vehicle).segment)
        vessel = get_vessel(fleet.vehicles, vehicle)
        away = Deviation(vessel.north - wanted.north, vessel.east - wanted.east)
        put_deviation(fleet.scores, vehicle, away)
        north, east = north + away.north, east + away.east
    for vehicle in range(fleet.size):
        count_formation(fleet, vehicle, Deviation(north / fleet.size, east / fleet.size), counts)


@compiled
def count_formation(fleet: Fleet, vehicle: int, common: Deviation, counts: bool) -> None:
    """Add one tick to a vehicle's formation error, with and without the fleet's common displacement."""
    away, before = get_deviation(fleet.scores, vehicle), get_formation(fleet.scores, vehicle)
    north, east = away.north - common.north, away.east - common.east
    squared = away.north * away.north + away.east * away.east
    dt = where(counts, fleet.tick, 0.0)
    after = Formation(
        before.time + dt,
        before.squares + dt * squared,
        before.relative_squares + dt * (north * north + east * east),
    )
    put_formation(fleet.scores, vehicle, after)
    tally(fleet, vehicle, FORMATION, sqrt(squared), counts)
