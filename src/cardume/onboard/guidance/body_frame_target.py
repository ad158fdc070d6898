"""A virtual target with a speed of its own, chased in the vehicle's axes: speed and yaw rate."""

import math
from typing import Annotated, NamedTuple

from cardume.compiler import where
from cardume.laws import (
    Bounds,
    Meters,
    MetersPerSecond,
    NotNegative,
    PerSecond,
    PerSecondSquared,
    Positive,
    RadiansPerSecond,
    Seconds,
    Unit,
)
from cardume.maths import clip
from cardume.onboard.guidance.base import guidance_law
from cardume.onboard.guidance.chase import Chase, chase, look_at
from cardume.signals import Demand, Motion, Pace, PathError


class Target(NamedTuple):
    """What the law remembers: where the target is, and how fast it goes."""

    started: float = 0.0  # [-] 1 once it is on its way
    arc_length: float = 0.0  # [m]
    speed: float = 0.0  # [m/s]


@guidance_law
def body_frame_target(
    error: PathError,
    motion: Motion,
    pace: Pace,
    memory: Target,
    dt: Seconds,
    arm: Positive[Meters] = 1.0,
    gain_ahead: Positive[PerSecond] = 0.3,
    gain_starboard: Positive[PerSecond] = 0.3,
    correction_max: Positive[MetersPerSecond] = 0.5,
    target_damping: Positive[PerSecond] = 1.0,
    target_pull: NotNegative[PerSecondSquared] = 1.0,
    target_acceleration_max: Positive[Annotated[float, Unit("m/s^2")]] = 0.1,
    target_speed_min: Annotated[MetersPerSecond, Bounds(-math.inf, 0.0)] = -0.1,
    target_speed_max: Positive[MetersPerSecond] = 1.0,
    speed_max: Positive[MetersPerSecond] = 1.0,
    yaw_rate_max: Positive[RadiansPerSecond] = 0.2,
) -> tuple[Demand, Target]:
    """Bring a point ahead of the vehicle onto a target that waits for it.

    (u, b r) = -a tanh(K e_B / a) - (0, v) - R(psi)^T V_c + R(psi)^T t v_d,   e_B = R(psi)^T (p - p_t) + (b, 0)
    s'' = sat(-kz (s' - v_d) + ke t^T R(psi) e_B),   s' within its bounds

    p_t is the target, at arc length s of the vehicle's own path, t the path's tangent there; the target starts
    from rest at the vehicle's reference point. At rest e_B = 0: the vehicle is b behind the target. Unsaturated,
    with a constant v_d, (|e_B|^2 + (s' - v_d)^2 / ke) / 2 never grows. Speed and yaw rate are the law's own, past
    compensation; estimates of current and sway are in it.

    Args:
        error: path error; of its reference point only the place counts.
        motion: believed heading [rad], sway [m/s] and current [m/s].
        pace: v_d [m/s].
        memory: s [m] and s' [m/s].
        dt: [s] tick.
        arm: [m] b > 0; the yaw rate asked for goes with 1 / b.
        gain_ahead: [1/s] K of the error ahead: how fast it is closed.
        gain_starboard: [1/s] K of the error to starboard: how fast it is closed.
        correction_max: [m/s] a, the most that an error adds to the velocity.
        target_damping: [1/s] kz > 0, how fast the target takes up its speed.
        target_pull: [1/s^2] ke; 0: the target does not wait.
        target_acceleration_max: [m/s^2] limit of sat, of the target along the path.
        target_speed_min: [m/s] <= 0: how fast the target may run back to the vehicle.
        target_speed_max: [m/s] how fast it may run ahead.
        speed_max: [m/s] the speed asked for is between 0 and that.
        yaw_rate_max: [rad/s] largest that is asked for, either way.

    Returns:
        Yaw rate [rad/s] and speed through the water [m/s], and the next memory.

    Source: hungrepo/path-following-Matlab, `PFcontrollers.m`, Method6 (ud, gamma_ddot), with K within the tanh, and
    farol, `Aguiar.cpp`, with K before it; both ascribe it to Aguiar & Hespanha (IEEE TAC 52(8), 2007; not opened).
    Theirs is per path parameter; in meters of arc length their ke is the tangent's length squared.
    """
    s = where(memory.started > 0.5, memory.arc_length, error.arc_length)
    quarry = look_at(error, motion, s, arm)
    how = Chase(arm, gain_ahead, gain_starboard, correction_max, speed_max, yaw_rate_max)
    wanted = target_pull * quarry.along - target_damping * (memory.speed - pace.speed)
    speed = memory.speed + dt * clip(wanted, -target_acceleration_max, target_acceleration_max)
    speed = clip(speed, target_speed_min, target_speed_max)
    return chase(quarry, motion, pace.speed, how), Target(1.0, s + dt * speed, speed)
