"""Trajectory tracking: the point to be at moves on with time and waits for nobody."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import Meters, MetersPerSecond, PerSecond, Positive, RadiansPerSecond, Seconds
from cardume.onboard.guidance.base import guidance_law
from cardume.onboard.guidance.chase import Chase, chase, look_at
from cardume.signals import Demand, Motion, Pace, PathError


class Schedule(NamedTuple):
    """What the law remembers: where the vehicle should be by now."""

    started: float = 0.0  # [-] 1 once the point is on its way
    arc_length: float = 0.0  # [m]


@guidance_law
def trajectory_tracking(
    error: PathError,
    motion: Motion,
    pace: Pace,
    memory: Schedule,
    dt: Seconds,
    arm: Positive[Meters] = 1.0,
    gain_ahead: Positive[PerSecond] = 0.3,
    gain_starboard: Positive[PerSecond] = 0.3,
    correction_max: Positive[MetersPerSecond] = 0.5,
    speed_max: Positive[MetersPerSecond] = 1.0,
    yaw_rate_max: Positive[RadiansPerSecond] = 0.2,
) -> tuple[Demand, Schedule]:
    """Bring a point ahead of the vehicle onto one that is where the schedule says.

    (u, b r) = -a tanh(K e_B / a) - (0, v) - R(psi)^T V_c + R(psi)^T t v_d,   e_B = R(psi)^T (p - p_t) + (b, 0)
    s' = v_d

    `body_frame_target` with a target that does not wait: what path following is measured against. The schedule
    begins at the vehicle's reference point. Unsaturated |e_B| never grows; with an error that is small beside a / K,
    |e_B| = |e_B(0)| exp(-K t) for equal gains.

    Args:
        error: path error; of its reference point only the place counts.
        motion: believed heading [rad], sway [m/s] and current [m/s].
        pace: v_d [m/s], with what coordination adds.
        memory: s [m].
        dt: [s] tick.
        arm: [m] b > 0; the yaw rate asked for goes with 1 / b.
        gain_ahead: [1/s] K of the error ahead: how fast it is closed.
        gain_starboard: [1/s] K of the error to starboard: how fast it is closed.
        correction_max: [m/s] a, the most that an error adds to the velocity.
        speed_max: [m/s] the speed asked for is between 0 and that.
        yaw_rate_max: [rad/s] largest that is asked for, either way.

    Returns:
        Yaw rate [rad/s] and speed through the water [m/s], and the next memory.

    Source: hungrepo/path-following-Matlab, `Trajectory_tracking.m` (u_TT), which gives Vanni's thesis as its own
    (not opened); there linear in e_B, here bounded by a tanh as `body_frame_target`, for a fair comparison.
    """
    s = where(memory.started > 0.5, memory.arc_length, error.arc_length)
    how = Chase(arm, gain_ahead, gain_starboard, correction_max, speed_max, yaw_rate_max)
    quarry = look_at(error, motion, s, arm)
    return chase(quarry, motion, pace.speed, how), Schedule(1.0, s + dt * pace.speed)
