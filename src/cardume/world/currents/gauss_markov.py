"""A current that wanders about its mean: first-order Gauss-Markov along and across it."""

from cardume.laws import MetersPerSecond, NotNegative, Positive, Radians, Seconds
from cardume.maths import to_ned
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary_axes


@current_law
def gauss_markov(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    speed: NotNegative[MetersPerSecond] = 0.0,
    towards: Radians = 0.0,
    sigma_along: NotNegative[MetersPerSecond] = 0.05,
    sigma_across: NotNegative[MetersPerSecond] = 0.05,
    time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """A mean that fills all space, and a Gauss-Markov process along it and one across it.

    V_c = R(b) (speed + x(t), y(t)),   dx = -x / T dt + sigma_along sqrt(2 / T) dW,   and y alike with sigma_across

    <x(t) x(t + s)> = sigma_along^2 exp(-|s| / T): stationary from the first tick on.  A particle that it carries
    drifts, about its mean way, with the variance 2 sigma^2 T (t - T (1 - exp(-t / T))) in each direction.

    Args:
        place: not used; the current is the same everywhere.
        noise: of the mission's water, the same for all vehicles.
        memory: x and y of the tick before; the first ones are drawn from the stationary distribution.
        dt: [s] tick.
        speed: [m/s] of the mean.
        towards: [rad] b, where the mean flows to, clockwise from north; 0 makes "along" north, "across" east.
        sigma_along: [m/s] standard deviation along b.
        sigma_across: [m/s] standard deviation to starboard of b.
        time_constant: [s] T, the same for both.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: derived, the exact solution over a tick (`maths/gauss_markov.py`); closed form T
    (docs/theory/closed-forms.md).
    """
    wandered = vary_axes(memory, noise, dt, (sigma_along, sigma_across), time_constant)
    north, east = to_ned(towards, speed + wandered.north, wandered.east)
    return Water(north, east), wandered
