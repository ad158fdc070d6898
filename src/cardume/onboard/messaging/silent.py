"""Never speak."""

from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Outbox


@messaging_law
def silent(outbox: Outbox) -> float:
    """Send nothing, ever; a vehicle that is alone.

    send = 0

    Args:
        outbox: not used.

    Returns:
        0.

    Source: paper section 3, single vehicle.
    """
    return 0.0
