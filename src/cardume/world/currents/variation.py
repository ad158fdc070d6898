"""What varies in a current in the course of minutes: one process for the whole fleet."""

from typing import NamedTuple

from cardume.compiler import compiled, some
from cardume.maths.gauss_markov import gauss_markov
from cardume.signals import Noise

__all__ = ["Variation", "vary"]


class Variation(NamedTuple):
    """What the water does beside its mean; each vehicle remembers its own copy of the same process."""

    north: float = 0.0  # [m/s]
    east: float = 0.0  # [m/s]
    started: float = 0.0  # [-] 0 before the first tick


@compiled
def vary(memory: Variation, noise: Noise, dt: float, sigma: float, time_constant: float) -> Variation:
    """The variation in the next tick, north and east independent and each of standard deviation sigma.

    The noise of a tick is the same for all vehicles of a mission, so all of them feel the same variation.

    Args:
        memory: the variation of the tick before.
        noise: a and b drive north and east.
        dt: [s] tick.
        sigma: [m/s] standard deviation of each part; 0 gives exactly no variation.
        time_constant: [s] after which the autocorrelation has fallen to 1 / e.

    Returns:
        The variation now.
    """
    north, east = memory.north, memory.east
    if some(sigma > 0.0):
        north = gauss_markov(north, memory.started, dt, noise.a, sigma, time_constant)
        east = gauss_markov(east, memory.started, dt, noise.b, sigma, time_constant)
    return Variation(north, east, 1.0)
