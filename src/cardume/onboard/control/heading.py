"""Heading loop: feedback of heading, yaw rate and estimated sway, scheduled with speed, and the moment a turn needs."""

from typing import NamedTuple

from cardume.compiler import compiled, negate, where
from cardume.maths import clip, wrap_angle
from cardume.signals import Feedback
from cardume.vehicles.hull import drag, sway_step

# How the gains change with speed: see `feedforward_pid`.
SOFTENING = 1.0 / 0.9**2  # [s^2/m^2] the heading gain is halved at 0.9 m/s
STIFFENING = 1.0 / 1.4**2  # [s^2/m^2] the yaw-rate gain is doubled at 1.4 m/s
SMALL_ERROR = (
    0.05  # [rad] the integral counts no error as larger; held beyond it, it would wander with a noisy reference
)
INTEGRAL_SHARE = 0.2  # [-] of the largest moment that the integral may take


class HeadingGains(NamedTuple):
    """How hard to steer, and what is known of the hull."""

    gain: float  # [N m/rad] at rest
    rate_gain: float  # [N m s] at rest
    integral_gain: float  # [N m/rad] per plant step
    munk: float  # [kg] share of the Munk moment that the estimated sway cancels, times m_v - m_u
    turning: float  # [kg s] what is left of it in a steady turn, per u^2 z: -(1 - share) (m_v - m_u) m_u / Y
    turn_bandwidth: float  # [1/s]
    jump: float  # [rad]
    moment_max: float  # [N m]
    surge_mass: float  # [kg]
    sway_mass: float  # [kg]
    sway_drag: float  # [N s/m]
    sway_drag_quadratic: float  # [N s^2/m^2]
    yaw_drag: float  # [N m s]
    yaw_drag_quadratic: float  # [N m s^2]


class HeadingState(NamedTuple):
    """What the heading loop remembers."""

    turn_heading: float  # [rad] tracking filter of the reference
    turn_rate: float  # [rad/s] and its rate
    sway: float  # [m/s] estimate
    integral: float  # [N m]


@compiled
def track_turn(
    heading: float, rate: float, reference: float, bandwidth: float, jump: float, dt: float
) -> tuple[float, float]:
    """How fast the reference turns: a second-order filter that follows ramps without lag.

    psi_f' = z + 2 b (psi_ref - psi_f),   z' = b^2 (psi_ref - psi_f)

    A reference further off than `jump` is a new direction, which tells nothing about turning: the
    filter goes there at once and keeps its rate.

    Args:
        heading: [rad] psi_f.
        rate: [rad/s] z.
        reference: [rad] psi_ref.
        bandwidth: [1/s] b > 0.
        jump: [rad] > 0.
        dt: [s] plant step.

    Returns:
        The next psi_f [rad] and z [rad/s].
    """
    ahead = wrap_angle(reference - heading)
    jumped = abs(ahead) > jump
    followed = where(jumped, 0.0, ahead)
    moved = where(jumped, ahead, dt * (rate + 2.0 * bandwidth * followed))
    return heading + moved, rate + dt * bandwidth * bandwidth * followed


@compiled
def turning_moment(rate: float, surge: float, gains: HeadingGains) -> float:
    """Moment that holds a turn: drag, less what is left of the Munk moment.

    N = (d + D |z|) z - (1 - share) (m_v - m_u) m_u u^2 z / Y,   Y the linear sway drag

    Args:
        rate: [rad/s] z.
        surge: [m/s] u.
        gains: of the loop.

    Returns:
        The moment [N m].
    """
    return drag(rate, gains.yaw_drag, gains.yaw_drag_quadratic) + gains.turning * (surge * surge * rate)


@compiled
def steer_heading(
    feedback: Feedback, surge: float, state: HeadingState, gains: HeadingGains, dt: float
) -> tuple[float, HeadingState]:
    """Yaw moment for the wanted heading.

    N = kp(u) (psi_ref - psi) + kd(u) (z - r) + N_turn(z, u) + share (m_v - m_u) u v + s
    kp(u) = kp / (1 + (u / 0.9)^2),   kd(u) = kd (1 + (u / 1.4)^2)

    z is how fast the reference turns (`track_turn`), v the estimated sway, s the integral. Where a yaw rate
    is wanted instead of a heading it is z, and no error of the heading counts.

    Args:
        feedback: heading and yaw rate, measured; the wanted heading. NaN counts as no error.
        surge: [m/s] u, as believed.
        state: what the loop remembers.
        gains: of the loop.
        dt: [s] plant step.

    Returns:
        The moment [N m] and the next state.
    """
    heading, rate = track_turn(
        state.turn_heading, state.turn_rate, feedback.reference_heading, gains.turn_bandwidth, gains.jump, dt
    )
    turns = feedback.reference_yaw_rate == feedback.reference_yaw_rate
    rate = where(turns, feedback.reference_yaw_rate, rate)
    knows = (feedback.heading == feedback.heading) & (feedback.yaw_rate == feedback.yaw_rate)
    error = where(knows & negate(turns), wrap_angle(feedback.reference_heading - feedback.heading), 0.0)
    yaw_rate = where(knows, feedback.yaw_rate, rate)
    surge_squared = surge * surge
    munk = gains.munk * surge * state.sway
    wanted = (
        gains.gain * error / (1.0 + SOFTENING * surge_squared)
        + gains.rate_gain * (1.0 + STIFFENING * surge_squared) * (rate - yaw_rate)
        + turning_moment(rate, surge, gains)
        + munk
        + state.integral
    )
    small = where(abs(wanted) < gains.moment_max, clip(error, -SMALL_ERROR, SMALL_ERROR), 0.0)
    integral = state.integral + gains.integral_gain * small
    sway = sway_step(
        state.sway,
        surge,
        yaw_rate,
        gains.surge_mass,
        gains.sway_mass,
        gains.sway_drag,
        gains.sway_drag_quadratic,
        dt,
    )
    limit = INTEGRAL_SHARE * gains.moment_max
    moment = clip(wanted, -gains.moment_max, gains.moment_max)
    return moment, HeadingState(heading, rate, sway, clip(integral, -limit, limit))
