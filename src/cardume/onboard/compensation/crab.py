"""Crab: turn the heading into the current so that the course is the wanted one."""

from typing import Annotated

from cardume.compiler import some
from cardume.laws import Bounds, MetersPerSecond, Number, Positive
from cardume.maths import asin, clip, maximum, sincos, sqrt
from cardume.onboard.compensation.base import Steering, compensation_law
from cardume.signals import Course, Motion

LIMIT = 0.98  # of a right angle's sine: still 20 % of the speed along the course


@compensation_law
def crab(
    course: Course,
    motion: Motion,
    use_sway: Annotated[Number, Bounds(0.0, 1.0)] = 0.0,
    speed_min: Positive[MetersPerSecond] = 0.1,
) -> Steering:
    """Cancel the current across the wanted course by the heading, and along it by the speed.

    psi_d = chi_d - asin(Vperp / U) - atan2(v, u),   U = hypot(u, v)
    u_d = sqrt((v_d - Vpar)^2 + Vperp^2 - v^2)  over ground;  u_d = v_d  through the water

    Vpar and Vperp are the estimated current along and to starboard of the course, u and v surge and
    sway.  The printed sign of eq. (36) doubles the drift instead of cancelling it.  Feasible where
    |Vperp| < U; beyond 0.98 U the heading stays at 79 deg to the course.

    Args:
        course: wanted course [rad] and speed [m/s] along it.
        motion: believed motion; the same, possibly biased, speed that the current observer uses.
        use_sway: [-] 1 counts the sway v in, 0 leaves it out as the paper does (v = 0). With `bottom_track` u and v
            are over ground, v is the current's, and 1 is how the heading learns of it.
        speed_min: [m/s] the least U in the quotient, for a vehicle that starts from rest.

    Returns:
        Heading [rad], never wrapped away from the course, and speed through the water [m/s].

    Source: paper eqs. (35), (36), sign corrected.
    """
    sine, cosine = sincos(course.course)
    along = cosine * motion.current_north + sine * motion.current_east
    across = cosine * motion.current_east - sine * motion.current_north
    sway = use_sway * motion.sway
    speed = clip(sqrt(motion.surge * motion.surge + sway * sway), speed_min, 1e9)
    heading = course.course - asin(clip(across / speed, -LIMIT, LIMIT))
    if some(use_sway > 0.0):
        heading = heading - asin(clip(sway / speed, -LIMIT, LIMIT))  # atan2(v, u) ahead, and quiet at rest
    needed = course.speed - along
    through_water = sqrt(maximum(needed * needed + across * across - sway * sway, 0.0))
    return Steering(heading, course.speed + course.over_ground * (through_water - course.speed))
