"""A hull in four degrees of freedom: surge, sway, heave and yaw, through the water."""

from typing import NamedTuple

from cardume.compiler import compiled
from cardume.maths import sqrt, to_ned
from cardume.maths.integrators import gauss_slopes, runge_kutta_mean
from cardume.signals import Water


class Hull(NamedTuple):
    """Inertia with added mass, and drag; `per_` is one over it."""

    surge_mass: float  # [kg] m - X_udot
    sway_mass: float  # [kg] m - Y_vdot
    per_surge_mass: float  # [1/kg]
    per_sway_mass: float  # [1/kg]
    per_heave_mass: float  # [1/kg]
    per_yaw_inertia: float  # [1/(kg m^2)]
    surge_drag: float  # [N s/m]
    sway_drag: float  # [N s/m]
    heave_drag: float  # [N s/m]
    yaw_drag: float  # [N m s]
    surge_drag_quadratic: float  # [N s^2/m^2]
    sway_drag_quadratic: float  # [N s^2/m^2]
    heave_drag_quadratic: float  # [N s^2/m^2]
    yaw_drag_quadratic: float  # [N m s^2]


class Push(NamedTuple):
    """What the thrusters do to the hull."""

    thrust: float  # [N] forward
    yaw_moment: float  # [N m] bow to starboard
    heave_force: float  # [N] down


class Velocity(NamedTuple):
    """Velocity through the water in body axes; also its rate of change."""

    surge: float  # [m/s]
    sway: float  # [m/s] to starboard
    heave: float  # [m/s] down
    yaw_rate: float  # [rad/s]


class Pose(NamedTuple):
    """Where the hull is."""

    north: float  # [m]
    east: float  # [m]
    depth: float  # [m]
    heading: float  # [rad]


@compiled
def drag(velocity: float, linear: float, quadratic: float) -> float:
    """Force against a velocity: (d + D |v|) v.

    Args:
        velocity: [m/s] or [rad/s].
        linear: [N s/m] or [N m s] d >= 0.
        quadratic: [N s^2/m^2] or [N m s^2] D >= 0.

    Returns:
        The force [N] or moment [N m], of the sign of the velocity.
    """
    return (linear + quadratic * abs(velocity)) * velocity


@compiled
def acceleration(hull: Hull, velocity: Velocity, push: Push) -> Velocity:
    """Equations of motion in the body.

    m_u u' =  m_v v r - X_drag + X
    m_v v' = -m_u u r - Y_drag
    m_w w' = -Z_drag + Z
    I r'   = (m_u - m_v) u v - N_drag + N

    Velocities are through the water, so a current does not enter. For a neutrally buoyant hull that
    holds also where the current changes: the pressure gradient that accelerates the water accelerates
    the hull with it. Roll and pitch stay zero.

    Args:
        hull: masses and drags.
        velocity: through the water.
        push: force and moment of the thrusters.

    Returns:
        The rate of change of the velocity.

    Source: Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, maneuvering model in
    relative velocity, with diagonal mass and damping.
    """
    u, v, r = velocity.surge, velocity.sway, velocity.yaw_rate
    surge_force = push.thrust - drag(u, hull.surge_drag, hull.surge_drag_quadratic)
    sway_force = -drag(v, hull.sway_drag, hull.sway_drag_quadratic)
    heave_force = push.heave_force - drag(velocity.heave, hull.heave_drag, hull.heave_drag_quadratic)
    moment = push.yaw_moment - drag(r, hull.yaw_drag, hull.yaw_drag_quadratic)
    return Velocity(
        (surge_force + hull.sway_mass * v * r) * hull.per_surge_mass,
        (sway_force - hull.surge_mass * u * r) * hull.per_sway_mass,
        heave_force * hull.per_heave_mass,
        (moment + (hull.surge_mass - hull.sway_mass) * u * v) * hull.per_yaw_inertia,
    )


@compiled
def changed(velocity: Velocity, rate: Velocity, dt: float) -> Velocity:
    """The velocity after a time at a constant rate of change."""
    return Velocity(
        velocity.surge + dt * rate.surge,
        velocity.sway + dt * rate.sway,
        velocity.heave + dt * rate.heave,
        velocity.yaw_rate + dt * rate.yaw_rate,
    )


