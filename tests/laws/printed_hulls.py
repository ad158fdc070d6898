"""Equations of motion of the paper's proofs, moved as if they were vehicles."""

from cardume.laws import Meters, MetersPerSecond, Number, Positive, Seconds
from cardume.maths import cos, hypot, sqrt
from cardume.signals import Reference, VesselState, Water
from cardume.vehicles.base import vehicle_model


@vehicle_model
def radial_of_21(
    vessel: VesselState,
    reference: Reference,
    water: Water,
    dt: Seconds,
    radius: Positive[Meters] = 12.0,
    lookahead: Positive[Meters] = 5.0,
    speed: Positive[MetersPerSecond] = 0.5,
    printed: Number = 1.0,
) -> VesselState:
    """A point that moves straight to or from north = east = 0 as (21) says rho changes under law (18).

    printed:    rho' = -(u rho - R cos(d / R)) / D,   D = sqrt(R^2 + rho^2 - 2 R rho cos(d / R))
    corrected:  rho' = -u (rho - R cos(d / R)) / D

    Args:
        vessel: state before the step.
        reference: not looked at.
        water: not looked at.
        dt: [s] plant step.
        radius: [m] R.
        lookahead: [m] d.
        speed: [m/s] u.
        printed: [-] 1: the parenthesis as it is printed; 0: where it belongs.

    Returns:
        The state after an Euler step.

    Source: paper eq. (21) as printed, and corrected.
    """
    rho = hypot(vessel.north, vessel.east)
    inner = radius * cos(lookahead / radius)
    distance = sqrt(radius * radius + rho * rho - 2.0 * rho * inner)
    share = speed + printed * (1.0 - speed)  # of R cos(d / R): u, or 1 where the parenthesis is lost
    grown = 1.0 - dt * (speed * rho - share * inner) / (distance * rho)
    return VesselState(
        vessel.north * grown, vessel.east * grown, 0.0, vessel.heading, speed, 0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0
    )
