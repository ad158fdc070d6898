"""What varies in a current in the course of minutes: one process for the whole fleet."""

from typing import NamedTuple

from cardume.compiler import compiled, some
from cardume.maths.gauss_markov import gauss_markov
from cardume.signals import Noise

__all__ = ["Variation", "vary", "vary_axes"]


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
    return vary_axes(memory, noise, dt, (sigma, sigma), time_constant)


@compiled
def vary_axes(
    memory: Variation, noise: Noise, dt: float, sigmas: tuple[float, float], time_constant: float
) -> Variation:
    """The same with a standard deviation for each of two axes, which need not be north and east.

    Args:
        memory: the variation of the tick before.
        noise: a and b drive the first and the second axis.
        dt: [s] tick.
        sigmas: [m/s] standard deviations; 0 gives exactly no variation.
        time_constant: [s] after which the autocorrelation has fallen to 1 / e.

    Returns:
        The variation now, the first axis where `north` is and the second where `east` is.
    """
    first, second = memory.north, memory.east
    if some((sigmas[0] > 0.0) | (sigmas[1] > 0.0)):
        first = gauss_markov(first, memory.started, dt, noise.a, sigmas[0], time_constant)
        second = gauss_markov(second, memory.started, dt, noise.b, sigmas[1], time_constant)
    return Variation(first, second, 1.0)
