"""Ekman's spiral: a current that wind drives, weaker and turned further with depth."""

from cardume.laws import Meters, MetersPerSecond, NotNegative, Positive, Radians, Seconds
from cardume.maths import exp, sincos
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary


@current_law
def ekman(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    speed: NotNegative[MetersPerSecond] = 0.1,
    towards: Radians = 0.0,
    turning_depth: Positive[Meters] = 15.0,
    turn: Radians = 1.0,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """The steady drift under a steady wind in deep water, with the same eddy viscosity at all depths.

    V_c = speed exp(-z / D) (cos(b + turn z / D), sin(b + turn z / D)) + x(t),   D = sqrt(2 K / f)

    It solves K V'' = f k x V, k upwards, f the Coriolis parameter and K the eddy viscosity, for turn = 1 rad (northern
    hemisphere) and -1 rad (southern); its surface current flows 45 deg to the right, or left, of the wind.

    Args:
        place: its depth z.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before.
        dt: [s] tick.
        speed: [m/s] at the surface.
        towards: [rad] b, where it flows to at the surface, clockwise from north.
        turning_depth: [m] D, at which it has fallen to 1 / e; pi D is the depth where it flows against the surface.
        turn: [rad] from the surface to D, > 0 clockwise; 0: it fades without turning.
        variation_sigma: [m/s] standard deviation of the variation x, in each of north and east, at all depths alike.
        variation_time_constant: [s] after which x is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: V. W. Ekman (1905); derived here from the equation above, which a test holds it to.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    deep = place.depth / turning_depth
    sine, cosine = sincos(towards + turn * deep)
    along = speed * exp(-deep)
    return Water(along * cosine + variation.north, along * sine + variation.east), variation
