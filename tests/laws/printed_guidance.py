"""Guidance and compensation as the paper prints them, where that is wrong or incomplete."""

from cardume.compiler import where
from cardume.laws import Meters, PerSecond, Positive, Radians
from cardume.maths import asin, atan2, clip, sincos
from cardume.onboard.compensation.base import Steering, compensation_law
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import Course, Motion, PathError


@guidance_law
def error_of_19(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    """Line of sight (3) with the error of (19), rho - R, instead of the distance to starboard.

    chi_d = chi_p + atan(-(rho - R) / d),   rho - R = -sigma e

    Args:
        error: path error; on a line sigma is taken for 1.
        lookahead: [m] d > 0.

    Returns:
        Desired course [rad].

    Source: paper eqs. (3) and (19), signs mixed; right only where the path turns to port.
    """
    radial = where(error.curvature < 0.0, error.cross_track, -error.cross_track)
    return error.path_course + atan2(-radial, lookahead)


@guidance_law
def arcsine_to_one(error: PathError, gain: Positive[PerSecond] = 0.1) -> Radians:
    """Maurya's law with its saturation where it is printed, at one.

    chi_d = chi_p + asin(sat(-k1 e / u)),   |sat| <= 1

    Args:
        error: path error.
        gain: [1/s] k1 > 0.

    Returns:
        Desired course [rad].

    Source: paper eq. (4) as printed.
    """
    return error.path_course + asin(clip(-gain * error.cross_track / error.speed, -1.0, 1.0))


@compensation_law
def crab_of_36(course: Course, motion: Motion) -> Steering:
    """Turn the heading with the current instead of into it.

    psi_d = chi_d + asin(Vperp / u),   u_d = v_d

    Args:
        course: wanted course [rad] and speed through the water [m/s].
        motion: believed surge and current [m/s].

    Returns:
        Heading [rad] and speed through the water [m/s].

    Source: paper eq. (36) as printed, born in the sign of (35).
    """
    sine, cosine = sincos(course.course)
    across = cosine * motion.current_east - sine * motion.current_north
    return Steering(course.course + asin(clip(across / motion.surge, -1.0, 1.0)), course.speed)
