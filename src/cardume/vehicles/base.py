"""Vehicle models: one plant step.

A model gets the true `VesselState`, the `Command` of its autopilot, the `Reference` (a kinematic
model follows it at once) and the `Water` around it, and gives the state one plant step later.
"""

from cardume.laws import law_family
from cardume.signals import Command, Reference, VesselState, Water

vehicle_model, step_vehicle = law_family("model", (VesselState, Command, Reference, Water), VesselState)
