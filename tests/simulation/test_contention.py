"""Modems that share the water: half duplex, collisions, capture; and the same bits in lanes."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from acceptance.test_bits import assert_same
from cardume.laws import Seconds
from cardume.onboard.messaging import messaging_law, tdma
from cardume.signals import Outbox
from cardume.simulation.fly import fly, fly_batch
from cardume.simulation.memo import NO_MEMO
from cardume.simulation.plan import Choice, Plan
from cardume.simulation.sizes import num_slots
from properties.flown import plan_of
from simulation.ticks import watch

TEXT = """
cardume: 1
name: shared
seed: 4
duration: {duration} s
path: {{type: line, length: 900 m}}
formation: {{speed: 0.5 m/s}}
model: kinematic
coordination: {{law: laplacian_tanh, topology: complete}}
messaging: {{schedule: periodic, period: {period} s}}
acoustics: {{channel: modem, sound_speed: 1500 m/s, {channel}}}
vehicles:
{vehicles}
"""
VEHICLE = """  - {{name: {name}, offset: {{starboard: {starboard} m}}, start: {{speed: 0.5 m/s}},
      messaging: {{offset: {offset} s}}}}
"""
SLOW = "overhead: 0 s, byte_time: 0.1 s, processing: 0 s, payload: {payload}"


def plan(places: dict[str, float], offsets: tuple[float, ...], duration=10.0, period=100.0, channel=SLOW, payload=10):
    """Vehicles abreast at places [m] to starboard that first speak at offsets [s]."""
    vehicles = "".join(
        VEHICLE.format(name=name, starboard=place, offset=offset)
        for (name, place), offset in zip(places.items(), offsets, strict=True)
    )
    text = TEXT.format(duration=duration, period=period, channel=channel.format(payload=payload), vehicles=vehicles)
    return plan_of(text)


def fate(own: Plan) -> dict[tuple[str, str, float], bool]:
    """Whether each message came: by sender, receiver and time of sending."""
    seen = watch(own)
    rows, names = seen.messages(), seen.names
    found = {}
    for sent, received, sender, receiver, lost in zip(
        *(rows[c] for c in ("time_sent", "time_received", "sender", "receiver", "lost")), strict=True
    ):
        found[names[int(sender)], names[int(receiver)], round(float(sent), 6)] = bool(lost < 0.5)
        assert np.isnan(received) == (lost > 0.5)
    return found


def test_two_that_speak_at_once_do_not_hear_each_other():
    found = fate(plan({"a": 0.0, "b": 30.0}, (1.0, 1.5)))  # each for a second
    assert found == {("a", "b", 1.0): False, ("b", "a", 1.5): False}
    apart = fate(plan({"a": 0.0, "b": 30.0}, (1.0, 2.1)))
    assert apart == {("a", "b", 1.0): True, ("b", "a", 2.1): True}


@pytest.mark.parametrize(("second", "comes"), [(2.9, False), (3.1, True)])
def test_packets_collide_as_in_ns_3(second, comes):
    """17 bytes at 80 bit/s take 1.7 s; its test sends at 1 s and at 2.99 or 3.001 s from two nodes 50 m away.

    There a packet of 17 bytes carries headers besides and lasts 2 s; so does ours, of 20 bytes.
    """
    own = plan({"a": -50.0, "m": 0.0, "z": 50.0}, (1.0, 50.0, second), payload=20)
    found = fate(own)
    assert found["a", "m", 1.0] is comes
    assert found["z", "m", second] is comes


def test_what_overlaps_depends_on_where_one_listens():
    """Sent one after the other, messages may overlap at one place and not at another: 600 m are 0.4 s."""
    own = plan({"a": 0.0, "b": 600.0, "c": 610.0}, (1.0, 2.1, 50.0))
    found = fate(own)
    assert not found["a", "c", 1.0]  # hears a from 1.4 to 2.4 s, b from 2.107 s: and b is louder
    assert found["b", "c", 2.1]
    assert not found["a", "b", 1.0]  # is still hearing when it begins to speak
    assert found["b", "a", 2.1]


def test_the_louder_captures_the_receiver():
    """b is 50 m from the listener, a 500 m: 15 dB of spreading (k = 1.5) and 2.3 of absorption."""
    places, offsets = {"a": 0.0, "b": 450.0, "c": 500.0}, (1.0, 1.5, 50.0)
    for capture, heard in ((6, True), (17.0, True), (17.6, False)):
        found = fate(plan(places, offsets, channel=SLOW + f", capture_db: {capture} dB"))
        assert not found["a", "c", 1.0]
        assert found["b", "c", 1.5] is heard


def test_those_that_are_not_listened_to_disturb_all_the_same():
    places, offsets = {"a": 0.0, "b": 30.0, "c": 60.0}, (1.0, 50.0, 1.3)
    own = plan(places, offsets)
    deaf = replace(own, hears=np.array([[0, 1, 0], [1, 0, 0], [0, 0, 0]]))  # b listens to a alone
    assert fate(deaf) == {("a", "b", 1.0): False}
    quiet = plan({"a": 0.0, "b": 30.0, "c": 60.0}, (1.0, 50.0, 60.0))
    assert fate(replace(quiet, hears=deaf.hears)) == {("a", "b", 1.0): True}


def test_a_modem_that_is_still_sending_sends_nothing_else():
    found = fate(plan({"a": 0.0, "b": 30.0}, (1.0, 50.0), period=0.6, duration=4.0))
    sent = {time: comes for (sender, _, time), comes in found.items() if sender == "a"}
    assert sent == {1.0: True, 1.6: False, 2.2: True, 2.8: False, 3.4: True}


@messaging_law
def chatter(outbox: Outbox, every: Seconds = 0.7) -> float:
    """Speaks now and then, each vehicle with its own times. Source: this test."""
    return 1.0 if outbox.elapsed > every * (1.0 + 0.3 * outbox.place) else 0.0


def test_what_is_lost_in_a_crowd_is_what_overlaps():
    """Every message of a busy minute, against a list of intervals made from the log alone."""
    places = {"a": 0.0, "b": 300.0, "c": 700.0, "d": 710.0}
    own = plan(places, (0.0,) * 4, duration=60.0, channel="overhead: 0.2 s, byte_time: 0.01 s, capture_db: 1000 dB")
    own = replace(own, vehicles=tuple(replace(v, laws=v.laws | {"messaging": Choice(chatter)}) for v in own.vehicles))
    found = fate(own)
    lasts = {v.name: 0.2 + 0.01 * v.medium.payload for v in own.vehicles}
    sent = sorted({(time, sender) for sender, _, time in found})
    spoken = []  # what modems that were free sent
    for time, sender in sent:
        if all(s != sender or t + lasts[s] <= time for t, s in spoken):
            spoken.append((time, sender))
    assert len(spoken) < len(sent) or len(sent) > 200
    for (sender, receiver, time), comes in found.items():
        start = time + abs(places[sender] - places[receiver]) / 1500.0
        clear = (time, sender) in spoken
        for t, s in spoken:
            begins = t + abs(places[s] - places[receiver]) / 1500.0
            overlaps = begins < start + lasts[sender] and start < begins + lasts[s]
            clear &= (t, s) == (time, sender) or not overlaps
        assert comes is clear, (sender, receiver, time)
    assert 0.1 < np.mean(list(found.values())) < 0.9


FLEET = """
cardume: 1
name: lanes
duration: 90 s
log_period: 90 s
path: {type: lawnmower, leg: 15 m, legs: 2, spacing: 8 m}
formation: {speed: 0.5 m/s}
vehicles:
  - {name: hub, sensors: {gnss: {}, usbl: {angle_sigma: 2 deg}, ahrs: {}, depth: {}, thruster_speed: {}}}
  - {name: low, depth: 3 m, offset: {starboard: 2 m}}
  - {name: mid, depth: 2 m, offset: {starboard: -2 m}}
