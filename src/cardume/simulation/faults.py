"""Faults in a mission: where what goes wrong meets sensors, water, messages and hulls.

A mission without faults is flown by an engine that was compiled without them: see `optional`.
"""

from typing import Any

from cardume.compiler import Rows, at, compiled, floor, load, negate, optional, some, store, where
from cardume.maths.random import Key, uniforms
from cardume.onboard.mind import (
    FLAG,
    HEAD,
    get_setup,
    get_trusted,
    head_of,
    put_head,
    put_seen,
    sighting_in,
)
from cardume.signals import (
    NOTHING,
    AhrsReading,
    Baseline,
    Command,
    DvlReading,
    GnssReading,
    Reference,
    UsblReading,
    Water,
)
from cardume.simulation.fleet import (
    AHRS,
    DVL,
    FAULT_COLUMNS,
    GNSS,
    KIND,
    SENSOR,
    USBL,
    WHOM,
    Fleet,
    Held,
    get_attitude,
    get_fault,
    get_fault_key,
    get_kept,
    get_on_path,
    get_velocity,
    get_vessel,
    get_weakness,
    put_kept,
    sources_of,
)
from cardume.world.faults import (
    BIASED,
    BLANK,
    FORGED,
    FROZEN,
    LOST,
    OUTLIER,
    REPLAYED,
    SILENT,
    STIRRED,
    WEAK,
    Kept,
    adrift,
    beats,
    displaced,
    forged_report,
    forged_sighting,
    is_active,
    shifted,
    stirred,
    weakened,
)

CLOCK_COLUMNS = 5  # vehicle, begin, end, offset, drift


@compiled
def regards(fleet: Fleet, fault: int, kind: int, vehicle: int) -> bool:
    """Whether a fault is of a kind and happens to a vehicle, or to all."""
    columns = at(fleet.faults.kinds, fault * FAULT_COLUMNS)
    whom = load(columns, WHOM)
    return load(columns, KIND) == kind and (whom == vehicle or whom < 0)


@compiled
def is_faulty(fleet: Fleet, kind: int, vehicle: int, time: float) -> bool:
    """Whether a vehicle has a fault of a kind at a time [s], in each lane."""
    rows = fleet.faults.rows
    ill = 0.0 * get_fault(rows, 0).begin
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, kind, vehicle):
            ill = where(is_active(get_fault(rows, fault), time), 1.0, ill)
    return ill > 0.5


# ---- the sea, clocks and hulls ---------------------------------------------------------------------------------------


@optional(otherwise="water")
@compiled
def water_in_fault(fleet: Fleet, vehicle: int, water: Water, time: float) -> Water:
    """The water around a vehicle, with all steps in it."""
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, STIRRED, vehicle):
            row = get_fault(fleet.faults.rows, fault)
            water = stirred(water, row.size, row.more, is_active(row, time))
    return water


@compiled
def clock_of(fleet: Fleet, vehicle: int, time: float) -> float:
    """What the clock aboard a vehicle says [s]; it is the same in all lanes.

    Args:
        fleet: the mission.
        vehicle: which.
        time: [s] true.
    """
    return wrong_clock(fleet.faults.kinds, fleet, vehicle, time)


@optional(otherwise="time")
@compiled
def wrong_clock(fleet: Fleet, vehicle: int, time: float) -> float:
    """What a clock says [s] that may have faults.

    Args:
        fleet: the mission.
        vehicle: which.
        time: [s] true.
    """
    said = time
    for k in range(fleet.faults.num_clocks):
        clock = at(fleet.faults.clocks, k * CLOCK_COLUMNS)
        if load(clock, 0) == vehicle and load(clock, 1) <= time and time < load(clock, 2):
            said = said + shifted(time, load(clock, 1), load(clock, 3), load(clock, 4)) - time
    return said


@optional(otherwise="reference")
@compiled
def reference_in_fault(fleet: Fleet, vehicle: int, reference: Reference, time: float) -> Reference:
    """What a hull follows: the reference, or nothing where the vehicle is lost."""
    return where(is_faulty(fleet, LOST, vehicle, time), adrift(get_vessel(fleet.vehicles, vehicle)), reference)


