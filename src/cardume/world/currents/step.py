"""A current that changes at a time, as when a vehicle leaves the lee of a headland or the tide turns."""

from cardume.compiler import where
from cardume.laws import MetersPerSecond, NotNegative, Positive, Radians, Seconds
from cardume.maths import clip, sincos
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary


@current_law
def step(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    speed: NotNegative[MetersPerSecond] = 0.0,
    towards: Radians = 0.0,
    later_speed: NotNegative[MetersPerSecond] = 0.1,
    later_towards: Radians = 0.0,
    at: NotNegative[Seconds] = 0.0,
    ramp: NotNegative[Seconds] = 0.0,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """One velocity before a time and another from then on, at once or in a straight line over a while.

    V_c = V_1 + w (V_2 - V_1) + x(t),   w = sat((t - at) / ramp) in [0, 1];  without a ramp w = 1 for t >= at

    Args:
        place: its time t.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before.
        dt: [s] tick.
        speed: [m/s] of V_1, the current before the change.
        towards: [rad] where V_1 flows to, clockwise from north.
        later_speed: [m/s] of V_2, the current after it.
        later_towards: [rad] where V_2 flows to.
        at: [s] when the change begins, since the start of the mission.
        ramp: [s] how long it takes.
        variation_sigma: [m/s] standard deviation of the variation x, in each of north and east.
        variation_time_constant: [s] after which x is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: definition; the variation as in `uniform`.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    since = place.time - at
    is_gradual = ramp > 0.0
    share = where(is_gradual, clip(since / where(is_gradual, ramp, 1.0), 0.0, 1.0), where(since >= 0.0, 1.0, 0.0))
    sine, cosine = sincos(towards)
    later_sine, later_cosine = sincos(later_towards)
    north, east = speed * cosine, speed * sine
    north = north + share * (later_speed * later_cosine - north)
    east = east + share * (later_speed * later_sine - east)
    return Water(north + variation.north, east + variation.east), variation
