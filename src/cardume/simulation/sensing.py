"""Sensors: each reads the truth of its latency ago at its own period, and holds or forgets the reading."""

from cardume.compiler import at, compiled, floor, inlined, load, some, store, where
from cardume.maths import to_body
from cardume.maths.random import Key, normals
from cardume.onboard.mind import get_setup, head_of, is_fresh
from cardume.onboard.sightings import USBL_WIDTH
from cardume.signals import (
    NOTHING,
    Baseline,
    DvlReading,
    GnssReading,
    Noise,
    Sampling,
    Seabed,
    ShaftReading,
    Spot,
    UsblReading,
    VesselState,
    Water,
)
from cardume.simulation.faults import (
    attitude_in_fault,
    baseline_in_fault,
    due_in_fault,
    echo_in_fault,
    number_in_fault,
    position_in_fault,
    velocity_in_fault,
)
from cardume.simulation.fleet import (
    AHRS,
    ALTIMETER,
    DEPTH,
    DVL,
    GNSS,
    NUM_SENSORS,
    NUM_STREAMS,
    SEEN,
    STREAMS,
    THRUSTER_SPEED,
    USBL,
    AltimeterReading,
    DepthReading,
    Due,
    Fleet,
    Satellite,
    Timing,
    book_of,
    get_altitude,
    get_attitude,
    get_depth,
    get_key,
    get_shaft,
    get_timing,
    get_velocity,
    get_vessel,
    get_water,
    put_altitude,
    put_attitude,
    put_depth,
    put_due,
    put_satellite,
    put_shaft,
    put_velocity,
    sources_of,
    view_vessel,
)
from cardume.simulation.noise import NOISE_WIDTH, noise_of_reading
from cardume.world.bathymetry import sound
from cardume.world.sensors.base import (
    read_ahrs,
    read_altimeter,
    read_depth,
    read_dvl,
    read_gnss,
    read_thruster_speed,
    read_usbl,
)

LINK = STREAMS.index("link")
put_past_vessel, pick_past_vessel = SEEN.writer(VesselState), SEEN.picker(VesselState)
view_past_vessel = SEEN.viewer(VesselState)
put_past_water, pick_past_water = SEEN.writer(Water), SEEN.picker(Water)


@compiled
def sense(fleet: Fleet, vehicle: int, now: int) -> None:
    """Let every sensor of a vehicle that is due read."""
    remember(fleet, vehicle, now)
    if reads(fleet, vehicle, AHRS, now):
        sense_attitude(fleet, vehicle, now)
    if reads(fleet, vehicle, DEPTH, now):
        sense_depth(fleet, vehicle, now)
    if reads(fleet, vehicle, THRUSTER_SPEED, now):
        sense_shaft(fleet, vehicle, now)
    if reads(fleet, vehicle, ALTIMETER, now):
        sense_altitude(fleet, vehicle, now)
    if reads(fleet, vehicle, DVL, now):
        sense_velocity(fleet, vehicle, now)
    sense_position(fleet, vehicle, now)
    sense_others(fleet, vehicle, now)


@compiled
def remember(fleet: Fleet, vehicle: int, now: int) -> None:
    """Keep the truth of this tick for sensors with a latency."""
    if fleet.past_size > 1:
        row = vehicle * fleet.past_size + now % fleet.past_size
        put_past_vessel(fleet.past, row, get_vessel(fleet.vehicles, vehicle))
        put_past_water(fleet.past, row, get_water(fleet.vehicles, vehicle))


@compiled
def timing_of(fleet: Fleet, vehicle: int, sensor: int) -> Timing:
    """When a sensor of a vehicle reads."""
    return get_timing(fleet.timings, vehicle * NUM_SENSORS + sensor)


@inlined
def reads(fleet: Fleet, vehicle: int, sensor: int, now: int) -> bool:
    """Whether a sensor of a vehicle reads in this tick, in any lane."""
    return some(timing_of(fleet, vehicle, sensor).next_sample <= now)


