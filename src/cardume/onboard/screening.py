"""Which readings a vehicle believes, and what it does without those that it does not.

A reading that is no number is none.  One that repeats itself to the last bit for longer than `patience` is that of a
frozen sensor, where noise is told of the sensor, or where a heading or depth is off what the vehicle asks for and so
should have changed; it is believed again once it changes.  A position by GNSS that repeats itself is not believed
where noise is told or the vehicle thinks to have moved; a USBL reading, where noise is told.

Without a heading the vehicle keeps the last one, carried on by the yaw rate if it has one, and stops; without a speed
it takes the one it asked for; without a depth its autopilot leaves the depth as it is; without fixes it reckons.
"""

from cardume.compiler import Rows, at, compiled, negate, optional, where
from cardume.maths import hypot, to_ned, wrap_angle
from cardume.onboard.mind import (
    OWN,
    Asked,
    Echo,
    Mind,
    Trusted,
    Watch,
    Watches,
    Way,
    get_asked,
    get_current,
    get_datasheet,
    get_echo,
    get_speed,
    get_trusted,
    get_watch,
    get_way,
    put_asked,
    put_echo,
    put_trusted,
    put_watch,
    put_way,
)
from cardume.signals import NOTHING, Measured, Reference

OFF_HEADING = 0.1  # [rad] off the heading asked for, where a compass should turn
OFF_DEPTH = 0.3  # [m] off the depth asked for, where a depth should change
MOVED = 0.5  # [m] beyond which a position should have changed
WATCHES_START = OWN.offsets[Watches]
WATCHED = tuple(name for name in Watches._fields if not name.endswith(("_same", "_doubted")))
HEADING, DEPTH, ALTITUDE, SHAFT_SPEED, SURGE, NORTH = range(len(WATCHED))


@compiled
def watches_of(own: Rows) -> Rows:
    """The watches of a vehicle, one for each of WATCHED.

    Args:
        own: [any] (n,) the records of OWN.
    """
    return at(own, WATCHES_START)


@compiled
def is_number(value: float) -> bool:
    """Whether a value [any] is finite."""
    return value - value == 0.0


@compiled
def believe(mind: Mind, which: int, reading: float, suspicious: bool, time: float) -> float:
    """A reading [any], or nothing where it is none or has been the same for too long.

    Args:
        mind: of the vehicle, which notes the first time that it does not believe it.
        which: one of WATCHED.
        reading: [any] of this tick.
        suspicious: [-] whether one that does not change is not to be believed, in each lane.
        time: [s]
    """
    watches, patience = watches_of(mind.own), get_datasheet(mind.own, 0).patience
    before = get_watch(watches, which)
    same = where(reading == before.reading, before.same + mind.book.dt, 0.0)
    good = is_number(reading) & negate((same > patience) & suspicious)
    told_before = is_number(before.reading) | is_number(before.doubted)
    is_first = negate(good) & told_before & negate(is_number(before.doubted))
    kept = where(is_number(reading), reading, before.reading)
    put_watch(watches, which, Watch(kept, same, where(is_first, time, before.doubted)))
    return where(good, reading, NOTHING)


@compiled
def screen(mind: Mind, measured: Measured, time: float) -> Measured:
    """The readings of this tick that are to be believed; the vehicle remembers what it made of them.

    Args:
        mind: of the vehicle, changed in place; one that does not look at its readings believes them all.
        measured: what its sensors say.
        time: [s]
    """
    return screened(mind.screens, mind, measured, time)


