"""MEDUSA as IST's Simulink model of 2013 has it: lighter than farol's, a longer arm, hardly any quadratic sway drag.

Source of all numbers, unless a line says otherwise: hungrepo/cooperative-path-following,
`CPF-Medusa/Simulation/Mylibrary.mdl`, "Real MEDUSA Vehicle (2013)", "model of Sirene given in the thesis of Vanni", its
active numbers. The same file has another set, commented out: Y_vdot 1.3175, I_z 4.14, Y_v -55.117, Y_|v|v -101.2776.
Nobody says why it differs from farol's; see docs/theory/medusa-calibration.md.
"""

from cardume.vehicles import medusa_data as farol
from cardume.vehicles.base import announce, variant_of
from cardume.vehicles.medusa import medusa
from cardume.vehicles.medusa_data import RADIANS_PER_SECOND_PER_RPM

MASS = 17.0  # [kg]
YAW_INERTIA = 1.0  # [kg m^2] I_z
SURGE_ADDED_MASS = 20.0  # [kg] -X_udot
SWAY_ADDED_MASS = 30.0  # [kg] -Y_vdot
YAW_ADDED_INERTIA = 8.69  # [kg m^2] -N_rdot

SURGE_DRAG = 0.2  # [N s/m] -X_u
SWAY_DRAG = 50.0  # [N s/m] -Y_v
YAW_DRAG = 4.14  # [N m s] -N_r
SURGE_DRAG_QUADRATIC = 25.0  # [N s^2/m^2] -X_|u|u
SWAY_DRAG_QUADRATIC = 0.01  # [N s^2/m^2] -Y_|v|v
YAW_DRAG_QUADRATIC = 6.23  # [N m s^2] -N_|r|r

THRUST_COEFFICIENT = 4.0 / (1500.0 * RADIANS_PER_SECOND_PER_RPM) ** 2  # [N s^2/rad^2] eta = 4 / 1500^2, n in rpm
MAX_SHAFT_SPEED = 100.0 * 45.0 * RADIANS_PER_SECOND_PER_RPM  # [rad/s] 45 rpm per percent, saturated at 100 %
DEAD_ZONE = 0.0  # [-] there is none in that model
MOTOR_POLE = 7.2115  # [rad/s] K0
MOTOR_DELAY = 0.346  # [s] tau, a pure delay there; farol_gazebo takes the same number for a time constant
THRUSTER_ARM = 0.25  # [m] l

# The Simulink model moves in the horizontal plane only. In heave this vehicle is farol's: vertical thrusters, added
# mass and drag of `medusa_data`.
LARGEST_FORCE = THRUST_COEFFICIENT * MAX_SHAFT_SPEED**2  # [N] of one thruster


@variant_of(
    medusa,
    mass=MASS,
    yaw_inertia=YAW_INERTIA,
    surge_added_mass=SURGE_ADDED_MASS,
    sway_added_mass=SWAY_ADDED_MASS,
    yaw_added_inertia=YAW_ADDED_INERTIA,
    surge_drag=SURGE_DRAG,
    sway_drag=SWAY_DRAG,
    yaw_drag=YAW_DRAG,
    surge_drag_quadratic=SURGE_DRAG_QUADRATIC,
    sway_drag_quadratic=SWAY_DRAG_QUADRATIC,
    yaw_drag_quadratic=YAW_DRAG_QUADRATIC,
    thrust_coefficient=THRUST_COEFFICIENT,
    max_shaft_speed=MAX_SHAFT_SPEED,
    dead_zone=DEAD_ZONE,
    motor_pole=MOTOR_POLE,
    motor_delay=MOTOR_DELAY,
    thruster_arm=THRUSTER_ARM,
)
def medusa_2013() -> None:
    """One plant step of the MEDUSA of IST's Simulink model: the equations of `medusa` with other numbers.

    Thrusters: n' = p (n_c(t - delay) - n),  F = c n |n|,  see `thrusters`. Hull: see `hull_step`.

    Against `medusa` it has 37 instead of 50 kg in surge, twice the inertia in yaw, 0.25 m of arm instead of 0.15 m, no
    dead zone, and drifts more in a turn, because its sway drag hardly grows with speed. In heave it is farol's.

    Source: hungrepo/cooperative-path-following, `CPF-Medusa/Simulation/Mylibrary.mdl`, "Real MEDUSA Vehicle (2013)";
    the hull's equations as in `medusa`.
    """


announce(
    medusa_2013,
    autopilot={
        # twice the inertia wants twice the gains; a step of 90 degrees: tests/vehicles/test_medusa_2013.py
        "heading_gain": 10.0,  # [N m/rad]
        "yaw_rate_gain": 10.0,  # [N m s]
        "thrust_max": 2.0 * LARGEST_FORCE,
        "yaw_moment_max": 2.0 * LARGEST_FORCE * THRUSTER_ARM,
        "heave_force_max": 2.0 * LARGEST_FORCE,
        "thruster_lag": MOTOR_DELAY + 1.0 / MOTOR_POLE,
        "surge_mass": MASS + SURGE_ADDED_MASS,
        "sway_mass": MASS + SWAY_ADDED_MASS,
        "heave_mass": MASS + farol.HEAVE_ADDED_MASS,
        "surge_drag": SURGE_DRAG,
        "surge_drag_quadratic": SURGE_DRAG_QUADRATIC,
        "sway_drag": SWAY_DRAG,
        "sway_drag_quadratic": SWAY_DRAG_QUADRATIC,
        "yaw_drag": YAW_DRAG,
        "yaw_drag_quadratic": YAW_DRAG_QUADRATIC,
    },
    speed={
        "thrust_coefficient": THRUST_COEFFICIENT,
        "linear_drag": SURGE_DRAG,
        "quadratic_drag": SURGE_DRAG_QUADRATIC,
    },
)
