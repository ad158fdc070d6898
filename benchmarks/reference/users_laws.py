"""The guidance law of the reference workload as two users write it: for lanes, and with an `if`, which has no lanes."""

from cardume.laws import Meters, Positive, Radians
from cardume.maths import HALF_PI, atan2
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError


@guidance_law
def for_lanes(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    """Steer for the point one lookahead ahead on the tangent: chi_d = chi_p + atan(-e / d).

    Args:
        error: path error.
        lookahead: [m] d.

    Returns:
        The desired course [rad].

    Source: paper eq. (3).
    """
    return error.path_course + atan2(-error.cross_track, lookahead)


@guidance_law
def with_an_if(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    """The same, which far from the path steers straight for it.

    chi_d = chi_p - sign(e) pi / 2 where |e| > 50 d, else chi_p + atan(-e / d)

    Args:
        error: path error.
        lookahead: [m] d.

    Returns:
        The desired course [rad].

    Source: paper eq. (3).
    """
    if error.cross_track > 50.0 * lookahead:
        return error.path_course - HALF_PI
    if error.cross_track < -50.0 * lookahead:
        return error.path_course + HALF_PI
    return error.path_course + atan2(-error.cross_track, lookahead)
