"""The mind of one vehicle: its laws, what it was told before the mission, and what it remembers."""

from typing import Any, NamedTuple

from cardume.compiler import Layout, Rows, at, compiled, load
from cardume.laws import LawBook
from cardume.paths.table import PathPlace
from cardume.signals import NOTHING, DvlReading, Report, Sighting, Water

LONG_AGO = -1e9  # [s] before any mission
NEVER = 1e9  # [s] after any mission; [m] beyond any depth
UNTOLD = -1.0  # [-] phase of one that has not said it: below them all

# The whole numbers of `Mind.features`: what of phases.py, pace.py, depths.py, neighborhood.py and silence.py a
# vehicle's mission asks for.
(
    ORDERS_START,
    PACE_OVER,
    PACE_POINTS,
    VARIES_ALONG,
    DEPTH_OVER,
    DEPTH_POINTS,
    KEEPS_ALTITUDE,
    HAS_PHASES,
    FENCE_CORNERS,
    ANSWERS,
    FORESEES,
    ROUNDS,
    YIELDS,
    NUM_FEATURES,
) = range(14)
OVER_TIME, OVER_PATH = 1, 2  # values of PACE_OVER and DEPTH_OVER; 0: no profile


class Setup(NamedTuple):
    """What a vehicle is told before the mission."""

    depth: float = 0.0  # [m] to keep
    over_ground: float = 1.0  # [-] 1: path speed is over ground, 0: through the water
    stays: float = 1.0  # [-] 1: hold the end point, 0: go on along the extended path
    surfaces: float = 0.0  # [-] 1: come up at the end
    shares_sightings: float = 0.0  # [-] 1: carries a USBL head and tells the others where they are
    takes_old_fixes: float = 0.0  # [-] 1: its position law wants also those that were valid before the last one


class Datasheet(NamedTuple):
    """What a vehicle is told of the errors of its sensors, standard deviations; NaN: nothing."""

    gnss: float = NOTHING  # [m] per axis
    range: float = NOTHING  # [m] by USBL
    angle: float = NOTHING  # [rad] azimuth and elevation by USBL
    heading: float = NOTHING  # [rad]
    attitude: float = NOTHING  # [rad] roll and pitch
    depth: float = NOTHING  # [m]
    altitude: float = NOTHING  # [m]
    velocity: float = NOTHING  # [m/s] by DVL
    shaft_speed: float = NOTHING  # [-] of the speed
    patience: float = 5.0  # [s] for which the reading of a sensor that works may stay the same


class Grid(NamedTuple):
    """What is left of numbers that are sent in few bits: low + k step, k a whole number from 0 to `last`."""

    time_step: float = 0.0  # [s] of a message's time
    age_step: float = 0.0  # [s] of a sighting's age, from 0
    age_last: float = 0.0  # [-]
    position_low: float = 0.0  # [m]
    position_step: float = 0.0  # [m]
    position_last: float = 0.0  # [-]
    state_low: float = 0.0  # [m]
    state_step: float = 0.0  # [m]
    state_last: float = 0.0  # [-]
    path_speed_low: float = 0.0  # [m/s]
    path_speed_step: float = 0.0  # [m/s]
    path_speed_last: float = 0.0  # [-]


class Orders(NamedTuple):
    """What a vehicle is told beside its `Setup` where its mission is more than a path."""

    altitude: float = 0.0  # [m] above the seabed to keep
    dives: float = 0.0  # [-] 1: goes down before it sets out
    dive_tolerance: float = 0.5  # [m] of the depth it is to reach
    dive_timeout: float = NEVER  # [s]
    gathers: float = 0.0  # [-] 1: waits for those it hears before it sets out
    gather_radius: float = 2.0  # [m] of its start within which it is there
    gather_timeout: float = NEVER  # [s]
    hold_time: float = NEVER  # [s] at the end of the path before it comes up
    circle_radius: float = 0.0  # [m] on which it waits; 0: it holds its place
    aborts: float = 0.0  # [-] 1: gives up where one of the following is so
    abort_surfaces: float = 1.0  # [-] 1: comes up when it gives up, 0: stays down
    silence: float = NEVER  # [s] since it heard anybody
    latest: float = NEVER  # [s] since the start of the mission
    depth_limit: float = NEVER  # [m]
    altitude_limit: float = -NEVER  # [m]
    fence_radius: float = 0.0  # [m] of a round geofence; 0: none, or a polygon
    fence_north: float = 0.0  # [m] its center
    fence_east: float = 0.0  # [m]
    silent_after: float = NEVER  # [s] without news of a neighbor
    silent_share: float = 1.0  # [-] of the speed along the path while one is silent; 0: it holds its place


