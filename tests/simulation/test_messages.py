"""Messages on their way: how many are lost, when they arrive, which one is read, and how old its news is."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from cardume.laws import Seconds
from cardume.maths.random import random_key, uniforms
from cardume.onboard.messaging import messaging_law
from cardume.onboard.mind import FLAG
from cardume.signals import Arrival, Link, Outbox, Report, VesselState
from cardume.simulation.fleet import OnPath
from cardume.simulation.fly import Flown
from cardume.simulation.plan import Choice, Plan
from cardume.simulation.results import metrics_of
from cardume.world.acoustics.base import acoustics_law
from properties.flown import plan_of
from simulation.ticks import Watched, watch

TEXT = """
cardume: 1
name: talk
seed: 11
duration: {duration} s
path: {{type: line, start: {{north: 0 m, east: 0 m, course: 30 deg}}, length: 900 m}}
formation: {{speed: 0.5 m/s}}
model: kinematic
messaging: {{schedule: periodic, period: {period} s}}
acoustics: {{channel: bernoulli, loss: {loss}, delay: {delay} s, sound_speed: {sound} m/s}}
coordination: {{law: laplacian_tanh, topology: {topology}}}
vehicles:
  - {{name: a, start: {{speed: 0.5 m/s}}}}
  - {{name: b, depth: 20 m, offset: {{starboard: 40 m}}, start: {{along_track: -3 m, speed: 0.5 m/s}}}}
  - {{name: c, depth: 5 m, offset: {{starboard: -60 m}}, start: {{along_track: 2 m, speed: 0.5 m/s}}}}
