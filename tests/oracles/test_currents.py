"""Currents flown: what a vehicle that is carried by them sees, against their closed forms."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import chi2

from cardume.signals import Noise, Where
from cardume.simulation.fly import fly_batch
from cardume.world.currents import ekman
from cardume.world.currents.variation import Variation
from flying import fly_text, series, value_at
from oracles.aboard import plan_of, vessel_of

MISSION = """
cardume: 1
name: water
duration: {duration!r} s
tick: {tick!r} s
plant_step: {tick!r} s
log_period: {tick!r} s
path: {{type: line, length: 100 m}}
formation: {{speed: {speed!r} m/s}}
current: {{{current}}}
guidance: {{law: 'aids:parallel'}}
speed_reference: water
coordination: none
end: continue
vehicles:
{vehicles}
"""
SPEED = 0.5


def text(current: str, duration: float, tick: float = 1.0, depths: tuple[float, ...] = (0.0,)) -> str:
    """Vehicles that head north at 0.5 m/s through the water, one at each depth [m], and are carried."""
    rows = "\n".join(
        f"  - {{name: v{k}, model: kinematic, sensors: ideal, depth: {z!r} m, start: {{speed: {SPEED!r} m/s}}}}"
        for k, z in enumerate(depths)
    )
    return MISSION.format(current=current, duration=duration, tick=tick, speed=SPEED, vehicles=rows)


# ---- Gauss-Markov ----------------------------------------------------------------------------------------------------

COUNT = 400  # flights


def drift_variance(sigma: float, time_constant: float, time: float) -> float:
    """Row T: 2 s^2 tc (t - tc (1 - exp(-t / tc)))."""
    return 2.0 * sigma**2 * time_constant * (time - time_constant * (1.0 - math.exp(-time / time_constant)))


@functools.cache
def drifts(current: str, time: float, tick: float) -> np.ndarray:
    """(flight, 2) [m] how far the water alone carried each of many vehicles, north and east."""
    plan = plan_of(text(current, time, tick))
    flights = fly_batch([replace(plan, seed=1000 + k) for k in range(COUNT)])
    ends = [vessel_of(flown) for flown in flights]
    return np.array([(end.north - SPEED * time, end.east) for end in ends])


def assert_variance(samples: np.ndarray, variance: float) -> None:
    """The mean square lies where that of so many independent normal numbers does, but for one case in a thousand."""
    ratio = float(np.sum(np.square(samples))) / variance
    low, high = chi2.ppf([0.0005, 0.9995], len(samples))
    assert low < ratio < high, f"{ratio / len(samples)} of the closed form"


@pytest.mark.parametrize(("time", "printed"), [(10.0, 0.4918037228), (60.0, 2.7277429873)])
def test_t_the_drift_at_the_printed_parameters(time: float, printed: float) -> None:
    """Row T: s = .05 m/s, tc = 100 s: RMS drift 0.4918037228 m in 10 s, 2.7277429873 m in 60 s."""
    assert math.sqrt(drift_variance(0.05, 100.0, time)) == pytest.approx(printed, abs=1e-10)
    found = drifts("type: gauss_markov, sigma_along: 0.05, sigma_across: 0.05, time_constant: 100", time, 1.0)
    assert_variance(found.ravel(), printed**2)


def test_t_the_drift_of_uniform_with_its_variation_is_the_same_process() -> None:
    one = drifts("type: gauss_markov, sigma_along: 0.05, sigma_across: 0.05, time_constant: 100", 10.0, 1.0)
    other = drifts("type: uniform, variation_sigma: 0.05, variation_time_constant: 100", 10.0, 1.0)
    assert one == pytest.approx(other, abs=1e-12)


def test_t_the_drift_with_other_parameters_and_axes() -> None:
    """Row T along and across a mean of 0.3 m/s towards 120 deg: each with its own sigma, and uncorrelated."""
    current = "type: gauss_markov, speed: 0.3, towards: 120 deg, sigma_along: 0.2, sigma_across: 0.04, time_constant: 8"
    found = drifts(current, 50.0, 0.25)
    sine, cosine = math.sin(math.radians(120.0)), math.cos(math.radians(120.0))
    along = found @ [cosine, sine] - 0.3 * 50.0
    across = found @ [-sine, cosine]
    assert_variance(along, drift_variance(0.2, 8.0, 50.0))
    assert_variance(across, drift_variance(0.04, 8.0, 50.0))
    assert abs(np.corrcoef(along, across)[0, 1]) < 3.3 / math.sqrt(COUNT)


def test_the_process_is_stationary_with_an_exponential_autocorrelation() -> None:
    """One sigma from the first tick on, and exp(-|lag| / T) between two times."""
    plan = plan_of(text("type: gauss_markov, sigma_along: 0.1, sigma_across: 0.1, time_constant: 20", 41.0))
    flights = fly_batch([replace(plan, seed=k) for k in range(COUNT)])
    north = np.array([record_of(flown) for flown in flights])
    for time in (0, 20, 40):
        assert_variance(north[:, time], 0.01)
    for lag in (5, 20, 40):
        # x(t + lag) - rho x(t) is independent of x(t) and has the variance sigma^2 (1 - rho^2)
        rho = math.exp(-lag / 20.0)
        assert_variance(north[:, lag] - rho * north[:, 0], 0.01 * (1.0 - rho * rho))


def record_of(flown) -> np.ndarray:
    """The north part of the current [m/s] in every record of a flight."""
    from cardume.simulation.recording import LOG, Truth

    log = flown.tables.log.reshape(-1, LOG.width)
    column = LOG.offsets[Truth] + Truth._fields.index("current_north")
    return log[:, column]


# ---- by depth --------------------------------------------------------------------------------------------------------

DEPTHS = (0.0, 2.0, 5.0, 7.5, 10.0, 20.0, 35.0)


def seen(current: str) -> np.ndarray:
    """(depth, 2) [m/s] the current at each of DEPTHS, which is also the way of a vehicle there less its own."""
    flight = fly_text(text(current, 20.0, depths=DEPTHS))
    logged = np.array([[value_at(flight, f"current_{axis}", 10.0, k) for axis in ("north", "east")] for k in range(7)])
    made = [[value_at(flight, axis, 20.0 - 1.0, k) / 19.0 for axis in ("north", "east")] for k in range(7)]
    assert np.array(made) - [SPEED, 0.0] == pytest.approx(logged, abs=1e-12)
    return logged


def test_a_profile_is_linear_between_its_points_and_constant_beyond() -> None:
    points = (
        "{depth: 2, speed: 0.3}, {depth: 7, speed: 0.2, towards: 90 deg}, {depth: 20, speed: 0.1, towards: 180 deg}"
    )
    north = np.interp(DEPTHS, [2.0, 7.0, 20.0], [0.3, 0.0, -0.1])
    east = np.interp(DEPTHS, [2.0, 7.0, 20.0], [0.0, 0.2, 0.0])
    assert seen(f"type: sheared, profile: [{points}]") == pytest.approx(np.transpose([north, east]), abs=1e-15)
    half = seen(f"type: sheared, scale: 0.5, profile: [{points}]")
    assert half == pytest.approx(0.5 * np.transpose([north, east]), abs=1e-15)


def test_one_point_is_a_uniform_current() -> None:
    current = seen("type: sheared, profile: [{depth: 5, speed: 0.2, towards: 30 deg}]")
    assert current == pytest.approx(np.tile([0.2 * math.sqrt(0.75), 0.1], (7, 1)), abs=1e-15)


@pytest.mark.parametrize(("exponent", "seabed"), [(1.0 / 7.0, 40.0), (1.0, 30.0), (2.5, 35.0)])
def test_a_power_law_at_several_depths(exponent: float, seabed: float) -> None:
    found = seen(f"type: power_law, speed: 0.4, towards: 90 deg, seabed_depth: {seabed!r}, exponent: {exponent!r}")
    expected = [0.4 * max(1.0 - z / seabed, 0.0) ** exponent for z in DEPTHS]
    assert found[:, 1] == pytest.approx(expected, rel=1e-13)
    assert found[:, 0] == pytest.approx([0.0] * 7, abs=1e-15)


def test_ekman_at_several_depths() -> None:
    found = seen("type: ekman, speed: 0.2, towards: 40 deg, turning_depth: 9")
    spiral = 0.2 * np.exp(1j * math.radians(40.0) - (1.0 - 1.0j) * np.array(DEPTHS) / 9.0)
    assert found == pytest.approx(np.transpose([spiral.real, spiral.imag]), abs=1e-14)
    south = seen("type: ekman, speed: 0.2, towards: 40 deg, turning_depth: 9, turn: -1 rad")
    spiral = 0.2 * np.exp(1j * math.radians(40.0) - (1.0 + 1.0j) * np.array(DEPTHS) / 9.0)
    assert south == pytest.approx(np.transpose([spiral.real, spiral.imag]), abs=1e-14)


@pytest.mark.parametrize("depth", [1.0, 6.0, 30.0])
def test_ekman_balances_friction_and_rotation(depth: float) -> None:
    """K V'' = f k x V, k upwards, so that K (N'', E'') = f (E, -N)."""
    f, viscosity = 1e-4, 0.01
    turning = math.sqrt(2.0 * viscosity / f)

    def flow(z: float) -> np.ndarray:
        place = Where(0.0, 0.0, z, 0.0, np.zeros(1))
        return np.array(ekman(place, Noise(0.0, 0.0, 0.0, 0.0), Variation(), 0.1, 0.3, 0.7, turning)[0])

    h = 0.02
    bend = (flow(depth - h) - 2.0 * flow(depth) + flow(depth + h)) / h**2
    north, east = flow(depth)
    assert viscosity * bend == pytest.approx([f * east, -f * north], rel=1e-4, abs=1e-9)
    stress = viscosity * (flow(0.0) - flow(h)) / h  # of the wind on the water
    surface = flow(0.0)
    turned = math.atan2(surface[1], surface[0]) - math.atan2(stress[1], stress[0])
    assert math.degrees(turned) == pytest.approx(45.0, abs=0.1)


# ---- by time ---------------------------------------------------------------------------------------------------------


def test_a_current_that_changes_at_a_time() -> None:
    changing = "type: step, speed: 0.1, towards: 0 deg, later_speed: 0.3, later_towards: 90 deg, at: 20"
    flight = fly_text(text(changing, 60.0))
    times, north = series(flight, "current_north")
    _, east = series(flight, "current_east")
    assert north == pytest.approx(np.where(times < 20.0, 0.1, 0.0), abs=1e-15)
    assert east == pytest.approx(np.where(times < 20.0, 0.0, 0.3), abs=1e-15)
    assert value_at(flight, "east", 59.0) == pytest.approx(0.3 * 39.0, abs=1e-12)


def test_a_current_that_changes_over_a_while() -> None:
    flight = fly_text(text("type: step, speed: 0, later_speed: 0.4, at: 10, ramp: 20", 60.0))
    times, north = series(flight, "current_north")
    assert north == pytest.approx(0.4 * np.clip((times - 10.0) / 20.0, 0.0, 1.0), abs=1e-15)


@pytest.mark.parametrize("across", [0.0, 0.08, -0.08])
def test_a_tide_carries_a_vehicle_round_its_ellipse(across: float) -> None:
    """The way is the integral of the velocity; in one period the ellipse closes and only the mean is left."""
    tide = f"type: tidal, speed: 0.2, towards: 30 deg, across_speed: {across!r}, period: 120, phase: 0.4"
    flight = fly_text(text(f"{tide}, mean_speed: 0.05, mean_towards: 90 deg", 121.0, 0.1))
    c, s, w = math.cos(math.radians(30.0)), math.sin(math.radians(30.0)), 2.0 * math.pi / 120.0

    def north(t: float) -> float:
        return c * 0.2 * math.cos(w * t + 0.4) - s * across * math.sin(w * t + 0.4)

    def east(t: float) -> float:
        return s * 0.2 * math.cos(w * t + 0.4) + c * across * math.sin(w * t + 0.4) + 0.05

    for time in (31.0, 77.0, 120.0):
        assert value_at(flight, "current_north", time) == pytest.approx(north(time), abs=1e-14)
        assert value_at(flight, "current_east", time) == pytest.approx(east(time), abs=1e-14)
        # the engine holds the current over a tick of 0.1 s: half a tick late
        assert value_at(flight, "north", time) - SPEED * time == pytest.approx(quad(north, 0.0, time)[0], abs=0.022)
        assert value_at(flight, "east", time) == pytest.approx(quad(east, 0.0, time)[0], abs=0.022)
    assert value_at(flight, "north", 120.0) == pytest.approx(SPEED * 120.0, abs=1e-9)
    assert value_at(flight, "east", 120.0) == pytest.approx(0.05 * 120.0, abs=1e-9)
