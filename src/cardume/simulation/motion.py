"""Motion: autopilots steer and hulls move, at the plant step, between two ticks."""

from cardume.compiler import compiled, where
from cardume.onboard.control.base import steer
from cardume.onboard.mind import get_speed
from cardume.signals import Feedback, Reference, Water
from cardume.simulation.faults import command_in_fault, held_aboard, reference_in_fault
from cardume.simulation.fleet import (
    Fleet,
    Held,
    book_of,
    get_held,
    put_command,
    put_vessel,
    view_vessel,
)
from cardume.vehicles.base import step_vehicle


@compiled
def move(fleet: Fleet, vehicle: int, reference: Reference, water: Water, time: float) -> None:
    """Let one vehicle follow its reference for one tick, in the water around it.

    Between ticks the autopilot sees the measured values of the tick, carried on by the measured rates.
    """
    dt = fleet.tick / fleet.substeps
    book = book_of(fleet, vehicle, dt)
    held = get_held(fleet.vehicles, vehicle)
    held = held_aboard(fleet.faults.kinds, fleet, vehicle, held)
    reference = reference_in_fault(fleet.faults.kinds, fleet, vehicle, reference, time)
    surge = get_speed(fleet.minds, vehicle).surge
    for step in range(fleet.substeps):
        command = steer(book, 0, feedback_of(held, surge, reference, step * dt))
        command = command_in_fault(fleet.faults.kinds, fleet, vehicle, command, time)
        vessel = step_vehicle(book, 0, view_vessel(fleet.vehicles, vehicle), command, reference, water)
        put_vessel(fleet.vehicles, vehicle, vessel)
        put_command(fleet.vehicles, vehicle, command)


@compiled
def feedback_of(held: Held, surge: float, reference: Reference, ahead: float) -> Feedback:
    """What the autopilot sees some time after the tick.

    Args:
        held: what the sensors said in the tick.
        surge: [m/s] believed.
        reference: what is asked of it.
        ahead: [s] since the tick.
    """
    yaw_rate = where(held.yaw_rate == held.yaw_rate, held.yaw_rate, 0.0)
    return Feedback(
        held.heading + yaw_rate * ahead,
        yaw_rate,
        surge,
        held.depth,
        reference.heading,
        reference.speed,
        reference.depth,
        reference.yaw_rate,
    )
