"""Chasing a point: speed and yaw rate that bring a point ahead of the vehicle onto one that moves along the path."""

from typing import NamedTuple

from cardume.compiler import compiled
from cardume.maths import clip, sincos, tanh, to_body
from cardume.paths.projection import point_at
from cardume.signals import NOTHING, Demand, Motion, PathError


class Chase(NamedTuple):
    """How hard a point is chased, and with what."""

    arm: float  # [m] from the vehicle to the point ahead of it that is steered, > 0
    gain_ahead: float  # [1/s]
    gain_starboard: float  # [1/s]
    correction_max: float  # [m/s] that an error can ask for
    speed_max: float  # [m/s]
    yaw_rate_max: float  # [rad/s]


class Quarry(NamedTuple):
    """The point that is chased, as the vehicle sees it."""

    ahead: float  # [m] of the vehicle's error: how far it, with its arm, is ahead of the point
    starboard: float  # [m] and to starboard of it
    along: float  # [m] the same along the path's course at the point
    tangent_ahead: float  # [-] direction of the path there, in the vehicle's axes
    tangent_starboard: float  # [-]


@compiled
def look_at(error: PathError, motion: Motion, arc_length: float, arm: float) -> Quarry:
    """The error of the point ahead of the vehicle, in the vehicle's axes: e_B = R(psi)^T (p - p_t) + (b, 0).

    Args:
        error: the vehicle is at its reference point, plus along_track ahead and cross_track to starboard.
        motion: its heading [rad].
        arc_length: [m] of the point that is chased, on the own path.
        arm: [m] b.
    """
    foot, target = point_at(error.path, error.arc_length), point_at(error.path, arc_length)
    north = foot.north - target.north + error.along_track * foot.cos_course - error.cross_track * foot.sin_course
    east = foot.east - target.east + error.along_track * foot.sin_course + error.cross_track * foot.cos_course
    ahead, starboard = to_body(motion.heading, north, east)
    tangent_ahead, tangent_starboard = to_body(motion.heading, target.cos_course, target.sin_course)
    ahead = ahead + arm
    return Quarry(
        ahead,
        starboard,
        ahead * tangent_ahead + starboard * tangent_starboard,
        tangent_ahead,
        tangent_starboard,
    )


@compiled
def chase(quarry: Quarry, motion: Motion, target_speed: float, how: Chase) -> Demand:
    """Speed and yaw rate that let e_B die out while the point moves on.

    (u, b r) = -a tanh(K e_B / a) - (0, v) - R(psi)^T V_c + R(psi)^T t v_d

    Args:
        quarry: the point, and e_B.
        motion: believed sway [m/s], heading [rad] and current [m/s].
        target_speed: [m/s] v_d at which the point is wanted to go along the path.
        how: arm b, gains K, a, and limits.
    """
    sine, cosine = sincos(motion.heading)
    current_ahead = cosine * motion.current_north + sine * motion.current_east
    current_starboard = cosine * motion.current_east - sine * motion.current_north
    most = how.correction_max
    speed = quarry.tangent_ahead * target_speed - most * tanh(how.gain_ahead * quarry.ahead / most) - current_ahead
    across = (
        quarry.tangent_starboard * target_speed
        - most * tanh(how.gain_starboard * quarry.starboard / most)
        - current_starboard
        - motion.sway
    )
    yaw_rate = clip(across / how.arm, -how.yaw_rate_max, how.yaw_rate_max)
    return Demand(NOTHING, NOTHING, yaw_rate, clip(speed, 0.0, how.speed_max))
