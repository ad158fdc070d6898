"""The numbers of MEDUSA, as farol's simulator has them.

Source, unless a line says otherwise: dsor-isr/farol,
`farol_bringup/config/defaults/{myellow,mred,mblack,mvector}/sim.yaml`, the same in
`medusa_simulation`.  Farol writes damping as negative derivatives (`X_u = -0`, `Y_v = -55.1`);
here drag is positive.  Other published sets differ (mass 17 to 30 kg, yaw inertia 1 to 4.14 kg m^2);
nobody says why.
"""

import math

RADIANS_PER_SECOND_PER_RPM = 2.0 * math.pi / 60.0

MASS = 30.0  # [kg]
YAW_INERTIA = 4.14  # [kg m^2] I_zz
SURGE_ADDED_MASS = 20.0  # [kg] -X_udot
SWAY_ADDED_MASS = 30.0  # [kg] -Y_vdot
HEAVE_ADDED_MASS = 80.088  # [kg] -Z_wdot
YAW_ADDED_INERTIA = 0.5  # [kg m^2] -N_rdot

SURGE_DRAG = 0.0  # [N s/m] -X_u
SWAY_DRAG = 55.1  # [N s/m] -Y_v
HEAVE_DRAG = 4.1879  # [N s/m] -Z_w
YAW_DRAG = 4.14  # [N m s] -N_r
SURGE_DRAG_QUADRATIC = 27.5  # [N s^2/m^2] -X_|u|u
SWAY_DRAG_QUADRATIC = 101.0  # [N s^2/m^2] -Y_|v|v
HEAVE_DRAG_QUADRATIC = 40.9649  # [N s^2/m^2] -Z_|w|w
YAW_DRAG_QUADRATIC = 6.23  # [N m s^2] -N_|r|r

# F = 1.77778e-6 n |n| with n in rpm: 4 N at 1500 rpm.  The file's gain, 45 rpm per percent, makes
# 100 % 4500 rpm (36 N); below 8.6 % a thruster does not turn.
THRUST_COEFFICIENT = 1.77778e-6 / RADIANS_PER_SECOND_PER_RPM**2  # [N s^2/rad^2]
MAX_SHAFT_SPEED = 100.0 * 45.0 * RADIANS_PER_SECOND_PER_RPM  # [rad/s]
DEAD_ZONE = 0.086  # [-] of the largest shaft speed
MOTOR_POLE = 7.2115  # [rad/s]
MOTOR_DELAY = 0.345  # [s]
THRUSTER_ARM = 0.15  # [m] of the horizontal thrusters, at (-0.25, -+0.15, 0)
NUM_HORIZONTAL_THRUSTERS = 2.0
NUM_VERTICAL_THRUSTERS = 2.0  # myellow/sim.yaml; the surface craft mred and mblack have none
