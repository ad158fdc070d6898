"""Compensation that divides by another speed than the current observer believes in."""

from cardume.compiler import where
from cardume.maths import asin, sincos
from cardume.onboard.compensation import compensation_law
from cardume.onboard.compensation.base import Steering
from cardume.signals import Course, Motion


@compensation_law
def crab_by_true_speed(course: Course, motion: Motion) -> Steering:
    """psi_d = chi_d - asin(Vperp / u), u the speed asked for, not a u.   Source: paper eq. (36), read so."""
    sine, cosine = sincos(course.course)
    across = cosine * motion.current_east - sine * motion.current_north
    speed = where(course.speed > 0.0, course.speed, 1.0)
    return Steering(course.course - asin(across / speed), course.speed)