position: {law: reset_compensated}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, topology: star}
MESSAGING
acoustics: {channel: modem, bursts: coastal, codec: compact}
"""


@pytest.mark.parametrize("schedule", ["tdma, range: 100 m", "polling", "event_triggered, trigger_floor: 0.2 m"])
def test_lanes_give_the_bits_of_one_mission(schedule):
    text = FLEET.replace("MESSAGING", f"messaging: {{schedule: {schedule}}}")
    plans = [
        replace(
            plan_of(text, [f"acoustics.loss={0.05 + 0.08 * k}", f"vehicles.low.start.cross_track={0.3 * k} m"], seed=k),
            log_period=0.0,
        )
        for k in range(8)
    ]
    alone = [fly(p) for p in plans]
    assert all(flown.trouble is None for flown in alone)
    together = fly_batch(plans, lanes=True)
    same = {"outbox", "sent", "arrivals", "due", "on_air", "logged"}  # places of messages under way: shared by lanes
    hidden = [replace(f, tables=f.tables._replace(**dict.fromkeys(same, 0))) for f in (*alone, *together)]
    assert_same(hidden[:8], hidden[8:])
    heard = {f.tables.scores.tobytes() for f in alone}
    assert len(heard) == 8


def test_messages_that_were_sent_arrive_or_not_by_pairs():
    """All links of a quiet channel deliver everything."""
    found = fate(plan({"a": 0.0, "b": 30.0, "c": 60.0}, (0.0, 2.0, 4.0), duration=60.0, period=6.0, payload=10))
    assert len(found) == 10 * 6
    assert all(found.values())
    assert {(s, r) for s, r, _ in found} == set(itertools.permutations("abc", 2))


@pytest.mark.parametrize(("slot", "expected"), [(0.0, 64), (0.7, 7)])
def test_a_slot_that_nobody_has_worked_out_is_no_division_by_zero(slot, expected):
    """A plan made by hand may have the law's own default; then there is room for a message in every tick."""
    own = plan({"a": 0.0, "b": 30.0}, (0.0, 0.0))
    vehicles = [replace(v, laws=v.laws | {"messaging": Choice(tdma, {"slot": slot})}) for v in own.vehicles]
    assert num_slots(vehicles, 0.01, NO_MEMO) == expected