@optional(otherwise="held")
@compiled
def held_aboard(fleet: Fleet, vehicle: int, held: Held) -> Held:
    """The measured values that the autopilot goes by: those that the vehicle trusts."""
    trusted = get_trusted(fleet.minds, vehicle)
    return Held(
        trusted.heading,
        trusted.yaw_rate,
        held.roll,
        held.pitch,
        trusted.depth,
        held.shaft_speed,
        held.dvl_surge,
        held.dvl_sway,
        held.altitude,
    )


@optional(otherwise="command")
@compiled
def command_in_fault(fleet: Fleet, vehicle: int, command: Command, time: float) -> Command:
    """The command that thrusters make of the autopilot's; none where the vehicle is lost."""
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, WEAK, vehicle):
            weak, row = get_weakness(fleet.faults.rows, fault), get_fault(fleet.faults.rows, fault)
            command = where(is_active(row, time), weakened(command, weak), command)
    nothing = 0.0 * command.thrust
    return where(is_faulty(fleet, LOST, vehicle, time), Command(nothing, nothing, nothing), command)


# ---- sensors ---------------------------------------------------------------------------------------------------------


@compiled
def bias_of(fleet: Fleet, vehicle: int, sensor: int, time: float) -> tuple[float, float]:
    """What is added to the first numbers of a sensor's readings, in their units [any].

    Args:
        fleet: the mission.
        vehicle: which.
        sensor: which of SENSORS.
        time: [s]
    """
    first, second = 0.0 * get_fault(fleet.faults.rows, 0).begin, 0.0 * get_fault(fleet.faults.rows, 0).begin
    for fault in range(fleet.faults.num):
        if (
            regards(fleet, fault, BIASED, vehicle)
            and load(fleet.faults.kinds, fault * FAULT_COLUMNS + SENSOR) == sensor
        ):
            row = get_fault(fleet.faults.rows, fault)
            active = is_active(row, time)
            first, second = first + where(active, row.size, 0.0), second + where(active, row.more, 0.0)
    return first, second


@compiled
def tainted(fleet: Fleet, vehicle: int, sensor: int, reading: Any, before: Any, nothing: Any, time: float) -> Any:
    """A reading, or the one before while the sensor is frozen, or nothing while it says that.

    Args:
        fleet: the mission.
        vehicle: which.
        sensor: which of SENSORS.
        reading: as it would be.
        before: as it was.
        nothing: the record without numbers.
        time: [s]
    """
    for fault in range(fleet.faults.num):
        if load(fleet.faults.kinds, fault * FAULT_COLUMNS + SENSOR) == sensor:
            active = is_active(get_fault(fleet.faults.rows, fault), time)
            if regards(fleet, fault, FROZEN, vehicle):
                reading = where(active, before, reading)
            if regards(fleet, fault, BLANK, vehicle):
                reading = where(active, nothing, reading)
    return reading


@optional(otherwise="reading")
@compiled
def attitude_in_fault(fleet: Fleet, vehicle: int, reading: AhrsReading, time: float) -> AhrsReading:
    """What the AHRS says."""
    bias, _ = bias_of(fleet, vehicle, AHRS, time)
    biased = AhrsReading(reading.heading + bias, reading.yaw_rate, reading.roll, reading.pitch)
    none = NOTHING * bias
    before = get_attitude(fleet.vehicles, vehicle)
    return tainted(fleet, vehicle, AHRS, biased, before, AhrsReading(none, none, none, none), time)


@optional(otherwise="reading")
@compiled
def number_in_fault(fleet: Fleet, vehicle: int, reading: float, sensor: int, before: float, time: float) -> float:
    """What a sensor of one number says [any].

    Args:
        fleet: the mission.
        vehicle: which.
        reading: [any] as it would be.
        sensor: which of SENSORS.
        before: [any] as it was.
        time: [s]
    """
    bias, _ = bias_of(fleet, vehicle, sensor, time)
    return tainted(fleet, vehicle, sensor, reading + bias, before, NOTHING * bias, time)


@optional(otherwise="reading")
@compiled
def velocity_in_fault(fleet: Fleet, vehicle: int, reading: DvlReading, time: float) -> DvlReading:
    """What the DVL says."""
    bias, _ = bias_of(fleet, vehicle, DVL, time)
    biased, none = DvlReading(reading.surge + bias, reading.sway), NOTHING * bias
    return tainted(fleet, vehicle, DVL, biased, get_velocity(fleet.vehicles, vehicle), DvlReading(none, none), time)


