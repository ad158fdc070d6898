"""Fly a model in plain Python, and the same equations written down a second time for scipy."""

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from cardume.signals import Command, VesselState, Water
from cardume.vehicles import medusa
from cardume.vehicles.hull import Hull, Pose, Push, Velocity, hull_step
from cardume.vehicles.thrusters import SLOTS, Thrusters

STILL = Water(0.0, 0.0)
M_U, M_V, M_W, I_R = 50.0, 60.0, 110.088, 4.64  # farol's masses with added mass
HULL = Hull(
    surge_drag=0.0,
    sway_drag=55.1 / M_V,
    heave_drag=4.1879 / M_W,
    yaw_drag=4.14 / I_R,
    surge_drag_quadratic=27.5 / M_U,
    sway_drag_quadratic=101.0 / M_V,
    heave_drag_quadratic=40.9649 / M_W,
    yaw_drag_quadratic=6.23 / I_R,
    surge_coupling=M_V / M_U,
    sway_coupling=M_U / M_V,
    yaw_coupling=(M_U - M_V) / I_R,
)
NEWTONS_PER_RPM2 = 1.77778e-6


def fresh() -> Thrusters:
    """The memory of thrusters at the start of a mission, with a ring of its own."""
    return Thrusters(commands=np.zeros(3 * SLOTS))


def fly(
    command: Command | Callable[[float], Command],
    duration: float,
    dt: float = 0.05,
    start: VesselState = VesselState(),
    water: Water = STILL,
    **parameters: float,
) -> list[VesselState]:
    """States of a MEDUSA after each plant step."""
    vessel, memory, states = start, fresh(), []
    for k in range(round(duration / dt)):
        wanted = command(k * dt) if callable(command) else command
        vessel, memory = medusa(vessel, wanted, water, memory, dt, **parameters)
        states.append(vessel)
    return states


def push(thrust: float, yaw_moment: float, heave_force: float) -> Push:
    """Force and moment, per mass."""
    return Push(surge=thrust / M_U, heave=heave_force / M_W, yaw=yaw_moment / I_R)


def glide(pose: Pose, velocity: Velocity, force: Push, duration: float, dt: float, water: Water = STILL):
    """The hull under a constant push: pose and velocity at the end."""
    for _ in range(round(duration / dt)):
        pose, velocity = hull_step(HULL, pose, velocity, water, force, force, force, dt)
    return pose, velocity


def equations(state: np.ndarray, thrust: float, moment: float, down: float, water: Water) -> list[float]:
    """Rates of [north, east, depth, heading, u, v, w, r]: farol's numbers, typed again."""
    *_, psi, u, v, w, r = state
    return [
        u * math.cos(psi) - v * math.sin(psi) + water.north,
        u * math.sin(psi) + v * math.cos(psi) + water.east,
        w,
        r,
        (thrust + 60.0 * v * r - 27.5 * u * abs(u)) / 50.0,
        (-50.0 * u * r - 55.1 * v - 101.0 * v * abs(v)) / 60.0,
        (down - 4.1879 * w - 40.9649 * w * abs(w)) / 110.088,
        (moment - 10.0 * u * v - 4.14 * r - 6.23 * r * abs(r)) / 4.64,
    ]


def solved(
    rates: Callable[[float, np.ndarray], list[float]], start: list[float], begin: float, end: float
) -> np.ndarray:
    """The state at the end, by scipy's method of eighth order."""
    answer = solve_ivp(rates, (begin, end), start, method="DOP853", rtol=1e-12, atol=1e-13)
    assert answer.success
    return np.asarray(answer.y[:, -1])