@compiled
def schedule_next(fleet: Fleet, vehicle: int, sensor: int, timing: Timing, due: bool) -> None:
    """After a reading, set when the next one is delivered."""
    before, after = Due(timing.next_sample, timing.sample), Due(timing.next_sample + timing.period, timing.sample + 1.0)
    put_due(fleet.timings, vehicle * NUM_SENSORS + sensor, where(due, after, before))


@compiled
def key_of(fleet: Fleet, vehicle: int, stream: int) -> Key:
    """Names the random numbers of one stream of one vehicle."""
    return get_key(fleet.keys, vehicle * NUM_STREAMS + stream)


@compiled
def noise_of(fleet: Fleet, vehicle: int, sensor: int, timing: Timing, now: int) -> Noise:
    """The noise of a reading, named after the tick it is valid in."""
    noise = Noise(0.0 * timing.latency, 0.0 * timing.latency, 0.0 * timing.latency, 0.0 * timing.latency)
    if some(timing.noise_pairs > 0.5):
        kept = at(fleet.noise, (vehicle * NUM_SENSORS + sensor) * NOISE_WIDTH)
        key, tick = key_of(fleet, vehicle, sensor), now - timing.latency
        noise = noise_of_reading(kept, key, tick, timing.period, timing.sample, timing.noise_pairs)
    return noise


@compiled
def past_row(fleet: Fleet, vehicle: int, timing: Timing, now: int) -> float:
    """Where the truth of a sensor's latency ago is kept."""
    then = now - timing.latency
    return vehicle * fleet.past_size + then - fleet.past_size * floor(then / fleet.past_size)


@inlined
def vessel_then(fleet: Fleet, vehicle: int, timing: Timing, now: int) -> VesselState:
    """The state of a vehicle when the reading of this tick was valid, by reference: where it is kept, or copied to."""
    vessel = view_vessel(fleet.vehicles, vehicle)
    if some(timing.latency > 0.5):
        put_past_vessel(fleet.aside, vehicle, pick_past_vessel(fleet.past, past_row(fleet, vehicle, timing, now)))
        vessel = view_past_vessel(fleet.aside, vehicle)
    return vessel


@inlined
def water_then(fleet: Fleet, vehicle: int, timing: Timing, now: int) -> Water:
    """The water around a vehicle when the reading of this tick was valid."""
    water = get_water(fleet.vehicles, vehicle)
    if some(timing.latency > 0.5):
        water = pick_past_water(fleet.past, past_row(fleet, vehicle, timing, now))
    return water


@compiled
def sampling_of(fleet: Fleet, timing: Timing, now: int) -> Sampling:
    """When a reading is valid, and how long after the one before."""
    return Sampling(timing.period * fleet.tick, (now - timing.latency) * fleet.tick)


@compiled
def sense_attitude(fleet: Fleet, vehicle: int, now: int) -> None:
    """Heading, yaw rate, roll and pitch by AHRS."""
    timing = timing_of(fleet, vehicle, AHRS)
    due = timing.next_sample <= now
    reading = read_ahrs(
        book_of(fleet, vehicle, fleet.tick),
        0,
        vessel_then(fleet, vehicle, timing, now),
        water_then(fleet, vehicle, timing, now),
        noise_of(fleet, vehicle, AHRS, timing, now),
        sampling_of(fleet, timing, now),
    )
    reading = attitude_in_fault(fleet.faults.kinds, fleet, vehicle, reading, now * fleet.tick)
    put_attitude(fleet.vehicles, vehicle, where(due, reading, get_attitude(fleet.vehicles, vehicle)))
    schedule_next(fleet, vehicle, AHRS, timing, due)


@compiled
def sense_depth(fleet: Fleet, vehicle: int, now: int) -> None:
    """Depth by pressure."""
    timing = timing_of(fleet, vehicle, DEPTH)
    due = timing.next_sample <= now
    depth = read_depth(
        book_of(fleet, vehicle, fleet.tick),
        0,
        vessel_then(fleet, vehicle, timing, now),
        water_then(fleet, vehicle, timing, now),
        noise_of(fleet, vehicle, DEPTH, timing, now),
        sampling_of(fleet, timing, now),
    )
    before = get_depth(fleet.vehicles, vehicle).depth
    depth = number_in_fault(fleet.faults.kinds, fleet, vehicle, depth, DEPTH, before, now * fleet.tick)
    put_depth(fleet.vehicles, vehicle, where(due, DepthReading(depth), get_depth(fleet.vehicles, vehicle)))
    schedule_next(fleet, vehicle, DEPTH, timing, due)


