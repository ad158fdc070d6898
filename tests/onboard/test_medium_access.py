"""Who speaks when: slots, questions and answers, events; flown through the engine on a modem."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from cardume.errors import MissionError
from cardume.maths.random import random_key, uniforms
from cardume.missions.medium_access import broadcast_slot, cycle_of, slot_of, two_way_slot
from cardume.onboard.mind import OTHERS, UNTOLD, Outlook
from cardume.signals import Report, Sighting
from cardume.simulation.fleet import OnPath
from cardume.simulation.flight import Flight
from cardume.simulation.plan import VehiclePlan
from cardume.world.acoustics.medium import medium_of
from flying import fly_text
from properties.flown import plan_of
from simulation.ticks import Watched, watch

TEXT = """
cardume: 1
name: turns
seed: 5
duration: {duration} s
path: {{type: line, start: {{course: 20 deg}}, length: 900 m}}
formation: {{speed: 0.5 m/s}}
vehicles:
  - name: surface
    sensors: {{gnss: {{sigma: 0 m, period: 0.1 s}}, usbl: {{range_sigma: 0 m, angle_sigma: 0 deg}},
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg}}, depth: {{sigma: 0 m}},
      thruster_speed: {{sigma: 0}}}}
  - {{name: port, depth: 10 m, offset: {{starboard: -40 m}}}}
  - {{name: starboard, depth: 10 m, offset: {{starboard: 40 m}}}}
