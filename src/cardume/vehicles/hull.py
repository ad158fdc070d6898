"""A hull in four degrees of freedom: surge, sway, heave and yaw, through the water."""

from typing import NamedTuple

from cardume.compiler import compiled
from cardume.maths import sqrt
from cardume.maths.integrators import runge_kutta_mean, way_made
from cardume.signals import Water


class Hull(NamedTuple):
    """Drags and couplings, each divided by the mass or inertia that it moves, for speed in the innermost loop."""

    surge_drag: float  # [1/s] d_u / m_u
    sway_drag: float  # [1/s]
    heave_drag: float  # [1/s]
    yaw_drag: float  # [1/s]
    surge_drag_quadratic: float  # [1/m] D_u / m_u
    sway_drag_quadratic: float  # [1/m]
    heave_drag_quadratic: float  # [1/m]
    yaw_drag_quadratic: float  # [-]
    surge_coupling: float  # [-] m_v / m_u
    sway_coupling: float  # [-] m_u / m_v
    yaw_coupling: float  # [1/m^2] (m_u - m_v) / I, the Munk moment


class Push(NamedTuple):
    """What the thrusters do to the hull, divided by the mass or inertia that they move."""

    surge: float  # [m/s^2] X / m_u
    heave: float  # [m/s^2] Z / m_w, down
    yaw: float  # [rad/s^2] N / I, bow to starboard


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
        linear: [N s/m] or [N m s] d >= 0; per mass [1/s].
        quadratic: [N s^2/m^2] or [N m s^2] D >= 0; per mass [1/m] or [-].

    Returns:
        The force [N], moment [N m] or deceleration, of the sign of the velocity.
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
        hull: drags and couplings per mass.
        velocity: through the water.
        push: of the thrusters, per mass.

    Returns:
        The rate of change of the velocity.

    Source: dsor-isr/farol, `AUV.cpp` (updateDynamics, computeCoriolisMatrix) with roll and pitch zero; the
    Coriolis matrix is that of MSS `GNC/m2c.m`.
    """
    u, v, w, r = velocity
    return Velocity(
        (push.surge + hull.surge_coupling * (v * r)) - drag(u, hull.surge_drag, hull.surge_drag_quadratic),
        -(hull.sway_coupling * (u * r)) - drag(v, hull.sway_drag, hull.sway_drag_quadratic),
        push.heave - drag(w, hull.heave_drag, hull.heave_drag_quadratic),
        (push.yaw + hull.yaw_coupling * (u * v)) - drag(r, hull.yaw_drag, hull.yaw_drag_quadratic),
    )


@compiled
def mean_rate(k1: Velocity, k2: Velocity, k3: Velocity, k4: Velocity) -> Velocity:
    """Mean over a step from the four slopes of the Runge-Kutta method."""
    return Velocity(
        runge_kutta_mean(k1.surge, k2.surge, k3.surge, k4.surge),
        runge_kutta_mean(k1.sway, k2.sway, k3.sway, k4.sway),
        runge_kutta_mean(k1.heave, k2.heave, k3.heave, k4.heave),
        runge_kutta_mean(k1.yaw_rate, k2.yaw_rate, k3.yaw_rate, k4.yaw_rate),
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
    """One step of fourth order: Runge-Kutta for velocity, heading and depth, `way_made` for the position.

    p' = R(psi) (u, v) + Vc,   z' = w,   psi' = r

    Args:
        hull: drags and couplings per mass.
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
    after = changed(velocity, mean_rate(a1, a2, a3, a4), dt)
    mean = mean_rate(v1, v2, v3, v4)
    mean_heading = pose.heading + dt * (v1.yaw_rate + v2.yaw_rate + v3.yaw_rate) * (1.0 / 6.0)
    north, east = way_made(
        mean_heading, dt * mean.yaw_rate, mean.surge, mean.sway, after.surge - v1.surge, after.sway - v1.sway
    )
    moved = Pose(
        pose.north + dt * (north + water.north),
        pose.east + dt * (east + water.east),
        pose.depth + dt * mean.heave,
        pose.heading + dt * mean.yaw_rate,
    )
    return moved, after


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
