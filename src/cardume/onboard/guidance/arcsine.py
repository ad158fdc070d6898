"""Maurya's law: approach at a speed in proportion to the error."""

from cardume.laws import PerSecond, Positive, Radians
from cardume.maths import asin, clip
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError

STEEPEST = 0.99  # of a right angle's sine: at 1 the vehicle would make no way along the path
SLOWEST = 1e-3  # [m/s] keeps the quotient finite before the vehicle moves


@guidance_law
def arcsine(error: PathError, gain: Positive[PerSecond] = 0.1) -> Radians:
    """Make the cross-track error decay exponentially, as fast as the speed allows.

    chi_d = chi_p + asin(sat(-k1 e / u)),   |sat| <= 0.99

    Unsaturated e = e0 exp(-k1 t).  The paper saturates at 1, where the heading is square to the path
    and the slope of asin infinite; 0.99 leaves 14 % of the speed along the path and changes the
    approach by 1 %.

    Args:
        error: path error; e = cross_track > 0 to starboard, u = speed through the water.
        gain: [1/s] k1 > 0, how fast the error falls near the path.

    Returns:
        Desired course [rad], NED.

    Source: paper eq. (4) (Maurya); saturation level corrected.
    """
    speed = clip(error.speed, SLOWEST, 1e9)
    return error.path_course + asin(clip(-gain * error.cross_track / speed, -STEEPEST, STEEPEST))
