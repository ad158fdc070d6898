"""No compensation: the heading is the wanted course."""

from cardume.onboard.compensation.base import Steering, compensation_law
from cardume.signals import Course


@compensation_law
def none(course: Course) -> Steering:
    """Head along the wanted course, at the wanted speed, whatever the current does.

    psi_d = chi_d,  u_d = v_d

    Args:
        course: wanted course [rad] and speed [m/s].

    Returns:
        Heading [rad] and speed through the water [m/s].

    Source: paper section 2, before compensation.
    """
    return Steering(course.course, course.speed)
