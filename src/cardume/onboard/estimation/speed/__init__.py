"""Speed through the water, from the speed of the shafts."""

from cardume.onboard.estimation.speed.base import read_shaft, speed_law
from cardume.onboard.estimation.speed.proportional import proportional
from cardume.onboard.estimation.speed.thruster_calibration import thruster_calibration

__all__ = ["proportional", "read_shaft", "speed_law", "thruster_calibration"]
