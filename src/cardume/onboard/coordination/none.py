"""No coordination: every vehicle keeps the formation's speed."""

from cardume.laws import MetersPerSecond
from cardume.onboard.coordination.base import coordination_law
from cardume.signals import Disagreement


@coordination_law
def none(disagreement: Disagreement) -> MetersPerSecond:
    """Do not correct.

    v_i = v_L

    Args:
        disagreement: not used.

    Returns:
        0 [m/s].

    Source: paper section 3, single vehicle.
    """
    return 0.0
