"""All of one mission's tables, as Python hands them over and as compiled code sees them.

`Tables` holds numpy arrays, `Fleet` the same as rows.  One mission has arrays of shape (n,); eight
missions in lanes have (n, 8).  Whole numbers are the same in all lanes.
"""

from typing import Any, NamedTuple

import numpy as np

from cardume.compiler import Layout, Rows, at, compiled, inlined, load, rows_of
from cardume.laws import COLUMNS, FAMILIES, LawBook
from cardume.maths.random import Key
from cardume.onboard.mind import NUM_FEATURES, ORDERS_START, OTHERS_WIDTH, OWN_WIDTH, Mind
from cardume.paths.table import PathPlace
from cardume.signals import AhrsReading, Command, DvlReading, Measured, Reference, ShaftReading, VesselState, Water
from cardume.world.acoustics.medium import Medium
from cardume.world.faults import Fault, Kept, Weakness

HANDLES = len(FAMILIES) * COLUMNS


class Timing(NamedTuple):
    """When a sensor samples; an absent one never does."""

    next_sample: float = np.inf  # [ticks] when the next reading is delivered
    sample: float = 0.0  # [-] readings so far
    period: float = 1.0  # [ticks]
    latency: float = 0.0  # [ticks]
    noise_pairs: float = 2.0  # [-] of random numbers that its law reads: 0, 1 or 2


class Due(NamedTuple):
    """What of a timing changes with every reading."""

    next_sample: float  # [ticks]
    sample: float  # [-]


class OnPath(NamedTuple):
    """The truth about a vehicle and its path."""

    cross_track: float = 0.0  # [m]
    along_track: float = 0.0  # [m]
    path_course: float = 0.0  # [rad]
    curvature: float = 0.0  # [1/m]
    coordination_state: float = 0.0  # [m]
    finished: float = 0.0  # [-] 1 once past the end


class Held(NamedTuple):
    """What the sensors that hold their last value said; the fields of `Measured` without the fixes."""

    heading: float = np.nan  # [rad]
    yaw_rate: float = np.nan  # [rad/s]
    roll: float = np.nan  # [rad]
    pitch: float = np.nan  # [rad]
    depth: float = np.nan  # [m]
    shaft_speed: float = np.nan  # [rad/s]
    dvl_surge: float = np.nan  # [m/s]
    dvl_sway: float = np.nan  # [m/s]
    altitude: float = np.nan  # [m]


class DepthReading(NamedTuple):
    """What of it the depth sensor says."""

    depth: float  # [m]


class AltimeterReading(NamedTuple):
    """What of it the altimeter says."""

    altitude: float  # [m]


class Satellite(NamedTuple):
    """The GNSS reading of this tick."""

    north: float = np.nan  # [m]
    east: float = np.nan  # [m]
    age: float = np.nan  # [s]


VEHICLE = Layout(VesselState, Water, Reference, Command, PathPlace, OnPath, Held, Satellite)
get_vessel, put_vessel = VEHICLE.reader(VesselState), VEHICLE.writer(VesselState)
view_vessel = VEHICLE.viewer(VesselState)
get_water, put_water = VEHICLE.reader(Water), VEHICLE.writer(Water)
get_reference, put_reference = VEHICLE.reader(Reference), VEHICLE.writer(Reference)
get_command, put_command = VEHICLE.reader(Command), VEHICLE.writer(Command)
get_true_place, put_true_place = VEHICLE.reader(PathPlace), VEHICLE.writer(PathPlace)
get_on_path, put_on_path = VEHICLE.reader(OnPath), VEHICLE.writer(OnPath)
VEHICLE.lay_over(Held, "heading", AhrsReading, DepthReading, ShaftReading, DvlReading, AltimeterReading)
get_held = VEHICLE.reader(Held)
get_attitude, put_attitude = VEHICLE.reader(AhrsReading), VEHICLE.writer(AhrsReading)
get_depth, put_depth = VEHICLE.reader(DepthReading), VEHICLE.writer(DepthReading)
get_shaft, put_shaft = VEHICLE.reader(ShaftReading), VEHICLE.writer(ShaftReading)
get_velocity, put_velocity = VEHICLE.reader(DvlReading), VEHICLE.writer(DvlReading)
get_altitude, put_altitude = VEHICLE.reader(AltimeterReading), VEHICLE.writer(AltimeterReading)
get_satellite, put_satellite = VEHICLE.reader(Satellite), VEHICLE.writer(Satellite)

