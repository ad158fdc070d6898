"""The current inside the guidance law: approach and crab angle from one arcsine."""

from cardume.laws import Meters, Positive
from cardume.maths import asin, clip, to_path
from cardume.onboard.guidance.arcsine import STEEPEST
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import NOTHING, Demand, Motion, PathError

SLOWEST = 0.1  # [m/s] as `crab`: keeps the quotient small before the vehicle moves


@guidance_law
def arcsine_with_current(error: PathError, motion: Motion, decay_length: Positive[Meters] = 8.0) -> Demand:
    """Make the cross-track error decay with the distance flown, in a current that is estimated.

    psi_d = chi_p - asin(sat(e / l + Vperp / u)),   |sat| <= 0.99

    Vperp is the estimated current across the path, to starboard, u the surge. Unsaturated, on a line,
    e = e0 exp(-u t / l) in any current that is known. This is the other way to meet a current: inside the
    law instead of behind it. It asks for a heading, so `compensation` leaves that alone and gives only the speed.

    Args:
        error: path error; e = cross_track > 0 to starboard, chi_p = path_course.
        motion: believed surge [m/s] and current [m/s].
        decay_length: [m] l > 0, the distance through the water in which the error falls to 1 / e of itself.

    Returns:
        Desired heading [rad], NED, and the course of the path for the record.

    Source: hungrepo/cooperative-path-following, `CPF-Medusa/Simulation/Mylibrary.mdl` (a, theta, yaw_ref; its
    s = 8 m and 2 m), the form flown on MEDUSAs; saturated there at 1 and not guarded at rest.
    """
    _, across = to_path(error.path_course, motion.current_north, motion.current_east)
    speed = clip(motion.surge, SLOWEST, 1e9)
    sine = clip(error.cross_track / decay_length + across / speed, -STEEPEST, STEEPEST)
    return Demand(error.path_course, error.path_course - asin(sine), NOTHING, NOTHING)
