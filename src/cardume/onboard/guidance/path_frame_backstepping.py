"""Backstepping in the frame of the path: a yaw rate, from the error in position and in course."""

from typing import Annotated

from cardume.compiler import where
from cardume.laws import Bounds, NotNegative, PerSecond, Positive, Radians, RadiansPerSecond, Unit
from cardume.maths import HALF_PI, atan2, clip, cos, hypot, maximum, sin, tanh, to_ned, wrap_angle
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import NOTHING, Demand, Motion, PathError

PerMeter = Annotated[float, Unit("1/m")]
PerSquareMeter = Annotated[float, Unit("1/m^2")]
SLOWEST = 0.1  # [m/s] a vehicle at rest steers as if it went that fast


@guidance_law
def path_frame_backstepping(
    error: PathError,
    motion: Motion,
    course_gain: Positive[PerSecond] = 1.0,
    error_gain: NotNegative[PerSquareMeter] = 0.1,
    approach: Annotated[Radians, Bounds(0.0, HALF_PI)] = 0.8,
    steepness: Positive[PerMeter] = 0.2,
    yaw_rate_max: Positive[RadiansPerSecond] = 0.2,
) -> Demand:
    """Turn so that course and cross-track error go to the path's together, as their Lyapunov function falls.

    r = sat(c s' + delta' - k1 (chi_e - delta) - k2 e U (sin chi_e - sin delta) / (chi_e - delta))
    delta = -theta tanh(k e),   e' = U sin chi_e - c s' s1,   chi_e = chi - chi_p

    s' is the speed of the reference point along the path. With `reference_point: projection`, where s1 = 0 and
    s' = U cos chi_e / (1 - c e), this is the law of Micaelli and Samson; with `virtual_target`, where
    s' = U cos chi_e + target_gain s1, that of Lapierre and Soetanto. Unsaturated, (k2 e^2 + (chi_e - delta)^2) / 2
    never grows; near a line the poles are those of (s + k1) (s + U theta k) + k2 U^2.

    The sources have heading and speed through the water in the place of course chi and speed over ground U; the
    two are the same without current and sway. With them known, the law has no static error in a current, and
    needs no compensation: `crab` would turn a heading that it does not ask for, and still gives the speed.

    Args:
        error: path error; e = cross_track > 0 to starboard, s1 = along_track, c = curvature.
        motion: believed heading [rad], velocity through the water and current [m/s].
        course_gain: [1/s] k1 > 0, how fast the error of course falls.
        error_gain: [1/m^2] k2 of the cross-track error, in the rate of turn.
        approach: [rad] theta, the angle to the path far away from it.
        steepness: [1/m] k > 0, how near the path the approach bends.
        yaw_rate_max: [rad/s] limit of sat, either way.

    Returns:
        Yaw rate [rad/s], and chi_p + delta [rad], which the course is to become.

    Source: Hung et al., "A review of path following control strategies" (arXiv 2204.07319; abstract opened), by
    its toolbox hungrepo/path-following-Matlab, `PFcontrollers.m`, Method1 and Method2, which it ascribes to
    Micaelli & Samson 1993 and to Lapierre & Soetanto 2007 (neither opened); the same in farol, `Samson.cpp` and
    `Lapierre.cpp`. There the quotient is 0 / 0 at chi_e = delta, and is worked around; here it is
    cos((chi_e + delta) / 2) sinc((chi_e - delta) / 2), its value everywhere.
    """
    north, east = to_ned(motion.heading, maximum(motion.surge, SLOWEST), motion.sway)
    north, east = north + motion.current_north, east + motion.current_east
    speed, off = hypot(north, east), wrap_angle(atan2(east, north) - error.path_course)
    e, c, reference_speed = error.cross_track, error.curvature, error.path_speed * error.stretch
    bent = tanh(steepness * e)
    delta = -approach * bent
    across = speed * sin(off) - c * reference_speed * error.along_track
    delta_rate = -approach * steepness * (1.0 - bent * bent) * across
    apart = off - delta
    half = 0.5 * apart
    sinc = where(abs(half) > 1e-4, sin(half) / where(abs(half) > 1e-4, half, 1.0), 1.0 - half * half / 6.0)
    pull = error_gain * e * speed * cos(0.5 * (off + delta)) * sinc
    rate = c * reference_speed + delta_rate - course_gain * apart - pull
    return Demand(error.path_course + delta, NOTHING, clip(rate, -yaw_rate_max, yaw_rate_max), NOTHING)
