"""Messages in few bits, and who is believed."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.errors import InputError
from cardume.onboard.messaging.authentication import Doorkeeper, Window, seal
from cardume.onboard.messaging.codec import COMPACT, PacketError, Range, decode, encode, whole_sequence
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


@pytest.mark.parametrize(("value", "named"), [(4000.0, "coordination_state"), (math.inf, "coordination_state")])
def test_what_does_not_fit_is_refused(value, named):
    with pytest.raises(PacketError, match=rf"{named} = .* must be -500 to 3595"):
        encode(0, report(state=value))
    with pytest.raises(PacketError, match="sender = 64"):
        encode(64, report())
    with pytest.raises(PacketError, match="north"):
        encode(0, report(), [sighting(north=5000.0)])


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


def test_a_genuine_packet_is_let_in_once():
    door = Doorkeeper(KEY)
    sealed = seal(encode(1, report(), [sighting()]), 1, KEY)
    assert len(sealed) == COMPACT.size(1) + 4
    assert door.open(sealed, 13.0).report.coordination_state == 40.0
    with pytest.raises(PacketError, match="heard before"):
        door.open(sealed, 13.0)


def test_late_packets_are_let_in_within_the_window():
    door = Doorkeeper(KEY)
    packets = {k: seal(encode(1, report(k)), k, KEY) for k in (1, 2, 3, 30, 31, 100)}
    for k in (2, 31, 3, 30, 100):
        assert door.open(packets[k], 13.0).report.sequence == k
    with pytest.raises(PacketError, match="too old"):
        door.open(packets[1], 13.0)


def test_vehicles_have_windows_of_their_own_and_sequences_go_past_a_byte():
    door = Doorkeeper(KEY)
    for k in range(1, 700):
        for sender in (0, 5):
            assert door.open(seal(encode(sender, report(k)), k, KEY), 13.0).report.sequence == k


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
        return seal(other, int(draw.integers(1, 900)), draw.bytes(16))
    return one[:-4] + genuine[draw.integers(len(genuine))][-4:] if len(set(genuine)) > 1 else one[::-1]


def test_ten_thousand_bad_packets_and_none_is_let_in():
    """Between them genuine ones come and are let in, so that the door is open at all."""
    draw, door, heard, refused = np.random.default_rng(6), Doorkeeper(KEY), [], 0
    waiting = [seal(encode(k % 3, report(k // 3 + 1), [sighting()] * (k % 2)), k // 3 + 1, KEY) for k in range(600)]
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
            window.take(k)
            taken.add(k)


def test_a_short_key_is_refused():
    with pytest.raises(InputError, match="a key of 3"):
        seal(b"x", 1, b"abc")
