"""MEDUSA: two horizontal and two vertical thrusters on a hull in four degrees of freedom, as farol simulates it."""

from typing import Annotated, NamedTuple

from cardume.compiler import compiled, some, where
from cardume.laws import (
    Bounds,
    Kilograms,
    Meters,
    NotNegative,
    Once,
    PerSecond,
    Positive,
    RadiansPerSecond,
    Seconds,
    Unit,
)
from cardume.maths import signed_root, signed_square
from cardume.signals import Command, VesselState, Water
from cardume.vehicles import medusa_data as farol
from cardume.vehicles.base import vehicle_model
from cardume.vehicles.hull import Hull, Pose, Push, Velocity, drag, hull_step
from cardume.vehicles.thrusters import (
    ShaftSpeeds,
    ThrusterPlant,
    Thrusters,
    allocate,
    shaft_speed_for,
    started_thrusters,
    thruster_force,
    thruster_plant,
    turned_shafts,
)

Inertia = Annotated[float, Unit("kg m^2")]
LinearDrag = Annotated[float, Unit("N s/m")]
QuadraticDrag = Annotated[float, Unit("N s^2/m^2")]
LinearYawDrag = Annotated[float, Unit("N m s")]
QuadraticYawDrag = Annotated[float, Unit("N m s^2")]
ThrustCoefficient = Annotated[float, Unit("N s^2/rad^2")]


class Forces(NamedTuple):
    """Force of each horizontal thruster, and of both vertical ones together."""

    port: float  # [N] > 0 ahead
    starboard: float  # [N]
    down: float  # [N]


@compiled
def forces_of(shafts: ShaftSpeeds, coefficient: float) -> Forces:
    """Forces of all thrusters: F = c n |n| each, and the vertical pair together.

    Args:
        shafts: shaft speeds [rad/s].
        coefficient: [N s^2/rad^2] c.

    Returns:
        The forces.
    """
    return Forces(
        thruster_force(shafts.port, coefficient),
        thruster_force(shafts.starboard, coefficient),
        farol.NUM_VERTICAL_THRUSTERS * thruster_force(shafts.vertical, coefficient),
    )


class PerForce(NamedTuple):
    """What a force of a thruster does to the hull."""

    surge: float  # [1/kg] 1 / m_u
    heave: float  # [1/kg] 1 / m_w
    yaw: float  # [1/(kg m)] l / I, l the arm of each horizontal thruster


class Medusa(NamedTuple):
    """What does not change about a MEDUSA during a mission."""

    hull: Hull
    per_force: PerForce
    thrusters: ThrusterPlant
    arm: float  # [m] l
    surge_drag: float  # [N s/m] d_u
    surge_drag_quadratic: float  # [N s^2/m^2] D_u


@compiled
def push_of(forces: Forces, per_force: PerForce) -> Push:
    """(F_port + F_starboard) / m_u,   F_down / m_w,   l (F_port - F_starboard) / I.

    Args:
        forces: of the thrusters.
        per_force: what a force does.

    Returns:
        The push on the hull.
    """
    return Push(
        (forces.port + forces.starboard) * per_force.surge,
        forces.down * per_force.heave,
        (forces.port - forces.starboard) * per_force.yaw,
    )


@compiled
def useful_power(forces: Forces, velocity: Velocity, arm: float) -> float:
    """Power that the thrusters exchange with the hull, each counted as positive: sum of |F| |speed of the water there|.

    Args:
        forces: of the thrusters.
        velocity: of the hull through the water.
        arm: [m] of each horizontal thruster.

    Returns:
        The power [W]. No electrical model of these thrusters is published; a thruster that pushes a
        vehicle at rest counts as free.
    """
    port = forces.port * (velocity.surge + arm * velocity.yaw_rate)
    starboard = forces.starboard * (velocity.surge - arm * velocity.yaw_rate)
    return abs(port) + abs(starboard) + abs(forces.down * velocity.heave)


