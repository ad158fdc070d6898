"""Messages in few bits, and who is believed."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.errors import InputError
from cardume.onboard.messaging.authentication import Doorkeeper, Window, seal
from cardume.onboard.messaging.codec import COMPACT, PacketError, Range, decode, encode, whole_sequence
from cardume.onboard.messaging.polling import asked_in_turn
from cardume.onboard.messaging.rounding import rounded_report, rounded_sighting
from cardume.onboard.mind import UNTOLD
from cardume.signals import NOTHING, Report, Sighting

KEY = bytes(range(16))


def report(sequence: int = 1, time: float = 12.3, state: float = 40.0) -> Report:
    return Report(1.0, float(sequence), time, state, 0.5, 4.0)


def sighting(time: float = 11.9, north: float = 12.4) -> Sighting:
    return Sighting(north, -7.2, time, 38.75, 0.45, time, 4.0)


def test_a_fix_and_a_state_take_seven_bytes():
    assert COMPACT.sighting_bits == 7 * 8
    assert [len(encode(0, report(), [sighting()] * k)) for k in range(4)] == [6, 13, 20, 27]
    assert [COMPACT.size(k) for k in range(4)] == [6, 13, 20, 27]


numbers = st.tuples(
    st.floats(-3276.0, 3276.0),
    st.floats(-3276.0, 3276.0),
    st.floats(0.0, 5.0),
    st.floats(-400.0, 3500.0),
    st.floats(-0.4, 1.0),
)


@given(st.integers(1, 10_000), st.integers(0, 100_000), numbers, st.integers(0, 7))
def test_what_is_read_is_what_was_said_to_half_a_step(sequence, ticks, values, phase):
    north, east, age, state, speed = values
    time = 0.1 * ticks
    own = Report(1.0, float(sequence), time, state, speed, float(phase))
    seen = Sighting(north, east, time - age, state, speed, time - age, float(phase))
    packet = decode(encode(2, own, [Sighting(), seen]), time + 3.0, sequence - 1.0)
    assert packet.sender == 2
    read = packet.report
    assert (read.sequence, read.phase) == (sequence, phase)
    assert read.time_of_validity == pytest.approx(time, abs=1e-6)
    assert read.coordination_state == pytest.approx(state, abs=0.125 + 1e-9)
    assert read.path_speed == pytest.approx(speed, abs=0.025 + 1e-9)
    assert math.isnan(packet.sightings[0].north)
    assert math.isnan(packet.sightings[0].coordination_state)
    other = packet.sightings[1]
    assert (other.north, other.east) == pytest.approx((north, east), abs=0.1 + 1e-9)
    assert other.time_of_fix == pytest.approx(time - age, abs=0.2 + 1e-6)
    assert other.coordination_state == pytest.approx(state, abs=0.125 + 1e-9)
    assert other.phase == phase


def test_one_time_stands_for_fix_and_state():
    """The state is brought to the time of the fix by its own speed; without a fix the time is the state's."""
    seen = Sighting(1.0, 2.0, 10.3, 40.0, 0.5, 11.9, 4.0)
    read = decode(encode(1, report(), [seen]), 13.0).sightings[0]
    assert read.time_of_fix == read.time_of_validity == pytest.approx(10.3)
    assert read.coordination_state == pytest.approx(40.0 - 1.6 * 0.5, abs=0.125)
    blind = Sighting(NOTHING, NOTHING, NOTHING, 40.0, 0.5, 11.9, 4.0)
    read = decode(encode(1, report(), [blind]), 13.0).sightings[0]
    assert math.isnan(read.time_of_fix)
    assert (read.coordination_state, read.time_of_validity) == pytest.approx((40.0, 11.9))


def test_what_is_too_old_is_not_told():
    read = decode(encode(1, report(), [sighting(12.3 - 5.9)]), 13.0).sightings[0]
    assert math.isnan(read.north)
    assert math.isnan(read.coordination_state)


@pytest.mark.parametrize("value", [4000.0, -500.2, math.inf, -math.inf, math.nan])
def test_what_is_out_of_range_is_left_out(value):
    read = decode(encode(0, report(state=value), [sighting(north=5000.0)]), 13.0)
    assert math.isnan(read.report.coordination_state)
    seen = read.sightings[1]
    assert math.isnan(seen.north)
    assert math.isnan(seen.time_of_fix)
    assert (seen.coordination_state, seen.phase) == (38.75, 4.0)
    fast = decode(encode(0, report()._replace(path_speed=1.7)), 13.0).report
    assert fast.path_speed == pytest.approx(1.0)  # as fast as can be said


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"sequence": math.nan}, "sequence = nan"),
        ({"time_of_validity": math.nan}, "time_of_validity = nan"),
        ({"phase": math.inf}, "phase = inf"),
        ({"asks": 5.0}, "asks = 5 .* question 1 of vehicle 0, which tells of 1 others, asks vehicle 1"),
    ],
)
def test_what_no_packet_can_say_is_refused(change, named):
    with pytest.raises(PacketError, match=named):
        encode(0, report()._replace(**change), [sighting()])
    with pytest.raises(PacketError, match="sender = 64"):
        encode(64, report())
    with pytest.raises(PacketError, match=r"v = 4 cannot be sent: it must be -0.5 to 1"):
        Range(-0.5, 0.05, 5).encode(4.0, "v")