SENSORS = ("gnss", "ahrs", "depth", "usbl", "dvl", "thruster_speed", "altimeter")
STREAMS = (*SENSORS, "link")  # each with its own random numbers
NUM_SENSORS, NUM_STREAMS = len(SENSORS), len(STREAMS)
GNSS, AHRS, DEPTH, USBL, DVL, THRUSTER_SPEED, ALTIMETER = range(NUM_SENSORS)
TIMING, KEY = Layout(Timing), Layout(Key)
TIMING.lay_over(Timing, "next_sample", Due)
get_timing, put_due = TIMING.reader(Timing), TIMING.writer(Due)
get_key, put_key = KEY.reader(Key), KEY.writer(Key)

FAULTS = Layout(Fault, Weakness, Kept, Key)
get_fault, get_weakness = FAULTS.reader(Fault), FAULTS.reader(Weakness)
get_kept, put_kept = FAULTS.reader(Kept), FAULTS.writer(Kept)
get_fault_key = FAULTS.reader(Key)
KIND, WHOM, SENSOR, FAULT_COLUMNS = range(4)  # columns of Faults.kinds

MODEM = Layout(Medium)
get_medium = MODEM.reader(Medium)

SEEN = Layout(VesselState, Water)  # what a sensor with a latency looks back at


class OnAir(NamedTuple):
    """When one message sounds at one vehicle, which need not listen, and how loud."""

    start: float = -1.0  # [s]
    end: float = -1.0  # [s]
    level: float = -1e9  # [dB re 1 uPa]


ON_AIR = Layout(OnAir)
get_on_air, put_on_air = ON_AIR.reader(OnAir), ON_AIR.writer(OnAir)


NEVER = 1e300  # [s]


class Air(NamedTuple):
    """Messages in the water."""

    outbox: Rows  # (vehicle, slot, message) as sent
    sending: Rows  # (vehicle,) 1 when it spoke in this tick
    sent: Any  # Ints (vehicle,) messages so far
    due: Rows  # (link,) [s] when the next message arrives
    arrivals: Rows  # (link, slot) [s] when each does; inf: never
    inbox: Rows  # (link, message) what was heard last
    slots: int  # [-] messages of one sender that can be under way at once
    messages: int  # [-] numbers in a message
    widest: int  # [-] links per listener, at most
    is_shared: int  # [-] 1: modems cannot hear while they send, and messages that overlap destroy each other
    asks: int  # [-] 1: a USBL reading comes with the answer to a question
    modems: Rows  # (vehicle, the records of MODEM)
    on_air: Rows  # (vehicle, vehicle, slot, OnAir) what sounds at the first when the second sends
    logged: Rows  # (link, slot) the row of the log of messages that each stands in


class Faults(NamedTuple):
    """What goes wrong."""

    num: int  # [-]
    num_clocks: int  # [-] clocks that go wrong
    kinds: Any  # Ints (fault, FAULT_COLUMNS) kind, place of the vehicle or -1 for all, sensor or -1; else not there
    rows: Rows  # (fault, the records of FAULTS)
    recordings: Rows  # (fault, message) packets that somebody recorded
    clocks: Any  # SharedRows (clock, 5): vehicle, begin, end [s], offset [s], drift; the same in all lanes


