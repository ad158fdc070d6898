"""The vehicle and the autopilot of the reference workload, written as a user writes them."""

from typing import Annotated, NamedTuple

from cardume.compiler import compiled
from cardume.laws import Kilograms, NotNegative, Once, Positive, Seconds, Unit
from cardume.maths import clip, sincos, wrap_angle
from cardume.maths.integrators import runge_kutta_mean
from cardume.onboard.control.base import autopilot_law
from cardume.signals import Command, Feedback, VesselState, Water
from cardume.vehicles.base import vehicle_model

Inertia = Annotated[float, Unit("kg m^2")]
LinearDrag = Annotated[float, Unit("N s/m")]
QuadraticDrag = Annotated[float, Unit("N s^2/m^2")]
LinearYawDrag = Annotated[float, Unit("N m s")]
QuadraticYawDrag = Annotated[float, Unit("N m s^2")]
Stiffness = Annotated[float, Unit("N m/rad")]


class Hull(NamedTuple):
    """Drags and couplings, each divided by the mass or inertia that it moves."""

    per_surge: float  # [1/kg] 1 / m_u
    per_yaw: float  # [1/(kg m^2)] 1 / I
    surge_drag: float  # [1/s] d_u / m_u
    sway_drag: float  # [1/s]
    yaw_drag: float  # [1/s]
    surge_drag_quadratic: float  # [1/m] D_u / m_u
    sway_drag_quadratic: float  # [1/m]
    yaw_drag_quadratic: float  # [-]
    surge_coupling: float  # [-] m_v / m_u
    sway_coupling: float  # [-] m_u / m_v
    yaw_coupling: float  # [1/m^2] (m_u - m_v) / I


class State(NamedTuple):
    """Place and velocity of the hull; also their rates of change."""

    north: float  # [m]
    east: float  # [m]
    heading: float  # [rad]
    surge: float  # [m/s] through the water
    sway: float  # [m/s]
    yaw_rate: float  # [rad/s]


def hull_of(
    dt: Seconds,
    surge_mass: Positive[Kilograms] = 37.0,
    sway_mass: Positive[Kilograms] = 47.0,
    yaw_inertia: Positive[Inertia] = 9.69,
    surge_drag: NotNegative[LinearDrag] = 0.2,
    sway_drag: NotNegative[LinearDrag] = 50.0,
    yaw_drag: NotNegative[LinearYawDrag] = 4.14,
    surge_drag_quadratic: NotNegative[QuadraticDrag] = 25.0,
    sway_drag_quadratic: NotNegative[QuadraticDrag] = 0.01,
    yaw_drag_quadratic: NotNegative[QuadraticYawDrag] = 6.23,
) -> Hull:
    """What does not change about the hull during a mission.

    Args:
        dt: [s] plant step; not used.
        surge_mass: [kg] m_u, with added mass, as the others.
        sway_mass: [kg] m_v.
        yaw_inertia: [kg m^2] I.
        surge_drag: [N s/m] -X_u.
        sway_drag: [N s/m] -Y_v.
        yaw_drag: [N m s] -N_r.
        surge_drag_quadratic: [N s^2/m^2] -X_|u|u.
        sway_drag_quadratic: [N s^2/m^2] -Y_|v|v.
        yaw_drag_quadratic: [N m s^2] -N_|r|r.
    """
    return Hull(
        1.0 / surge_mass,
        1.0 / yaw_inertia,
        surge_drag / surge_mass,
        sway_drag / sway_mass,
        yaw_drag / yaw_inertia,
        surge_drag_quadratic / surge_mass,
        sway_drag_quadratic / sway_mass,
        yaw_drag_quadratic / yaw_inertia,
        sway_mass / surge_mass,
        surge_mass / sway_mass,
        (surge_mass - sway_mass) / yaw_inertia,
    )


@compiled
def rates(hull: Hull, state: State, push: float, twist: float, water: Water) -> State:
    """The rate of change of the state.

    Args:
        hull: of the vehicle.
        state: now.
        push: [m/s^2] thrust per mass.
        twist: [rad/s^2] moment per inertia.
        water: current [m/s].
    """
    sine, cosine = sincos(state.heading)
    u, v, r = state.surge, state.sway, state.yaw_rate
    return State(
        cosine * u - sine * v + water.north,
        sine * u + cosine * v + water.east,
        r,
        push + hull.surge_coupling * (v * r) - (hull.surge_drag + hull.surge_drag_quadratic * abs(u)) * u,
        -hull.sway_coupling * (u * r) - (hull.sway_drag + hull.sway_drag_quadratic * abs(v)) * v,
        twist + hull.yaw_coupling * (u * v) - (hull.yaw_drag + hull.yaw_drag_quadratic * abs(r)) * r,
    )


