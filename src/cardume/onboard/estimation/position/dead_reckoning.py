"""Dead reckoning over one tick."""

from cardume.compiler import compiled
from cardume.maths import to_ned
from cardume.signals import Motion


@compiled
def displacement(motion: Motion, dt: float) -> tuple[float, float]:
    """How far the vehicle comes in one tick, north and east.

    dp = [R(psi + r dt / 2) (u, v) + Vc_hat] dt

    The heading in the middle of the tick: Euler's rule, printed, lags by u dt |sin(theta / 2)| after a
    turn by theta.

    Args:
        motion: believed heading [rad], yaw rate [rad/s], velocity through the water and current [m/s].
        dt: [s] tick.

    Returns:
        North and east [m].

    Source: paper eq. (49), midpoint instead of Euler, hats restored.
    """
    north, east = _velocity_midway(motion, dt)
    return dt * (north + motion.current_north), dt * (east + motion.current_east)


@compiled
def swaying(motion: Motion, sway: float) -> Motion:
    """The motion with a sway that was not measured.

    Args:
        motion: as measured.
        sway: [m/s] to add to it.
    """
    return Motion(
        motion.heading,
        motion.yaw_rate,
        motion.surge,
        motion.sway + sway,
        motion.north,
        motion.east,
        motion.current_north,
        motion.current_east,
    )


@compiled
def way_through_water(motion: Motion, dt: float) -> tuple[float, float]:
    """The same without the current: R(psi + r dt / 2) (u, v) dt.

    Args:
        motion: believed heading [rad], yaw rate [rad/s] and velocity through the water [m/s].
        dt: [s] tick.

    Returns:
        North and east [m].
    """
    north, east = _velocity_midway(motion, dt)
    return dt * north, dt * east


@compiled
def _velocity_midway(motion: Motion, dt: float) -> tuple[float, float]:
    """Velocity through the water [m/s], north and east, with the heading in the middle of the tick."""
    return to_ned(motion.heading + 0.5 * dt * motion.yaw_rate, motion.surge, motion.sway)
