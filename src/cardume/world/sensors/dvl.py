"""Velocity through the water by Doppler log."""

from cardume.laws import MetersPerSecond, NotNegative, Number, Positive
from cardume.signals import DvlReading, Noise, VesselState
from cardume.world.sensors.base import dvl_sensor


@dvl_sensor(period=0.5)
def dvl(
    truth: VesselState,
    noise: Noise,
    sigma: NotNegative[MetersPerSecond] = 0.004,
    scale: Positive[Number] = 1.0,
) -> DvlReading:
    """True velocity through the water (water track), scaled, plus white noise.

    reading = scale (u, v) + sigma (n_1, n_2)

    The layer of water that a real log listens to lies a few meters below the vehicle; here it moves with the water
    around the vehicle.

    Args:
        truth: surge u and sway v through the water, body.
        noise: a for surge, b for sway.
        sigma: [m/s] white noise of each.
        scale: [-] 1 is exact; a wrong sound speed or beam angle gives 0.1 to 1 %.

    Returns:
        Surge and sway [m/s] through the water, body.

    Source: 0.004 m/s is the default of LSTS DUNE, Simulators/DVL, "Standard Deviation - Water Velocity".
    """
    return DvlReading(scale * truth.surge + sigma * noise.a, scale * truth.sway + sigma * noise.b)
