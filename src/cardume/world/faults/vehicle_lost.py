"""A vehicle without power: it asks its thrusters for nothing, keeps its depth and drifts."""

from cardume.compiler import compiled
from cardume.signals import NOTHING, Reference, VesselState


@compiled
def adrift(vessel: VesselState) -> Reference:
    """What such a vehicle follows: its own heading and depth, without speed, so that a kinematic one stops too."""
    nothing = NOTHING * vessel.heading
    return Reference(vessel.heading, vessel.heading, 0.0 * vessel.heading, vessel.depth, nothing)