@compiled
def sense_shaft(fleet: Fleet, vehicle: int, now: int) -> None:
    """Speed of the thrusters' shafts."""
    timing = timing_of(fleet, vehicle, THRUSTER_SPEED)
    due = timing.next_sample <= now
    shaft_speed = read_thruster_speed(
        book_of(fleet, vehicle, fleet.tick),
        0,
        vessel_then(fleet, vehicle, timing, now),
        water_then(fleet, vehicle, timing, now),
        noise_of(fleet, vehicle, THRUSTER_SPEED, timing, now),
        sampling_of(fleet, timing, now),
    )
    before = get_shaft(fleet.vehicles, vehicle).shaft_speed
    shaft_speed = number_in_fault(
        fleet.faults.kinds, fleet, vehicle, shaft_speed, THRUSTER_SPEED, before, now * fleet.tick
    )
    put_shaft(fleet.vehicles, vehicle, where(due, ShaftReading(shaft_speed), get_shaft(fleet.vehicles, vehicle)))
    schedule_next(fleet, vehicle, THRUSTER_SPEED, timing, due)


@compiled
def sense_altitude(fleet: Fleet, vehicle: int, now: int) -> None:
    """Altitude above the seabed by sound, where there is a seabed; NaN without an echo."""
    if fleet.has_seabed > 0:
        timing = timing_of(fleet, vehicle, ALTIMETER)
        due = timing.next_sample <= now
        then = vessel_then(fleet, vehicle, timing, now)
        altitude = read_altimeter(
            book_of(fleet, vehicle, fleet.tick),
            0,
            then,
            seabed_below(fleet, vehicle, then),
            noise_of(fleet, vehicle, ALTIMETER, timing, now),
            sampling_of(fleet, timing, now),
        )
        before = get_altitude(fleet.vehicles, vehicle).altitude
        altitude = number_in_fault(fleet.faults.kinds, fleet, vehicle, altitude, ALTIMETER, before, now * fleet.tick)
        reading = AltimeterReading(altitude)
        put_altitude(fleet.vehicles, vehicle, where(due, reading, get_altitude(fleet.vehicles, vehicle)))
        schedule_next(fleet, vehicle, ALTIMETER, timing, due)


@compiled
def seabed_below(fleet: Fleet, vehicle: int, vessel: VesselState) -> Seabed:
    """The seabed below a vehicle; unknown where the mission has none."""
    depth = NOTHING * vessel.north
    if fleet.has_seabed > 0:
        depth = sound(book_of(fleet, vehicle, fleet.tick), 0, Spot(vessel.north, vessel.east, fleet.seabed))
    return Seabed(depth)


@compiled
def sense_velocity(fleet: Fleet, vehicle: int, now: int) -> None:
    """Velocity through the water, or over ground, by DVL."""
    timing = timing_of(fleet, vehicle, DVL)
    due = timing.next_sample <= now
    then = vessel_then(fleet, vehicle, timing, now)
    reading: DvlReading = read_dvl(
        book_of(fleet, vehicle, fleet.tick),
        0,
        then,
        water_then(fleet, vehicle, timing, now),
        noise_of(fleet, vehicle, DVL, timing, now),
        sampling_of(fleet, timing, now),
        seabed_below(fleet, vehicle, then),
    )
    reading = velocity_in_fault(fleet.faults.kinds, fleet, vehicle, reading, now * fleet.tick)
    put_velocity(fleet.vehicles, vehicle, where(due, reading, get_velocity(fleet.vehicles, vehicle)))
    schedule_next(fleet, vehicle, DVL, timing, due)


