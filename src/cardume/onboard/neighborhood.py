"""What a vehicle hears of the others, and what they do meanwhile."""

from cardume.compiler import Rows, compiled, load, negate, some, where
from cardume.onboard.coordination import correct_speed
from cardume.onboard.estimation.neighbors import predict
from cardume.onboard.mind import (
    FORESEES,
    HAS_PHASES,
    YIELDS,
    Fresh,
    Mind,
    News,
    Outlook,
    get_along,
    get_fresh,
    get_news,
    get_outlook,
    head_of,
    is_fresh,
    message_from,
    neighbors_of,
    put_fresh,
    put_news,
    put_outlook,
    sighting_in,
)
from cardume.onboard.pace import pace_gained, pace_of_neighbor
from cardume.onboard.phases import has_told, is_waiting, takes_part
from cardume.onboard.silence import is_silent
from cardume.signals import NOTHING, Disagreement, NeighborReport, PathError

SAME = 1e-6  # [s] within rounding


@compiled
def forget_news(mind: Mind) -> None:
    """What was new in the last tick is known now."""
    for k in range(1, load(mind.known, 0) + 1):
        put_fresh(mind.others, load(mind.known, k), Fresh(0.0))


@compiled
def listen(mind: Mind, heard: Rows, time: float) -> None:
    """Note the newest that the messages of this tick say of each vehicle that matters."""
    for k in range(1, load(mind.known, 0) + 1):
        vehicle = load(mind.known, k)
        for source in range(load(mind.sources, 0)):
            message = message_from(heard, mind.size, source)
            if some(is_fresh(message)):
                note(mind, message, load(mind.sources, source + 1), vehicle, time)


@compiled
def note(mind: Mind, message: Rows, sender: int, vehicle: int, time: float) -> None:
    """Learn a vehicle's coordination state from a message, its own or a sighting, if that is newer, and its phase.

    Phases only follow one another, so that a message which a sighting has overtaken still tells a later one.
    """
    if sender == vehicle:
        head = head_of(message)
        learnt = News(head.coordination_state, head.path_speed, head.time_of_validity, head.phase)
    else:
        seen = sighting_in(message, vehicle)
        learnt = News(seen.coordination_state, seen.path_speed, seen.time_of_validity, seen.phase)
    before, is_read = get_news(mind.others, vehicle), is_fresh(message)
    phase = where(is_read & (learnt.phase > before.phase), learnt.phase, before.phase)
    put_news(mind.others, vehicle, News(before.state, before.path_speed, before.time_of_validity, phase))
    was_set_back = before.time_of_validity > time + SAME  # the own clock, or somebody told of the future
    is_new = is_read & ((learnt.time_of_validity > before.time_of_validity) | was_set_back)
    valid = where(learnt.time_of_validity > time + SAME, time, learnt.time_of_validity)
    learn(mind, vehicle, is_new, News(learnt.state, learnt.path_speed, valid, phase))


@compiled
def learn(mind: Mind, vehicle: int, is_new: bool, news: News) -> None:
    """Note news of a vehicle, in the lanes where they are new."""
    put_news(mind.others, vehicle, where(is_new, news, get_news(mind.others, vehicle)))
    put_fresh(mind.others, vehicle, where(is_new, Fresh(1.0), get_fresh(mind.others, vehicle)))


@compiled
def predict_neighbors(mind: Mind, heard: Rows, error: PathError, time: float) -> Disagreement:
    """Bring what is known of the others up to now, and compare: (53)-(55), (D^-1 L gamma)_i."""
    listen(mind, heard, time)
    own_before = error.path_parameter - mind.book.dt * get_along(mind.own, 0).path_speed
    for k in range(1, load(mind.known, 0) + 1):
        expect_correction(mind, load(mind.known, k), own_before)
    for k in range(1, load(mind.known, 0) + 1):
        bring_up_to_date(mind, load(mind.known, k), error, time)
    if load(mind.features, FORESEES) > 0:
        foresee(mind, error, own_before, time)
    return disagreement_of(mind, mind.me, error.path_parameter, error.path_parameter)


@compiled
def foresee(mind: Mind, error: PathError, own_before: float, time: float) -> None:
    """Predict oneself as the others do, from what was last said: gamma_hat of event-triggered sending.

    Args:
        mind: whose view it is.
        error: where it is on its path.
        own_before: [m] own coordination state at the last tick.
        time: [s]
    """
    expect_correction(mind, mind.me, own_before)
    bring_up_to_date(mind, mind.me, error, time)
    put_fresh(mind.others, mind.me, Fresh(0.0))


@compiled
def expect_correction(mind: Mind, vehicle: int, own_before: float) -> None:
    """What coordination made a vehicle do since the last tick, by all states as they were then.

    Args:
        mind: whose view it is.
        vehicle: who is thought of.
        own_before: [m] own coordination state at the last tick.
    """
    state = get_outlook(mind.others, vehicle).state
    apart = disagreement_of(mind, vehicle, state, own_before)
    has_view = apart.disagreement == apart.disagreement
    in_agreement = Disagreement(own_before, own_before, 0.0 * own_before)
    slot = mind.size if vehicle == mind.me else vehicle  # its own memory of the law is for what it does
    correction = correct_speed(mind.book, slot, where(has_view, apart, in_agreement))
    put_outlook(mind.others, vehicle, Outlook(state, correction))


@compiled
def bring_up_to_date(mind: Mind, vehicle: int, error: PathError, time: float) -> None:
    """Predict where a vehicle is along the formation by now."""
    news, outlook = get_news(mind.others, vehicle), get_outlook(mind.others, vehicle)
    is_new, age = get_fresh(mind.others, vehicle).is_new, time - news.time_of_validity
    nominal, expected = pace_of_neighbor(mind, outlook, error, time), outlook.correction
    is_known = news.state == news.state
    path_speed = news.path_speed + pace_gained(mind, news.time_of_validity, time)
    path_speed = where(path_speed == path_speed, path_speed, nominal)
    if load(mind.features, HAS_PHASES) > 0:
        waits = is_waiting(news.phase) & has_told(news.phase)
        nominal, expected = where(waits, 0.0, nominal), where(waits, 0.0, expected)
        is_known = is_known & takes_part(news.phase)
    if load(mind.features, YIELDS) > 0:
        is_known = is_known & negate(is_silent(mind, vehicle, time))
    heard_last = NeighborReport(is_new, news.state, path_speed, age, nominal, expected)
    predicted = predict(mind.book, vehicle, heard_last)
    put_outlook(mind.others, vehicle, Outlook(where(is_known, predicted, NOTHING), outlook.correction))


@compiled
def disagreement_of(mind: Mind, vehicle: int, state: float, own_state: float) -> Disagreement:
    """(D^-1 L gamma)_i: a state less the mean of those the vehicle hears and of whom anything is known.

    Args:
        mind: whose view it is.
        vehicle: i.
        state: [m] its coordination state.
        own_state: [m] that of the one whose view it is.
    """
    listed = neighbors_of(mind, vehicle)
    total, count = 0.0 * own_state, 0.0 * own_state
    for k in range(1, load(listed, 0) + 1):
        other = load(listed, k)
        if other == mind.me:
            total, count = total + own_state, count + 1.0
        else:
            predicted = get_outlook(mind.others, other).state
            is_known = predicted == predicted
            total, count = total + where(is_known, predicted, 0.0), count + where(is_known, 1.0, 0.0)
    mean = where(count > 0.5, total / where(count > 0.5, count, 1.0), state)
    return Disagreement(state, mean, state - mean)
