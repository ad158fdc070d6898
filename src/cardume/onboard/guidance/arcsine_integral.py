"""Maurya's law with its integral: a drift is unlearnt, and nothing is learnt while the law is saturated."""

from typing import NamedTuple

from cardume.laws import Meters, NotNegative, PerSecond, PerSecondSquared, Positive, Radians, Seconds
from cardume.maths import asin, clip
from cardume.onboard.guidance.arcsine import SLOWEST, STEEPEST
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError


class ErrorIntegral(NamedTuple):
    """What the law remembers."""

    sum: float = 0.0  # [m s] z


@guidance_law
def arcsine_integral(
    error: PathError,
    memory: ErrorIntegral,
    dt: Seconds,
    gain: Positive[PerSecond] = 0.14,
    integral_gain: NotNegative[PerSecondSquared] = 0.01,
    anti_windup: NotNegative[Meters] = 10.0,
) -> tuple[Radians, ErrorIntegral]:
    """Make the cross-track error obey a linear equation of second order, whatever the constant drift.

    chi_d = chi_p + asin(sat(a)),   a = -(k1 e + k2 z) / u,   |sat| <= 0.99
    z' = e + ka (a - sat(a))

    Unsaturated, on a line, e'' + k1 e' + k2 e = 0; in a current V it settles at z = V / k2. Saturated, the
    second term of z' takes back what the first adds.

    Args:
        error: path error; e = cross_track > 0 to starboard, u = speed through the water.
        memory: z [m s].
        dt: [s] tick.
        gain: [1/s] k1 > 0, speed across the path over the error.
        integral_gain: [1/s^2] k2; 0 gives `arcsine`.
        anti_windup: [m] ka; 0 lets it wind up.

    Returns:
        Desired course [rad], NED, and the next memory.

    Source: farol `path_following/src/algorithms/Pramod.cpp` (zeta_dot, yaw_correction), which gives Maurya et
    al., Sensors 22(11):4293, 2022, as its own; of that paper only the abstract was opened. Its gains are
    farol's; saturated at 0.99 as `arcsine`, and the speed guarded where farol divides by zero at rest.
    """
    speed = clip(error.speed, SLOWEST, 1e9)
    wanted = -(gain * error.cross_track + integral_gain * memory.sum) / speed
    sine = clip(wanted, -STEEPEST, STEEPEST)
    rate = error.cross_track + anti_windup * (wanted - sine)
    return error.path_course + asin(sine), ErrorIntegral(memory.sum + dt * rate)
