"""The autopilot of a MEDUSA: heading, speed and depth; what the hull needs is fed forward, what is left is fed back."""

from typing import Annotated, NamedTuple

from cardume.compiler import where
from cardume.laws import (
    Kilograms,
    MetersPerSecond,
    NewtonMeters,
    Newtons,
    NotNegative,
    Once,
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
YawRateGain = Annotated[float, Unit("N m s")]

SURGE_MASS = farol.MASS + farol.SURGE_ADDED_MASS
SWAY_MASS = farol.MASS + farol.SWAY_ADDED_MASS
HEAVE_MASS = farol.MASS + farol.HEAVE_ADDED_MASS
LARGEST_FORCE = farol.THRUST_COEFFICIENT * farol.MAX_SHAFT_SPEED**2  # [N] of one thruster
THRUSTER_LAG = farol.MOTOR_DELAY + 1.0 / farol.MOTOR_POLE  # [s]


class Helm(NamedTuple):
    """What the autopilot remembers."""

    started: float = 0.0  # [-] 1 after the first step
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


class Pilot(NamedTuple):
    """What does not change about the autopilot during a mission."""

    heading: HeadingGains
    speed: SpeedGains
    depth: DepthGains


def pilot_of(
    dt: Seconds,
    heading_gain: NotNegative[Annotated[float, Unit("N m/rad")]] = 5.0,
    yaw_rate_gain: NotNegative[YawRateGain] = 4.0,
    heading_integral_gain: NotNegative[Annotated[float, Unit("N m/(rad s)")]] = 0.1,
    sway_share: Probability = 0.55,
    turn_bandwidth: Positive[PerSecond] = 0.5,
    heading_jump: Positive[Radians] = 0.14,
    speed_bandwidth: Positive[PerSecond] = 1.0,
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
    yaw_drag: NotNegative[YawRateGain] = farol.YAW_DRAG,
    yaw_drag_quadratic: NotNegative[Annotated[float, Unit("N m s^2")]] = farol.YAW_DRAG_QUADRATIC,
) -> Pilot:
    """What does not change about the autopilot during a mission, from the parameters that a mission may set.

    Args:
        dt: [s] plant step.
        heading_gain: [N m/rad] kp at rest.
        yaw_rate_gain: [N m s] kd at rest.
        heading_integral_gain: [N m/(rad s)] of s, against thrusters that are not alike.
        sway_share: [-] of the Munk moment that the estimate of sway cancels.
        turn_bandwidth: [1/s] of the filter that finds z.
        heading_jump: [rad] a larger change of the reference says nothing about turning.
        speed_bandwidth: [1/s] b, how fast the speed model follows the reference.
        acceleration_max: [m/s^2] of the speed model.
        speed_integral_gain: [N/m] of s, against drag that is not as believed.
        depth_gain: [1/s] k, heave asked for, over the error of depth.
        heave_max: [m/s] largest heave w_d that is asked for, either way.
        heave_gain: [N s/m] kw, force over the error of heave.
        depth_integral_gain: [N/(m s)] of s, against a vehicle that is not trimmed.
        heave_bandwidth: [1/s] of the observer of heave.
        thrust_max: [N] largest that is commanded, either way.
        yaw_moment_max: [N m] largest that is commanded, either way.
        heave_force_max: [N] largest that is commanded, either way.
        thruster_lag: [s] delay and lag together, for the observer of heave.
        surge_mass: [kg] m_u, with added mass, as the autopilot believes it; so with all that follow.
        sway_mass: [kg] m_v, with added mass in sway.
        heave_mass: [kg] m_w, with added mass in heave.
        surge_drag: [N s/m] d in surge, linear.
        surge_drag_quadratic: [N s^2/m^2] D in surge, quadratic.
        sway_drag: [N s/m] Y, linear in sway.
        sway_drag_quadratic: [N s^2/m^2] D in sway, quadratic.
        heave_drag: [N s/m] d in heave, linear.
        heave_drag_quadratic: [N s^2/m^2] D in heave, quadratic.
        yaw_drag: [N m s] N_r, linear in yaw.
        yaw_drag_quadratic: [N m s^2] D in yaw, quadratic.
    """
    return Pilot(
        HeadingGains(
            heading_gain,
            yaw_rate_gain,
            heading_integral_gain * dt,
            sway_share * (sway_mass - surge_mass),
            (1.0 - sway_share) * (sway_mass - surge_mass) * (-surge_mass / sway_drag),
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
        SpeedGains(
            speed_bandwidth,
            acceleration_max,
            speed_integral_gain * dt,
            thrust_max,
            surge_mass,
            surge_drag,
            surge_drag_quadratic,
        ),
        DepthGains(
            depth_gain,
            heave_max,
            heave_gain,
            depth_integral_gain * dt,
            heave_bandwidth,
            heave_force_max,
            dt / (thruster_lag + dt),
            1.0 / heave_mass,
            heave_drag,
            heave_drag_quadratic,
        ),
    )


@autopilot_law
def feedforward_pid(
    feedback: Feedback,
    memory: Helm,
    dt: Seconds,
    pilot: Annotated[Pilot, Once(pilot_of)],
) -> tuple[Command, Helm]:
    """Yaw moment, thrust and heave force of a MEDUSA, by three loops that know its hull.

    N = kp(u) (psi_ref - psi) + kd(u) (z - r) + N_turn(z, u) + share (m_v - m_u) u v + s   (`steer_heading`)
    X = m_u u_m' + (d + D |u_m|) u_m + s,   u_m' = sat(b (u_ref - u_m))                    (`drive_speed`)
    Z = kw (w_d - w) + (d + D |w_d|) w_d + s,   w_d = sat(k (z_ref - z))                   (`keep_depth`)

    Heading. A command takes 0.345 s and a lag of 0.139 s to act, and above 0.68 m/s the hull does not keep
    its course by itself: the Munk moment (m_u - m_v) u v, with the sway of a turn v = -m_u u r / Y, beats the
    yaw drag where (m_v - m_u) m_u u^2 / Y > N_r. With these gains heading and yaw rate alone
    stabilize it to 1.1 m/s; with an estimate of sway, which cancels about half that moment, to 1.2 m/s and more. Linear
    analysis, 0.42 s of pure delay and the motor's pole in the loop: the slowest pole is at -0.84, -1.03, -0.78,
    -0.61, -0.52 1/s and the largest sensitivity 1.7, 1.8, 1.9, 2.2, 2.8 at 0.15, 0.5, 0.7, 1.0, 1.2 m/s. On an
    arc the lag is made up by z, how fast the reference turns; 6 degrees of noise, a new draw every second,
    move the moment by 0.5 N m.

    Measured with `medusa`, plant step 0.05 s, tick 0.1 s, surge from `thruster_calibration`: a heading step of
    90 degrees overshoots by < 2 % and is within 5 % after 4.5 s at 0.15, 5.9 s at 0.5, 7.1 s at 0.7, 10.2 s at
    1.2 m/s; lag on an arc of R = 12 m at 0.5 m/s 0.02 s (0.05 degrees), at its beginning 4 degrees for some
    seconds; speed 0 to 0.5 m/s in 4.3 s without overshoot; depth 0 to 10 m in 25 s, 0.06 m too far.

    Args:
        feedback: measured heading, yaw rate, surge and depth, and what is wanted. NaN where nothing is known.
        memory: of the three loops; they start at the measured speed and depth.
        dt: [s] plant step.
        pilot: the rest, of the parameters that `pilot_of` names.

    Returns:
        Thrust [N], yaw moment [N m], heave force [N], each within its limits, and the next memory.

    Source: own design for the inner loops that the paper assumes; the numbers of the hull from farol, see
    `medusa_data`. Farol's and the real vehicles' own gains are not used: their units are not stated.
    """
    new = memory.started < 0.5
    surge = where(feedback.surge == feedback.surge, feedback.surge, memory.speed_model)
    turn_heading = where(new, feedback.reference_heading, memory.turn_heading)
    turning = HeadingState(turn_heading, memory.turn_rate, memory.sway, memory.heading_integral)
    moment, h = steer_heading(feedback, surge, turning, pilot.heading, dt)
    driving = SpeedState(where(new, surge, memory.speed_model), memory.speed_integral)
    thrust, s = drive_speed(feedback, driving, pilot.speed, dt)
    depth = where(new, where(feedback.depth == feedback.depth, feedback.depth, 0.0), memory.depth)
    diving = DepthState(depth, memory.heave, memory.heave_force, memory.depth_integral)
    force, d = keep_depth(feedback, diving, pilot.depth, dt)
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
