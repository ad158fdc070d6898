"""Laws that isolate one equation: they do nothing, or know what a vehicle would have to estimate."""

from cardume.laws import MetersPerSecond, Radians
from cardume.maths import to_ned
from cardume.onboard.estimation.current.base import current_observer_law
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import Motion, NavigationEstimate, PathError, Water


@guidance_law
def parallel(error: PathError) -> Radians:
    """Keep to the direction of the path, whatever the error.

    chi_d = chi_p

    Args:
        error: path error.

    Returns:
        Desired course [rad].

    Source: none; what drifts off this course is what compensation left.
    """
    return error.path_course


@current_observer_law
def told(position: NavigationEstimate, motion: Motion, speed: MetersPerSecond = 0.0, towards: Radians = 0.0) -> Water:
    """A vehicle that was told the current before the mission.

    Vc_hat = speed (cos towards, sin towards)

    Args:
        position: not looked at.
        motion: not looked at.
        speed: [m/s] of the water.
        towards: [rad] where it flows to.

    Returns:
        The current [m/s].

    Source: none; it takes the observer's transient out of a test of compensation.
    """
    north, east = to_ned(towards, speed, 0.0)
    return Water(north, east)