"""


def plan(duration=60, period=1, loss=0, delay=0.3, sound=1500, topology="complete") -> Plan:
    return plan_of(
        TEXT.format(duration=duration, period=period, loss=loss, delay=delay, sound=sound, topology=topology)
    )


def distance(seen: Watched, sender: int, receiver: int) -> np.ndarray:
    """(tick,) [m] between two vehicles."""
    parts = [seen.at_start(VesselState, axis) for axis in ("north", "east", "depth")]
    return np.sqrt(sum((p[:, sender] - p[:, receiver]) ** 2 for p in parts))


# ---- loss ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("loss", [0.0, 0.1, 0.5, 0.9, 1.0])
def test_each_link_loses_its_share(loss: float) -> None:
    rows = watch(plan(duration=400, period=0.1, loss=loss)).messages()
    for sender, receiver in itertools.permutations(range(3), 2):
        on_link = rows["lost"][(rows["sender"] == sender) & (rows["receiver"] == receiver)]
        assert len(on_link) == 4000
        bound = 5.0 * math.sqrt(4000 * loss * (1.0 - loss))
        assert abs(on_link.sum() - 4000 * loss) <= bound


def test_links_lose_independently_of_one_another_and_of_the_past() -> None:
    rows = watch(plan(duration=400, period=0.1, loss=0.5)).messages()
    links = {
        (s, r): rows["lost"][(rows["sender"] == s) & (rows["receiver"] == r)] - 0.5
        for s, r in itertools.permutations(range(3), 2)
    }
    for one, other in itertools.combinations(links.values(), 2):
        assert abs((one * other).sum() * 4.0) < 5.0 * math.sqrt(4000.0)
    for own in links.values():
        assert abs((own[1:] * own[:-1]).sum() * 4.0) < 5.0 * math.sqrt(4000.0)


def test_a_loss_is_that_of_the_random_number_of_this_link_and_tick() -> None:
    rows = watch(plan(duration=20, period=0.5, loss=0.3)).messages()
    names = "abc"
    for sent, sender, receiver, lost in zip(
        *(rows[c] for c in ("time_sent", "sender", "receiver", "lost")), strict=True
    ):
        own, other = (random_key(11, "link", names[int(k)]) for k in (receiver, sender))
        draw, *_ = uniforms(own._replace(vehicle_high=other.vehicle_low), float(round(sent / 0.1)))
        assert (draw < 0.3) == (lost > 0.5)


def test_a_lost_message_has_no_time_of_receipt() -> None:
    rows = watch(plan(loss=0.4)).messages()
    assert (np.isnan(rows["time_received"]) == (rows["lost"] > 0.5)).all()
    assert 0.3 < rows["lost"].mean() < 0.5


# ---- delay -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("delay", "sound"), [(0.3, 1500), (0.0, 1500), (0.05, 90), (2.7, 1480)])
def test_a_message_takes_the_delay_and_the_time_of_its_way(delay: float, sound: float) -> None:
    seen = watch(plan(duration=30, delay=delay, sound=sound))
    rows = seen.messages()
    assert len(rows["sender"]) == 180
    for sent, received, sender, receiver in zip(
        *(rows[c] for c in ("time_sent", "time_received", "sender", "receiver")), strict=True
    ):
        way = distance(seen, int(sender), int(receiver))[round(sent / 0.1)]
        assert received - sent == pytest.approx(delay + way / sound, abs=1e-12)


def test_a_message_is_read_in_the_first_tick_after_its_arrival() -> None:
    """Flag and head of the inbox, tick by tick, follow from the log alone."""
    seen = watch(plan(duration=30, delay=0.05, sound=90, loss=0.3, period=0.5))
    rows, width = seen.messages(), len(Report._fields)
    links = [(r, s) for r in range(3) for s in range(3) if r != s]  # the engine's order
    for link, (receiver, sender) in enumerate(links):
        mine = (rows["receiver"] == receiver) & (rows["sender"] == sender) & (rows["lost"] < 0.5)
        fresh = np.zeros(len(seen.times))
        for validity, received in zip(rows["time_of_validity"][mine], rows["time_received"][mine], strict=True):
            tick = math.ceil(received / 0.1 - 1e-9)
            if tick < len(fresh):
                fresh[tick] = 1.0
                head = Report(*seen.inbox[tick, link, 1 : 1 + width])
                assert head.time_of_validity == validity
                assert head.sequence == round(validity / 0.5) + 1
                assert head.coordination_state == pytest.approx(state_told(seen, sender, validity), abs=1e-9)
        assert (seen.inbox[:, link, FLAG] == fresh).all()
        assert fresh.sum() > 20


def state_told(seen: Watched, sender: int, time: float) -> float:
    """With ideal sensors a vehicle tells its true coordination state."""
    return float(seen.in_tick(OnPath, "coordination_state")[round(time / 0.1), sender])


@messaging_law
def thrice(outbox: Outbox, every: Seconds = 5.0) -> float:
    """Speaks in three ticks, one after the other, every so often. Source: this test."""
    since = outbox.time - every * float(int(outbox.time / every + 1e-6))
    return 1.0 if since < 0.25 else 0.0


@acoustics_law
def overtaking(link: Link, step: Seconds = 0.1) -> Arrival:
    """Takes 0.95, 1.05 or 1.15 s: later messages may arrive first, or in the same tick. Source: this test."""
    return Arrival(0.95 + step * float(int(3.0 * link.draw_2)), 1.0)


def test_of_messages_that_come_in_one_tick_the_latest_is_read_and_all_count() -> None:
    own = plan(duration=300)
    laws = {"messaging": Choice(thrice), "acoustics": Choice(overtaking)}
    own = replace(own, vehicles=tuple(replace(v, laws=v.laws | laws) for v in own.vehicles))
    seen, together, crossed = watch(own), 0, 0
    rows = seen.messages()
    assert len(rows["sender"]) == 6 * 3 * 60
    arrival = np.ceil(rows["time_received"] / 0.1 - 1e-9).astype(int)
    for link, (receiver, sender) in enumerate((r, s) for r in range(3) for s in range(3) if r != s):
        mine = (rows["receiver"] == receiver) & (rows["sender"] == sender)
        ticks, validity = arrival[mine], rows["time_of_validity"][mine]
        crossed += (np.diff(ticks) < 0).sum()
        for tick in np.unique(ticks):
            together += (ticks == tick).sum() > 1
            read = seen.inbox[tick, link, 1 + Report._fields.index("time_of_validity")]
            assert read == validity[ticks == tick].max()
    assert min(together, crossed) > 60
    metrics = metrics_of(Flown(own, seen.tables, own.num_ticks))
    assert [metrics.vehicles[n]["messages_delivered"] for n in "abc"] == [360.0] * 3


@pytest.mark.parametrize("period", [0.1, 0.5])
def test_many_messages_under_way_do_not_overwrite_one_another(period: float) -> None:
    """A slow channel: three seconds of messages are in the water at any time."""
    seen = watch(plan(duration=40, period=period, delay=2.9, sound=200))
    rows, metrics = seen.messages(), metrics_of(Flown(seen.plan, seen.tables, seen.plan.num_ticks))
    arrived = np.ceil(rows["time_received"] / 0.1 - 1e-9) < len(seen.times)
    for k, name in enumerate("abc"):
        mine = arrived & (rows["receiver"] == k)
        ages = np.ceil(rows["time_received"][mine] / 0.1 - 1e-9) * 0.1 - rows["time_of_validity"][mine]
        assert metrics.vehicles[name]["messages_delivered"] == mine.sum()
        assert metrics.vehicles[name]["information_age_max"] == pytest.approx(ages.max(), abs=1e-9)


def test_nobody_hears_whom_it_does_not_listen_to() -> None:
    rows = watch(plan(topology="[[0, 0, 0], [1, 0, 0], [0, 1, 0]]")).messages()
    assert {(int(s), int(r)) for s, r in zip(rows["sender"], rows["receiver"], strict=True)} == {(0, 1), (1, 2)}


@pytest.mark.parametrize(("period", "offset"), [(1.0, 0.0), (0.7, 0.3), (10.0, 4.2)])
def test_a_schedule_is_kept_to_the_tick(period: float, offset: float) -> None:
    own = plan_of(
        TEXT.format(duration=50, period=period, loss=0, delay=0, sound=1500, topology="complete"),
        [f"messaging.offset={offset} s"],
    )
    rows = watch(own).messages()
    sent = np.unique(rows["time_sent"])
    assert sent == pytest.approx(offset + period * np.arange(len(sent)), abs=1e-9)
    assert sent[-1] > 50.0 - 2.0 * period
