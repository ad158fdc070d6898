"""The physics of the acoustic channel against other programs, published tables and the numbers that they print."""

import math

import arlpy.uwa
import gsw
import numpy as np
import pytest
from numba import config

from cardume.compiler import load, rows_of, store
from cardume.signals import Link
from cardume.world.acoustics import modem
from cardume.world.acoustics.ainslie_mccolm import ainslie_mccolm
from cardume.world.acoustics.ambient_noise import ambient_noise
from cardume.world.acoustics.francois_garrison import francois_garrison
from cardume.world.acoustics.fsk_error import fsk_bit_error, fsk_packet_error
from cardume.world.acoustics.gilbert_elliott import is_out
from cardume.world.acoustics.medium import medium_of
from cardume.world.acoustics.modem import LinkState, airtime, packet_loss, received_level
from cardume.world.acoustics.packet_error import packet_error
from cardume.world.acoustics.profiles import BURSTS, MODEMS
from cardume.world.acoustics.sound_speed import mackenzie
from cardume.world.acoustics.spreading import transmission_loss
from compiler.three_ways import three_ways

# ---- water -----------------------------------------------------------------------------------------------------------


def test_sound_speed_is_arlpys_and_within_its_own_error_that_of_teos_10():
    draw = np.random.default_rng(1)
    for temperature, salinity, depth in draw.uniform((2.0, 25.0, 0.0), (30.0, 40.0, 8000.0), (50, 3)):
        found = mackenzie(temperature, salinity, depth)
        assert found == pytest.approx(arlpy.uwa.soundspeed(temperature, salinity, depth), abs=1e-9)
    errors = []
    for temperature, salinity, depth in draw.uniform((2.0, 33.0, 0.0), (25.0, 38.0, 1000.0), (200, 3)):
        pressure = gsw.p_from_z(-depth, 30.0)
        absolute = gsw.SA_from_SP(salinity, pressure, -20.0, 30.0)
        conservative = gsw.CT_from_t(absolute, temperature, pressure)
        true = gsw.sound_speed(absolute, conservative, pressure)
        errors.append(mackenzie(temperature, salinity, depth) - float(true))
    assert math.sqrt(np.mean(np.square(errors))) < 0.1  # its author: a standard error of 0.07 m/s
    assert mackenzie(12.0, 35.0, 20.0) == pytest.approx(1497.1505, abs=5e-5)


FREQUENCIES = (7, 10, 18, 24, 25, 26, 30, 50, 70, 100)  # [kHz]
FRANCOIS_GARRISON = (0.5308, 0.9305, 2.6169, 4.4016, 4.7359, 5.0796, 6.5403, 15.1052, 23.9459, 35.1970)
ECHOPYPE = (0.5464, 0.9538, 2.6722, 4.4910, 4.8317, 5.1820, 6.6708, 15.4053, 24.4329, 35.9533)  # without the 17


@pytest.mark.parametrize("k", range(len(FREQUENCIES)))
def test_absorption_is_that_of_echopype_at_its_conditions(k):
    """12 deg C, 35, 20 m, pH 8.1, in dB/km; echopype's Ainslie-McColm has e^(-(T/27 + z)) where the paper divides z."""
    hertz = 1000.0 * FREQUENCIES[k]
    assert 1000.0 * francois_garrison(hertz, 12.0, 35.0, 20.0, 8.1) == pytest.approx(FRANCOIS_GARRISON[k], abs=5e-5)
    pure = 4.9e-4 * FREQUENCIES[k] ** 2 * math.exp(-12.0 / 27.0)
    theirs = 1000.0 * ainslie_mccolm(hertz, 12.0, 35.0, 20.0, 8.1) + pure * (math.exp(-0.02) - math.exp(-0.02 / 17.0))
    assert theirs == pytest.approx(ECHOPYPE[k], abs=6e-5)


