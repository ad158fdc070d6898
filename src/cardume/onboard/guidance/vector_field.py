"""Vector field: from far away at a fixed angle, bending onto the path near it."""

from math import pi
from typing import Annotated

from cardume.laws import Bounds, Meters, Positive, Radians
from cardume.maths import HALF_PI, atan
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError


@guidance_law
def vector_field(
    error: PathError,
    approach: Annotated[Radians, Bounds(0.0, HALF_PI, low_open=True)] = 1.2,
    width: Positive[Meters] = 5.0,
) -> Radians:
    """Follow a field of courses that lead onto the path.

    chi_d = chi_p - (2 / pi) chi_inf atan(e / w)

    With chi_inf = pi / 2 and w = d it is `line_of_sight`; a smaller chi_inf keeps more of the speed along the
    path on a long approach.

    Args:
        error: path error; e = cross_track > 0 to starboard, chi_p = path_course.
        approach: [rad] chi_inf, the angle to the path far away from it.
        width: [m] w > 0, the distance at which half of it is left; 1 / k of the source.

    Returns:
        Desired course [rad], NED.

    Source: Nelson, Barber, McLain & Beard, IEEE Trans. Robotics 23(3), 2007, the field of a straight line;
    only its abstract was opened, the equation is as commonly quoted. Here on curves too, with the path's course.
    """
    return error.path_course - 2.0 / pi * approach * atan(error.cross_track / width)