@optional(otherwise="reading")
@compiled
def position_in_fault(fleet: Fleet, vehicle: int, reading: GnssReading, due: bool, time: float) -> GnssReading:
    """What the GNSS says; frozen, it repeats the last position before.

    Args:
        fleet: the mission.
        vehicle: which.
        reading: as it would be.
        due: [-] whether there is one, in each lane.
        time: [s]
    """
    north, east = bias_of(fleet, vehicle, GNSS, time)
    reading, none = GnssReading(reading.north + north, reading.east + east), NOTHING * north
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, FROZEN, vehicle) and load(fleet.faults.kinds, fault * FAULT_COLUMNS + SENSOR) == GNSS:
            active, kept = is_active(get_fault(fleet.faults.rows, fault), time), get_kept(fleet.faults.rows, fault)
            new = Kept(reading.north, reading.east)
            put_kept(fleet.faults.rows, fault, where(due & negate(active), new, kept))
            reading = where(active, GnssReading(kept.first, kept.second), reading)
    return tainted(fleet, vehicle, GNSS, reading, reading, GnssReading(none, none), time)


@optional(otherwise="baseline")
@compiled
def baseline_in_fault(fleet: Fleet, vehicle: int, baseline: Baseline, other: int, now: int) -> Baseline:
    """From where a USBL head hears another vehicle.

    Args:
        fleet: the mission.
        vehicle: with the head.
        baseline: to another one.
        other: which.
        now: [ticks]
    """
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, OUTLIER, vehicle):
            row = get_fault(fleet.faults.rows, fault)
            draw, turns, _, _ = uniforms(key_between(fleet, fault, other), now)
            happens = is_active(row, now * fleet.tick) & (draw < row.chance)
            baseline = displaced(baseline, row.size, happens, turns)
    return baseline


@compiled
def key_between(fleet: Fleet, fault: int, other: int) -> Key:
    """The random numbers of a fault where it concerns one more vehicle."""
    key = get_fault_key(fleet.faults.rows, fault)
    return Key(key.seed_low, key.seed_high, key.stream, key.vehicle_low, key.vehicle_high + 1.0 * other)


@optional(otherwise="due")
@compiled
def due_in_fault(fleet: Fleet, vehicle: int, due: bool, other: int, now: int) -> bool:
    """Whether a USBL reading of another vehicle is due: not while the modem of either is silent.

    Args:
        fleet: the mission.
        vehicle: with the head.
        due: [-] whether it would be, in each lane.
        other: who would answer.
        now: [ticks]
    """
    time = now * fleet.tick
    return due & negate(is_faulty(fleet, SILENT, vehicle, time) | is_faulty(fleet, SILENT, other, time))


@optional(otherwise="reading")
@compiled
def echo_in_fault(fleet: Fleet, vehicle: int, reading: UsblReading, before: UsblReading, time: float) -> UsblReading:
    """What a USBL head says of a vehicle."""
    more, turned = bias_of(fleet, vehicle, USBL, time)
    biased, none = UsblReading(reading.range + more, reading.azimuth + turned, reading.elevation), NOTHING * more
    return tainted(fleet, vehicle, USBL, biased, before, UsblReading(none, none, none), time)


# ---- packets ---------------------------------------------------------------------------------------------------------


@optional(otherwise="sending")
@compiled
def sending_in_fault(fleet: Fleet, sender: int, sending: float, time: float) -> float:
    """Whether a vehicle sends [-]: not while its modem is silent.

    Args:
        fleet: the mission.
        sender: which vehicle.
        sending: [-] 1 where it would.
        time: [s]
    """
    return where(is_faulty(fleet, SILENT, sender, time), 0.0, sending)


@optional(otherwise="delivered")
@compiled
def delivered_in_fault(fleet: Fleet, listener: int, delivered: bool, arrival: float) -> bool:
    """Whether a message is delivered: not where it arrives while the listener's modem is silent.

    Args:
        fleet: the mission.
        listener: which vehicle.
        delivered: [-] whether it would be, in each lane.
        arrival: [s] when.
    """
    return delivered & negate(is_faulty(fleet, SILENT, listener, arrival))


