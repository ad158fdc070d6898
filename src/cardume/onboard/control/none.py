"""No autopilot: for vehicles that follow their reference by themselves."""

from cardume.onboard.control.base import autopilot_law
from cardume.signals import Command, Feedback


@autopilot_law
def none(feedback: Feedback) -> Command:
    """Ask nothing of the thrusters.

    tau = 0

    Args:
        feedback: not looked at.

    Returns:
        No thrust [N], moment [N m] or heave force [N].

    Source: paper eq. (1), whose vehicle has no thrusters.
    """
    return Command(0.0, 0.0, 0.0)
