"""Depth loop: a wanted heave in proportion to the depth error, and the force that makes it."""

from typing import NamedTuple

from cardume.compiler import compiled, where
from cardume.maths import clip
from cardume.signals import Feedback
from cardume.vehicles.hull import drag

NEAR, AWAY = 0.05, 1.0  # [m] the integral works on errors between these; less is inside the thrusters' dead zone
INTEGRAL_SHARE = 0.5  # [-] of the largest force that the integral may take: enough for a badly trimmed vehicle


class DepthGains(NamedTuple):
    """How fast to dive, and what is known of the hull and its thrusters."""

    gain: float  # [1/s]
    heave_max: float  # [m/s]
    heave_gain: float  # [N s/m]
    integral_gain: float  # [N/m] per plant step
    bandwidth: float  # [1/s] of the heave observer
    force_max: float  # [N]
    delivered: float  # [-] share of a change of force that the thrusters deliver within a plant step
    per_mass: float  # [1/kg] of one with added mass
    drag: float  # [N s/m]
    drag_quadratic: float  # [N s^2/m^2]


class DepthState(NamedTuple):
    """What the depth loop remembers."""

    depth: float  # [m] estimate
    heave: float  # [m/s] estimate
    force: float  # [N] as the thrusters should deliver it now
    integral: float  # [N]


@compiled
def keep_depth(feedback: Feedback, state: DepthState, gains: DepthGains, dt: float) -> tuple[float, DepthState]:
    """Heave force for the wanted depth.

    w_d = sat(k (z_ref - z)),   Z = kw (w_d - w) + (d + D |w_d|) w_d + s,   s' = ks (z_ref - z)

    z and w come from an observer driven by measured depth, because differences of a depth sensor are
    mostly noise:  z' = w + 2 b (z_m - z),   m_w w' = Z_delivered - (d + D |w|) w + m_w b^2 (z_m - z).

    Args:
        feedback: depth, measured; the wanted depth. Without a measurement (NaN) there is no force.
        state: what the loop remembers.
        gains: of the loop.
        dt: [s] plant step.

    Returns:
        The force [N], down, and the next state.
    """
    knows = feedback.depth == feedback.depth
    error = feedback.reference_depth - state.depth
    wanted_heave = clip(gains.gain * error, -gains.heave_max, gains.heave_max)
    wanted = (
        gains.heave_gain * (wanted_heave - state.heave)
        + drag(wanted_heave, gains.drag, gains.drag_quadratic)
        + state.integral
    )
    force = where(knows, clip(wanted, -gains.force_max, gains.force_max), 0.0)
    works = knows & (abs(error) > NEAR) & (abs(error) < AWAY)
    integral = state.integral + where(works, gains.integral_gain * error, 0.0)
    limit = INTEGRAL_SHARE * gains.force_max

    miss = where(knows, feedback.depth - state.depth, 0.0)
    b = gains.bandwidth
    acceleration = (state.force - drag(state.heave, gains.drag, gains.drag_quadratic)) * gains.per_mass
    return force, DepthState(
        state.depth + dt * (state.heave + 2.0 * b * miss),
        state.heave + dt * (acceleration + b * b * miss),
        state.force + (force - state.force) * gains.delivered,
        clip(integral, -limit, limit),
    )
