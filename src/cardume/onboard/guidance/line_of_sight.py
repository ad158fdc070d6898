"""Line of sight: steer for a point on the tangent, one lookahead ahead."""

from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan2
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError


@guidance_law
def line_of_sight(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    """Steer for the point on the path's tangent one lookahead ahead of the projection.

    chi_d = chi_p + atan(-e / d)

    Converges from anywhere on a line, and inside the centre on an arc; with speed u the error obeys
    e' = -u e / sqrt(d^2 + e^2) on lines and arcs alike.

    Args:
        error: path error; e = cross_track > 0 to starboard, chi_p = path_course.
        lookahead: [m] d > 0, how far ahead on the tangent it looks.

    Returns:
        Desired course [rad], NED.

    Source: paper eq. (3), with the starboard e.
    """
    return error.path_course + atan2(-error.cross_track, lookahead)