@pytest.mark.parametrize("k", range(len(FREQUENCIES)))
def test_the_formula_of_absorption_is_a_choice(k):
    """The modem's own absorption is the stored one of the formula that is chosen, to four digits of dB/km."""
    hertz = 1000.0 * FREQUENCIES[k]
    pure = 4.9e-4 * FREQUENCIES[k] ** 2 * math.exp(-12.0 / 27.0) * (math.exp(-0.02) - math.exp(-0.02 / 17.0))
    wanted = (FRANCOIS_GARRISON[k], ECHOPYPE[k] - pure)
    for choice, absorption in enumerate(wanted):
        found = medium_of(frequency=hertz, absorption=float(choice)).absorption
        assert 1000.0 * found == pytest.approx(absorption, abs=6e-5)


def test_absorption_is_arlpys_wherever_it_holds():
    draw = np.random.default_rng(2)
    low, high = (500.0, 0.0, 30.0, 0.0, 7.7), (200_000.0, 30.0, 38.0, 3000.0, 8.3)
    for frequency, temperature, salinity, depth, acidity in draw.uniform(low, high, (100, 5)):
        theirs = arlpy.uwa.absorption(frequency, 1000.0, temperature, salinity, depth, acidity)
        ours = francois_garrison(frequency, temperature, salinity, depth, acidity)
        assert 1000.0 * ours == pytest.approx(-20.0 * math.log10(theirs), rel=1e-9)


def test_absorption_at_the_documented_point_of_underwater_acoustics_jl():
    """100 kHz, 27 deg C, 35, 10 m, pH 8.1: 0.035611359656810865 dB/m."""
    assert francois_garrison(100_000.0, 27.0, 35.0, 10.0, 8.1) == pytest.approx(0.035611359656810865, rel=1e-12)


def test_the_two_absorptions_are_near_each_other():
    for frequency in (7e3, 10e3, 18e3, 26e3, 50e3, 100e3):
        for temperature in (0.0, 5.0, 12.0, 20.0):
            ours = francois_garrison(frequency, temperature, 35.0, 20.0, 8.1)
            assert ainslie_mccolm(frequency, temperature, 35.0, 20.0, 8.1) == pytest.approx(ours, rel=0.041)


@pytest.mark.parametrize(
    ("kilohertz", "levels"),
    [
        (10, (29.337, 46.090, 53.036, 58.366)),
        (26, (22.056, 38.220, 45.155, 50.484)),
        (50, (20.712, 32.835, 39.637, 44.941)),
    ],
)
def test_noise_is_that_of_ns_3(kilohertz, levels):
    found = [ambient_noise(1000.0 * kilohertz, s, w) for s, w in ((0.0, 0.0), (0.5, 5.0), (0.5, 10.0), (1.0, 15.0))]
    assert found == pytest.approx(levels, abs=5e-4)


def test_spreading():
    assert transmission_loss(1000.0, 2.0, 0.0) == pytest.approx(60.0, abs=1e-12)
    assert transmission_loss(1000.0, 1.5, 0.005) == pytest.approx(45.0 + 5.0, abs=1e-12)
    assert transmission_loss(0.2, 2.0, 0.01) == pytest.approx(0.01)  # nearer than 1 m it is as at 1 m


@pytest.mark.parametrize(
    ("name", "spreading", "ratios"),
    [
        ("nanomodem_v3", 2.0, {100: 51, 500: 35, 1000: 26, 2000: 14, 3000: 4}),
        ("nanomodem_v3", 1.5, {100: 61, 500: 48, 1000: 41, 2000: 30, 3000: 22}),
        ("evologics_s2c", 2.0, {100: 63, 500: 47, 1000: 39, 2000: 28, 3000: 19}),
    ],
)
def test_signal_to_noise_is_what_was_computed_elsewhere(name, spreading, ratios):
    """By other programs, to whole dB: 12 deg C, ships 0.5, wind 5 m/s."""
    medium = medium_of(**MODEMS[name].values, spreading=spreading)
    for distance, ratio in ratios.items():
        assert received_level(medium, distance) - medium.noise_level == pytest.approx(ratio, abs=1.0)