def test_whom_a_question_asks_comes_out_as_it_went_in():
    """Of four the second asks, also where the sequence goes past a byte and the reader's count is a cycle off."""
    seen = [sighting()] * 3
    for sequence in range(1, 600):
        asks = asked_in_turn(float(sequence), 1.0, 4.0)
        data = encode(1, report(sequence)._replace(asks=asks), seen)
        assert asks in (0.0, 2.0, 3.0)
        assert decode(data, 13.0, sequence - 1.0).report.asks == asks
        assert decode(data, 13.0, sequence + 255.0).report.asks == asks
        assert decode(encode(1, report(sequence), seen), 13.0, sequence - 1.0).report.asks == -1.0
    assert {asked_in_turn(float(k), 1.0, 4.0) for k in range(1, 4)} == {0.0, 2.0, 3.0}


# ---- the simulation's rounding is the codec's ------------------------------------------------------------------------

anything = st.one_of(st.floats(-6000.0, 6000.0), st.sampled_from([NOTHING, 3276.6, 3276.75, -3276.7, 3595.5, 3595.7]))
ages = st.one_of(st.floats(-0.3, 8.0), st.sampled_from([0.0, 0.2, 0.6, 5.6, 5.8, 5.9, 1e9, NOTHING]))
sightings = st.builds(
    lambda north, east, age, state, speed, since, phase, slant: (north, east, age, state, speed, since, phase, slant),
    anything,
    anything,
    ages,
    st.one_of(st.floats(-700.0, 3800.0), st.sampled_from([NOTHING, -500.0, 3595.5])),
    st.one_of(st.floats(-1.0, 2.0), st.just(NOTHING)),
    ages,
    st.sampled_from([UNTOLD, *map(float, range(8))]),
    st.one_of(st.just(NOTHING), st.just(NOTHING), st.floats(1.0, 500.0)),
)


@given(st.integers(0, 100_000), st.sampled_from([0.1, 0.05]), sightings, st.integers(1, 5000))
def test_rounding_in_the_simulation_is_packing_and_reading(ticks, tick, values, sequence):
    """Whatever is seen, of whatever age and however far: the same numbers to the last bit, times to a rounding."""
    north, east, age, state, speed, since, phase, slant = values
    time = ticks * tick
    own = Report(1.0, float(sequence), time, state, speed if speed == speed else 0.0, max(phase, 0.0))
    seen = Sighting(
        north, east, time - age, state, speed, time - since, phase, 1.0, 0.0, 1.0, slant, 0.1, 2.0
    )  # errors, and a range, are not said
    told = rounded_report(own, COMPACT.grid)
    packet = decode(encode(1, own, [seen]), time + 0.3, sequence - 1.0)
    same_record(packet.report, told)
    same_record(packet.sightings[0], rounded_sighting(seen, told.time_of_validity, COMPACT.grid))


def same_record(read, told):
    for field in read._fields:
        one, other = getattr(read, field), getattr(told, field)
        assert math.isnan(one) == math.isnan(other), (field, read, told)
        exact = not field.startswith("time")
        assert math.isnan(one) or (one == other if exact else abs(one - other) < 1e-6), (field, read, told)


def test_a_range_says_its_ends():
    speed = Range(-0.5, 0.05, 5)
    assert (speed.high, speed.nothing) == (pytest.approx(1.0), 31)
    assert speed.decode(speed.encode(1.0, "v")) == pytest.approx(1.0)
    assert math.isnan(speed.decode(speed.encode(math.nan, "v")))


@given(st.integers(1, 100_000), st.integers(-100, 100))
def test_a_sequence_is_made_whole_again(sequence, ahead):
    last = max(0, sequence - 1 - ahead)
    assert whole_sequence(sequence % 256, float(last)) == sequence


@pytest.mark.parametrize("data", [b"", b"\x41", bytes(5), bytes(7), b"\xff" * 6, bytes(6)])
def test_what_is_no_packet_is_refused(data):
    with pytest.raises(PacketError):
        decode(data, 10.0)


# ---- authentication --------------------------------------------------------------------------------------------------


def sealed_by(sender: int, told: Report, seen: Sequence[Sighting] = ()) -> bytes:
    return seal(encode(sender, told, seen), told, KEY)


def test_a_genuine_packet_is_let_in_once():
    door = Doorkeeper(KEY)
    sealed = sealed_by(1, report(), [sighting()])
    assert len(sealed) == COMPACT.size(1) + 4
    assert door.open(sealed, 13.0).report.coordination_state == 40.0
    with pytest.raises(PacketError, match="heard before"):
        door.open(sealed, 13.0)


