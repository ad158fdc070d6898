"""How fast the thrusters turn."""

from cardume.laws import NotNegative, Number, RadiansPerSecond
from cardume.signals import Noise, VesselState
from cardume.world.sensors.base import thruster_speed_sensor


@thruster_speed_sensor(period=0.1)
def thruster_speed(truth: VesselState, noise: Noise, sigma: NotNegative[Number] = 0.005) -> RadiansPerSecond:
    """True shaft speed with noise in proportion to it.

    reading = n (1 + sigma w)

    A wrong speed scale, a of eq. (38), belongs to the calibration that turns the reading into a speed.

    Args:
        truth: mean speed n of the horizontal thrusters' shafts.
        noise: a is w.
        sigma: [-] white noise relative to the shaft speed; 0.005 is our estimate for the speed feedback of a
            brushless motor.

    Returns:
        Shaft speed [rad/s].

    Source: paper eq. (37), whose input it is; the noise is ours.
    """
    return truth.shaft_speed * (1.0 + sigma * noise.a)