# ---- packets ---------------------------------------------------------------------------------------------------------


def test_packet_errors_follow_the_makers_curve():
    table = {-2: 1.0, -1: 0.8, 0: 0.4, 1: 0.23, 2: 0.09, 3: 0.03, 4: 0.01, 5: 0.003, 6: 0.001}
    for ratio, loss in table.items():
        assert packet_error(float(ratio), -0.09, 0.72) == pytest.approx(loss, abs=0.07)
    assert packet_error(-1e9, 0.0, 0.1) == 1.0
    assert packet_error(1e9, 0.0, 0.1) < 1e-300
    assert packet_error(math.nan, 0.0, 0.1) == 1.0


def test_frequency_hopped_packets_are_lost_as_in_ns_3():
    """Its test: 1000 bytes at 9 dB, 0.539 within 0.001; it says 288 for the number of bits in the last term."""
    wrong, bits = fsk_bit_error(9.0), 8000
    theirs = 1.0 - (1.0 - wrong) ** bits - 288 * wrong * (1.0 - wrong) ** (bits - 1)
    assert theirs == pytest.approx(0.539, abs=0.001)
    assert fsk_packet_error(9.0, 1000.0) == pytest.approx(0.192, abs=0.001)  # what it meant
    assert (fsk_packet_error(6.0, 9.0), fsk_packet_error(10.0, 9.0)) == (1.0, 0.0)


def test_the_micromodem_profile_is_a_fit_to_that():
    """The profile's ratio is of signal to noise in 4 kHz, of which a bit at 80 bit/s gets 17 dB more."""
    medium = medium_of(**MODEMS["micromodem_fsk"].values)
    assert medium.bit_gain == pytest.approx(10.0 * math.log10(4000.0 / 80.0))
    for of_bit in np.arange(6.2, 10.0, 0.1):
        fitted = packet_error(of_bit - medium.bit_gain, medium.half, medium.width)
        assert fitted == pytest.approx(fsk_packet_error(of_bit, 32.0), abs=0.05)


def theory(ratio_db: float, bits: int) -> float:
    """Union bound and check sum with whole numbers and powers, as they are printed."""
    distances = (12, 14, 16, 18, 20, 22, 24, 26)
    weights = (33, 281, 2179, 15035, 105166, 692330, 4580007, 29692894)
    p = 1.0 / (2.0 + 10.0 ** (ratio_db / 10.0))
    error = sum(
        weight * p**d * sum(math.comb(d - 1 + k, k) * (1.0 - p) ** k for k in range(d))
        for d, weight in zip(distances, weights, strict=True)
    )
    return 1.0 - (1.0 - error) ** bits - bits * error * (1.0 - error) ** (bits - 1)


@pytest.mark.parametrize("payload", [6, 32, 1000])
def test_theory_in_flight_is_theory_with_whole_numbers(payload):
    for ratio in np.arange(6.4, 10.0, 0.05):
        assert fsk_packet_error(ratio, float(payload)) == pytest.approx(theory(ratio, 8 * payload), abs=1e-12)
    assert fsk_packet_error(math.nan, 9.0) == 1.0


def test_the_curve_of_packet_errors_is_a_choice():
    """With `fsk` a message is lost by the bits on the air, in whole frames, at Eb/N0; else by the two numbers."""
    values = {**MODEMS["micromodem_fsk"].values, "max_range": 1e9}
    for packet_errors in (0.0, 1.0):
        medium = medium_of(**values, packet_errors=packet_errors)
        for of_bit in (7.2, 7.6, 8.0):
            ratio = of_bit - medium.bit_gain
            by_curve = packet_error(ratio, values["half_db"], values["width_db"])
            wanted = theory(of_bit, 8 * 32) if packet_errors else by_curve
            assert packet_loss(medium, ratio, 7.0) == pytest.approx(wanted, abs=1e-12)
            level = medium.noise_level + ratio
            choice = {**values, "packet_errors": packet_errors}
            quiet = choice["source_level_db"] - received_level(medium, 500.0) + level  # heard at this ratio 500 m away
            for draw in (wanted - 1e-6, wanted + 1e-6):
                arrival, _ = modem(
                    Link(500.0, draw, 0.5, 0.0, 7.0), LinkState(), **{**choice, "source_level_db": quiet}
                )
                assert arrival.delivered == float(draw > wanted)


