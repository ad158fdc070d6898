"""What a vehicle can do at all: its least and largest steady speed, and how late its heading follows."""

import math
from typing import NamedTuple

import numpy as np

from cardume.simulation.plan import Choice, VehiclePlan
from cardume.vehicles.medusa_data import NUM_HORIZONTAL_THRUSTERS

HULL_LENGTH = 1.035  # [m] of a MEDUSA: farol_gazebo, farol_vehicles/*_vehicle/urdf/base.xacro

# Slowest pole of `feedforward_pid` on `medusa`, both with their defaults: see that law's docstring.
SPEEDS = (0.15, 0.5, 0.7, 1.0, 1.2)  # [m/s]
POLES = (0.84, 1.03, 0.78, 0.61, 0.52)  # [1/s]
HEADING_GAINS = ("heading_gain", "yaw_rate_gain", "sway_share", "turn_bandwidth")


MEDUSAS = ("medusa", "medusa_2013")


class SpeedLimits(NamedTuple):
    """Steady speeds through the water that a vehicle can keep."""

    least: float  # [m/s] slower, its thrusters turn now and then only
    most: float  # [m/s]


def speed_limits(vehicle: VehiclePlan) -> SpeedLimits | None:
    """The steady speeds that a vehicle's thrusters allow on a straight line; None for a user's own model.

    2 c n^2 = (d + D u) u,   n = n_max, or the dead zone's share of it

    Args:
        vehicle: with its model and autopilot.
    """
    model = vehicle.laws["model"]
    if model.law.name == "kinematic":
        return SpeedLimits(0.0, math.inf)
    if model.law.name not in MEDUSAS:
        return None
    thrust = NUM_HORIZONTAL_THRUSTERS * model.value("thrust_coefficient") * model.value("max_shaft_speed") ** 2
    slowest = model.value("dead_zone") ** 2 * thrust
    autopilot = vehicle.laws["autopilot"]
    if autopilot.law.name == "feedforward_pid":
        thrust = min(thrust, autopilot.value("thrust_max"))
    return SpeedLimits(steady_speed(model, slowest), steady_speed(model, thrust))


def steady_speed(model: Choice, thrust: float) -> float:
    """The speed [m/s] at which the drag of a MEDUSA equals a thrust.

    u = 2 X / (d + sqrt(d^2 + 4 D X))

    Args:
        model: one of MEDUSAS.
        thrust: [N] X >= 0.
    """
    linear, quadratic = model.value("surge_drag"), model.value("surge_drag_quadratic")
    root = linear + math.sqrt(linear * linear + 4.0 * quadratic * thrust)
    return 2.0 * thrust / root if root > 0.0 else math.inf


def heading_lag(vehicle: VehiclePlan, speed: float) -> float | None:
    """Time constant [s] with which the heading follows what is asked; None where nobody analyzed it.

    Args:
        vehicle: with its model and autopilot.
        speed: [m/s] through the water.
    """
    model, autopilot = vehicle.laws["model"], vehicle.laws["autopilot"]
    if model.law.name == "kinematic":
        return model.value("heading_time_constant")
    is_analyzed = (
        model.law.name == "medusa"
        and autopilot.law.name == "feedforward_pid"
        and all(autopilot.value(gain) == Choice(autopilot.law).value(gain) for gain in HEADING_GAINS)
    )
    return 1.0 / float(np.interp(speed, SPEEDS, POLES)) if is_analyzed else None


def hull_length(vehicle: VehiclePlan) -> float:
    """Length [m] of a vehicle's hull; a kinematic one is a point."""
    return 0.0 if vehicle.laws["model"].law.name == "kinematic" else HULL_LENGTH
