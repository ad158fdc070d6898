"""What a vehicle knows of the others, what they do meanwhile, and what it tells them."""

from typing import NamedTuple

from cardume.compiler import Rows, at, compiled, load, negate, some, where
from cardume.maths import floor, to_cartesian, to_ned_3d
from cardume.maths.blocks import Spread
from cardume.onboard.coordination import correct_speed
from cardume.onboard.estimation.neighbors import predict
from cardume.onboard.messaging import decide_to_send
from cardume.onboard.mind import (
    ANSWERS,
    FORESEES,
    HAS_PHASES,
    ROUNDS,
    Fresh,
    Grid,
    LastSeen,
    Mind,
    News,
    Outlook,
    Speech,
    get_along,
    get_datasheet,
    get_fresh,
    get_grid,
    get_last_seen,
    get_news,
    get_outlook,
    get_progress,
    get_seen_place,
    get_setup,
    get_speech,
    head_of,
    is_fresh,
    message_from,
    neighbors_of,
    path_of,
    put_fresh,
    put_last_seen,
    put_news,
    put_outlook,
    put_seen_place,
    put_speech,
    sighting_in,
)
from cardume.onboard.pace import pace_gained, pace_of_neighbor
from cardume.onboard.phases import has_told, is_waiting, takes_part
from cardume.paths.projection import project
from cardume.signals import (
    NOTHING,
    Disagreement,
    Forecast,
    Measured,
    Motion,
    NavigationEstimate,
    NeighborReport,
    Outbox,
    PathError,
    Place,
    Question,
    Report,
    Sighting,
)

USBL_WIDTH = 4  # range, azimuth, elevation, age


class Said(NamedTuple):
    """What a vehicle tells the others: a report and, from a vehicle with a USBL head, what it knows of the others."""

    report: Report
    others: Rows


@compiled
def forget_news(mind: Mind) -> None:
    """What was new in the last tick is known now."""
    for k in range(1, load(mind.known, 0) + 1):
        put_fresh(mind.others, load(mind.known, k), Fresh(0.0))


@compiled
def listen(mind: Mind, heard: Rows) -> None:
    """Note the newest that the messages of this tick say of each vehicle that matters."""
    for k in range(1, load(mind.known, 0) + 1):
        vehicle = load(mind.known, k)
        for source in range(load(mind.sources, 0)):
            message = message_from(heard, mind.size, source)
            if some(is_fresh(message)):
                note(mind, message, load(mind.sources, source + 1), vehicle)


@compiled
def note(mind: Mind, message: Rows, sender: int, vehicle: int) -> None:
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
    is_new = is_read & (learnt.time_of_validity > before.time_of_validity)
    learn(mind, vehicle, is_new, News(learnt.state, learnt.path_speed, learnt.time_of_validity, phase))


@compiled
def learn(mind: Mind, vehicle: int, is_new: bool, news: News) -> None:
    """Note news of a vehicle, in the lanes where they are new."""
    put_news(mind.others, vehicle, where(is_new, news, get_news(mind.others, vehicle)))
    put_fresh(mind.others, vehicle, where(is_new, Fresh(1.0), get_fresh(mind.others, vehicle)))


@compiled
def look_around(
    mind: Mind, measured: Measured, position: NavigationEstimate, motion: Motion, error: PathError, time: float
) -> None:
    """Begin the tick without news of the others; with a USBL head, turn each new reading into news.

    p_j = p_1 - V_1 age + R_1 r, R_1 the measured attitude, turned back by the yaw rate times the age;
    gamma_j is the projection of p_j on j's own path.
    """
    forget_news(mind)
    shares = some(get_setup(mind.own, 0).shares_sightings > 0.5)
    for vehicle in range(mind.size if shares else 0):
        reading = at(measured.usbl, vehicle * USBL_WIDTH)
        age = load(reading, 3)
        is_new = age == age
        if some(is_new):
            ahead, starboard, down = to_cartesian(load(reading, 0), load(reading, 1), load(reading, 2))
            north, east, down = to_ned_3d(
                measured.roll, measured.pitch, measured.heading - measured.yaw_rate * age, ahead, starboard, down
            )
            spread = spread_of_sighting(mind, position, north, east, down)
            north = north + position.north - age * (motion.north + motion.current_north)
            east = east + position.east - age * (motion.east + motion.current_east)
            nothing = NOTHING * age
            seen = LastSeen(north, east, time - age, spread.nn, spread.ne, spread.ee, nothing, nothing)
            has_bearing = is_new & (load(reading, 1) == load(reading, 1))
            sight(mind, vehicle, has_bearing, seen, error)
            is_range = is_new & negate(has_bearing)
            if some(is_range):
                ranged = range_from(mind, measured, position, motion, load(reading, 0), age, time)
                put_last_seen(mind.others, vehicle, where(is_range, ranged, get_last_seen(mind.others, vehicle)))


@compiled
def range_from(
    mind: Mind,
    measured: Measured,
    position: NavigationEstimate,
    motion: Motion,
    distance: float,
    age: float,
    time: float,
) -> LastSeen:
    """What is left of a reading without a bearing: from where how far away a vehicle was.

    Its variances are those of the own position and of the range together.

    Args:
        mind: of the one who measured.
        measured: its depth.
        position: its own.
        motion: its own.
        distance: [m] slant range.
        age: [s] of the reading.
        time: [s]
    """
    told = get_datasheet(mind.own, 0)
    own, known = told.gnss * told.gnss, position.north_variance == position.north_variance
    more = told.range * told.range
    return LastSeen(
        position.north - age * (motion.north + motion.current_north),
        position.east - age * (motion.east + motion.current_east),
        time - age,
        where(known, position.north_variance, own) + more,
        where(known, position.covariance, 0.0),
        where(known, position.east_variance, own) + more,
        distance,
        measured.depth,
    )


