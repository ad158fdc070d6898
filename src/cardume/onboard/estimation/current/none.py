"""No observer: the vehicle believes the water stands still."""

from cardume.onboard.estimation.current.base import current_observer_law
from cardume.signals import Motion, NavigationEstimate, Water


@current_observer_law
def none(position: NavigationEstimate, motion: Motion) -> Water:
    """Believe in no current.

    Vc_hat = 0

    Args:
        position: not used.
        motion: not used.

    Returns:
        No current [m/s].

    Source: paper section 2, before the observer.
    """
    return Water(0.0, 0.0)
