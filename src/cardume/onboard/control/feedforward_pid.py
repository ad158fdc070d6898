"""The autopilot of a MEDUSA: heading, speed and depth; what the hull needs is fed forward, what is left is fed back."""

from typing import Annotated, NamedTuple

from cardume.compiler import where
from cardume.laws import (
    Kilograms,
    MetersPerSecond,
    NewtonMeters,
    Newtons,
    NotNegative,
    PerSecond,
    Positive,
    Probability,
    Radians,
    Seconds,
    Unit,
)
from cardume.onboard.control.base import autopilot_law
from cardume.onboard.control.depth import DepthGains, DepthState, keep_depth
from cardume.onboard.control.heading import HeadingGains, HeadingState, steer_heading
from cardume.onboard.control.speed import SpeedGains, SpeedState, drive_speed
from cardume.signals import Command, Feedback
from cardume.vehicles import medusa_data as farol

Acceleration = Annotated[float, Unit("m/s^2")]
LinearDrag = Annotated[float, Unit("N s/m")]
QuadraticDrag = Annotated[float, Unit("N s^2/m^2")]
AngularRate = Annotated[float, Unit("N m s")]

SURGE_MASS = farol.MASS + farol.SURGE_ADDED_MASS
SWAY_MASS = farol.MASS + farol.SWAY_ADDED_MASS
HEAVE_MASS = farol.MASS + farol.HEAVE_ADDED_MASS
LARGEST_FORCE = farol.THRUST_COEFFICIENT * farol.MAX_SHAFT_SPEED**2  # [N] of one thruster
THRUSTER_LAG = farol.MOTOR_DELAY + 1.0 / farol.MOTOR_POLE  # [s]


class Helm(NamedTuple):
    """What the autopilot remembers."""

    started: float = 0.0
    turn_heading: float = 0.0  # [rad]
    turn_rate: float = 0.0  # [rad/s]
    sway: float = 0.0  # [m/s]
    heading_integral: float = 0.0  # [N m]
    speed_model: float = 0.0  # [m/s]
    speed_integral: float = 0.0  # [N]
    depth: float = 0.0  # [m]
    heave: float = 0.0  # [m/s]
    heave_force: float = 0.0  # [N]
    depth_integral: float = 0.0  # [N]


@autopilot_law
def feedforward_pid(
    feedback: Feedback,
    memory: Helm,
    dt: Seconds,
    heading_gain: NotNegative[Annotated[float, Unit("N m/rad")]] = 5.0,
    yaw_rate_gain: NotNegative[AngularRate] = 4.0,
    heading_integral_gain: NotNegative[Annotated[float, Unit("N m/(rad s)")]] = 0.1,
    sway_share: Probability = 0.55,
    turn_bandwidth: Positive[PerSecond] = 0.5,
    heading_jump: Positive[Radians] = 0.14,
    speed_time_constant: Positive[Seconds] = 1.0,
    acceleration_max: Positive[Acceleration] = 0.2,
    speed_integral_gain: NotNegative[Annotated[float, Unit("N/m")]] = 1.0,
    depth_gain: NotNegative[PerSecond] = 0.25,
    heave_max: Positive[MetersPerSecond] = 0.5,
    heave_gain: NotNegative[LinearDrag] = 80.0,
    depth_integral_gain: NotNegative[Annotated[float, Unit("N/(m s)")]] = 0.3,
    heave_bandwidth: Positive[PerSecond] = 1.0,
    thrust_max: Positive[Newtons] = 2.0 * LARGEST_FORCE,
    yaw_moment_max: Positive[NewtonMeters] = 2.0 * LARGEST_FORCE * farol.THRUSTER_ARM,
    heave_force_max: Positive[Newtons] = 2.0 * LARGEST_FORCE,
    thruster_lag: NotNegative[Seconds] = THRUSTER_LAG,
    surge_mass: Positive[Kilograms] = SURGE_MASS,
    sway_mass: Positive[Kilograms] = SWAY_MASS,
    heave_mass: Positive[Kilograms] = HEAVE_MASS,
    surge_drag: NotNegative[LinearDrag] = farol.SURGE_DRAG,
    surge_drag_quadratic: NotNegative[QuadraticDrag] = farol.SURGE_DRAG_QUADRATIC,
    sway_drag: Positive[LinearDrag] = farol.SWAY_DRAG,
    sway_drag_quadratic: NotNegative[QuadraticDrag] = farol.SWAY_DRAG_QUADRATIC,
    heave_drag: NotNegative[LinearDrag] = farol.HEAVE_DRAG,
    heave_drag_quadratic: NotNegative[QuadraticDrag] = farol.HEAVE_DRAG_QUADRATIC,
    yaw_drag: NotNegative[AngularRate] = farol.YAW_DRAG,
    yaw_drag_quadratic: NotNegative[Annotated[float, Unit("N m s^2")]] = farol.YAW_DRAG_QUADRATIC,
) -> tuple[Command, Helm]:
    """Doc."""
    new = memory.started < 0.5
    surge = where(feedback.surge == feedback.surge, feedback.surge, memory.speed_model)
    moment, h = steer_heading(
        feedback,
        surge,
        HeadingState(
            where(new, feedback.reference_heading, memory.turn_heading),
            memory.turn_rate,
            memory.sway,
            memory.heading_integral,
        ),
        HeadingGains(
            heading_gain,
            yaw_rate_gain,
            heading_integral_gain,
            sway_share,
            turn_bandwidth,
            heading_jump,
            yaw_moment_max,
            surge_mass,
            sway_mass,
            sway_drag,
            sway_drag_quadratic,
            yaw_drag,
            yaw_drag_quadratic,
        ),
        dt,
    )
    thrust, s = drive_speed(
        feedback,
        SpeedState(where(new, surge, memory.speed_model), memory.speed_integral),
        SpeedGains(
            speed_time_constant,
            acceleration_max,
            speed_integral_gain,
            thrust_max,
            surge_mass,
            surge_drag,
            surge_drag_quadratic,
        ),
        dt,
    )
    depth = where(feedback.depth == feedback.depth, feedback.depth, 0.0)
    force, d = keep_depth(
        feedback,
        DepthState(
            where(new, depth, memory.depth), memory.heave, memory.heave_force, memory.depth_integral
        ),
        DepthGains(
            depth_gain,
            heave_max,
            heave_gain,
            depth_integral_gain,
            heave_bandwidth,
            heave_force_max,
            thruster_lag,
            heave_mass,
            heave_drag,
            heave_drag_quadratic,
        ),
        dt,
    )
    after = Helm(
        1.0,
        h.turn_heading,
        h.turn_rate,
        h.sway,
        h.integral,
        s.model,
        s.integral,
        d.depth,
        d.heave,
        d.force,
        d.integral,
    )
    return Command(thrust, moment, force), after
