"""Speed loop: the thrust that makes a speed model's acceleration and carries its drag, and a slow integral."""

from typing import NamedTuple

from cardume.compiler import compiled, where
from cardume.maths import clip
from cardume.signals import Feedback
from cardume.vehicles.hull import drag

UNSETTLED = 1.0 / 0.02**2  # [s^2/m^2] the integral works at half its gain with the model 0.02 m/s from what is asked
INTEGRAL_SHARE = 0.2  # [-] of the largest thrust that the integral may take


class SpeedGains(NamedTuple):
    """How fast to change speed, and what is known of the hull."""

    bandwidth: float  # [1/s]
    acceleration_max: float  # [m/s^2]
    integral_gain: float  # [N s/m] per plant step
    thrust_max: float  # [N]
    mass: float  # [kg] with added mass
    drag: float  # [N s/m]
    drag_quadratic: float  # [N s^2/m^2]


class SpeedState(NamedTuple):
    """What the speed loop remembers."""

    model: float  # [m/s] where the speed should be by now
    integral: float  # [N]


@compiled
def drive_speed(feedback: Feedback, state: SpeedState, gains: SpeedGains, dt: float) -> tuple[float, SpeedState]:
    """Thrust for the wanted speed.

    u_m' = sat(b (u_ref - u_m)),   X = m_u u_m' + (d + D |u_m|) u_m + s,   s' = k (u_ref - u) near u_m = u_ref

    There is no proportional term: speed read from the shafts (37) is but the thrust of the moment,
    so feeding it back would take away the very thrust that accelerates the vehicle.

    Args:
        feedback: surge through the water, measured; the wanted speed. NaN counts as no error.
        state: what the loop remembers.
        gains: of the loop.
        dt: [s] plant step.

    Returns:
        The thrust [N] and the next state.
    """
    ahead = feedback.reference_speed - state.model
    acceleration = clip(gains.bandwidth * ahead, -gains.acceleration_max, gains.acceleration_max)
    wanted = gains.mass * acceleration + drag(state.model, gains.drag, gains.drag_quadratic) + state.integral
    thrust = clip(wanted, -gains.thrust_max, gains.thrust_max)
    error = feedback.reference_speed - feedback.surge
    share = 1.0 / (1.0 + UNSETTLED * (ahead * ahead))
    works = (thrust == wanted) & (error == error)
    integral = state.integral + where(works, gains.integral_gain * share * error, 0.0)
    limit = INTEGRAL_SHARE * gains.thrust_max
    return thrust, SpeedState(state.model + dt * acceleration, clip(integral, -limit, limit))