@compiled
def hull_step(
    hull: Hull, pose: Pose, velocity: Velocity, water: Water, start: Push, middle: Push, end: Push, dt: float
) -> tuple[Pose, Velocity]:
    """One step of fourth order: Runge-Kutta for the velocity, Gauss's rule for the way it makes.

    p' = R(psi) (u, v) + Vc,   z' = w,   psi' = r

    The velocity does not depend on the pose, so the pose is only integrated: two sines and cosines do
    what four would do in a Runge-Kutta step of everything.

    Args:
        hull: masses and drags.
        pose: before the step.
        velocity: through the water, before the step.
        water: current [m/s], NED, towards, held over the step.
        start: push at the start of the step.
        middle: push halfway.
        end: push at the end.
        dt: [s] step.

    Returns:
        Pose and velocity after the step.
    """
    v1 = velocity
    a1 = acceleration(hull, v1, start)
    v2 = changed(velocity, a1, 0.5 * dt)
    a2 = acceleration(hull, v2, middle)
    v3 = changed(velocity, a2, 0.5 * dt)
    a3 = acceleration(hull, v3, middle)
    v4 = changed(velocity, a3, dt)
    a4 = acceleration(hull, v4, end)
    turn_1, turn_2 = gauss_slopes(v1.yaw_rate, v2.yaw_rate, v3.yaw_rate, v4.yaw_rate)
    surge_1, surge_2 = gauss_slopes(a1.surge, a2.surge, a3.surge, a4.surge)
    sway_1, sway_2 = gauss_slopes(a1.sway, a2.sway, a3.sway, a4.sway)
    north_1, east_1 = to_ned(pose.heading + dt * turn_1, velocity.surge + dt * surge_1, velocity.sway + dt * sway_1)
    north_2, east_2 = to_ned(pose.heading + dt * turn_2, velocity.surge + dt * surge_2, velocity.sway + dt * sway_2)
    moved = Pose(
        pose.north + dt * (0.5 * (north_1 + north_2) + water.north),
        pose.east + dt * (0.5 * (east_1 + east_2) + water.east),
        pose.depth + dt * runge_kutta_mean(v1.heave, v2.heave, v3.heave, v4.heave),
        pose.heading + dt * runge_kutta_mean(v1.yaw_rate, v2.yaw_rate, v3.yaw_rate, v4.yaw_rate),
    )
    mean = Velocity(
        runge_kutta_mean(a1.surge, a2.surge, a3.surge, a4.surge),
        runge_kutta_mean(a1.sway, a2.sway, a3.sway, a4.sway),
        runge_kutta_mean(a1.heave, a2.heave, a3.heave, a4.heave),
        runge_kutta_mean(a1.yaw_rate, a2.yaw_rate, a3.yaw_rate, a4.yaw_rate),
    )
    return moved, changed(velocity, mean, dt)


@compiled
def steady_sway(
    surge: float, yaw_rate: float, surge_mass: float, sway_drag: float, sway_drag_quadratic: float
) -> float:
    """The sway of a steady turn: the root of m_u u r + (d + D |v|) v = 0.

    v = -2 m_u u r / (d + sqrt(d^2 + 4 D m_u |u r|))

    A vehicle drifts outwards, to port (v < 0) in a turn to starboard.

    Args:
        surge: [m/s] u, through the water.
        yaw_rate: [rad/s] r.
        surge_mass: [kg] m_u = m - X_udot.
        sway_drag: [N s/m] d > 0.
        sway_drag_quadratic: [N s^2/m^2] D >= 0.

    Returns:
        The sway v [m/s].
    """
    side_force = surge_mass * surge * yaw_rate
    root = sqrt(sway_drag * sway_drag + 4.0 * sway_drag_quadratic * abs(side_force))
    return -2.0 * side_force / (sway_drag + root)


@compiled
def sway_step(
    sway: float,
    surge: float,
    yaw_rate: float,
    surge_mass: float,
    sway_mass: float,
    sway_drag: float,
    sway_drag_quadratic: float,
    dt: float,
) -> float:
    """One step of m_v v' = -m_u u r - (d + D |v|) v, drag taken at the new v: stable for any step.

    Args:
        sway: [m/s] v before the step.
        surge: [m/s] u, through the water.
        yaw_rate: [rad/s] r.
        surge_mass: [kg] m_u = m - X_udot.
        sway_mass: [kg] m_v = m - Y_vdot.
        sway_drag: [N s/m] d >= 0.
        sway_drag_quadratic: [N s^2/m^2] D >= 0.
        dt: [s] step.

    Returns:
        v after the step [m/s].
    """
    resistance = sway_drag + sway_drag_quadratic * abs(sway)
    return (sway_mass * sway - dt * surge_mass * surge * yaw_rate) / (sway_mass + dt * resistance)
