"""Guidance: from the error to the path to what leads back to it.

A law gets a `PathError`, and if it asks for them the vehicle's believed `Motion` and the `Pace` at
which it is to go.  It gives the desired course over ground [rad] as a number; or a `Demand`, for a
heading, a yaw rate or a speed of its own.  It may keep a memory.
"""

from cardume.laws import law_family
from cardume.signals import Demand, Motion, Pace, PathError

guidance_law, guide = law_family("guidance", (PathError, Motion, Pace), Demand, plain="course")