@optional(otherwise="measured")
@compiled
def screened(mind: Mind, measured: Measured, time: float) -> Measured:
    """What `screen` makes of readings where the vehicle looks at them.

    Args:
        mind: of the vehicle.
        measured: what its sensors say.
        time: [s]
    """
    heading, yaw_rate = screen_heading(mind, measured.heading, measured.yaw_rate, time)
    depth = screen_depth(mind, measured.depth, time)
    surge = screen_surge(mind, measured.dvl_surge, time)
    north = screen_position(mind, measured.gnss_north, measured.gnss_east, time)
    return Measured(
        heading,
        yaw_rate,
        where(is_number(measured.roll), measured.roll, 0.0),
        where(is_number(measured.pitch), measured.pitch, 0.0),
        depth,
        screen_shaft(mind, measured.shaft_speed, time),
        surge,
        where(is_number(measured.dvl_sway), measured.dvl_sway, 0.0),
        screen_altitude(mind, measured.altitude, time),
        north,
        measured.gnss_east,
        measured.gnss_age,
        measured.usbl,
    )


@compiled
def screen_heading(mind: Mind, heading: float, yaw_rate: float, time: float) -> tuple[float, float]:
    """Heading [rad] and yaw rate [rad/s] to go by.

    Args:
        mind: of the vehicle.
        heading: [rad] measured.
        yaw_rate: [rad/s] measured.
        time: [s]
    """
    off = abs(wrap_angle(get_asked(mind.own, 0).heading - heading)) > OFF_HEADING
    believed = believe(mind, HEADING, heading, (get_datasheet(mind.own, 0).heading > 0.0) | off, time)
    trusted, knows = get_trusted(mind.own, 0), believed == believed
    rate = where(is_number(yaw_rate) & (knows | negate(is_number(heading))), yaw_rate, 0.0)
    kept = where(is_number(trusted.heading), trusted.heading, 0.0) + mind.book.dt * rate
    heading = where(knows, believed, kept)
    put_trusted(mind.own, 0, Trusted(heading, rate, trusted.depth, where(knows, 1.0, 0.0)))
    return heading, rate


@compiled
def screen_depth(mind: Mind, depth: float, time: float) -> float:
    """Depth [m] to go by, NaN: not known.

    Args:
        mind: of the vehicle.
        depth: [m] measured.
        time: [s]
    """
    off = abs(get_asked(mind.own, 0).depth - depth) > OFF_DEPTH
    believed = believe(mind, DEPTH, depth, (get_datasheet(mind.own, 0).depth > 0.0) | off, time)
    trusted = get_trusted(mind.own, 0)
    put_trusted(mind.own, 0, Trusted(trusted.heading, trusted.yaw_rate, believed, trusted.knows_heading))
    return believed


@compiled
def screen_altitude(mind: Mind, altitude: float, time: float) -> float:
    """Altitude [m] to go by, NaN: no echo.

    Args:
        mind: of the vehicle.
        altitude: [m] measured.
        time: [s]
    """
    return believe(mind, ALTITUDE, altitude, get_datasheet(mind.own, 0).altitude > 0.0, time)


@compiled
def screen_shaft(mind: Mind, shaft_speed: float, time: float) -> float:
    """Shaft speed [rad/s] to go by, NaN: not known.

    Args:
        mind: of the vehicle.
        shaft_speed: [rad/s] measured; at rest there is no noise.
        time: [s]
    """
    is_noisy = (get_datasheet(mind.own, 0).shaft_speed > 0.0) & (abs(shaft_speed) > 0.0)
    return believe(mind, SHAFT_SPEED, shaft_speed, is_noisy, time)


@compiled
def screen_surge(mind: Mind, surge: float, time: float) -> float:
    """Surge by DVL [m/s] to go by, NaN: not known.

    Args:
        mind: of the vehicle.
        surge: [m/s] measured.
        time: [s]
    """
    return believe(mind, SURGE, surge, get_datasheet(mind.own, 0).velocity > 0.0, time)