class Progress(NamedTuple):
    """Where in its mission a vehicle is, see phases.py."""

    phase: float = 4.0  # [-]
    since: float = 0.0  # [s] when it entered that phase
    heard: float = 0.0  # [s] when it last heard anybody
    anchor_north: float = 0.0  # [m] where it waits
    anchor_east: float = 0.0  # [m]


class Journal(NamedTuple):
    """When a vehicle entered each phase [s], NaN: not yet; and why."""

    dive: float = NOTHING  # [s]
    gather: float = NOTHING  # [s]
    ready: float = NOTHING  # [s]
    assembled: float = NOTHING  # [s]
    go: float = NOTHING  # [s]
    hold: float = NOTHING  # [s]
    surface: float = NOTHING  # [s]
    abort: float = NOTHING  # [s]
    dive_late: float = 0.0  # [-] 1: the dive ended by its timeout
    gather_late: float = 0.0  # [-] 1: waiting for the others ended by its timeout
    reason: float = 0.0  # [-] why it gave up


class Sounding(NamedTuple):
    """What a vehicle remembers of depth."""

    seabed: float = NOTHING  # [m] depth of the seabed below it, filtered
    wanted: float = NOTHING  # [m] depth that it is to keep, unless it comes up


class Whereabouts(NamedTuple):
    """Where a vehicle believes it is."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    time_of_fix: float = LONG_AGO  # [s] validity of the newest fix used
    north_variance: float = NOTHING  # [m^2] NaN: its position law does not say
    covariance: float = NOTHING  # [m^2] of north with east
    east_variance: float = NOTHING  # [m^2]


class Along(NamedTuple):
    """Where it believes it is on its path."""

    cross_track: float = 0.0  # [m]
    coordination_state: float = 0.0  # [m]
    path_speed: float = 0.0  # [m/s] rate of the coordination state
    finished: float = 0.0  # [-] 1 once past the end


class Speech(NamedTuple):
    """What it said last."""

    last_sent: float = LONG_AGO  # [s]
    sequence: float = 0.0  # [-] messages sent


class Correction(NamedTuple):
    """What coordination adds to the formation's speed."""

    speed: float = 0.0  # [m/s]


class News(NamedTuple):
    """What was last learnt of how far along the formation another vehicle is."""

    state: float = NOTHING  # [m] its coordination state
    path_speed: float = 0.0  # [m/s] and the rate of that; NaN: not told, v_L stands in
    time_of_validity: float = LONG_AGO  # [s]
    phase: float = UNTOLD  # [-] the latest of its mission that it said


class Fresh(NamedTuple):
    """Whether there are news of another vehicle."""

    is_new: float = 0.0  # [-] 1 when they came in this tick


class Outlook(NamedTuple):
    """What another vehicle is thought to do meanwhile."""

    state: float = NOTHING  # [m] its coordination state now
    correction: float = 0.0  # [m/s] what coordination makes it do


class LastSeen(NamedTuple):
    """Where another vehicle was seen, or from where how far away."""

    north: float = NOTHING  # [m] of the vehicle; where `range` is a number, of the one who saw it
    east: float = NOTHING  # [m]
    time_of_fix: float = NOTHING  # [s] when
    north_variance: float = NOTHING  # [m^2] of north and east
    covariance: float = NOTHING  # [m^2] of north with east
    east_variance: float = NOTHING  # [m^2]
    range: float = NOTHING  # [m] slant; NaN: north and east are the vehicle's
    range_variance: float = NOTHING  # [m^2]
    depth: float = NOTHING  # [m] of the one who saw it


class Told(NamedTuple):
    """Which fix that another vehicle told was used last."""

    time_of_fix: float = LONG_AGO  # [s]
    north: float = NOTHING  # [m]