@compiled
def moved(state: State, rate: State, dt: float) -> State:
    """The state after a time at a constant rate of change."""
    return State(
        state.north,  # no rate depends on the place
        state.east,
        state.heading + dt * rate.heading,
        state.surge + dt * rate.surge,
        state.sway + dt * rate.sway,
        state.yaw_rate + dt * rate.yaw_rate,
    )


@vehicle_model
def reference_vehicle(
    vessel: VesselState, command: Command, water: Water, dt: Seconds, hull: Annotated[Hull, Once(hull_of)]
) -> VesselState:
    """One step of Runge-Kutta of fourth order of a MEDUSA-like hull in three degrees of freedom.

    m_u u' =  m_v v r - (d_u + D_u |u|) u + X
    m_v v' = -m_u u r - (d_v + D_v |v|) v
    I r'   = (m_u - m_v) u v - (d_r + D_r |r|) r + N

    Args:
        vessel: state before the step; depth stays as it is.
        command: thrust X [N] and yaw moment N [N m], obeyed at once.
        water: current [m/s], held over the step.
        dt: [s] plant step.
        hull: the rest, of the parameters that `hull_of` names.

    Returns:
        The state after the step; power counts |X u| + |N r|.

    Source: the "Real MEDUSA Vehicle (2013)" of hungrepo's Mylibrary.mdl, as `medusa_2013`, without its thrusters.
    """
    state = State(vessel.north, vessel.east, vessel.heading, vessel.surge, vessel.sway, vessel.yaw_rate)
    push, twist = command.thrust * hull.per_surge, command.yaw_moment * hull.per_yaw
    k1 = rates(hull, state, push, twist, water)
    k2 = rates(hull, moved(state, k1, 0.5 * dt), push, twist, water)
    k3 = rates(hull, moved(state, k2, 0.5 * dt), push, twist, water)
    k4 = rates(hull, moved(state, k3, dt), push, twist, water)
    surge = state.surge + dt * runge_kutta_mean(k1.surge, k2.surge, k3.surge, k4.surge)
    yaw_rate = state.yaw_rate + dt * runge_kutta_mean(k1.yaw_rate, k2.yaw_rate, k3.yaw_rate, k4.yaw_rate)
    return VesselState(
        state.north + dt * runge_kutta_mean(k1.north, k2.north, k3.north, k4.north),
        state.east + dt * runge_kutta_mean(k1.east, k2.east, k3.east, k4.east),
        vessel.depth,
        state.heading + dt * runge_kutta_mean(k1.heading, k2.heading, k3.heading, k4.heading),
        surge,
        state.sway + dt * runge_kutta_mean(k1.sway, k2.sway, k3.sway, k4.sway),
        vessel.heave,
        yaw_rate,
        vessel.shaft_speed,
        command.thrust,
        command.yaw_moment,
        abs(command.thrust * surge) + abs(command.yaw_moment * yaw_rate),
    )


class SpeedError(NamedTuple):
    """Memory: the integral of the speed error."""

    integral: float = 0.0  # [m]


@autopilot_law
def reference_autopilot(
    feedback: Feedback,
    memory: SpeedError,
    dt: Seconds,
    heading_gain: NotNegative[Stiffness] = 12.0,
    yaw_rate_gain: NotNegative[LinearYawDrag] = 8.0,
    speed_gain: NotNegative[LinearDrag] = 30.0,
    integral_gain: NotNegative[Annotated[float, Unit("N/m")]] = 3.0,
    drag_quadratic: NotNegative[QuadraticDrag] = 25.0,
    thrust_max: Positive[Annotated[float, Unit("N")]] = 60.0,
    moment_max: Positive[Annotated[float, Unit("N m")]] = 15.0,
) -> tuple[Command, SpeedError]:
    """A proportional and integral speed loop with the drag fed forward, a proportional and rate heading loop.

    X = sat(D |u_d| u_d + k (u_d - u) + k_i s),   s' = u_d - u, |s| <= 5 m
    N = sat(k_p (psi_d - psi) - k_d r)

    Args:
        feedback: what is measured and what is wanted.
        memory: s.
        dt: [s] plant step.
        heading_gain: [N m/rad] k_p.
        yaw_rate_gain: [N m s] k_d.
        speed_gain: [N s/m] k.
        integral_gain: [N/m] k_i.
        drag_quadratic: [N s^2/m^2] D.
        thrust_max: [N] of X.
        moment_max: [N m] of N.

    Returns:
        The command and the next memory.

    Source: the reference workload; gains of ours.
    """
    wanted = feedback.reference_speed
    error = wanted - feedback.surge
    thrust = drag_quadratic * abs(wanted) * wanted + speed_gain * error + integral_gain * memory.integral
    moment = heading_gain * wrap_angle(feedback.reference_heading - feedback.heading)
    command = Command(
        clip(thrust, -thrust_max, thrust_max),
        clip(moment - yaw_rate_gain * feedback.yaw_rate, -moment_max, moment_max),
        0.0,
    )
    return command, SpeedError(clip(memory.integral + dt * error, -5.0, 5.0))
