"""A tidal current: its tip goes round an ellipse once a tide."""

from cardume.laws import MetersPerSecond, NotNegative, Positive, Radians, Seconds
from cardume.maths import sincos, to_ned
from cardume.signals import Noise, Water, Where
from cardume.world.currents.base import current_law
from cardume.world.currents.variation import Variation, vary

M2_PERIOD = 44714.16  # [s] of the principal lunar tide, 360 deg / (28.984104 deg/h)
TURN = 6.283185307179586  # [rad]


@current_law
def tidal(
    place: Where,
    noise: Noise,
    memory: Variation,
    dt: Seconds,
    speed: NotNegative[MetersPerSecond] = 0.2,
    towards: Radians = 0.0,
    across_speed: MetersPerSecond = 0.0,
    period: Positive[Seconds] = M2_PERIOD,
    phase: Radians = 0.0,
    mean_speed: NotNegative[MetersPerSecond] = 0.0,
    mean_towards: Radians = 0.0,
    variation_sigma: NotNegative[MetersPerSecond] = 0.0,
    variation_time_constant: Positive[Seconds] = 100.0,
) -> tuple[Water, Variation]:
    """One tidal constituent and a mean, the same everywhere.

    V_c = V_0 + R(b) (v cos(w t + phase), m sin(w t + phase)) + x(t),   w = 2 pi / T

    Args:
        place: its time t, since the start of the mission.
        noise: of the mission's water, the same for all vehicles.
        memory: the variation of the tick before.
        dt: [s] tick.
        speed: [m/s] v, the largest of the tide; with phase 0 the mission starts with it.
        towards: [rad] b, where it flows to then, clockwise from north; half a period later the other way.
        across_speed: [m/s] m, when it turns; > 0 turns clockwise seen from above, < 0 the other way, 0 there and back.
        period: [s] T; the default is the principal lunar tide.
        phase: [rad] of the tide when the mission starts; a quarter turn starts with the slack.
        mean_speed: [m/s] of the residual current V_0.
        mean_towards: [rad] where V_0 flows to.
        variation_sigma: [m/s] standard deviation of the variation x, in each of north and east.
        variation_time_constant: [s] after which x is another.

    Returns:
        Velocity of the water [m/s] and the next memory.

    Source: definition of a tidal ellipse; speed of M2 28.984104 deg/h.
    """
    variation = vary(memory, noise, dt, variation_sigma, variation_time_constant)
    sine, cosine = sincos(TURN * place.time / period + phase)
    north, east = to_ned(towards, speed * cosine, across_speed * sine)
    sine, cosine = sincos(mean_towards)
    north, east = north + mean_speed * cosine, east + mean_speed * sine
    return Water(north + variation.north, east + variation.east), variation