@optional(otherwise="message")
@compiled
def record_packet(fleet: Fleet, sender: int, message: Rows, sends: bool, time: float) -> Rows:
    """Let whoever will replay a vehicle's packets record one that it sends; the last before the fault is kept.

    Args:
        fleet: the mission.
        sender: who speaks.
        message: (message,) what it says.
        sends: [-] whether it does, in each lane.
        time: [s]
    """
    width = fleet.air.messages
    for fault in range(fleet.faults.num):
        if regards(fleet, fault, REPLAYED, sender):
            recorded = at(fleet.faults.recordings, fault * width)
            hears = sends & negate(is_active(get_fault(fleet.faults.rows, fault), time))
            for k in range(1, width):
                store(recorded, k, where(hears, load(message, k), load(recorded, k)))
    return message


@optional(otherwise="time")
@compiled
def intrude(fleet: Fleet, listener: int, time: float) -> float:
    """Put forged and replayed packets into a listener's inbox, those that it takes for genuine, by a time [s]."""
    sources, deaf = sources_of(fleet, listener), is_faulty(fleet, SILENT, listener, time)
    for source in range(load(sources, 0)):
        sender = load(sources, source + 1)
        message = at(fleet.air.inbox, (listener * fleet.air.widest + source) * fleet.air.messages)
        for fault in range(fleet.faults.num):
            is_forged = regards(fleet, fault, FORGED, sender)
            if is_forged or regards(fleet, fault, REPLAYED, sender):
                row, kept = get_fault(fleet.faults.rows, fault), get_kept(fleet.faults.rows, fault)
                draw, _, _, _ = uniforms(key_between(fleet, fault, listener), floor(time / fleet.tick + 0.5))
                comes = beats(row, time, fleet.tick) & negate(deaf)
                taken = comes & (draw < row.chance)
                count = Kept(kept.first + where(comes, 1.0, 0.0), kept.second + where(taken, 1.0, 0.0))
                put_kept(fleet.faults.rows, fault, count)
                if some(taken) and is_forged:
                    forge(fleet, sender, message, row.size, taken, time)
                if some(taken) and negate(is_forged):
                    replay(fleet, fault, message, taken)
    return time


@compiled
def forge(fleet: Fleet, sender: int, message: Any, size: float, taken: bool, time: float) -> None:
    """Write a forged packet over what was last heard of a vehicle.

    Args:
        fleet: the mission.
        sender: in whose name.
        message: (message,) the listener's inbox.
        size: [m] by which it tells everything wrong.
        taken: [-] whether it is, in each lane.
        time: [s]
    """
    heard = head_of(message)
    told = forged_report(heard, time, get_on_path(fleet.vehicles, sender).coordination_state + size)
    put_head(at(message, 1), 0, where(taken, told, heard))
    tells = taken & (get_setup(fleet.minds, sender).shares_sightings > 0.5)
    for other in range(fleet.size):
        seen, vessel = sighting_in(message, other), get_vessel(fleet.vehicles, other)
        state = get_on_path(fleet.vehicles, other).coordination_state + size
        put_seen(at(message, HEAD), other, where(tells, forged_sighting(seen, vessel, state, time, size), seen))
    store(message, FLAG, where(taken, 1.0, load(message, FLAG)))


@compiled
def replay(fleet: Fleet, fault: int, message: Any, taken: bool) -> None:
    """Let a recorded packet be heard again, unless a genuine one came in this very tick.

    Args:
        fleet: the mission.
        fault: whose recording it is.
        message: (message,) the listener's inbox.
        taken: [-] whether it is taken for genuine, in each lane.
    """
    recorded = at(fleet.faults.recordings, fault * fleet.air.messages)
    sequence = head_of(recorded).sequence
    heard = taken & (load(message, FLAG) < 0.5) & (sequence == sequence)
    for k in range(1, fleet.air.messages):
        store(message, k, where(heard, load(recorded, k), load(message, k)))
    store(message, FLAG, where(heard, 1.0, load(message, FLAG)))


@optional(otherwise="finished")
@compiled
def finished_in_fault(fleet: Fleet, vehicle: int, finished: float, time: float) -> float:
    """Whether a vehicle's path counts as finished [-]: a lost one's does.

    Args:
        fleet: the mission.
        vehicle: which.
        finished: [-] 1 when it is at its end.
        time: [s]
    """
    return where(is_faulty(fleet, LOST, vehicle, time), 1.0, finished)
