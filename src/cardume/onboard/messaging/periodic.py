"""Speak at fixed intervals."""

from cardume.compiler import where
from cardume.laws import NotNegative, Positive, Seconds
from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Outbox


@messaging_law
def periodic(outbox: Outbox, dt: Seconds, period: Positive[Seconds] = 1.0, offset: NotNegative[Seconds] = 0.0) -> float:
    """Send when the period has passed since the last sending.

    send = t - t_last >= period and t >= offset, to half a tick

    A vehicle with a USBL head does well to speak just after a reading: then its own state and what it
    says of the others carry the same GNSS error, which cancels in their difference.

    Args:
        outbox: time since the last sending [s].
        dt: [s] tick.
        period: [s] from one message to the next.
        offset: [s] of the first one.

    Returns:
        1 to send, else 0.

    Source: paper section 4.3: one exchange a second.
    """
    due = (outbox.elapsed > period - 0.5 * dt) & (outbox.time > offset - 0.5 * dt)
    return where(due, 1.0, 0.0)