class Fleet(NamedTuple):
    """One mission, or eight, as compiled code sees it."""

    size: int
    substeps: int  # [-] plant steps per tick
    tick: float  # [s]
    handles: Any  # Ints (vehicle, family, 4)
    gains: Rows  # (vehicle, gains)
    gains_width: int
    memory: Rows  # (vehicle, memory)
    memory_width: int
    vehicles: Rows  # (vehicle, the records of VEHICLE)
    minds: Rows  # (vehicle, the records of OWN)
    others: Rows  # (vehicle, vehicle, the records of OTHERS)
    usbl: Rows  # (vehicle, vehicle, 4) readings of this tick
    timings: Rows  # (vehicle, sensor, Timing)
    keys: Rows  # (vehicle, stream, Key), then the fleet's own
    noise: Rows  # (vehicle, sensor, NOISE_WIDTH), then the fleet's own
    past: Rows  # (vehicle, tick, SEEN)
    aside: Rows  # (vehicle, SEEN) the one of them that a sensor looks at
    past_size: int  # [ticks] 1: no sensor looks back
    paths: Rows
    path_starts: Any  # Ints (vehicle,)
    graph: Any  # Ints (vehicle, list) neighbors, then known, then sources
    list_width: int
    orders: Rows  # of each vehicle, see onboard/mind.py
    features: Any  # Ints (vehicle, NUM_FEATURES)
    field: Any  # SharedRows: gridded current, the same in all lanes
    seabed: Any  # SharedRows: gridded seabed
    has_seabed: int  # [-] 1: the mission has a seabed
    has_phases: int  # [-] 1: some vehicle has more to do than to follow its path
    is_watched: int  # [-] 1: depth, altitude, geofence or separation are limited
    has_weather: int  # [-] 1: the current has noise of its own
    air: Air
    faults: Faults
    scores: Rows  # (vehicle, the records of SCORES)
    fleet_score: Rows  # FleetScore
    histograms: Rows  # (vehicle, metric, bin)
    trouble: Rows  # code, vehicle, time of the first number that is not one
    log: Rows  # (record, vehicle, channel)
    predictions: Rows  # (record, vehicle, vehicle)
    messages: Rows  # (message, column)
    counts: Any  # Ints: records, messages written; how many there is room for; ticks per record
    requirements: Rows  # transient threshold and hold, swath width


class Whole(NamedTuple):
    """The whole numbers of a mission, the same in all lanes."""

    size: int
    substeps: int
    gains_width: int
    memory_width: int
    past_size: int
    list_width: int
    slots: int
    message_width: int
    widest: int
    has_seabed: int = 0
    has_phases: int = 0
    is_watched: int = 0
    has_weather: int = 0
    is_shared: int = 0
    asks: int = 0
    num_faults: int = 0
    num_clocks: int = 0


class Tables(NamedTuple):
    """The same as numpy arrays; field by field what `Fleet` and `Air` hold."""

    whole: Whole
    tick: float  # [s]
    handles: np.ndarray
    gains: np.ndarray
    memory: np.ndarray
    vehicles: np.ndarray
    minds: np.ndarray
    others: np.ndarray
    usbl: np.ndarray
    timings: np.ndarray
    keys: np.ndarray
    noise: np.ndarray
    past: np.ndarray
    aside: np.ndarray
    paths: np.ndarray
    path_starts: np.ndarray
    graph: np.ndarray
    orders: np.ndarray
    features: np.ndarray
    field: np.ndarray
    seabed: np.ndarray
    outbox: np.ndarray
    sending: np.ndarray
    sent: np.ndarray
    due: np.ndarray
    arrivals: np.ndarray
    inbox: np.ndarray
    modems: np.ndarray
    on_air: np.ndarray
    logged: np.ndarray
    fault_kinds: np.ndarray
    faults: np.ndarray
    recordings: np.ndarray
    clocks: np.ndarray
    scores: np.ndarray
    fleet_score: np.ndarray
    histograms: np.ndarray
    trouble: np.ndarray
    log: np.ndarray
    predictions: np.ndarray
    messages: np.ndarray
    counts: np.ndarray
    requirements: np.ndarray


