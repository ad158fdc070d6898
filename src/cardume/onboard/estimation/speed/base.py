"""Speed through the water, from the speed of the shafts.

A law gets a `ShaftReading` and gives the surge [m/s].  Its parameters stand in the mission file
under `sensors.thruster_speed`: it is how the reading of that sensor is read.
"""

from cardume.laws import law_family
from cardume.signals import ShaftReading

speed_law, read_shaft = law_family("speed", (ShaftReading,))
