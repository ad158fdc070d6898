"""The current as the position filter knows it."""

from cardume.compiler import where
from cardume.onboard.estimation.current.base import current_observer_law
from cardume.signals import Motion, NavigationEstimate, Water


@current_observer_law
def from_position(position: NavigationEstimate, motion: Motion) -> Water:
    """Take the current from a position law that estimates it, such as `kalman_replay`.

    Vc_hat = V_T - V_m

    The sum of it and of the measured velocity through the water is the velocity over ground, also where speed or
    heading are measured wrongly; so compensation needs to know nothing of that.

    Args:
        position: with the current that its law estimates; NaN where it estimates none, which is taken for no current.
        motion: not used.

    Returns:
        The current [m/s], NED.

    Source: closed form K (docs/theory/closed-forms.md): e -> 0 needs the current that belongs to the speed as measured.
    """
    north, east = position.current_north, position.current_east
    return Water(where(north == north, north, 0.0), where(east == east, east, 0.0))