class Trusted(NamedTuple):
    """What a vehicle that looks at its readings goes by."""

    heading: float = NOTHING  # [rad]
    yaw_rate: float = 0.0  # [rad/s]
    depth: float = NOTHING  # [m] NaN: not known
    knows_heading: float = 1.0  # [-]


class Asked(NamedTuple):
    """What it asked of its autopilot in the last tick."""

    heading: float = 0.0  # [rad]
    speed: float = 0.0  # [m/s]
    depth: float = 0.0  # [m]


class Watch(NamedTuple):
    """What it remembers of one reading."""

    reading: float = NOTHING  # [any] the last number
    same: float = 0.0  # [s] for which it has not changed
    doubted: float = NOTHING  # [s] when it was first not believed


class Watches(NamedTuple):
    """A `Watch` of each reading."""

    heading: float = NOTHING  # [rad]
    heading_same: float = 0.0  # [s]
    heading_doubted: float = NOTHING  # [s]
    depth: float = NOTHING  # [m]
    depth_same: float = 0.0  # [s]
    depth_doubted: float = NOTHING  # [s]
    altitude: float = NOTHING  # [m]
    altitude_same: float = 0.0  # [s]
    altitude_doubted: float = NOTHING  # [s]
    shaft_speed: float = NOTHING  # [rad/s]
    shaft_speed_same: float = 0.0  # [s]
    shaft_speed_doubted: float = NOTHING  # [s]
    surge: float = NOTHING  # [m/s]
    surge_same: float = 0.0  # [s]
    surge_doubted: float = NOTHING  # [s]
    north: float = NOTHING  # [m]
    north_same: float = 0.0  # [s]
    north_doubted: float = NOTHING  # [s]


class Stop(NamedTuple):
    """Where it holds its place for the sake of one who is silent."""

    holds: float = 0.0  # [-] 1: it does
    north: float = NOTHING  # [m]
    east: float = NOTHING  # [m]


class Way(NamedTuple):
    """The last position by GNSS, and how far the vehicle thinks to have come since it changed."""

    north: float = NOTHING  # [m]
    east: float = NOTHING  # [m]
    way_north: float = 0.0  # [m]
    way_east: float = 0.0  # [m]


class Echo(NamedTuple):
    """The last USBL reading of another vehicle."""

    range: float = NOTHING  # [m]
    azimuth: float = NOTHING  # [rad]


class Mind(NamedTuple):
    """All of one vehicle's tables; `known`, `sources` and `neighbors` are lists after their length."""

    book: LawBook
    own: Rows  # the records of OWN
    orders: Rows  # Orders, then the points of v_L, of depth, and the corners of the geofence
    features: Any  # Ints (NUM_FEATURES,)
    others: Rows  # (vehicle, the records of OTHERS)
    paths: Rows  # path tables of all vehicles
    path_starts: Any  # Ints (vehicle,) where each path table begins
    neighbors: Any  # Ints (vehicle, list) whom each vehicle coordinates with
    list_width: int  # [-] length of each such list
    known: Any  # Ints (list,) whose states matter to this vehicle, in the fleet's order
    sources: Any  # Ints (list,) whose messages it reads
    me: int
    size: int  # [-] vehicles in the fleet
    screens: Any  # Ints: it looks at its readings before it believes them; else not there


ORDERS = Layout(Orders)
get_orders = ORDERS.reader(Orders)
ORDERS_WIDTH = ORDERS.width
POINT_WIDTH = 2

OWN = Layout(
    Setup,
    Datasheet,
    DvlReading,
    Whereabouts,
    Water,
    Along,
    Speech,
    Correction,
    Progress,
    Journal,
    Sounding,
    Grid,
    Trusted,
    Asked,
    Watches,
    Way,
    Stop,
)
get_setup, put_setup = OWN.reader(Setup), OWN.writer(Setup)
get_datasheet = OWN.reader(Datasheet)
get_speed, put_speed = OWN.reader(DvlReading), OWN.writer(DvlReading)
get_whereabouts, put_whereabouts = OWN.reader(Whereabouts), OWN.writer(Whereabouts)
get_current, put_current = OWN.reader(Water), OWN.writer(Water)
get_along, put_along = OWN.reader(Along), OWN.writer(Along)
get_speech, put_speech = OWN.reader(Speech), OWN.writer(Speech)
get_correction, put_correction = OWN.reader(Correction), OWN.writer(Correction)
get_progress, put_progress = OWN.reader(Progress), OWN.writer(Progress)
get_journal, put_journal = OWN.reader(Journal), OWN.writer(Journal)
get_grid = OWN.reader(Grid)
get_sounding, put_sounding = OWN.reader(Sounding), OWN.writer(Sounding)
get_trusted, put_trusted = OWN.reader(Trusted), OWN.writer(Trusted)
get_asked, put_asked = OWN.reader(Asked), OWN.writer(Asked)
get_way, put_way = OWN.reader(Way), OWN.writer(Way)
get_stop, put_stop = OWN.reader(Stop), OWN.writer(Stop)
WATCH = Layout(Watch)
get_watch, put_watch = WATCH.reader(Watch), WATCH.writer(Watch)

