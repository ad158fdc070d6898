"""Speak when asked: the vehicle with the USBL head asks the others in turn, and each answers."""

from cardume.compiler import compiled, where
from cardume.laws import Meters, NotNegative, Positive, Seconds
from cardume.maths import floor
from cardume.onboard.messaging.base import messaging_law
from cardume.signals import Outbox, Question

SAID = 256.0  # of a sequence number only the remainder is in a packet


@compiled
def asked_in_turn(sequence: float, place: float, size: float) -> float:
    """Place of the vehicle that a question asks [-], by its number: so the packet need not say it.

    Args:
        sequence: [-] of the question; all that have the same last eight bits ask the same vehicle.
        place: [-] of the one who asks, by name, from 0.
        size: [-] vehicles in the fleet, at least 2.
    """
    number, others = sequence - SAID * floor(sequence / SAID), size - 1.0
    turn = number - others * floor(number / others)
    return where(turn < place, turn, turn + 1.0)


@messaging_law
def polling(
    outbox: Outbox,
    question: Question,
    dt: Seconds,
    slot: NotNegative[Seconds] = 0.0,
    range: Positive[Meters] = 500.0,
    guard: NotNegative[Seconds] = 0.2,
) -> float:
    """The head asks once a slot, in turn; the others answer in the tick in which the question comes.

    send = t - t_last >= slot for the head,   send = asked for the others

    A question carries what the head says to all.  The USBL reading comes with the answer: it needs both ways, is valid
    when the answer was sent, and there is none where a question or an answer is lost.  A slot that is left out is as
    long as both need: time on the air of question and answer, twice range over the speed of sound and the modem's
    processing, and the guard, rounded up to whole ticks.  A cycle has a slot for each vehicle but the head.

    Args:
        outbox: time since the last sending.
        question: whether this vehicle asks, and whether it is asked.
        dt: [s] tick.
        slot: [s] 0: what modem, messages, range and guard need.
        range: [m] up to which an answer is waited for.
        guard: [s] after the answer.

    Returns:
        1 to send, else 0.

    Source: interrogation as on MEDUSA (a pinger with slack and timeout, `comms.yaml` of medusa_simulation) and COLA2,
        where the fix is measured on the reply and sent back with the next message.
    """
    each = where(slot > 0.0, slot, 1.0)
    asks = (question.is_head > 0.5) & (outbox.elapsed > each - 0.5 * dt)
    answers = (question.is_head < 0.5) & (question.asked > 0.5)
    return where(asks | answers, 1.0, 0.0)