@compiled
def screen_position(mind: Mind, north: float, east: float, time: float) -> float:
    """North [m] of a position by GNSS that is to be believed, NaN: none is.

    Args:
        mind: of the vehicle; it adds up how far it thinks to have come since the position changed.
        north: [m] measured.
        east: [m] measured.
        time: [s]
    """
    dt, before, speed = mind.book.dt, get_way(mind.own, 0), get_speed(mind.own, 0)
    heading, current = get_trusted(mind.own, 0).heading, get_current(mind.own, 0)
    made_north, made_east = to_ned(heading, speed.surge, speed.sway)
    made_north, made_east = made_north + current.north, made_east + current.east
    way_north = before.way_north + dt * where(is_number(made_north), made_north, 0.0)
    way_east = before.way_east + dt * where(is_number(made_east), made_east, 0.0)
    is_there = is_number(north) & is_number(east)
    repeats = is_there & (north == before.north) & (east == before.east)
    is_noisy = get_datasheet(mind.own, 0).gnss > 0.0
    stuck = repeats & (is_noisy | (hypot(way_north, way_east) > MOVED))
    is_new, watches = is_there & negate(repeats), watches_of(mind.own)
    last = get_watch(watches, NORTH)
    is_first = stuck & negate(is_number(last.doubted))
    put_watch(watches, NORTH, Watch(last.reading, last.same, where(is_first, time, last.doubted)))
    moved = Way(before.north, before.east, way_north, way_east)
    put_way(mind.own, 0, where(is_new, Way(north, east, 0.0 * north, 0.0 * north), moved))
    return where(is_there & negate(stuck), north, NOTHING)


@compiled
def is_believable(mind: Mind, vehicle: int, is_new: bool, distance: float, azimuth: float) -> bool:
    """Whether there is a USBL reading, and no repetition of the last of that vehicle; without a heading none is.

    Args:
        mind: of the vehicle with the head.
        vehicle: who was heard.
        is_new: [-] whether there is a reading, in each lane.
        distance: [m]
        azimuth: [rad] NaN: a range only.
    """
    return is_no_repetition(mind.screens, mind, vehicle, is_new & is_number(distance), distance, azimuth)


@optional(otherwise="is_new")
@compiled
def is_no_repetition(mind: Mind, vehicle: int, is_new: bool, distance: float, azimuth: float) -> bool:
    """What `is_believable` says where the vehicle looks at its readings.

    Args:
        mind: of the vehicle with the head.
        vehicle: who was heard.
        is_new: [-] whether there is a reading, in each lane.
        distance: [m]
        azimuth: [rad] NaN: a range only.
    """
    before = get_echo(mind.others, vehicle)
    put_echo(mind.others, vehicle, where(is_new, Echo(distance, azimuth), before))
    same = (distance == before.range) & ((azimuth == before.azimuth) | negate(azimuth == azimuth))
    repeats = same & (get_datasheet(mind.own, 0).range > 0.0)
    return is_new & negate(repeats) & (get_trusted(mind.own, 0).knows_heading > 0.5)


@optional(otherwise="surge")
@compiled
def surge_or_asked(mind: Mind, surge: float, is_measured: bool) -> float:
    """Surge [m/s] where it is measured; else the speed that was asked for, of a vehicle that carries a sensor of it.

    Args:
        mind: of the vehicle.
        surge: [m/s]
        is_measured: [-] whether it is, in each lane.
    """
    told = get_datasheet(mind.own, 0)
    carries = (told.velocity == told.velocity) | (told.shaft_speed == told.shaft_speed)
    return where(carries & negate(is_measured), get_asked(mind.own, 0).speed, surge)


@compiled
def stop_if_lost(mind: Mind, reference: Reference) -> Reference:
    """The reference, or to stay where it is for a vehicle that knows that it does not know its heading."""
    return reference_if_lost(mind.screens, mind, reference)


@optional(otherwise="reference")
@compiled
def reference_if_lost(mind: Mind, reference: Reference) -> Reference:
    """What `stop_if_lost` gives where the vehicle looks at its readings; it remembers what it asks."""
    trusted = get_trusted(mind.own, 0)
    knows, none = trusted.knows_heading > 0.5, NOTHING * reference.heading
    stay = Reference(reference.course, trusted.heading, 0.0 * trusted.heading, reference.depth, none)
    reference = where(knows, reference, stay)
    put_asked(mind.own, 0, Asked(reference.heading, reference.speed, reference.depth))
    return reference
