"""The water: what varies, what a grid says between its nodes, and that compiled code says the same."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numba import config, njit
from scipy.interpolate import RegularGridInterpolator

from cardume.compiler import WIDTH, load, rows_of, store
from cardume.signals import Noise, Where
from cardume.world.currents import (
    ekman,
    gauss_markov,
    gridded,
    pack_grid,
    power_law,
    sheared,
    step,
    tidal,
    uniform,
    water_at,
)
from cardume.world.currents.grid import LEAST_WEIGHT
from cardume.world.currents.variation import Variation, vary

LAWS = (uniform, gridded, sheared, power_law, ekman, step, tidal, gauss_markov)
NO_FIELD = np.zeros(0)
HERE = Where(3.0, -4.0, 5.0, 6.0, NO_FIELD)
SILENCE = Noise(0.0, 0.0, 0.0, 0.0)


# ---- uniform, and the variation --------------------------------------------------------------------------------------


@given(st.floats(0.0, 3.0), st.floats(-7.0, 7.0))
def test_a_uniform_current_flows_towards_its_direction(speed: float, towards: float) -> None:
    water, _ = uniform(HERE, Noise(1.0, -2.0, 3.0, 4.0), Variation(), 0.1, speed=speed, towards=towards)
    assert water.north == pytest.approx(speed * math.cos(towards), abs=1e-15)
    assert water.east == pytest.approx(speed * math.sin(towards), abs=1e-15)


def responses(steps: int, dt: float, sigma: float, time_constant: float) -> np.ndarray:
    """(step, draw): how much each standard normal draw moves the north part at each step; the law is linear in them."""
    answer = np.zeros((steps, steps))
    for draw in range(steps):
        memory = Variation()
        for k in range(steps):
            noise = Noise(1.0 if k == draw else 0.0, 9.0, 0.0, 0.0)
            water, memory = uniform(
                HERE, noise, memory, dt, variation_sigma=sigma, variation_time_constant=time_constant
            )
            answer[k, draw] = water.north
    return answer


@pytest.mark.parametrize(("dt", "sigma", "time_constant"), [(0.1, 0.05, 100.0), (7.0, 0.3, 3.0), (40.0, 0.02, 60.0)])
def test_the_variation_is_stationary_with_an_exponential_autocorrelation(
    dt: float, sigma: float, time_constant: float
) -> None:
    h = responses(12, dt, sigma, time_constant)
    lags = np.abs(np.subtract.outer(np.arange(12), np.arange(12))) * dt
    assert h @ h.T == pytest.approx(sigma**2 * np.exp(-lags / time_constant), rel=1e-12)


@pytest.mark.parametrize(("time", "drift"), [(10.0, 0.4918037228), (60.0, 2.7277429873)])
def test_the_drift_it_causes_is_the_closed_form(time: float, drift: float) -> None:
    """Theory: 2 s^2 T (t - T (1 - exp(-t / T))) is the variance; the trapezoidal sum converges to it as dt^2."""
    variances = []
    for steps in (10, 20):
        h = responses(steps + 1, time / steps, 0.05, 100.0)
        weights = np.full(steps + 1, time / steps)
        weights[[0, -1]] /= 2.0
        variances.append(np.sum((weights @ h) ** 2))
    coarse, fine = variances
    assert math.sqrt(fine + (fine - coarse) / 3.0) == pytest.approx(drift, rel=1e-6)


def test_many_seeds_drift_by_the_closed_form() -> None:
    draws = np.random.default_rng(20).normal(size=(1000, 31, 2))
    drifts = []
    for run in draws:
        memory, flow = Variation(), []
        for a, b in run:
            memory = vary(memory, Noise(a, b, 0.0, 0.0), 2.0, 0.05, 100.0)
            flow.append(memory[:2])
        drifts.append(np.trapezoid(flow, dx=2.0, axis=0))
    rms = np.sqrt(np.mean(np.square(drifts), axis=0))
    assert rms == pytest.approx([2.7277429873] * 2, rel=4.0 / math.sqrt(2.0 * 1000.0))
    assert abs(np.corrcoef(np.transpose(drifts))[0, 1]) < 4.0 / math.sqrt(1000.0)


def test_two_vehicles_feel_the_same_variation() -> None:
    noises = [Noise(*row) for row in np.random.default_rng(3).normal(size=(50, 4))]
    one = two = Variation()
    elsewhere = Where(-900.0, 50.0, 20.0, 6.0, NO_FIELD)
    for noise in noises:
        water, one = uniform(HERE, noise, one, 0.1, speed=0.2, towards=1.0, variation_sigma=0.05)
        other, two = uniform(elsewhere, noise, two, 0.1, speed=0.2, towards=1.0, variation_sigma=0.05)
        assert water == other


def test_no_variation_leaves_the_mean_alone() -> None:
    memory = Variation()
    mean, _ = uniform(HERE, SILENCE, memory, 0.1, speed=0.3, towards=0.7)
    for k in range(5):
        water, memory = uniform(HERE, Noise(k, -k, k, 1.0), memory, 0.1, speed=0.3, towards=0.7)
        assert water == mean


# ---- the grid --------------------------------------------------------------------------------------------------------

TIMES = np.array([0.0, 600.0, 3600.0])
DEPTHS = np.array([0.49, 1.54, 2.65, 3.82, 5.08, 6.44, 40.3, 318.0, 5727.0])  # a model's levels, far from even
NORTHS = np.array([-1500.0, -1.0, 1480.0, 2990.0, 4500.0])
EASTS = np.array([-3000.0, -1490.0, 20.0, 1500.0])
AXES = (TIMES, DEPTHS, NORTHS, EASTS)
VELOCITY = np.random.default_rng(7).normal(size=(3, 9, 5, 4, 2))
GRID = pack_grid(*AXES, VELOCITY)
HOLED = np.where(np.random.default_rng(8).uniform(size=VELOCITY.shape[:-1])[..., None] < 0.4, np.nan, VELOCITY)
HOLED_GRID = pack_grid(*AXES, HOLED)


def inside(axis: np.ndarray) -> st.SearchStrategy[float]:
    return st.one_of(st.floats(float(axis[0]), float(axis[-1])), st.sampled_from([float(x) for x in axis]))


places = st.tuples(inside(NORTHS), inside(EASTS), inside(DEPTHS), inside(TIMES))


@given(places)
def test_between_nodes_it_is_what_scipy_says(place: tuple[float, float, float, float]) -> None:
    north, east, depth, time = place
    expected = RegularGridInterpolator(AXES, VELOCITY)((time, depth, north, east))
    assert water_at(GRID, north, east, depth, time) == pytest.approx(tuple(expected), abs=1e-13)


def test_at_nodes_it_is_the_node() -> None:
    for t, d, n, e in itertools.product(range(3), range(9), range(5), range(4)):
        water = water_at(HOLED_GRID, NORTHS[n], EASTS[e], DEPTHS[d], TIMES[t])
        assert np.array_equal(water, HOLED[t, d, n, e], equal_nan=True)


def by_definition(north: float, east: float, depth: float, time: float) -> tuple[np.ndarray, float]:
    """The sum over the sixteen nodes around a place, and the weight of those that hold water."""
    choices = []
    for axis, x in zip(AXES, (time, depth, north, east), strict=True):
        k = min(max(int(np.searchsorted(axis, x, side="right")) - 1, 0), len(axis) - 2)
        f = min(max((x - axis[k]) / (axis[k + 1] - axis[k]), 0.0), 1.0)
        choices.append([(k, 1.0 - f), (k + 1, f)])
    total, weight = np.zeros(2), 0.0
    for corner in itertools.product(*choices):
        w = math.prod(part for _, part in corner)
        value = HOLED[tuple(k for k, _ in corner)]
        if w > 0.0 and np.isfinite(value).all():
            total, weight = total + w * value, weight + w
    return total / weight if weight > 0.0 else total, weight


@given(places)
def test_holes_are_left_out_and_the_rest_carries_their_weight(place: tuple[float, float, float, float]) -> None:
    expected, weight = by_definition(*place)
    water = water_at(HOLED_GRID, *place)
    if weight > LEAST_WEIGHT * (1.0 + 1e-9):
        assert water == pytest.approx(tuple(expected), abs=1e-12)
    elif weight < LEAST_WEIGHT * (1.0 - 1e-9):
        assert np.isnan(water).all()


def test_one_node_of_four_carries_the_middle_of_a_cell_and_no_more() -> None:
    velocity = np.full((1, 1, 2, 2, 2), np.nan)
    velocity[0, 0, 1, 1] = (0.3, -0.1)
    grid = pack_grid(np.zeros(1), np.zeros(1), np.array([0.0, 1000.0]), np.array([0.0, 800.0]), velocity)
    assert water_at(grid, 500.0, 400.0, 30.0, 99.0) == (0.3, -0.1)
    assert water_at(grid, 1000.0, 800.0, 0.0, 0.0) == (0.3, -0.1)
    assert np.isnan(water_at(grid, 499.0, 400.0, 0.0, 0.0)).all()
    assert np.isnan(water_at(grid, 1000.0, 100.0, 0.0, 0.0)).all()


@given(places, st.sampled_from([TIMES[1], TIMES[0] - 1e5, TIMES[-1] + 1e5]))
def test_beyond_the_times_and_levels_the_nearest_one_counts(
    place: tuple[float, float, float, float], time: float
) -> None:
    north, east, _, _ = place
    nearest = min(max(time, TIMES[0]), TIMES[-1])
    for depth, level in ((-3.0, DEPTHS[0]), (9000.0, DEPTHS[-1])):
        assert water_at(GRID, north, east, depth, time) == water_at(GRID, north, east, level, nearest)


@pytest.mark.parametrize(
    ("north", "east"),
    [(-1500.1, 0.0), (4500.1, 0.0), (0.0, -3000.1), (0.0, 1500.1), (math.nan, 0.0), (0.0, math.nan), (math.inf, 0.0)],
)
def test_beyond_the_grid_there_is_nothing(north: float, east: float) -> None:
    assert np.isnan(water_at(GRID, north, east, 1.0, 1.0)).all()


def test_a_lost_depth_or_time_is_no_velocity() -> None:
    assert np.isnan(water_at(GRID, 0.0, 0.0, math.nan, 1.0)).all()
    assert np.isnan(water_at(GRID, 0.0, 0.0, 1.0, math.nan)).all()


def test_the_table_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        GRID[0] = 1.0


def test_a_gridded_current_is_the_grid_plus_the_variation() -> None:
    noises = [Noise(*row) for row in np.random.default_rng(5).normal(size=(20, 4))]
    one = two = Variation()
    for k, noise in enumerate(noises):
        place = Where(100.0 * k, -50.0 * k, 4.0, 30.0 * k, GRID)
        water, one = gridded(place, noise, one, 0.1, 0.05, 100.0)
        shaken, two = uniform(place, noise, two, 0.1, variation_sigma=0.05)
        still = water_at(GRID, place.north, place.east, place.depth, place.time)
        assert water == pytest.approx((still.north + shaken.north, still.east + shaken.east), abs=1e-15)


# ---- compiled --------------------------------------------------------------------------------------------------------


def drift(grid: np.ndarray, asked: np.ndarray, seen: np.ndarray, count: int) -> None:
    """Look up place after place, and let the water vary meanwhile."""
    field, question, answer = rows_of(grid), rows_of(asked), rows_of(seen)
    memory = Variation(0.0 * load(question, 0), 0.0 * load(question, 0), 0.0 * load(question, 0))
    for k in range(count):
        north, east = load(question, 4 * k), load(question, 4 * k + 1)
        depth, time = load(question, 4 * k + 2), load(question, 4 * k + 3)
        water = water_at(field, north, east, depth, time)
        after = vary(memory, Noise(north * 1e-3, east * 1e-3, depth, time), 0.1, 0.05 + 0.0 * north, 100.0)
        memory = Variation(after.north, after.east, 0.0 * north + after.started)
        store(answer, 2 * k, water.north + memory.north)
        store(answer, 2 * k + 1, water.east + memory.east)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
def test_python_one_mission_and_lanes_agree_to_the_last_bit() -> None:
    compiled = njit(nogil=True, error_model="numpy")(drift)
    count = 60
    generator = np.random.default_rng(11)
    low = np.array([a[0] for a in (NORTHS, EASTS, DEPTHS, TIMES)]) - 50.0
    high = np.array([NORTHS[-1], EASTS[-1], 50.0, TIMES[-1]]) + 50.0
    asked = generator.uniform(low[:, None], high[:, None], size=(count, 4, WIDTH))
    lanes = np.zeros((2 * count, WIDTH))
    compiled(HOLED_GRID, asked.reshape(-1, WIDTH), lanes, count)
    assert 0.3 < np.isfinite(lanes).mean() < 1.0
    for lane in range(WIDTH):
        own, one = np.ascontiguousarray(asked[:, :, lane]).ravel(), np.zeros(2 * count)
        compiled(HOLED_GRID, own, one, count)
        assert np.array_equal(one, lanes[:, lane], equal_nan=True)
    plain = np.zeros(2 * count)
    drift(HOLED_GRID, own, plain, count)
    assert np.allclose(one, plain, rtol=1e-12, atol=1e-12, equal_nan=True)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the laws")
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_the_laws_compile_for_one_mission_and_for_lanes(law) -> None:
    assert law.handle() > 0
    assert law.handle(lanes=True) > 0
