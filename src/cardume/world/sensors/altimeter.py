"""Altitude above the seabed by sound."""

from cardume.compiler import where
from cardume.laws import Meters, NotNegative, Positive
from cardume.signals import NOTHING, Noise, Seabed, VesselState
from cardume.world.sensors.base import altimeter_sensor


@altimeter_sensor(period=0.2)
def altimeter(
    truth: VesselState,
    seabed: Seabed,
    noise: Noise,
    sigma: NotNegative[Meters] = 0.1,
    bias: Meters = 0.0,
    nearest: NotNegative[Meters] = 0.3,
    range: Positive[Meters] = 30.0,
) -> Meters:
    """Height above the seabed straight below, plus white noise and a constant; nothing out of reach.

    reading = (b - z) + bias + sigma n   where nearest <= b - z <= range

    Args:
        truth: depth z below the surface.
        seabed: its depth b below the vehicle.
        noise: a.
        sigma: [m] white noise, standard deviation.
        bias: [m] > 0 reads too high.
        nearest: [m] below it the echo comes while the transducer still rings.
        range: [m] above it no echo is heard.

    Returns:
        Altitude [m], NaN without an echo.

    Source: 0.1 m at 5 Hz and 30 m of reach as in IST's medusa_simulation, myellow/sim.yaml (ALT; DVL_BT).
        The vehicle does not roll or pitch, so the beam is straight down.
    """
    altitude = seabed.depth - truth.depth
    is_heard = (altitude >= nearest) & (altitude <= range)
    return where(is_heard, altitude + bias + sigma * noise.a, NOTHING)
