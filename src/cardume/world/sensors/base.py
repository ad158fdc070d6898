"""Sensors: from the truth of some time ago to a reading.

A law gets the true state and water at the time of validity, four standard normal numbers and the
time since the last sample; the engine keeps period and latency.
"""

from cardume.laws import sensor_family
from cardume.signals import (
    AhrsReading,
    Baseline,
    DvlReading,
    GnssReading,
    Noise,
    Sampling,
    Seabed,
    UsblReading,
    VesselState,
    Water,
)

SCENE = (VesselState, Water, Noise, Sampling)

gnss_sensor, read_gnss = sensor_family("gnss", SCENE, GnssReading)
ahrs_sensor, read_ahrs = sensor_family("ahrs", SCENE, AhrsReading)
depth_sensor, read_depth = sensor_family("depth", SCENE)
dvl_sensor, read_dvl = sensor_family("dvl", (*SCENE, Seabed), DvlReading)
thruster_speed_sensor, read_thruster_speed = sensor_family("thruster_speed", SCENE)
usbl_sensor, read_usbl = sensor_family("usbl", (Baseline, Noise, Sampling), UsblReading)
altimeter_sensor, read_altimeter = sensor_family("altimeter", (VesselState, Seabed, Noise, Sampling))
