"""Speak at fixed intervals."""

from cardume.compiler import where
from cardume.laws import Positive, Seconds
from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Outbox


@messaging_law
def periodic(outbox: Outbox, dt: Seconds, period: Positive[Seconds] = 1.0) -> float:
    """Send when the period has passed since the last sending.

    send = t - t_last >= period, to half a tick

    Args:
        outbox: time since the last sending [s].
        dt: [s] tick.
        period: [s] between messages.

    Returns:
        1 to send, else 0.

    Source: paper section 4.3: one exchange a second.
    """
    return where(outbox.elapsed > period - 0.5 * dt, 1.0, 0.0)