MEASURED = {1: 0.172, 4: 0.197, 7: 0.229, 16: 0.328, 20: 0.369, 32: 0.500, 39: 0.582}  # S2C, by DESERT


@pytest.mark.parametrize(("payload", "duration"), MEASURED.items())
def test_time_on_the_air_is_that_of_the_published_table(payload, duration):
    assert airtime(medium_of(), float(payload)) == pytest.approx(duration, abs=0.008)


def test_frames_are_sent_whole():
    medium = medium_of(**MODEMS["micromodem_fsk"].values)
    assert airtime(medium, 1.0) == airtime(medium, 32.0) == pytest.approx(3.5)
    assert airtime(medium, 33.0) == pytest.approx(6.7)
    nano = medium_of(**MODEMS["nanomodem_v3"].values)
    assert 64 * 8 / airtime(nano, 64.0) == pytest.approx(463.0, rel=0.001)  # bit/s in all, as published
    assert airtime(medium_of(**MODEMS["tritech_micron"].values), 7.0) == pytest.approx(7 * 8 / 40)


@pytest.mark.parametrize("name", MODEMS)
def test_a_profile_says_where_it_is_from_and_what_nobody_published(name):
    profile = MODEMS[name]
    known = {p.name for p in modem.parameters}
    assert profile.values.keys() <= known
    assert profile.source
    assert profile.unverified
    for parameter in modem.parameters:
        assert parameter.accepts(profile.values.get(parameter.name, parameter.default))


def test_the_first_profile_is_what_the_law_has_by_default():
    values = MODEMS["evologics_s2c"].values
    assert {p.name: p.default for p in modem.parameters if p.name in values} == pytest.approx(dict(values))


# ---- outages ---------------------------------------------------------------------------------------------------------


def lost(share: float, burst: float, interval: float, count: int = 200_000) -> np.ndarray:
    """Which of many messages at equal intervals are lost."""
    draws, state, found = np.random.default_rng(3).uniform(size=count), 0.0, np.zeros(count, bool)
    for k, draw in enumerate(draws):
        state = is_out(state, interval if k else 1e9, share, burst, draw)
        found[k] = state > 0.5
    return found