@compiled
def fleet_of(tables: Tables) -> Fleet:
    """The tables as rows; the arrays must stay alive meanwhile."""
    whole = tables.whole
    air = Air(
        rows_of(tables.outbox),
        rows_of(tables.sending),
        rows_of(tables.sent),
        rows_of(tables.due),
        rows_of(tables.arrivals),
        rows_of(tables.inbox),
        whole.slots,
        whole.message_width,
        whole.widest,
        whole.is_shared,
        whole.asks,
        rows_of(tables.modems),
        rows_of(tables.on_air),
        rows_of(tables.logged),
    )
    faults = Faults(
        whole.num_faults,
        whole.num_clocks,
        rows_of(tables.fault_kinds),
        rows_of(tables.faults),
        rows_of(tables.recordings),
        rows_of(tables.clocks),
    )
    return Fleet(
        whole.size,
        whole.substeps,
        tables.tick,
        rows_of(tables.handles),
        rows_of(tables.gains),
        whole.gains_width,
        rows_of(tables.memory),
        whole.memory_width,
        rows_of(tables.vehicles),
        rows_of(tables.minds),
        rows_of(tables.others),
        rows_of(tables.usbl),
        rows_of(tables.timings),
        rows_of(tables.keys),
        rows_of(tables.noise),
        rows_of(tables.past),
        rows_of(tables.aside),
        whole.past_size,
        rows_of(tables.paths),
        rows_of(tables.path_starts),
        rows_of(tables.graph),
        whole.list_width,
        rows_of(tables.orders),
        rows_of(tables.features),
        rows_of(tables.field),
        rows_of(tables.seabed),
        whole.has_seabed,
        whole.has_phases,
        whole.is_watched,
        whole.has_weather,
        air,
        faults,
        rows_of(tables.scores),
        rows_of(tables.fleet_score),
        rows_of(tables.histograms),
        rows_of(tables.trouble),
        rows_of(tables.log),
        rows_of(tables.predictions),
        rows_of(tables.messages),
        rows_of(tables.counts),
        rows_of(tables.requirements),
    )


@compiled
def book_of(fleet: Fleet, vehicle: int, dt: float) -> LawBook:
    """The laws of one vehicle, for steps of dt [s]."""
    return LawBook(
        at(fleet.handles, vehicle * HANDLES),
        at(fleet.gains, vehicle * fleet.gains_width),
        at(fleet.memory, vehicle * fleet.memory_width),
        dt,
    )


@compiled
def mind_of(fleet: Fleet, vehicle: int) -> Mind:
    """What a vehicle decides with: nothing of the truth is in it."""
    lists = fleet.size * fleet.list_width
    return Mind(
        book_of(fleet, vehicle, fleet.tick),
        at(fleet.minds, vehicle * OWN_WIDTH),
        orders_of(fleet, vehicle),
        features_of(fleet, vehicle),
        at(fleet.others, vehicle * fleet.size * OTHERS_WIDTH),
        fleet.paths,
        fleet.path_starts,
        fleet.graph,
        fleet.list_width,
        at(fleet.graph, lists + vehicle * fleet.list_width),
        sources_of(fleet, vehicle),
        vehicle,
        fleet.size,
        fleet.faults.kinds,
    )


@compiled
def features_of(fleet: Fleet, vehicle: int) -> Any:
    """The whole numbers that say what a vehicle's mission asks for."""
    return at(fleet.features, vehicle * NUM_FEATURES)


@compiled
def orders_of(fleet: Fleet, vehicle: int) -> Rows:
    """What a vehicle is told of phases, profiles and limits."""
    return at(fleet.orders, load(fleet.features, vehicle * NUM_FEATURES + ORDERS_START))


@compiled
def sources_of(fleet: Fleet, vehicle: int) -> Any:
    """The list of those whose messages a vehicle reads, after its length."""
    return at(fleet.graph, 2 * fleet.size * fleet.list_width + vehicle * fleet.list_width)


@inlined
def measured_of(fleet: Fleet, vehicle: int) -> Measured:
    """All that a vehicle's sensors say in this tick."""
    held, satellite = get_held(fleet.vehicles, vehicle), get_satellite(fleet.vehicles, vehicle)
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
