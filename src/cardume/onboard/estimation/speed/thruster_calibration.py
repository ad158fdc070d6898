"""Speed from thrust: the speed at which the drag equals what the shafts push."""

from typing import Annotated

from cardume.laws import Bounds, NotNegative, Number, Positive, Unit
from cardume.maths import maximum, signed_square, sqrt
from cardume.onboard.estimation.speed.base import speed_law
from cardume.signals import ShaftReading
from cardume.vehicles import medusa_data as farol

LEAST_ROOT = 1e-12  # [N s/m] keeps 0 / 0 away where neither thrust nor linear drag is


@speed_law
def thruster_calibration(
    reading: ShaftReading,
    thrust_coefficient: Positive[Annotated[float, Unit("N s^2/rad^2")]] = farol.THRUST_COEFFICIENT,
    num_thrusters: Annotated[float, Unit(""), Bounds(1.0, 16.0)] = farol.NUM_HORIZONTAL_THRUSTERS,
    linear_drag: NotNegative[Annotated[float, Unit("N s/m")]] = farol.SURGE_DRAG,
    quadratic_drag: NotNegative[Annotated[float, Unit("N s^2/m^2")]] = farol.SURGE_DRAG_QUADRATIC,
    scale: Positive[Number] = 1.0,
) -> float:
    """Surge from the mean shaft speed of the horizontal thrusters.

    tau = N c n |n|,   u = a (-X_u - sqrt(X_u^2 - 4 X_uu tau)) / (2 X_uu)

    The paper writes the drag with negative X_u, X_uu; here linear_drag = -X_u and quadratic_drag = -X_uu,
    and the root is written 2 tau / (d + sqrt(d^2 + 4 D |tau|)), which also holds without either drag and
    astern. It is the steady speed: while the vehicle accelerates it runs ahead of the truth, and it neglects
    m_v v r in turns.

    Args:
        reading: n = shaft_speed [rad/s], > 0 pushes ahead; NaN gives NaN.
        thrust_coefficient: [N s^2/rad^2] c, of each thruster.
        num_thrusters: [-] N, how many push ahead.
        linear_drag: [N s/m] d >= 0; may be zero, as quadratic_drag may, but not both.
        quadratic_drag: [N s^2/m^2] D >= 0, that grows with the square of the speed.
        scale: [-] a, an error of the calibration; a = sqrt(f) where the thrust is believed to be f times what it is.

    Returns:
        Surge through the water [m/s].

    Source: paper eq. (37), and (38) with the factor on the speed, as (39) has it.
    """
    thrust = num_thrusters * thrust_coefficient * signed_square(reading.shaft_speed)
    root = sqrt(linear_drag * linear_drag + 4.0 * quadratic_drag * abs(thrust))
    return scale * 2.0 * thrust / maximum(LEAST_ROOT, linear_drag + root)