def test_late_packets_are_let_in_within_the_window():
    door = Doorkeeper(KEY)
    packets = {k: sealed_by(1, report(k)) for k in (1, 2, 3, 30, 31, 100)}
    for k in (2, 31, 3, 30, 100):
        assert door.open(packets[k], 13.0).report.sequence == k
    with pytest.raises(PacketError, match="too old"):
        door.open(packets[1], 13.0)


def test_vehicles_have_windows_of_their_own_and_sequences_go_past_a_byte():
    door = Doorkeeper(KEY)
    for k in range(1, 700):
        for sender in (0, 5):
            assert door.open(sealed_by(sender, report(k)), 13.0).report.sequence == k


@pytest.mark.parametrize("missed", [100, 129, 200, 255, 256, 300, 5000])
def test_whoever_missed_many_messages_is_let_in_again(missed):
    """One a second; of any number of them, and also by a receiver that comes late."""
    door, late = Doorkeeper(KEY), Doorkeeper(KEY)
    for k in (1000, 1001, 1002 + missed, 1003 + missed):
        sealed = sealed_by(1, report(k, 1.0 * k))
        assert door.open(sealed, k + 0.3).report.sequence == k
    assert late.open(sealed, k + 0.3).report.sequence == k


def test_what_was_recorded_is_not_let_in_a_cycle_of_time_or_of_numbers_later():
    """Not heard at its time, it is new by its number; but its code is of its time, which the clock has left."""
    recorded = sealed_by(1, report(2, 12.3))
    assert Doorkeeper(KEY).open(recorded, 37.0).report.time_of_validity == pytest.approx(12.3)  # only late, and says so
    for later in (37.7, 12.4 + 25.6, 12.4 + 2 * 25.6, 12.4 + 256 * 25.6):
        door = Doorkeeper(KEY)
        door.open(sealed_by(1, report(1, 12.2)), 12.3)
        with pytest.raises(PacketError, match="at this time"):
            door.open(recorded, later)
    door = Doorkeeper(KEY)
    for k in range(3, 259):  # 2 and 258 look alike
        door.open(sealed_by(1, report(k, 12.3)), 12.5)
    with pytest.raises(PacketError):
        door.open(recorded, 12.6)


def test_a_clock_somewhat_ahead_does_no_harm():
    assert Doorkeeper(KEY).open(sealed_by(1, report(1, 12.3)), 11.9).report.time_of_validity == pytest.approx(12.3)


def forge(draw: np.random.Generator, genuine: list[bytes], heard: list[bytes]) -> bytes:
    """A forged, replayed, truncated or damaged packet."""
    kind, one = draw.integers(6), genuine[draw.integers(len(genuine))]
    if kind == 0:
        return draw.bytes(int(draw.integers(0, 40)))
    if kind == 1:
        return heard[draw.integers(len(heard))]
    if kind == 2:
        return one[: draw.integers(len(one))]
    if kind == 3:
        bit = int(draw.integers(8 * len(one)))
        return (int.from_bytes(one, "big") ^ 1 << bit).to_bytes(len(one), "big")
    if kind == 4:
        other = encode(int(draw.integers(4)), report(int(draw.integers(1, 900)), 12.0, float(draw.uniform(0, 99))))
        return seal(other, report(int(draw.integers(1, 900)), 12.0), draw.bytes(16))
    return one[:-4] + genuine[draw.integers(len(genuine))][-4:] if len(set(genuine)) > 1 else one[::-1]


def test_ten_thousand_bad_packets_and_none_is_let_in():
    """Between them genuine ones come and are let in, so that the door is open at all."""
    draw, door, heard, refused = np.random.default_rng(6), Doorkeeper(KEY), [], 0
    waiting = [sealed_by(k % 3, report(k // 3 + 1), [sighting()] * (k % 2)) for k in range(600)]
    for k in range(10_000):
        if k % 20 == 0:
            heard.append(waiting.pop(0))
            door.open(heard[-1], 13.0)
        bad = forge(draw, waiting[:20], heard)
        while bad in waiting:
            bad = forge(draw, waiting[:20], heard)
        with pytest.raises(PacketError):
            door.open(bad, 13.0)
        refused += 1
    assert refused == 10_000
    assert len(heard) == 500
    assert all(window.newest > 100 for window in door.windows.values())


def test_a_window_remembers_as_many_as_it_says():
    window, taken = Window(), set()
    for sequence in np.random.default_rng(1).integers(1, 300, 2000):
        k = int(sequence)
        assert window.is_new(k) == (k not in taken and k > window.newest - 64)
        if window.is_new(k):
            window.take(k, 0)
            taken.add(k)


def test_a_short_key_is_refused():
    with pytest.raises(InputError, match="a key of 3"):
        seal(b"x", report(), b"abc")
