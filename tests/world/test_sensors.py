"""Readings: the truth when nothing disturbs it, and disturbed by as much as said."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from numba import config

from cardume.maths import to_cartesian, to_ned
from cardume.signals import AhrsReading, Baseline, DvlReading, Noise, Sampling, Seabed, UsblReading, VesselState, Water
from cardume.world.sensors import ahrs, bottom_track, depth, dvl, gnss, thruster_speed, usbl
from cardume.world.sensors.doppler import Ping
from cardume.world.sensors.gnss import Drift

DEGREE = math.pi / 180.0
EACH_SECOND = Sampling(1.0, 12.0)
LAWS = (gnss, ahrs, depth, dvl, bottom_track, thruster_speed, usbl)

some_number = st.floats(-1e4, 1e4)
noises = st.builds(Noise, *[st.floats(-6.0, 6.0)] * 4)
states = st.builds(VesselState, *[some_number] * 12)


def normal_noises(count: int, seed: int) -> list[Noise]:
    return [Noise(*row) for row in np.random.default_rng(seed).normal(size=(count, 4))]


# ---- nothing disturbs ------------------------------------------------------------------------------------------------


@given(states, noises)
def test_without_errors_a_reading_is_the_truth_to_the_last_bit(truth: VesselState, noise: Noise) -> None:
    assert ahrs(truth, noise, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0) == AhrsReading(truth.heading, truth.yaw_rate, 0.0, 0.0)
    assert depth(truth, noise, 0.0) == truth.depth
    assert dvl(truth, noise, EACH_SECOND, Ping(), 0.0)[0] == DvlReading(truth.surge, truth.sway)
    assert thruster_speed(truth, noise, 0.0) == truth.shaft_speed
    fix, drift = gnss(truth, noise, EACH_SECOND, Drift(), 0.0)
    assert np.array_equal(fix, (truth.north, truth.east)) == (truth.depth <= 0.2)
    assert drift[:2] == (0.0, 0.0)


@given(st.floats(-500.0, 500.0), st.floats(-500.0, 500.0), st.floats(-500.0, 500.0), noises)
def test_without_errors_the_head_hears_where_the_target_is(x: float, y: float, z: float, noise: Noise) -> None:
    reading = usbl(Baseline(x, y, z), noise, 0.0, 0.0)
    assert reading.range == pytest.approx(math.hypot(x, y, z), rel=1e-14, abs=1e-150)
    assert to_cartesian(*reading) == pytest.approx((x, y, z), abs=1e-12)


# ---- GNSS ------------------------------------------------------------------------------------------------------------


def test_white_gnss_errors_have_the_sigma_of_each_axis() -> None:
    truth = VesselState(north=100.0, east=-50.0)
    fixes = np.array([gnss(truth, noise, EACH_SECOND, Drift(), 0.5)[0] for noise in normal_noises(5000, 1)])
    errors = fixes - (100.0, -50.0)
    assert errors.mean(axis=0) == pytest.approx([0.0, 0.0], abs=4.0 * 0.5 / math.sqrt(5000.0))
    assert errors.std(axis=0) == pytest.approx([0.5, 0.5], rel=4.0 / math.sqrt(10000.0))
    assert abs(np.corrcoef(errors.T)[0, 1]) < 4.0 / math.sqrt(5000.0)


def test_by_default_a_fix_is_half_a_meter_off_per_axis() -> None:
    fix, _ = gnss(VesselState(), Noise(1.0, -2.0, 3.0, 3.0), EACH_SECOND, Drift())
    assert fix == (0.5, -1.0)


def test_slow_gnss_errors_are_stationary_with_an_exponential_autocorrelation() -> None:
    """Linear in the draws, so the covariance is exact; the steps need not be equal."""
    gaps = [1.0, 1.0, 5.0, 1.0, 30.0, 200.0, 0.1]
    moments = np.cumsum(gaps)
    h = np.zeros((len(gaps), len(gaps)))
    for draw in range(len(gaps)):
        memory = Drift()
        for k, gap in enumerate(gaps):
            noise = Noise(5.0, 5.0, 1.0 if k == draw else 0.0, 7.0)
            fix, memory = gnss(VesselState(), noise, Sampling(gap, moments[k]), memory, 0.0, 0.5, 100.0)
            h[k, draw] = fix.north
    lags = np.abs(np.subtract.outer(moments, moments))
    assert h @ h.T == pytest.approx(0.25 * np.exp(-lags / 100.0), rel=1e-12)


def test_slow_and_white_errors_add() -> None:
    noise = Noise(0.3, -0.4, 1.5, -0.7)
    both, _ = gnss(VesselState(), noise, EACH_SECOND, Drift(), 0.5, 2.0, 60.0)
    assert both == pytest.approx((0.3 * 0.5 + 1.5 * 2.0, -0.4 * 0.5 - 0.7 * 2.0))


def test_there_is_no_fix_under_water_and_the_slow_error_goes_on() -> None:
    noise, memory = Noise(0.0, 0.0, 1.0, 1.0), Drift(1.0, 1.0, 1.0)
    for below in (0.201, 10.0):
        fix, after = gnss(VesselState(depth=below), noise, EACH_SECOND, memory, 0.5, 0.5, 100.0)
        assert np.isnan(fix).all()
        assert after == gnss(VesselState(depth=0.2), noise, EACH_SECOND, memory, 0.5, 0.5, 100.0)[1]
    assert np.isfinite(gnss(VesselState(depth=0.2), noise, EACH_SECOND, memory)[0]).all()


# ---- AHRS, depth, DVL, thrusters -------------------------------------------------------------------------------------


def test_ahrs_noise_has_the_default_sigmas() -> None:
    truth = VesselState(heading=7.0, yaw_rate=0.1)
    errors = np.array([ahrs(truth, noise) for noise in normal_noises(4000, 4)]) - (7.0, 0.1, 0.0, 0.0)
    expected = np.array([0.3, 0.03, 0.3, 0.3]) * DEGREE
    assert errors.std(axis=0) == pytest.approx(expected, rel=4.0 / math.sqrt(8000.0))
    assert np.abs(errors.mean(axis=0) / expected).max() < 4.0 / math.sqrt(4000.0)
    assert np.abs(np.corrcoef(errors.T) - np.eye(4)).max() < 4.0 / math.sqrt(4000.0)


@given(st.floats(-20.0, 20.0), st.floats(-4.0, 4.0))
def test_the_compass_deviates_once_a_turn(heading: float, phase: float) -> None:
    reading = ahrs(VesselState(heading=heading), Noise(0.0, 0.0, 0.0, 0.0), 0.3, 0.02, 0.05, phase)
    assert reading.heading - heading == pytest.approx(0.02 + 0.05 * math.sin(heading + phase), abs=1e-14)


def test_depth_is_off_by_its_bias_and_noise() -> None:
    assert depth(VesselState(depth=10.0), Noise(2.0, 9.0, 9.0, 9.0), 0.05, 0.2) == pytest.approx(10.3)
    assert depth(VesselState(depth=10.0), Noise(1.0, 9.0, 9.0, 9.0)) == pytest.approx(10.01)


def test_a_doppler_log_is_scaled_and_noisy() -> None:
    truth = VesselState(surge=0.5, sway=-0.02)
    noise = Noise(1.0, -2.0, 9.0, 9.0)
    assert dvl(truth, noise, EACH_SECOND, Ping(), 0.004, 1.01)[0] == pytest.approx((0.509, -0.0282))
    assert dvl(truth, noise, EACH_SECOND, Ping())[0] == pytest.approx((0.504, -0.028))


def test_a_doppler_log_is_biased_and_twisted_in_its_own_axes() -> None:
    truth = VesselState(surge=0.5, heading=1.0)
    silence = Noise(0.0, 0.0, 0.0, 0.0)
    biased, _ = dvl(truth, silence, EACH_SECOND, Ping(), 0.0, 1.0, 0.02, -0.03)
    assert biased == pytest.approx((0.52, -0.03))
    twisted, _ = dvl(truth, silence, EACH_SECOND, Ping(), 0.0, 1.0, 0.0, 0.0, 2.0 * DEGREE)
    # turned to starboard, it sees the way ahead to port
    assert twisted == pytest.approx((0.5 * math.cos(2.0 * DEGREE), -0.5 * math.sin(2.0 * DEGREE)))


@given(states, noises, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_bottom_track_is_the_velocity_over_ground(truth: VesselState, noise: Noise, north: float, east: float) -> None:
    near = truth._replace(depth=10.0, heading=math.fmod(truth.heading, 6.0))
    reading, _ = bottom_track(near, Water(north, east), Seabed(20.0), noise, EACH_SECOND, Ping(), sigma=0.0)
    over_ground = to_ned(near.heading, reading.surge, reading.sway)
    through = to_ned(near.heading, near.surge, near.sway)
    scale = 1.0 + abs(truth.surge) + abs(truth.sway)
    assert over_ground == pytest.approx((through[0] + north, through[1] + east), abs=1e-12 * scale)


@pytest.mark.parametrize(("depth", "hears"), [(0.0, False), (5.0, True), (39.0, True), (39.8, False), (41.0, False)])
def test_bottom_track_hears_the_seabed_within_its_range(depth: float, hears: bool) -> None:
    """35 m of range over 40 m of water, and nothing nearer than 0.3 m."""
    truth = VesselState(surge=0.5, depth=depth)
    silence = Noise(0.0, 0.0, 0.0, 0.0)
    reading, memory = bottom_track(truth, Water(), Seabed(40.0), silence, EACH_SECOND, Ping(), range=35.0, sigma=0.0)
    assert (reading.surge == 0.5) is hears
    assert math.isnan(reading.surge) is not hears
    assert (memory.silent == 0.0) is hears
    nowhere, _ = bottom_track(truth, Water(), Seabed(math.nan), silence, EACH_SECOND, Ping())
    assert math.isnan(nowhere.surge)


def test_the_last_good_reading_is_held_and_then_there_is_none() -> None:
    silence, each = Noise(0.0, 0.0, 0.0, 0.0), Sampling(0.5, 0.0)
    fails = silence._replace(c=3.0)  # exp(-9 / 2) = 0.011 < 0.1
    reading, memory = dvl(VesselState(surge=0.5), silence, each, Ping(), 0.0, invalid=0.1)
    assert reading.surge == 0.5
    for _ in range(4):  # 2 s
        reading, memory = dvl(VesselState(surge=0.7), fails, each, memory, 0.0, invalid=0.1)
        assert reading.surge == 0.5
    reading, memory = dvl(VesselState(surge=0.7), fails, each, memory, 0.0, invalid=0.1)
    assert math.isnan(reading.surge)
    reading, _ = dvl(VesselState(surge=0.7), silence, each, memory, 0.0, invalid=0.1)
    assert reading.surge == 0.7


@pytest.mark.parametrize("share", [0.1, 0.6])
def test_as_many_pings_fail_as_said(share: float) -> None:
    each, failed = Sampling(0.5, 0.0), 0
    for noise in normal_noises(4000, 12):
        _, memory = dvl(VesselState(surge=0.5), noise, each, Ping(), invalid=share)
        failed += memory.silent > 0.0
    assert failed / 4000 == pytest.approx(share, abs=4.0 * math.sqrt(share * (1.0 - share) / 4000))


@given(st.floats(-200.0, 200.0), st.floats(0.5, 2.0), noises)
def test_shaft_speed_is_scaled_with_noise_in_proportion(speed: float, scale: float, noise: Noise) -> None:
    reading = scale * thruster_speed(VesselState(shaft_speed=speed), noise, 0.01)
    assert reading == pytest.approx(scale * speed * (1.0 + 0.01 * noise.a), rel=1e-14)


# ---- USBL ------------------------------------------------------------------------------------------------------------

SILENCE = Noise(0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("target", "azimuth_deg", "elevation_deg"),
    [
        ((10.0, 0.0, 0.0), 0.0, 0.0),
        ((0.0, 10.0, 0.0), 90.0, 0.0),
        ((0.0, -10.0, 0.0), -90.0, 0.0),
        ((-10.0, 0.0, 0.0), 180.0, 0.0),
        ((10.0, 0.0, 10.0), 0.0, 45.0),
        ((0.0, 10.0, -10.0), 90.0, -45.0),
        ((0.0, 0.0, 10.0), 0.0, 90.0),
        ((0.0, 0.0, 0.0), 0.0, 0.0),
    ],
)
def test_angles_are_positive_to_starboard_and_down(
    target: tuple[float, float, float], azimuth_deg: float, elevation_deg: float
) -> None:
    reading = usbl(Baseline(*target), SILENCE)
    assert reading.range == pytest.approx(math.hypot(*target))
    assert (reading.azimuth, reading.elevation) == pytest.approx((azimuth_deg * DEGREE, elevation_deg * DEGREE))


def test_a_degree_of_azimuth_is_the_range_times_its_sigma_across() -> None:
    """Closed form W: 0.87266463 m at 50 m; a heading error of the same size turns the fix as far."""
    readings = [usbl(Baseline(50.0, 0.0, 0.0), noise, 0.0, 1.0 * DEGREE) for noise in normal_noises(5000, 6)]
    across = np.array([to_cartesian(*reading)[1:] for reading in readings])
    assert across.std(axis=0) == pytest.approx([0.87266463] * 2, rel=4.0 / math.sqrt(10000.0))
    small = to_cartesian(*usbl(Baseline(50.0, 0.0, 0.0), Noise(0.0, 1.0, 0.0, 0.0), 0.0, 1e-6))
    assert small[1] / 1e-6 * DEGREE == pytest.approx(0.87266463, rel=1e-8)
    measured = ahrs(VesselState(), SILENCE, 0.0, 1e-6).heading
    turned = to_ned(measured, *to_cartesian(*usbl(Baseline(50.0, 0.0, 0.0), SILENCE))[:2])
    assert turned[1] / 1e-6 * DEGREE == pytest.approx(0.87266463, rel=1e-8)


def test_range_noise_is_along_the_range_and_never_below_zero() -> None:
    ranges = np.array([usbl(Baseline(3.0, 4.0, 12.0), noise).range for noise in normal_noises(4000, 9)])
    assert ranges.mean() == pytest.approx(13.0, abs=4.0 * 0.1 / math.sqrt(4000.0))
    assert ranges.std() == pytest.approx(0.1, rel=4.0 / math.sqrt(8000.0))
    assert usbl(Baseline(0.0, 0.0, 0.05), Noise(-1.0, 0.0, 0.0, 0.0)).range == 0.0


def test_a_head_turned_to_starboard_hears_a_target_ahead_to_port() -> None:
    reading = usbl(Baseline(100.0, 0.0, 0.0), SILENCE, 0.0, 0.0, 1.0 * DEGREE)
    assert reading == pytest.approx((100.0, -1.0 * DEGREE, 0.0))


def test_beyond_its_range_the_head_hears_nothing() -> None:
    at_range, beyond = usbl(Baseline(1000.0, 0.0, 0.0), SILENCE), usbl(Baseline(1000.1, 0.0, 0.0), SILENCE)
    assert np.isfinite(at_range).all()
    assert np.isnan(beyond).all()
    assert isinstance(beyond, UsblReading)


@given(st.floats(-300.0, 300.0), st.floats(-300.0, 300.0), st.floats(-300.0, 300.0), noises)
def test_port_and_starboard_are_mirror_images(x: float, y: float, z: float, noise: Noise) -> None:
    assume(y != 0.0)
    mirrored = Noise(noise.a, -noise.b, noise.c, noise.d)
    one, other = usbl(Baseline(x, y, z), noise), usbl(Baseline(x, -y, z), mirrored)
    assert (one.range, one.azimuth, one.elevation) == (other.range, -other.azimuth, other.elevation)


# ---- all -------------------------------------------------------------------------------------------------------------


def test_every_sensor_has_a_period_and_a_latency() -> None:
    rates = {law.name: (law.common["period"], law.common["latency"]) for law in LAWS}
    assert rates == {
        "gnss": (1.0, 0.0),
        "ahrs": (0.1, 0.0),
        "depth": (0.2, 0.0),
        "dvl": (0.5, 0.0),
        "bottom_track": (0.2, 0.0),
        "thruster_speed": (0.1, 0.0),
        "usbl": (1.0, 0.1),
    }


def test_ideal_is_every_error_parameter_at_zero() -> None:
    """What `sensors: ideal` may set to 0: each of these defaults to an error or to 0, and 1 is only for scales."""
    for law in LAWS:
        for parameter in law.parameters:
            if parameter.name.endswith(("sigma", "bias", "deviation", "misalignment")):
                assert parameter.low <= 0.0
            elif parameter.name == "scale":
                assert parameter.default == 1.0


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the laws")
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_the_laws_compile_for_one_mission_and_for_lanes(law) -> None:
    assert law.handle() > 0
    assert law.handle(lanes=True) > 0
