"""What a vehicle tells the others, when, and in how many bits."""

from typing import NamedTuple

from cardume.compiler import Rows, compiled, load, where
from cardume.onboard.messaging import decide_to_send
from cardume.onboard.messaging.polling import asked_in_turn
from cardume.onboard.messaging.rounding import rounded_report
from cardume.onboard.mind import (
    ANSWERS,
    FORESEES,
    NEVER,
    ROUNDS,
    Fresh,
    Mind,
    News,
    Speech,
    get_along,
    get_grid,
    get_news,
    get_outlook,
    get_progress,
    get_setup,
    get_speech,
    head_of,
    is_fresh,
    message_from,
    put_fresh,
    put_news,
    put_speech,
)
from cardume.signals import NOTHING, Forecast, Outbox, Question, Report


class Said(NamedTuple):
    """What a vehicle tells the others: a report and, from a vehicle with a USBL head, what it knows of the others."""

    report: Report
    others: Rows


@compiled
def report(mind: Mind, heard: Rows, time: float) -> Said:
    """What to tell the others now, if anything."""
    along, speech, setup = get_along(mind.own, 0), get_speech(mind.own, 0), get_setup(mind.own, 0)
    elapsed, place = time - speech.last_sent, 1.0 * mind.me
    elapsed = where(elapsed < 0.0, NEVER, elapsed)  # the clock was set back since
    outbox = Outbox(elapsed, along.coordination_state, along.path_speed, time, place, 1.0 * mind.size)
    asked, deviation = 0.0 * outbox.elapsed, NOTHING * outbox.elapsed
    if load(mind.features, ANSWERS) > 0:
        asked = is_asked(mind, heard)
    if load(mind.features, FORESEES) > 0:
        deviation = along.coordination_state - get_outlook(mind.others, mind.me).state
    turn = Question(setup.shares_sightings, asked)
    sending = decide_to_send(mind.book, 0, outbox, turn, Forecast(deviation))
    sends = sending > 0.5
    after = where(sends, Speech(time + 0.0 * speech.sequence, speech.sequence + 1.0), speech)
    put_speech(mind.own, 0, after)
    told = Report(
        sending,
        after.sequence,
        time + 0.0 * sending,
        along.coordination_state,
        along.path_speed,
        get_progress(mind.own, 0).phase,
        next_to_answer(mind, after.sequence),
    )
    if load(mind.features, ROUNDS) > 0:
        told = rounded_report(told, get_grid(mind.own, 0))
    if load(mind.features, FORESEES) > 0:
        said = News(told.coordination_state, told.path_speed, told.time_of_validity, told.phase)
        put_news(mind.others, mind.me, where(sends, said, get_news(mind.others, mind.me)))
        put_fresh(mind.others, mind.me, Fresh(where(sends, 1.0, 0.0)))
    return Said(told, mind.others)


@compiled
def is_asked(mind: Mind, heard: Rows) -> float:
    """Whether a message of this tick asks this vehicle [-]."""
    asked = 0.0 * get_speech(mind.own, 0).sequence
    for source in range(load(mind.sources, 0)):
        message = message_from(heard, mind.size, source)
        asked = where(is_fresh(message) & (head_of(message).asks == 1.0 * mind.me), 1.0, asked)
    return asked


@compiled
def next_to_answer(mind: Mind, sequence: float) -> float:
    """Place of the vehicle that a message asks [-]: of the one with the head, the others in turn; else -1.

    Args:
        mind: whose message it is.
        sequence: [-] of the message.
    """
    asks = 0.0 * sequence - 1.0
    if load(mind.features, ANSWERS) > 0 and mind.size > 1:
        turn = asked_in_turn(sequence, 1.0 * mind.me, 1.0 * mind.size)
        asks = where(get_setup(mind.own, 0).shares_sightings > 0.5, turn, asks)
    return asks