def medusa_plant(
    dt: Seconds,
    mass: Positive[Kilograms] = farol.MASS,
    yaw_inertia: Positive[Inertia] = farol.YAW_INERTIA,
    surge_added_mass: NotNegative[Kilograms] = farol.SURGE_ADDED_MASS,
    sway_added_mass: NotNegative[Kilograms] = farol.SWAY_ADDED_MASS,
    heave_added_mass: NotNegative[Kilograms] = farol.HEAVE_ADDED_MASS,
    yaw_added_inertia: NotNegative[Inertia] = farol.YAW_ADDED_INERTIA,
    surge_drag: NotNegative[LinearDrag] = farol.SURGE_DRAG,
    sway_drag: NotNegative[LinearDrag] = farol.SWAY_DRAG,
    heave_drag: NotNegative[LinearDrag] = farol.HEAVE_DRAG,
    yaw_drag: NotNegative[LinearYawDrag] = farol.YAW_DRAG,
    surge_drag_quadratic: NotNegative[QuadraticDrag] = farol.SURGE_DRAG_QUADRATIC,
    sway_drag_quadratic: NotNegative[QuadraticDrag] = farol.SWAY_DRAG_QUADRATIC,
    heave_drag_quadratic: NotNegative[QuadraticDrag] = farol.HEAVE_DRAG_QUADRATIC,
    yaw_drag_quadratic: NotNegative[QuadraticYawDrag] = farol.YAW_DRAG_QUADRATIC,
    thrust_coefficient: Positive[ThrustCoefficient] = farol.THRUST_COEFFICIENT,
    max_shaft_speed: Positive[RadiansPerSecond] = farol.MAX_SHAFT_SPEED,
    dead_zone: Annotated[float, Unit(""), Bounds(0.0, 1.0)] = farol.DEAD_ZONE,
    motor_pole: Positive[PerSecond] = farol.MOTOR_POLE,
    motor_delay: Annotated[float, Unit("s"), Bounds(0.0, 3.0)] = farol.MOTOR_DELAY,
    thruster_arm: Positive[Meters] = farol.THRUSTER_ARM,
) -> Medusa:
    """What does not change about a MEDUSA during a mission, from the parameters that a mission may set.

    Args:
        dt: [s] plant step, at least motor_delay / 63.
        mass: [kg] m, of the body.
        yaw_inertia: [kg m^2] I_zz, of the body about the vertical.
        surge_added_mass: [kg] -X_udot, of the water that goes along.
        sway_added_mass: [kg] -Y_vdot, of the water that goes along.
        heave_added_mass: [kg] -Z_wdot, of the water that goes along.
        yaw_added_inertia: [kg m^2] -N_rdot, of the water that turns along.
        surge_drag: [N s/m] -X_u, linear drag ahead.
        sway_drag: [N s/m] -Y_v, linear drag sideways.
        heave_drag: [N s/m] -Z_w, linear drag down and up.
        yaw_drag: [N m s] -N_r, linear drag of turning.
        surge_drag_quadratic: [N s^2/m^2] -X_|u|u, drag ahead that grows with the square.
        sway_drag_quadratic: [N s^2/m^2] -Y_|v|v, drag sideways that grows with the square.
        heave_drag_quadratic: [N s^2/m^2] -Z_|w|w, drag down and up that grows with the square.
        yaw_drag_quadratic: [N m s^2] -N_|r|r, drag of turning that grows with the square.
        thrust_coefficient: [N s^2/rad^2] c of each thruster.
        max_shaft_speed: [rad/s] largest of a shaft, either way.
        dead_zone: [-] of max_shaft_speed; a smaller command does not turn the shaft.
        motor_pole: [1/s] p, how fast a shaft follows its command.
        motor_delay: [s] of every command.
        thruster_arm: [m] of each horizontal thruster from the centre line.
    """
    surge_mass, sway_mass = mass + surge_added_mass, mass + sway_added_mass
    per_surge, per_sway = 1.0 / surge_mass, 1.0 / sway_mass
    per_heave, per_yaw = 1.0 / (mass + heave_added_mass), 1.0 / (yaw_inertia + yaw_added_inertia)
    hull = Hull(
        surge_drag * per_surge,
        sway_drag * per_sway,
        heave_drag * per_heave,
        yaw_drag * per_yaw,
        surge_drag_quadratic * per_surge,
        sway_drag_quadratic * per_sway,
        heave_drag_quadratic * per_heave,
        yaw_drag_quadratic * per_yaw,
        sway_mass * per_surge,
        surge_mass * per_sway,
        (surge_mass - sway_mass) * per_yaw,
    )
    return Medusa(
        hull,
        PerForce(per_surge, per_heave, thruster_arm * per_yaw),
        thruster_plant(dt, thrust_coefficient, max_shaft_speed, dead_zone, motor_pole, motor_delay, thruster_arm),
        thruster_arm,
        surge_drag,
        surge_drag_quadratic,
    )


