"""Speak when the others would be wrong: send by events instead of by the clock."""

from cardume.compiler import where
from cardume.laws import Meters, NotNegative, PerSecond, Positive, Seconds
from cardume.maths import exp
from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Forecast, Outbox


@messaging_law
def event_triggered(
    outbox: Outbox,
    forecast: Forecast,
    dt: Seconds,
    trigger_floor: Positive[Meters] = 0.5,
    trigger_margin: NotNegative[Meters] = 0.0,
    trigger_decay: NotNegative[PerSecond] = 1.0,
    dwell: NotNegative[Seconds] = 1.0,
    heartbeat: Positive[Seconds] = 30.0,
) -> float:
    """Send when what the others predict of this vehicle is too far from where it knows itself to be.

    send = (|gamma - gamma_hat| > c0 + c1 e^(-alpha t) or t - t_last >= heartbeat) and t - t_last >= dwell

    gamma_hat is what those who heard the last message predict: the vehicle runs its own `neighbors` law on what it
    last said.  What was lost it does not know, so it says something every `heartbeat` at least.  With a filter's jumps,
    or in a current, nothing bounds the time between events from below: `dwell` does.  First it speaks `dwell` after the
    vehicle before it, by name.

    Args:
        outbox: time, time since the last sending, and place.
        forecast: gamma - gamma_hat.
        dt: [s] tick.
        trigger_floor: [m] c0, the error of prediction that is always borne.
        trigger_margin: [m] c1, what is borne beside it at the start of the mission.
        trigger_decay: [1/s] alpha, how fast that margin shrinks.
        dwell: [s] least time between two messages.
        heartbeat: [s] most time between two messages.

    Returns:
        1 to send, else 0.

    Source: Rego, Hung, Jones, Pascoal & Aguiar (2019), as coded in dsor-isr/farol: c0 = 0.001, c1 = 5, alpha = 1; dwell
        and heartbeat are ours.
    """
    size = where(forecast.deviation > 0.0, forecast.deviation, -forecast.deviation)
    is_wrong = size > trigger_floor + trigger_margin * exp(-trigger_decay * outbox.time)
    is_due = is_wrong | (outbox.elapsed > heartbeat - 0.5 * dt)
    may = (outbox.elapsed > dwell - 0.5 * dt) & (outbox.time > outbox.place * dwell - 0.5 * dt)
    return where(is_due & may, 1.0, 0.0)
