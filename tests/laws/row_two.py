"""The truth of closed form II: a current that wanders, a velocity that shakes, and fixes that get lost."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import Meters, MetersPerSecond, NotNegative, Number, Seconds
from cardume.maths import sqrt
from cardume.signals import NOTHING, GnssReading, Noise, VesselState, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.sensors.base import gnss_sensor


class Walk(NamedTuple):
    """How far the current has wandered."""

    north: float = 0.0  # [m/s]
    east: float = 0.0  # [m/s]


@current_law
def shaking(
    place: Where,
    noise: Noise,
    memory: Walk,
    dt: Seconds,
    north: MetersPerSecond = 0.1,
    east: MetersPerSecond = 0.1,
    velocity_noise: NotNegative[Number] = 1e-3,
    current_noise: NotNegative[Number] = 1e-6,
) -> tuple[Water, Walk]:
    """V_c + white(q_v), V_c' = white(q_c): constant over a tick, so that both are exact at its ends."""
    shake, step = sqrt(velocity_noise / dt), sqrt(current_noise * dt)
    now = Water(north + memory.north + shake * noise.a, east + memory.east + shake * noise.b)
    return now, Walk(memory.north + step * noise.c, memory.east + step * noise.d)


@gnss_sensor(period=5.0, latency=1.0)
def lossy(truth: VesselState, noise: Noise, sigma: NotNegative[Meters] = 1.0, lost_above: Number = 9.0) -> GnssReading:
    """White fixes, of which those are lost whose third normal draw is above a number."""
    is_lost = noise.c > lost_above
    return GnssReading(
        where(is_lost, NOTHING, truth.north + sigma * noise.a), where(is_lost, NOTHING, truth.east + sigma * noise.b)
    )
