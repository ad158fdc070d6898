"""A current given at a few depths, linear between them."""

from cardume.laws import MetersPerSecond, NotNegative, Number, Positive, Seconds
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.profile import flow_at
from cardume.world.currents.variation import Variation, vary


@current_law
def sheared(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    scale: NotNegative[Number] = 1.0,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """A profile of velocities by depth, the same everywhere in the horizontal.

    V_c = scale (V_k + (z - z_k) / (z_k+1 - z_k) (V_k+1 - V_k)) + x(t)  between the points k and k + 1 of the profile

    Above the first and below the last point the nearest one counts.  A mission gives the points as
    `profile: [{depth: 0 m, speed: 0.3 m/s, towards: 60 deg}, ...]`.

    Args:
        place: its depth z, and the table of the profile.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before.
        dt: [s] tick.
        scale: [-] factor on the whole profile, for studies.
        variation_sigma: [m/s] standard deviation of the variation x, in each of north and east, at all depths alike.
        variation_time_constant: [s] after which x is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: definition, linear interpolation; the variation as in `uniform`.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    flow = flow_at(place.field, place.depth)
    return Water(scale * flow.north + variation.north, scale * flow.east + variation.east), variation
