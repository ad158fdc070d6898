"""A current that is held back by the seabed: fast at the surface, slower the nearer to the ground."""

from cardume.compiler import where
from cardume.laws import Meters, MetersPerSecond, NotNegative, Number, Positive, Radians, Seconds
from cardume.maths import clip, exp, log, sincos
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary


@current_law
def power_law(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    speed: NotNegative[MetersPerSecond] = 0.1,
    towards: Radians = 0.0,
    seabed_depth: Positive[Meters] = 50.0,
    exponent: Positive[Number] = 1.0 / 7.0,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """A power of the height above the seabed.

    V_c = speed (1 - z / H)^a (cos b, sin b) + x(t),   0 from the seabed on

    With a = 1 it falls in a straight line, as a current that wind drives is often taken to; 1 / 7 is usual for tides.

    Args:
        place: its depth z.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before.
        dt: [s] tick.
        speed: [m/s] at the surface.
        towards: [rad] b, where it flows to, clockwise from north.
        seabed_depth: [m] H, where the current ends.
        exponent: [-] a, how fast it falls with depth; 1/7 is usual.
        variation_sigma: [m/s] standard deviation of the variation x, in each of north and east, at all depths alike.
        variation_time_constant: [s] after which x is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: DNV, Bladed manual 4.17, "Currents": sub-surface current by a power law of the height, 1 / 7 unless given;
    near-surface current linear to zero at a reference depth.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    height = clip(1.0 - place.depth / seabed_depth, 0.0, 1.0)
    above = height > 0.0
    share = where(above, exp(exponent * log(where(above, height, 1.0))), 0.0)
    sine, cosine = sincos(towards)
    along = speed * share
    return Water(along * cosine + variation.north, along * sine + variation.east), variation