@compiled
def sense_position(fleet: Fleet, vehicle: int, now: int) -> None:
    """Position by GNSS, there only in the tick in which it is delivered."""
    timing = timing_of(fleet, vehicle, GNSS)
    due = timing.next_sample <= now
    nothing = Satellite(NOTHING, NOTHING, NOTHING)
    if some(due):
        reading: GnssReading = read_gnss(
            book_of(fleet, vehicle, fleet.tick),
            0,
            vessel_then(fleet, vehicle, timing, now),
            water_then(fleet, vehicle, timing, now),
            noise_of(fleet, vehicle, GNSS, timing, now),
            sampling_of(fleet, timing, now),
        )
        reading = position_in_fault(fleet.faults.kinds, fleet, vehicle, reading, due, now * fleet.tick)
        new = Satellite(reading.north, reading.east, timing.latency * fleet.tick)
        put_satellite(fleet.vehicles, vehicle, where(due, new, nothing))
        schedule_next(fleet, vehicle, GNSS, timing, due)
    else:
        put_satellite(fleet.vehicles, vehicle, nothing)


@compiled
def sense_others(fleet: Fleet, vehicle: int, now: int) -> None:
    """Range, azimuth and elevation of every other vehicle by USBL, there only when delivered."""
    if some(get_setup(fleet.minds, vehicle).shares_sightings > 0.5):
        timing = timing_of(fleet, vehicle, USBL)
        due = timing.next_sample <= now
        for other in range(fleet.size):
            if fleet.air.asks > 0:
                hear_answer(fleet, vehicle, other, timing, now)
            else:
                hear_beacon(fleet, vehicle, other, timing, due, now)
        schedule_next(fleet, vehicle, USBL, timing, due)


@compiled
def hear_answer(fleet: Fleet, vehicle: int, other: int, timing: Timing, now: int) -> None:
    """A USBL reading from an answer that came in the last tick, valid when that was sent: range needs both ways."""
    sources, answered, latency = sources_of(fleet, vehicle), timing.latency < 0.0, 0.0 * timing.latency
    for source in range(load(sources, 0)):
        if load(sources, source + 1) == other:
            message = at(fleet.air.inbox, (vehicle * fleet.air.widest + source) * fleet.air.messages)
            ticks = now - floor(head_of(message).time_of_validity / fleet.tick + 0.5)
            answered = is_fresh(message) & (ticks < fleet.past_size)
            latency = where(answered, ticks, 0.0)
    heard_then = Timing(timing.next_sample, timing.sample, timing.period, latency, timing.noise_pairs)
    hear_beacon(fleet, vehicle, other, heard_then, answered, now)


@compiled
def hear_beacon(fleet: Fleet, vehicle: int, other: int, timing: Timing, due: bool, now: int) -> None:
    """One USBL reading, in the axes of the head; each pair of vehicles has its own noise."""
    rows = at(fleet.usbl, (vehicle * fleet.size + other) * USBL_WIDTH)
    store(rows, USBL_WIDTH - 1, NOTHING)
    due = due_in_fault(fleet.faults.kinds, fleet, vehicle, due, other, now)
    if some(due) and other != vehicle:
        here, there = vessel_then(fleet, vehicle, timing, now), vessel_then(fleet, other, timing, now)
        ahead, starboard = to_body(here.heading, there.north - here.north, there.east - here.east)
        own, others = key_of(fleet, vehicle, USBL), key_of(fleet, other, USBL)
        pair = Key(own.seed_low, own.seed_high, own.stream, own.vehicle_low, others.vehicle_low)
        baseline = Baseline(ahead, starboard, there.depth - here.depth)
        baseline = baseline_in_fault(fleet.faults.kinds, fleet, vehicle, baseline, other, now)
        reading = read_usbl(
            book_of(fleet, vehicle, fleet.tick),
            other,
            baseline,
            normals(pair, now - timing.latency),
            sampling_of(fleet, timing, now),
        )
        heard = due & (reading.range == reading.range)
        before = UsblReading(load(rows, 0), load(rows, 1), load(rows, 2))
        reading = echo_in_fault(fleet.faults.kinds, fleet, vehicle, reading, before, now * fleet.tick)
        store(rows, 0, where(heard, reading.range, load(rows, 0)))
        store(rows, 1, where(heard, reading.azimuth, load(rows, 1)))
        store(rows, 2, where(heard, reading.elevation, load(rows, 2)))
        store(rows, USBL_WIDTH - 1, where(heard, timing.latency * fleet.tick, NOTHING))
