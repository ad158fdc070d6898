"""How fast the thrusters turn."""

from cardume.laws import NotNegative, Number, Positive, RadiansPerSecond
from cardume.signals import Noise, VesselState
from cardume.world.sensors.base import thruster_speed_sensor


@thruster_speed_sensor(period=0.1)
def thruster_speed(
    truth: VesselState, noise: Noise, scale: Positive[Number] = 1.0, sigma: NotNegative[Number] = 0.005
) -> RadiansPerSecond:
    """True shaft speed, scaled, with noise in proportion to it.

    reading = n (a + sigma w)

    Speed through the water is inferred from this reading by a calibration that is linear in it, so a scale a makes the
    vehicle believe a times its true speed.

    Args:
        truth: mean speed n of the horizontal thrusters' shafts.
        noise: a is w.
        scale: [-] a; 1 is exact.
        sigma: [-] white noise relative to the shaft speed; 0.005 is our estimate for the speed feedback of a
            brushless motor.

    Returns:
        Shaft speed [rad/s].

    Source: paper eqs. (37) and (38), where a is the speed scale.
    """
    return truth.shaft_speed * (scale + sigma * noise.a)