@compiled
def spread_of_sighting(mind: Mind, position: NavigationEstimate, north: float, east: float, down: float) -> Spread:
    """Covariance of where a vehicle is seen: long across the line of sight, where angles and heading go wrong.

    R = P_1 + a l l^T + b (1 - l l^T),   l = (north, east) / h,   h = hypot(north, east),   r = hypot(h, down)
    a = (sigma_r h / r)^2 + (sigma_a down)^2 + t,   b = (sigma_a h)^2 + (sigma_psi h)^2 + t,   t = (sigma_t down)^2

    P_1 is the covariance of the own position, of a vehicle that does not know it that of its GNSS; sigma_r and sigma_a
    are those of the USBL, sigma_psi and sigma_t those of heading and of roll and pitch.

    Args:
        mind: of the one who sees.
        position: its own.
        north: [m] of the target from the head, by measured attitude.
        east: [m]
        down: [m]
    """
    told = get_datasheet(mind.own, 0)
    level, below = north * north + east * east, down * down
    angle, tilt = told.angle * told.angle, below * told.attitude * told.attitude
    slant = where(level + below > 0.0, level + below, 1.0)
    along = told.range * told.range * level / slant + angle * below + tilt
    across = level * (angle + told.heading * told.heading) + tilt
    more = (along - across) / where(level > 0.0, level, 1.0)
    own, known = told.gnss * told.gnss, position.north_variance == position.north_variance
    return Spread(
        where(known, position.north_variance, own) + across + more * north * north,
        where(known, position.covariance, 0.0) + more * north * east,
        where(known, position.east_variance, own) + across + more * east * east,
    )


@compiled
def sight(mind: Mind, vehicle: int, is_new: bool, seen: LastSeen, error: PathError) -> None:
    """Note where a vehicle was seen, and how far along its path the point abeam of it is.

    Args:
        mind: of the one who saw.
        vehicle: who was seen.
        is_new: [-] whether it was, in each lane.
        seen: where and when.
        error: where the one who saw is on its own path.
    """
    before, place_before = get_news(mind.others, vehicle), get_seen_place(mind.others, vehicle)
    seen_at = Place(where(is_new, seen.north, 0.0), where(is_new, seen.east, 0.0), path_of(mind, vehicle))
    found, place = project(seen_at, place_before)
    speed = where(before.state == before.state, before.path_speed, error.speed_profile)
    learn(mind, vehicle, is_new, News(found.path_parameter, speed, seen.time_of_fix, before.phase))
    put_last_seen(mind.others, vehicle, where(is_new, seen, get_last_seen(mind.others, vehicle)))
    put_seen_place(mind.others, vehicle, where(is_new, place, place_before))


@compiled
def predict_neighbors(mind: Mind, heard: Rows, error: PathError, time: float) -> Disagreement:
    """Bring what is known of the others up to now, and compare: (53)-(55), (D^-1 L gamma)_i."""
    listen(mind, heard)
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
    if load(mind.features, HAS_PHASES) > 0:
        waits = is_waiting(news.phase) & has_told(news.phase)
        nominal, expected = where(waits, 0.0, nominal), where(waits, 0.0, expected)
        is_known = is_known & takes_part(news.phase)
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


@compiled
def report(mind: Mind, heard: Rows, time: float) -> Said:
    """What to tell the others now, if anything."""
    along, speech, setup = get_along(mind.own, 0), get_speech(mind.own, 0), get_setup(mind.own, 0)
    elapsed, place = time - speech.last_sent, 1.0 * mind.me
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
        others = mind.size - 1.0
        turn = sequence - others * floor(sequence / others)
        other = where(turn < 1.0 * mind.me, turn, turn + 1.0)
        asks = where(get_setup(mind.own, 0).shares_sightings > 0.5, other, asks)
    return asks


@compiled
def rounded(value: float, step: float) -> float:
    """The multiple of a step that is nearest to a number.

    Args:
        value: [any]
        step: [any] 0: the number itself.
    """
    return where(step > 0.0, step * floor(value / where(step > 0.0, step, 1.0) + 0.5), value)


@compiled
def rounded_report(told: Report, grid: Grid) -> Report:
    """A report as it is after its way through few bits."""
    return Report(
        told.sending,
        told.sequence,
        told.time_of_validity,
        rounded(told.coordination_state, grid.state),
        rounded(told.path_speed, grid.path_speed),
        told.phase,
        told.asks,
    )


@compiled
def rounded_sighting(seen: Sighting, grid: Grid) -> Sighting:
    """A sighting as it is after its way through few bits, which say nothing of errors, nor of a range alone."""
    unsaid, is_range = NOTHING * seen.north, seen.range == seen.range
    return Sighting(
        where(is_range, NOTHING, rounded(seen.north, grid.position)),
        where(is_range, NOTHING, rounded(seen.east, grid.position)),
        where(is_range, NOTHING, rounded(seen.time_of_fix, grid.time)),
        rounded(seen.coordination_state, grid.state),
        rounded(seen.path_speed, grid.path_speed),
        rounded(seen.time_of_validity, grid.time),
        seen.phase,
        unsaid,
        unsaid,
        unsaid,
        unsaid,
        unsaid,
    )
