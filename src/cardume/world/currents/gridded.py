"""A current read from a file, and a variation for what the file's grid is too coarse for."""

from cardume.laws import MetersPerSecond, NotNegative, Positive, Seconds
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.grid import water_at
from cardume.world.currents.variation import Variation, vary


@current_law
def gridded(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """The file's current here and now, and around it a Gauss-Markov variation that is the same everywhere.

    V_c = V(north, east, depth, t) + x(t),   <x(t) x(t + s)> = sigma^2 exp(-|s| / T) in each of north and east

    V is bilinear in the horizontal and linear in depth and time.  It is NaN outside the grid and in its holes, which
    stops the mission.

    Args:
        place: where and when, and the table of the field.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before; the first one is drawn from the stationary distribution.
        dt: [s] tick.
        variation_sigma: [m/s] standard deviation of the variation, in each of north and east.
        variation_time_constant: [s] T, after which the variation is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: multilinear interpolation, tested against SciPy's RegularGridInterpolator; the variation as in `uniform`.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    water = water_at(place.field, place.north, place.east, place.depth, place.time)
    return Water(water.north + variation.north, water.east + variation.east), variation