def runs(found: np.ndarray) -> np.ndarray:
    """Lengths of the runs of lost messages that are whole."""
    edges = np.flatnonzero(np.diff(found.astype(int)))
    if found[0]:
        edges = edges[1:]
    edges = edges[: len(edges) // 2 * 2]
    return edges[1::2] - edges[::2]


@pytest.mark.parametrize("name", ["calm", "coastal", "harsh", "bad_day"])
def test_outages_have_their_share_and_run_lengths_at_one_message_every_four_seconds(name):
    """Stationary loss L; runs geometric, of the mean 1 / ((1 - L) (1 - exp(-s / T))): 2, 3, 4 and 6 messages."""
    values = BURSTS[name].values
    share, burst = values["loss"], values["burst"]
    found = lost(share, burst, 4.0)
    lengths = runs(found)
    mean = 1.0 / ((1.0 - share) * (1.0 - math.exp(-4.0 / (burst * (1.0 - share)))))
    assert mean == pytest.approx({"calm": 2, "coastal": 3, "harsh": 4, "bad_day": 6}[name], rel=0.02)
    # the spread of a share of correlated draws: L (1 - L) (1 + q) / (1 - q) / n, q the correlation of neighbors
    q = math.exp(-4.0 / (burst * (1.0 - share)))
    assert found.mean() == pytest.approx(
        share, abs=4.0 * math.sqrt(share * (1 - share) * (1 + q) / (1 - q) / len(found))
    )
    assert lengths.mean() == pytest.approx(mean, abs=4.0 * mean / math.sqrt(len(lengths)))
    for longest in (1, 2, 5, 10):
        expected = (1.0 - 1.0 / mean) ** longest
        spread = math.sqrt(expected * (1.0 - expected) / len(lengths))
        assert (lengths > longest).mean() == pytest.approx(expected, abs=4.5 * spread)


def test_the_step_is_exact_over_any_time():
    """Two steps are one: P(out after s + t) is the sum over what is in between (Chapman and Kolmogorov)."""

    def chance(state: float, elapsed: float) -> float:
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if is_out(state, elapsed, 0.3, 7.0, middle) > 0.5 else (low, middle)
        return low

    for state in (0.0, 1.0):
        for first, second in ((0.1, 0.1), (1.0, 5.0), (20.0, 0.3)):
            middle = chance(state, first)
            both = middle * chance(1.0, second) + (1.0 - middle) * chance(0.0, second)
            assert chance(state, first + second) == pytest.approx(both, abs=1e-12)
    assert chance(1.0, 1e-9) == pytest.approx(1.0, abs=1e-8)
    assert chance(1.0, 1e9) == pytest.approx(0.3, abs=1e-12)


def test_without_a_length_each_message_is_lost_by_itself():
    found = lost(0.3, 0.0, 1.0, 50_000)
    assert runs(found).mean() == pytest.approx(1.0 / 0.7, rel=0.02)


# ---- the law ---------------------------------------------------------------------------------------------------------


def test_a_message_takes_its_time_on_the_air_on_the_way_and_in_the_modem():
    arrival, state = modem(Link(750.0, 0.5, 0.5, 12.0, 7.0), LinkState(), sound_speed=1500.0)
    assert arrival.delay == pytest.approx(0.1545 + 7 * 0.01085 + 0.5 + 0.09, abs=1e-12)
    assert arrival.delivered == 1.0
    assert state == LinkState(0.0, 12.0)
    by_water, _ = modem(Link(750.0, 0.5, 0.5, 12.0, 7.0), LinkState(), temperature_celsius=5.0, salinity=33.0)
    assert by_water.delay - arrival.delay == pytest.approx(750.0 / mackenzie(5.0, 33.0, 20.0) - 0.5, abs=1e-12)


def test_noise_loses_what_is_far_away():
    """Where the curve says half, half are lost; beyond the range all."""
    medium = medium_of(max_range=1e9)
    low, high = 100.0, 100_000.0
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        above = received_level(medium, middle) - medium.noise_level > medium.half
        low, high = (middle, high) if above else (low, middle)
    for draw, delivered in ((0.49, 0.0), (0.51, 1.0)):
        arrival, _ = modem(Link(low, draw, 0.5, 0.0, 7.0), LinkState(), max_range=1e9)
        assert arrival.delivered == delivered
    assert modem(Link(low, 0.51, 0.5, 0.0, 7.0), LinkState())[0].delivered == 0.0  # beyond 3500 m


def test_own_noise_is_heard():
    quiet, loud = medium_of(), medium_of(platform_noise_db=10.0)
    assert loud.noise_level - quiet.noise_level == pytest.approx(10.0)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the law")
def test_the_law_compiles_for_one_mission_and_for_lanes():
    assert modem.handle() > 0
    assert modem.handle(lanes=True) > 0


def losses(given, out):
    """Losses by either curve at one ratio."""
    rows, told = rows_of(given), rows_of(out)
    ratio = load(rows, 0)
    store(told, 0, fsk_packet_error(ratio, load(rows, 1)))
    store(told, 1, fsk_bit_error(ratio))


def test_theory_three_ways():
    """In plain Python, for one mission and for eight: the same bits."""
    draw = np.random.default_rng(8)
    given = np.stack([draw.uniform(5.5, 10.5, 8), draw.integers(1, 100, 8).astype(float)])
    out = three_ways(losses, given, 2)
    assert ((out[0] >= 0.0) & (out[0] <= 1.0)).all()
    assert len(np.unique(out[0])) > 4
