"""Line of sight along the path: steer for a point on the path itself."""

from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan2, wrap_angle
from cardume.onboard.guidance.base import guidance_law
from cardume.paths.projection import point_at
from cardume.signals import PathError


@guidance_law
def along_path(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    """Steer for the point on the path one lookahead of arc length ahead of the projection.

    chi_d = bearing from the vehicle to p(s + d)

    On a line this is `line_of_sight`.  On an arc of radius R it settles at
    rho - R = -R (1 - cos(d / R)), inside the arc, and needs d / R < pi / 2: beyond that the aim lies
    past the centre and the vehicle is drawn into it.

    Args:
        error: path error; the vehicle is at the projection plus cross_track to starboard.
        lookahead: [m] d > 0 along the path.

    Returns:
        Desired course [rad], NED.

    Source: paper eqs. (14)-(18).
    """
    foot = point_at(error.path, error.arc_length)
    aim = point_at(error.path, error.arc_length + lookahead)
    north = aim.north - foot.north + error.cross_track * foot.sin_course
    east = aim.east - foot.east - error.cross_track * foot.cos_course
    return error.path_course + wrap_angle(atan2(east, north) - error.path_course)