position: {{law: reset_compensated}}
coordination: {{law: laplacian_tanh, gain: 0.15 m/s, topology: {topology}}}
messaging: {{schedule: {schedule}}}
acoustics: {{channel: modem, sound_speed: 1500 m/s, {channel}}}
"""


def seen_of(schedule: str, channel: str = "bursts: none", duration: float = 60.0, topology: str = "star") -> Watched:
    return watch(plan_of(TEXT.format(schedule=schedule, channel=channel, duration=duration, topology=topology)))


# ---- slots -----------------------------------------------------------------------------------------------------------


def sender(payload: int) -> VehiclePlan:
    plan = plan_of(TEXT.format(schedule="tdma", channel="bursts: none", duration=1.0, topology="star")).vehicles[0]
    return replace(plan, medium=medium_of(sound_speed=1500.0)._replace(payload=float(payload)))


@pytest.mark.parametrize(
    ("distance", "payload", "slot"),
    [(200, 7, 0.55), (500, 7, 0.75), (500, 37, 1.08), (1000, 7, 1.09), (1000, 37, 1.41)],
)
def test_slots_are_those_computed_by_hand(distance, payload, slot):
    """On the air + range / 1500 m/s + 0.09 s in the modem + 0.1 s of guard, from the published S2C durations."""
    assert broadcast_slot(sender(payload), distance, 0.1) == pytest.approx(slot, abs=0.006)


@pytest.mark.parametrize(
    ("distance", "payload", "slot"), [(200, 7, 0.85), (500, 7, 1.25), (500, 37, 1.58), (1000, 7, 1.92)]
)
def test_questions_and_answers_are_those_computed_by_hand(distance, payload, slot):
    """A request of a byte and its answer; by hand the modem was counted once, 0.09 s, and it is in the way twice."""
    assert two_way_slot(sender(1), sender(payload), distance, 0.1) == pytest.approx(slot + 0.09, abs=0.012)


def test_everyone_speaks_in_its_slot_and_is_heard():
    seen = seen_of("tdma, range: 200 m")
    rows, fleet = seen.messages(), seen.plan.vehicles
    slot = slot_of(fleet[0], fleet, 0.1)
    assert slot == pytest.approx(0.1 * math.ceil((0.1545 + 20 * 0.01085 + 200 / 1500 + 0.09 + 0.1) / 0.1))
    assert cycle_of(fleet[0], fleet, 0.1) == pytest.approx(3 * slot)
    assert not rows["lost"].any()
    for place in range(3):
        times = np.unique(rows["time_sent"][rows["sender"] == place])
        assert times == pytest.approx(place * slot + 3 * slot * np.arange(len(times)), abs=1e-9)
        assert len(times) >= 60 // (3 * slot)
    on_air = {k: 0.1545 + 0.01085 * v.medium.payload for k, v in enumerate(fleet[i] for i in seen.plan.order)}
    waits = rows["time_received"] - rows["time_sent"] - [on_air[int(k)] for k in rows["sender"]] - 0.09
    assert (waits > 10 / 1500).all()
    assert (waits < 90 / 1500).all()


def test_a_payload_and_a_code_are_counted():
    def payloads(channel: str) -> list[float]:
        plan = plan_of(TEXT.format(schedule="tdma", channel=channel, duration=1.0, topology="star"))
        return [v.medium.payload for v in plan.vehicles]

    assert payloads("bursts: none") == [20.0, 6.0, 6.0]
    assert payloads("authentication: 4") == [24.0, 10.0, 10.0]
    assert payloads("payload: 7, authentication: 4") == [7.0, 7.0, 7.0]


# ---- questions and answers -------------------------------------------------------------------------------------------


def test_the_head_asks_in_turn_and_each_answers_when_it_hears():
    seen = seen_of("polling, range: 200 m")
    rows, names = seen.messages(), seen.names
    assert not rows["lost"].any()
    head = names.index("surface")
    asked = np.unique(rows["time_sent"][rows["sender"] == head])
    slot = slot_of(seen.plan.vehicles[0], seen.plan.vehicles, 0.1)
    assert asked == pytest.approx(slot * np.arange(len(asked)), abs=1e-9)
    answers = rows["sender"] != head
    turns = rows["sender"][answers].astype(int)
    assert (turns[1:] != turns[:-1]).all()  # one and the other
    for time, who in zip(rows["time_sent"][answers], turns, strict=True):
        question = asked[asked <= time + 1e-9][-1]
        heard = rows["time_received"][
            (rows["sender"] == head) & (rows["receiver"] == who) & (abs(rows["time_sent"] - question) < 1e-9)
        ]
        assert time == pytest.approx(0.1 * math.ceil(heard[0] / 0.1 - 1e-9), abs=1e-9)
    assert len(turns) >= len(asked) - 1


def test_a_reading_comes_with_an_answer_and_tells_where_its_sender_was():
    seen = seen_of("polling, range: 200 m")
    rows, names = seen.messages(), seen.names
    head = names.index("surface")
    readings = np.isfinite(seen.usbl[:, head, :, 3])
    came = 0
    for sent, received, who in zip(*(rows[c] for c in ("time_sent", "time_received", "sender")), strict=True):
        if who == head or received > 59.7:
            continue
        tick = math.ceil(received / 0.1 - 1e-9) + 1  # the next one
        reading = seen.usbl[tick, head, int(who)]
        assert reading[3] == pytest.approx(0.1 * tick - sent, abs=1e-9)
        then = round(sent / 0.1)
        places = [[seen.truth[then, k, axis] for axis in range(3)] for k in (head, int(who))]  # north, east, depth
        assert reading[0] == pytest.approx(float(np.linalg.norm(np.subtract(*places))), abs=1e-9)
        came += 1
    assert readings.sum() >= came > 30
    assert readings.sum() <= came + 2


def test_a_lost_question_is_not_answered_and_gives_no_reading():
    seen = seen_of("polling, range: 200 m", "loss: 0.4, burst: 0 s", duration=300.0)
    rows, names = seen.messages(), seen.names
    head = names.index("surface")
    questions = rows["sender"] == head
    asked = np.unique(rows["time_sent"][questions])
    for k, time in enumerate(asked[:-2]):
        sequence = k + 1
        who = sequence % 2  # among port and starboard, by name; the head is the last
        got = rows["lost"][questions & (rows["receiver"] == who) & (abs(rows["time_sent"] - time) < 1e-9)][0] < 0.5
        answer = (rows["sender"] == who) & (rows["time_sent"] >= time) & (rows["time_sent"] < asked[k + 1] - 1e-9)
        assert answer.sum() == got
    came = (rows["lost"] < 0.5) & ~questions
    assert np.isfinite(seen.usbl[:, head, :, 3]).sum() == pytest.approx(came.sum(), abs=1)
    assert 0.25 < came.sum() / len(asked) < 0.47  # (1 - 0.4)^2 = 0.36


def test_outages_are_drawn_link_by_link_from_the_named_numbers():
    """The log of losses, from the chain in continuous time and the random numbers of pair and tick."""
    seen = seen_of("tdma, range: 200 m", "loss: 0.4, burst: 6 s", duration=300.0)
    rows, names = seen.messages(), seen.names
    for receiver in range(3):
        for sender_ in range(3):
            mine = (rows["receiver"] == receiver) & (rows["sender"] == sender_)
            own, other = (random_key(5, "link", names[k]) for k in (receiver, sender_))
            out, last = 0.0, -1e9
            for sent, lost in zip(rows["time_sent"][mine], rows["lost"][mine], strict=True):
                _, draw, _, _ = uniforms(own._replace(vehicle_high=other.vehicle_low), float(round(sent / 0.1)))
                chance = 0.4 + (out - 0.4) * math.exp(-(sent - last) / (6.0 * 0.6))
                out, last = float(draw < chance), sent
                assert out == lost


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ("schedule: polling, heads: none", "one vehicle with a USBL head"),
        ("schedule: periodic, period: 0.1 s, delay: 30 s", "at least 0.5 s"),
    ],
)
def test_what_cannot_be_kept_is_refused(changes, words):
    text = TEXT.format(schedule="polling", channel="bursts: none", duration=10.0, topology="star")
    if "heads" in changes:
        text = text.replace("usbl: {range_sigma: 0 m, angle_sigma: 0 deg},", "")
    else:
        text = text.replace("schedule: polling", "schedule: periodic, period: 0.1 s")
        text = text.replace("channel: modem, sound_speed: 1500 m/s, bursts: none", "channel: bernoulli, delay: 30 s")
    with pytest.raises(MissionError, match=words):
        plan_of(text)


# ---- events ----------------------------------------------------------------------------------------------------------

PAIR = """
cardume: 1
name: events
duration: {duration} s
log_period: 0.1 s
tick: {tick} s
path: {{type: line, start: {{course: 70 deg}}, length: 3000 m}}
formation: {{speed: 0.5 m/s}}
current: {{type: uniform, speed: {current} m/s, towards: 70 deg}}
current_observer: {{law: 'aids:told', speed: {current}, towards: 70 deg}}
speed_reference: water
model: kinematic
vehicles:
  - {{name: a, sensors: ideal, start: {{along_track: {ahead}, speed: 0.5}}}}
  - {{name: b, sensors: ideal, offset: {{starboard: 5 m}}, start: {{speed: 0.5}}}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
coordination: {{law: laplacian_tanh, gain: {gain} m/s, topology: complete}}
neighbors: {{law: {neighbors}}}
messaging: {{schedule: event_triggered, trigger_floor: {floor} m, heartbeat: {heartbeat} s, dwell: {dwell} s}}
acoustics: {{channel: {channel}}}
"""


def events(**given) -> Flight:
    chosen = {
        "duration": 200,
        "current": 0.0,
        "ahead": 0.0,
        "gain": 0.2,
        "neighbors": "reported_speed",
        "floor": 0.5,
        "heartbeat": 1e6,
        "dwell": 0.1,
        "channel": "ideal",
        "tick": 0.1,
        **given,
    }
    flight = fly_text(PAIR.format(**chosen))
    assert flight.reason == "completed", flight.failure
    return flight


def sent_by(flight: Flight, vehicle: int) -> np.ndarray:
    """Times [s] at which a vehicle spoke."""
    times: np.ndarray = np.unique(flight.messages["time_sent"][flight.messages["sender"] == vehicle])
    return times


@pytest.mark.parametrize(
    ("current", "floor", "gain"), [(0.1, 0.5, 0.01), (0.1, 0.5, 0.2), (0.15, 0.4, 0.2), (0.15, 0.3, 0.1)]
)
def test_in_a_current_messages_come_at_the_rate_of_the_drift_over_the_floor(current, floor, gain):
    """Row P, |Vpar| / eps, and what it leaves out: each sees the other fall behind by x, and slows down for it.

    Receivers add v_L times the age, so x' = Vpar - k tanh(x) from 0 to eps between two messages.
    """
    law = "'printed_prediction:nominal_speed'"
    wanted, _ = quad(lambda x: 1.0 / (current - gain * math.tanh(x)), 0.0, floor)
    gaps = []
    for tick in (0.1, 0.05, 0.025):
        flight = events(current=current, floor=floor, gain=gain, neighbors=law, duration=200, tick=tick, dwell=tick)
        gaps.append(np.diff(sent_by(flight, 0)[2:]).mean())
    print(wanted, gaps)
    assert gaps[2] == pytest.approx(wanted, abs=max(0.06, 0.02 * wanted))
    assert abs(gaps[2] - wanted) < abs(gaps[0] - wanted) + 0.03


def test_where_slowing_down_holds_the_drift_nothing_more_is_said():
    """k tanh(eps) > Vpar: x stays below the floor for ever."""
    flight = events(current=0.05, floor=0.7, neighbors="'printed_prediction:nominal_speed'")
    assert len(sent_by(flight, 0)) == 1


@pytest.mark.parametrize(("floor", "gain"), [(0.5, 0.2), (0.3, 0.3)])
def test_without_current_the_time_between_messages_is_bounded_below(floor, gain):
    """Row P: >= eps / k_xi, while the two come together from 6 m apart."""
    flight = events(ahead=6.0, floor=floor, gain=gain, neighbors="'printed_prediction:nominal_speed'")
    for vehicle in range(2):
        times = sent_by(flight, vehicle)
        times = times[1:] if vehicle else times  # the second one's first word answers the first one's
        assert len(times) > 3
        assert np.diff(times).min() >= floor / gain - 1e-9
    assert np.ptp(flight.channels["coordination_state"][-1]) < 2.0 * floor


def test_what_is_said_carries_its_speed_and_then_a_current_costs_nothing():
    """Receivers that add the reported path speed times the age need no further message at a steady speed."""
    flight = events(current=0.1)
    assert len(sent_by(flight, 0)) <= 2
    state = flight.channels["coordination_state"]
    pace = (state[-1] - state[-200]) / (flight.times[-1] - flight.times[-200])
    assert pace == pytest.approx(0.6, abs=1e-6)


@pytest.mark.parametrize("neighbors", ["reported_speed", "coordinated", "last_report"])
def test_the_sender_knows_what_the_receiver_predicts(neighbors):
    """gamma_hat of the sender is the receiver's prediction of it, whatever the law, on a channel that loses nothing.

    What is heard a tick later differs for that tick alone; `coordinated` steps by what each knows of both, which
    differs by as much as the two states are apart from what is predicted of them.
    """
    flight = events(ahead=4.0, floor=0.2, neighbors=neighbors, duration=60, dwell=0.5)
    own = flight.neighbor_state_estimate[:, 0, 0]
    theirs = flight.neighbor_state_estimate[:, 1, 0]
    spoken = np.isin(
        np.round(flight.times, 6), np.round(np.concatenate([sent_by(flight, 0) + k for k in (0.0, 0.1)]), 6)
    )
    apart = np.abs(own - theirs)[~spoken]
    apart = apart[np.isfinite(apart)]
    assert len(apart) > 300
    limit = 0.3 if neighbors == "coordinated" else 1e-9
    assert apart.max() <= limit
    deviation = np.abs(flight.channels["coordination_state_estimate"][:, 0] - own)[20:]
    assert np.nanmax(deviation) < 0.2 + 0.5 * 0.75  # the floor, and what may come within a dwell


@pytest.mark.parametrize("dwell", [1.0, 3.0])
def test_a_dwell_is_never_violated(dwell):
    """With a filter that jumps at fixes and a modem that loses in bursts."""
    schedule = f"event_triggered, trigger_floor: 0.05 m, dwell: {dwell} s, heartbeat: 20 s"
    channel = "bursts: coastal"
    seen = seen_of(schedule, channel, duration=200.0)
    rows = seen.messages()
    for k in range(3):
        times = np.unique(rows["time_sent"][rows["sender"] == k])
        assert len(times) > 5
        assert np.diff(times).min() >= dwell - 1e-9
        assert np.diff(times).max() <= 20.0 + 1e-9
        assert times[0] == pytest.approx(k * dwell, abs=1e-9)


def test_its_own_forecast_stands_beside_those_of_the_others():
    seen = seen_of("event_triggered", duration=5.0)
    rows = seen.tables.others.reshape(3, 3, OTHERS.width)
    own = rows[np.arange(3), np.arange(3), OTHERS.column(Outlook, "state")]
    assert np.isfinite(own).all()


def test_numbers_are_rounded_where_the_codec_is_compact():
    seen = seen_of("tdma, range: 200 m", "codec: compact", duration=30.0)
    exact = seen_of("tdma, range: 200 m", "codec: exact", duration=30.0)
    heads = seen.inbox[:, :, 1:8]
    states = heads[..., 3][np.isfinite(heads[..., 3])]
    assert np.abs(states / 0.25 - np.round(states / 0.25)).max() < 1e-9
    loose = exact.inbox[:, :, 4][np.isfinite(exact.inbox[:, :, 4])]
    assert np.abs(loose / 0.25 - np.round(loose / 0.25)).max() > 0.1


def test_what_is_told_of_others_is_what_the_codec_would_have_read():
    """Of every message in an inbox: one age for fix and state, in its steps; of a silent one no speed."""
    text = TEXT.format(schedule="tdma, range: 200 m", channel="codec: compact", duration=30.0, topology="complete")
    seen = watch(plan_of(text.replace("name: port,", "name: port, messaging: none,")))
    assert seen.names == ["port", "starboard", "surface"]
    size, width = 3, len(Sighting._fields)
    told = seen.inbox.reshape(len(seen.inbox), -1, seen.inbox.shape[-1])
    heads, sightings = told[..., 1 : 1 + len(Report._fields)], told[..., 1 + len(Report._fields) :]
    times = heads[..., Report._fields.index("time_of_validity")]
    found = sightings.reshape(*told.shape[:2], size, width)
    field = {name: found[..., k] for k, name in enumerate(Sighting._fields)}
    has_fix = np.isfinite(field["north"])
    assert has_fix.any(axis=(0, 1)).tolist() == [True, True, False]  # the head sees the other two
    ages = (times[..., None] - field["time_of_fix"])[has_fix]
    assert np.abs(ages / 0.4 - np.round(ages / 0.4)).max() < 1e-6
    assert (field["time_of_fix"] == field["time_of_validity"])[has_fix].all()
    assert np.abs(field["north"][has_fix] / 0.2 - np.round(field["north"][has_fix] / 0.2)).max() < 1e-6
    assert np.isnan(field["north_variance"]).all()
    unheard = has_fix[..., 0]
    assert (field["phase"][..., 0][unheard] == UNTOLD).all()
    assert np.isnan(field["path_speed"][..., 0][unheard]).all()
    assert (field["phase"][..., 1][has_fix[..., 1]][-50:] == 4.0).all()
    believed = seen.tables.others.reshape(size, size, OTHERS.width)[1, 0, OTHERS.column(Outlook, "state")]
    true = seen.in_tick(OnPath, "coordination_state")[-1, 0]
    assert believed == pytest.approx(true, abs=1.5)  # starboard goes by what the head said of port