@vehicle_model
def medusa(
    vessel: VesselState,
    command: Command,
    water: Water,
    memory: Thrusters,
    dt: Seconds,
    plant: Annotated[Medusa, Once(medusa_plant)],
) -> tuple[VesselState, Thrusters]:
    """One plant step of a MEDUSA: thrusters with delay, lag, dead zone and saturation; a hull in 4 DOF.

    Thrusters: n' = p (n_c(t - delay) - n),  F = c n |n|,  see `thrusters`. Hull: see `hull_step`.

    The hull is neutrally buoyant. Farol computes the displaced volume from a sphere whose radius is
    cbrt(m / ((3/4) pi rho)) instead of cbrt(3 m / (4 pi rho)) (AUV.cpp); that is 16/9 of the volume, 242 N of
    buoyancy against 72 N of vertical thrust, and its vehicle could not dive. The surface holds: depth
    never goes below zero. A vehicle that starts with a speed starts with the thrusters that hold it.

    Args:
        vessel: state before the step; velocities are through the water.
        command: thrust [N], yaw moment [N m] and heave force [N] wanted.
        water: current [m/s], held over the step.
        memory: the thrusters.
        dt: [s] plant step, at least motor_delay / 63.
        plant: the rest, of the parameters that `medusa_plant` names.

    Returns:
        The state after the step, and the thrusters. shaft_speed is the speed [rad/s] at which both
        horizontal thrusters alike would push as much, so that (37) reads the thrust rightly also while
        they differ to turn: n |n| = (n_port |n_port| + n_starboard |n_starboard|) / 2.

    Source: dsor-isr/farol, `AUV.cpp` (applyThrustersModel, updateDynamics) and the sim.yaml of its MEDUSA
    vehicles, whose numbers stand in `medusa_data`.
    """
    before = memory
    if some(memory.started < 0.5):
        holding = 0.5 * drag(vessel.surge, plant.surge_drag, plant.surge_drag_quadratic)
        before = started_thrusters(memory, shaft_speed_for(holding, plant.thrusters.per_coefficient, 0.0))
    middle, after = turned_shafts(before, allocate(command, plant.thrusters), plant.thrusters)
    coefficient = plant.thrusters.coefficient
    forces = forces_of(ShaftSpeeds(after.port, after.starboard, after.vertical), coefficient)
    pose, velocity = hull_step(
        plant.hull,
        Pose(vessel.north, vessel.east, vessel.depth, vessel.heading),
        Velocity(vessel.surge, vessel.sway, vessel.heave, vessel.yaw_rate),
        water,
        push_of(forces_of(ShaftSpeeds(before.port, before.starboard, before.vertical), coefficient), plant.per_force),
        push_of(forces_of(middle, coefficient), plant.per_force),
        push_of(forces, plant.per_force),
        dt,
    )
    surfaced = pose.depth <= 0.0
    vessel = VesselState(
        pose.north,
        pose.east,
        where(surfaced, 0.0, pose.depth),
        pose.heading,
        velocity.surge,
        velocity.sway,
        where(surfaced & (velocity.heave < 0.0), 0.0, velocity.heave),
        velocity.yaw_rate,
        signed_root(0.5 * (signed_square(after.port) + signed_square(after.starboard))),
        forces.port + forces.starboard,
        plant.arm * (forces.port - forces.starboard),
        useful_power(forces, velocity, plant.arm),
    )
    return vessel, after
