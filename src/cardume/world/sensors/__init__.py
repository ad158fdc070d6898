"""Sensors: `gnss`, `ahrs`, `depth`, `usbl`, `dvl`, `thruster_speed`, `altimeter`, each a family with a law of its name.

`dvl`, which is water track, stands beside `bottom_track`.

With all its sigmas, biases and misalignments 0 and its scales 1 a law returns the truth, to the last bit wherever no
angle has to be computed.
"""

from cardume.world.sensors.ahrs import ahrs
from cardume.world.sensors.altimeter import altimeter
from cardume.world.sensors.base import (
    ahrs_sensor,
    altimeter_sensor,
    depth_sensor,
    dvl_sensor,
    gnss_sensor,
    read_ahrs,
    read_altimeter,
    read_depth,
    read_dvl,
    read_gnss,
    read_thruster_speed,
    read_usbl,
    thruster_speed_sensor,
    usbl_sensor,
)
from cardume.world.sensors.bottom_track import bottom_track
from cardume.world.sensors.depth import depth
from cardume.world.sensors.dvl import dvl
from cardume.world.sensors.gnss import gnss
from cardume.world.sensors.thruster_speed import thruster_speed
from cardume.world.sensors.usbl import usbl

__all__ = [
    "ahrs",
    "ahrs_sensor",
    "altimeter",
    "altimeter_sensor",
    "bottom_track",
    "depth",
    "depth_sensor",
    "dvl",
    "dvl_sensor",
    "gnss",
    "gnss_sensor",
    "read_ahrs",
    "read_altimeter",
    "read_depth",
    "read_dvl",
    "read_gnss",
    "read_thruster_speed",
    "read_usbl",
    "thruster_speed",
    "thruster_speed_sensor",
    "usbl",
    "usbl_sensor",
]
