"""One tick of the engine."""

from cardume.compiler import Rows, at, compiled, inlined, load, negate, passing, some, store, where
from cardume.onboard.agent import decide
from cardume.onboard.mind import get_progress, get_whereabouts
from cardume.onboard.phases import takes_part
from cardume.paths.projection import project
from cardume.signals import Noise, Place, VesselState, Water, Where
from cardume.simulation.air import arrived, carry, speak
from cardume.simulation.faults import clock_of, finished_in_fault, water_in_fault
from cardume.simulation.fleet import (
    NUM_SENSORS,
    NUM_STREAMS,
    Fleet,
    OnPath,
    book_of,
    get_key,
    get_on_path,
    get_reference,
    get_true_place,
    get_vessel,
    get_water,
    measured_of,
    mind_of,
    put_on_path,
    put_reference,
    put_true_place,
    put_water,
)
from cardume.simulation.motion import move
from cardume.simulation.noise import NOISE_WIDTH, noise_of_reading
from cardume.simulation.recording import record
from cardume.simulation.score import score, score_fleet
from cardume.simulation.sensing import sense
from cardume.world.currents.base import flow

FINE, STATE, CURRENT, REFERENCE, BELIEF = 0.0, 1.0, 2.0, 3.0, 4.0  # what is not a number
CODE, VEHICLE, TIME, TROUBLE_WIDTH = range(4)  # columns of Fleet.trouble


@compiled
def tick(fleet: Fleet, now: int) -> bool:
    """Vehicles sense, decide and speak; sound travels; all move.

    Args:
        fleet: the mission's tables, changed in place.
        now: [ticks] since the start of the mission.

    Returns:
        Whether any number in any lane is not one; `trouble` says which.
    """
    time = now * fleet.tick
    weather = common_noise(fleet, now)
    for i in range(fleet.size):
        truth = get_vessel(fleet.vehicles, i)
        put_water(fleet.vehicles, i, current_at(fleet, i, truth, weather, time))
        find_on_path(fleet, i, truth, time)
    for i in range(fleet.size):
        sense(fleet, i, now)
        measured, heard = measured_of(fleet, i), arrived(fleet, i, time)
        reference, said = decide(passing(mind_of(fleet, i)), measured, heard, clock_of(fleet, i, time))
        put_reference(fleet.vehicles, i, reference)
        speak(fleet, i, said, time)
    carry(fleet, time, now)  # delay, loss
    record(fleet, now)
    for i in range(fleet.size):
        score(fleet, i, get_vessel(fleet.vehicles, i), get_on_path(fleet.vehicles, i), time)
    score_fleet(fleet, time)
    for i in range(fleet.size):
        move(fleet, i, get_reference(fleet.vehicles, i), get_water(fleet.vehicles, i), time)
    return health(fleet, time)


@compiled
def common_noise(fleet: Fleet, now: int) -> Noise:
    """The randomness of the sea, the same for all vehicles."""
    key, kept = get_key(fleet.keys, fleet.size * NUM_STREAMS), at(fleet.noise, fleet.size * NUM_SENSORS * NOISE_WIDTH)
    noise = Noise(0.0 * key.stream, 0.0 * key.stream, 0.0 * key.stream, 0.0 * key.stream)
    if fleet.has_weather > 0:
        noise = noise_of_reading(kept, key, now * 1.0, 1.0, now * 1.0, 2.0 + 0.0 * key.stream)
    return noise


@compiled
def current_at(fleet: Fleet, vehicle: int, truth: VesselState, weather: Noise, time: float) -> Water:
    """The water around a vehicle."""
    place = Where(truth.north, truth.east, truth.depth, time, fleet.field)
    water = flow(book_of(fleet, vehicle, fleet.tick), 0, place, weather)
    return water_in_fault(fleet.faults.kinds, fleet, vehicle, water, time)


@compiled
def find_on_path(fleet: Fleet, vehicle: int, truth: VesselState, time: float) -> None:
    """Where a vehicle truly is on its path."""
    path: Rows = at(fleet.paths, load(fleet.path_starts, vehicle))
    error, place = project(Place(truth.north, truth.east, path), get_true_place(fleet.vehicles, vehicle))
    put_true_place(fleet.vehicles, vehicle, place)
    finished = where(error.finished > 0.5, 1.0, get_on_path(fleet.vehicles, vehicle).finished)
    if fleet.has_phases > 0:
        finished = where(takes_part(get_progress(fleet.minds, vehicle).phase), finished, 1.0)
    finished = finished_in_fault(fleet.faults.kinds, fleet, vehicle, finished, time)
    on_path = OnPath(
        error.cross_track,
        error.along_track,
        error.path_course,
        error.curvature,
        error.path_parameter,
        finished,
    )
    put_on_path(fleet.vehicles, vehicle, on_path)


@compiled
def health(fleet: Fleet, time: float) -> bool:
    """Note the first vehicle, signal and time at which a number is not one."""
    ill = load(fleet.trouble, CODE) > FINE
    total = numbers_of(fleet, 0)
    for i in range(1, fleet.size):
        total = total + numbers_of(fleet, i)
    if some(negate(total - total == 0.0)):  # x - x is 0 only for finite x
        for i in range(fleet.size):
            note_if_ill(fleet, i, time)
    return negate(some(negate(ill | (load(fleet.trouble, CODE) > FINE))))


@inlined
def numbers_of(fleet: Fleet, vehicle: int) -> float:
    """The sum of what must be a number of a vehicle, whatever its units."""
    vessel, water = get_vessel(fleet.vehicles, vehicle), get_water(fleet.vehicles, vehicle)
    reference, place = get_reference(fleet.vehicles, vehicle), get_whereabouts(fleet.minds, vehicle)
    state = vessel.north + vessel.east + vessel.depth + vessel.heading + vessel.surge + vessel.sway
    asked = reference.heading + reference.speed + reference.depth
    return state + asked + (water.north + water.east) + (place.north + place.east)


@compiled
def note_if_ill(fleet: Fleet, vehicle: int, time: float) -> None:
    """Look at one vehicle: x - x is 0 only for finite x."""
    vessel, water = get_vessel(fleet.vehicles, vehicle), get_water(fleet.vehicles, vehicle)
    reference = get_reference(fleet.vehicles, vehicle)
    place = get_whereabouts(fleet.minds, vehicle)
    state = vessel.north + vessel.east + vessel.depth + vessel.heading + vessel.surge + vessel.sway
    asked = reference.heading + reference.speed + reference.depth
    flowing, believed = water.north + water.east, place.north + place.east
    code = where(state - state == 0.0, FINE, STATE)
    code = where(asked - asked == 0.0, code, REFERENCE)
    code = where(believed - believed == 0.0, code, BELIEF)
    code = where(flowing - flowing == 0.0, code, CURRENT)
    first = (code > FINE) & (load(fleet.trouble, CODE) == FINE)
    if some(first):
        store(fleet.trouble, CODE, where(first, code, load(fleet.trouble, CODE)))
        store(fleet.trouble, VEHICLE, where(first, vehicle * 1.0, load(fleet.trouble, VEHICLE)))
        store(fleet.trouble, TIME, where(first, time, load(fleet.trouble, TIME)))
