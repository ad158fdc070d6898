"""Depth by pressure."""

from cardume.laws import Meters, NotNegative
from cardume.signals import Noise, VesselState
from cardume.world.sensors.base import depth_sensor


@depth_sensor(period=0.2)
def depth(truth: VesselState, noise: Noise, sigma: NotNegative[Meters] = 0.01, bias: Meters = 0.0) -> Meters:
    """True depth plus white noise and a constant.

    reading = z + bias + sigma n

    Args:
        truth: depth z below the surface.
        noise: a.
        sigma: [m] white noise, standard deviation.
        bias: [m] > 0 reads too deep; tide and air pressure since the sensor was zeroed give 0.1 to 0.3 m.

    Returns:
        Depth [m], positive down; noise may make it negative at the surface.

    Source: 0.01 m at 5 Hz as in IST's medusa_simulation, mred/sim.yaml (LSTS DUNE, Simulators/DepthSensor: 0.05 m).
    """
    return truth.depth + bias + sigma * noise.a