OWN_WIDTH = OWN.width

# What a vehicle knows of one other; the place is where on its own path that one was seen.
OTHERS = Layout(News, Fresh, Outlook, LastSeen, Told, PathPlace, Echo)
get_news, put_news = OTHERS.reader(News), OTHERS.writer(News)
get_fresh, put_fresh = OTHERS.reader(Fresh), OTHERS.writer(Fresh)
get_outlook, put_outlook = OTHERS.reader(Outlook), OTHERS.writer(Outlook)
get_last_seen, put_last_seen = OTHERS.reader(LastSeen), OTHERS.writer(LastSeen)
get_told, put_told = OTHERS.reader(Told), OTHERS.writer(Told)
get_seen_place, put_seen_place = OTHERS.reader(PathPlace), OTHERS.writer(PathPlace)
get_echo, put_echo = OTHERS.reader(Echo), OTHERS.writer(Echo)

OTHERS_WIDTH = OTHERS.width

# An inbox holds, for each source, whether a message came in this tick, and the last one.
ENVELOPE = Layout(Report)
SIGHTING = Layout(Sighting)
get_head, put_head = ENVELOPE.reader(Report), ENVELOPE.writer(Report)
get_seen, put_seen = SIGHTING.reader(Sighting), SIGHTING.writer(Sighting)
SIGHTING_WIDTH = SIGHTING.width
FLAG = 0  # 1 when the message came in this tick
HEAD = 1 + ENVELOPE.width  # the flag and the head of a report


def inbox_width(size: int) -> int:
    """Numbers in one inbox entry: flag, report, and a sighting of each vehicle of the fleet."""
    return HEAD + size * SIGHTING_WIDTH


@compiled
def message_from(heard: Rows, size: int, source: int) -> Rows:
    """The entry of one source in an inbox."""
    return at(heard, source * (HEAD + size * SIGHTING_WIDTH))


@compiled
def is_fresh(message: Rows) -> bool:
    """Whether the message came in this tick."""
    return load(message, FLAG) > 0.5


@compiled
def head_of(message: Rows) -> Report:
    """The report of a message."""
    return get_head(at(message, 1), 0)


@compiled
def sighting_in(message: Rows, vehicle: int) -> Sighting:
    """What the message says of a vehicle."""
    return get_seen(at(message, HEAD), vehicle)


@compiled
def path_of(mind: Mind, vehicle: int) -> Rows:
    """The path table of a vehicle of the fleet."""
    return at(mind.paths, load(mind.path_starts, vehicle))


@compiled
def neighbors_of(mind: Mind, vehicle: int) -> Any:
    """The list of those a vehicle coordinates with, after its length."""
    return at(mind.neighbors, vehicle * mind.list_width)


@compiled
def pace_points(mind: Mind) -> Rows:
    """The points of the profile of v_L."""
    return at(mind.orders, ORDERS_WIDTH)


@compiled
def depth_points(mind: Mind) -> Rows:
    """The points of the depth profile."""
    return at(mind.orders, ORDERS_WIDTH + POINT_WIDTH * load(mind.features, PACE_POINTS))


@compiled
def fence_corners(orders: Rows, features: Any) -> Rows:
    """The corners of the geofence, from a vehicle's orders and whole numbers."""
    before = load(features, PACE_POINTS) + load(features, DEPTH_POINTS)
    return at(orders, ORDERS_WIDTH + POINT_WIDTH * before)
