"""A current that is the same everywhere, and may vary in the course of minutes."""

from typing import Annotated

from cardume.laws import MetersPerSecond, NotNegative, Once, Positive, Radians, Seconds
from cardume.maths import sincos
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary


def mean_flow(dt: Seconds, speed: NotNegative[MetersPerSecond] = 0.0, towards: Radians = 0.0) -> Water:
    """The mean, which does not change during a mission.

    Args:
        dt: [s] tick; not used.
        speed: [m/s] of the mean.
        towards: [rad] where the mean flows to, clockwise from north.
    """
    s, c = sincos(towards)
    return Water(speed * c, speed * s)


@current_law
def uniform(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    mean: Annotated[Water, Once(mean_flow)],
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """A mean that fills all space, and around it a Gauss-Markov variation that is the same everywhere.

    V_c = speed (cos towards, sin towards) + x(t),   <x(t) x(t + s)> = sigma^2 exp(-|s| / T) in each of north and east

    A particle carried by the variation alone drifts, in each direction and over a time t, by
    sqrt(2 sigma^2 T (t - T (1 - exp(-t / T)))) RMS: 2.73 m in 60 s for 0.05 m/s and 100 s.

    Args:
        place: not used; the current is the same everywhere.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before; the first one is drawn from the stationary distribution.
        dt: [s] tick.
        mean: of the parameters that `mean_flow` names.
        variation_sigma: [m/s] standard deviation of the variation, in each of north and east.
        variation_time_constant: [s] T, after which the variation is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: derived; the exact solution of dx = -x / T dt + sigma sqrt(2 / T) dW over a tick, tested by its
    autocovariance and by the drift above.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    return Water(mean.north + variation.north, mean.east + variation.east), variation
