"""Philox against its published answers; streams that do not know of one another; the shape of the noise."""

import itertools
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numba import njit
from scipy import stats

from cardume.compiler import compiled, load, rows_of, store
from cardume.errors import InputError
from cardume.maths.random import Key, Noise, _unit, normals, philox, random_key, stream_id, uniforms, vehicle_id
from maths.evaluate import IN_PYTHON, lanes, nearly, plain, same_bits, scalar

NUM_TICKS = 2000 if IN_PYTHON else 100_000
BOUND = 5.0  # standard deviations: fixed seeds, so these tests never fail by chance twice
# Random123, tests/kat_vectors: counter, key, answer of philox4x32 with ten rounds.
KNOWN_ANSWERS = [
    ("00000000 00000000 00000000 00000000", "00000000 00000000", "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
    ("ffffffff ffffffff ffffffff ffffffff", "ffffffff ffffffff", "408f276d 41c83b0e a20bc7c6 6d5451fd"),
    ("243f6a88 85a308d3 13198a2e 03707344", "a4093822 299f31d0", "d16cfe09 94fdcceb 5001e420 24126ea1"),
]


# Of seed 7, stream "gnss", vehicle "alice", tick 3.
FIRST_NOISE = (-0.6496542961988724, -0.7887374913971594, -0.3860290363754559, 1.246107441066973)


def words(text: str) -> list[int]:
    return [int(word, 16) for word in text.split()]


def draw(
    function: Callable[..., Any], key: Key, ticks: np.ndarray, way: Callable[..., np.ndarray] = scalar
) -> np.ndarray:
    """Four columns of uniforms or normals, one row each tick."""
    columns = [np.full(ticks.size, part) for part in key]
    return way(_six_arguments(function), *columns, ticks, num_results=4)


@cache
def _six_arguments(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function with the fields of its key spread out."""

    def spread(a: float, b: float, c: float, d: float, e: float, tick: float) -> Any:
        return function(Key(a, b, c, d, e), tick)

    return compiled(spread)


def sample(name: str, vehicle: str = "ana", seed: int = 7) -> np.ndarray:
    return draw(normals, random_key(seed, name, vehicle), np.arange(NUM_TICKS, dtype=float))


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN_ANSWERS)
def test_known_answers(counter: str, key: str, answer: str) -> None:
    got = philox(*map(np.uint64, words(counter)), *map(np.uint64, words(key)))
    assert [int(word) for word in got] == words(answer)


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN_ANSWERS)
@pytest.mark.parametrize("way", [scalar, plain] if IN_PYTHON else [scalar, lanes, plain])
def test_known_answers_by_way_of_a_key(counter: str, key: str, answer: str, way: Callable[..., np.ndarray]) -> None:
    """The counter is (tick, stream, vehicle low, high), the key the seed: in compiled code and in lanes too."""
    tick, stream, *vehicle = map(float, words(counter))
    got = draw(uniforms, Key(*map(float, words(key)), stream, *vehicle), np.full(8, tick), way)
    assert np.all(got == ((np.array(words(answer)) + 0.5) * 2.0**-32)[:, None])


@pytest.mark.skipif(IN_PYTHON, reason="there is nothing to compare with")
@pytest.mark.parametrize("function", [uniforms, normals])
def test_lanes_give_the_same_bits_and_plain_python_nearly(function: Callable[..., Any]) -> None:
    ticks = np.concatenate([np.arange(1000.0), 2.0**32 - np.arange(1.0, 25.0)])
    key = random_key(2**64 - 1, "gnss", "ana")
    wanted = draw(function, key, ticks)
    assert same_bits(wanted, draw(function, key, ticks, lanes))
    assert nearly(wanted, draw(function, key, ticks, plain))


@pytest.mark.skipif(IN_PYTHON, reason="there are no lanes")
def test_eight_missions_with_seeds_of_their_own_at_one_tick() -> None:
    """As the engine calls it: the seed differs by lane, everything else is one number."""

    @njit
    def draw_lanes(seeds, stream, low, high, tick, out):
        rows = rows_of(seeds)
        noise = normals(Key(load(rows, 0), load(rows, 1), stream, low, high), tick)
        target = rows_of(out)
        store(target, 0, noise.a)
        store(target, 1, noise.b)
        store(target, 2, noise.c)
        store(target, 3, noise.d)

    keys = [random_key(seed, "usbl", "bia") for seed in range(2**33, 2**33 + 8)]
    out = np.empty((4, 8))
    draw_lanes(np.array(keys)[:, :2].T.copy(), *keys[0][2:], 12.0, out)
    assert nearly(out.T, np.array([normals(key, 12.0) for key in keys]))
    assert same_bits(out[:, 0], draw(normals, keys[0], np.array([12.0]))[:, 0])


def test_uniform_numbers_are_uniform() -> None:
    u = draw(uniforms, random_key(3, "loss"), np.arange(NUM_TICKS, dtype=float))
    assert 0.0 < u.min() < u.max() < 1.0
    for column in u:
        assert stats.kstest(column, "uniform").pvalue > 1e-3


def test_the_open_interval_is_open() -> None:
    """The least and the largest word there can be; the tail of the noise ends at 6.76 standard deviations."""
    least, most = _unit(np.uint64(0)), _unit(np.uint64(2**32 - 1))
    assert 0.0 < least == 2.0**-33
    assert 1.0 > most == 1.0 - 2.0**-33
    assert np.sqrt(-2.0 * np.log(least)) == pytest.approx(6.763705635, abs=1e-9)


def test_noise_is_made_of_the_uniform_numbers() -> None:
    ticks, key = np.arange(5000.0), random_key(5, "dvl", "ana")
    u, v, w, x = draw(uniforms, key, ticks)
    first, second = np.sqrt(-2.0 * np.log([u, w]))
    turn_v, turn_x = 2.0 * np.pi * v, 2.0 * np.pi * x
    want = [first * np.cos(turn_v), first * np.sin(turn_v), second * np.cos(turn_x), second * np.sin(turn_x)]
    assert np.max(np.abs(draw(normals, key, ticks) - want)) < 1e-14


def test_noise_is_standard_normal() -> None:
    z = sample("gnss").ravel()
    for power, mean, variance in ((1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0), (6, 15.0, 10170.0)):
        assert abs(np.mean(z**power) - mean) < BOUND * np.sqrt(variance / z.size), power
    assert stats.kstest(z, "norm").pvalue > 1e-3
    beyond = np.sum(np.abs(z) > 3.0)
    expected = z.size * 2.0 * stats.norm.sf(3.0)
    assert abs(beyond - expected) < BOUND * np.sqrt(expected)


def test_each_of_the_four_is_normal() -> None:
    for column in sample("ahrs"):
        assert stats.kstest(column, "norm").pvalue > 1e-3


def test_nothing_is_correlated() -> None:
    """Neighbors in every sense: the four of one tick, ticks, streams, vehicles, seeds; and their squares."""
    streams = [sample("gnss"), sample("usbl"), sample("gnss", "bia"), sample("gnss", "ana", 8)]
    columns = [column for four in streams for column in four]
    columns += [np.roll(streams[0][0], lag) for lag in (1, 2, 7, 256)]
    for a, b in itertools.combinations(columns, 2):
        assert abs(np.mean(a * b)) < BOUND / np.sqrt(NUM_TICKS)
        assert abs(np.mean((a**2 - 1.0) * (b**2 - 1.0))) < BOUND * 2.0 / np.sqrt(NUM_TICKS)


@given(seed=st.integers(0, 2**64 - 1), tick=st.integers(0, 2**32 - 1), word=st.integers(0, 5))
def test_every_part_of_the_key_matters(seed: int, tick: int, word: int) -> None:
    key = random_key(seed, "gnss", "ana")
    there = [*key, float(tick)]
    other = list(there)
    other[word] = float(int(there[word]) ^ 1)
    a, b = (set(uniforms(Key(*parts[:5]), parts[5])) for parts in (there, other))
    assert len(a & b) == 0


def test_names_are_hashed_the_same_for_ever() -> None:
    """Old missions keep their numbers: these must never change."""
    assert stream_id("gnss") == 1493015598.0
    assert vehicle_id("alice") == (2889059431.0, 3093839177.0)
    assert random_key(2**40 + 5, "gnss", "alice") == Key(5.0, 256.0, 1493015598.0, 2889059431.0, 3093839177.0)
    assert normals(random_key(7, "gnss", "alice"), 3.0) == Noise(*FIRST_NOISE)


def test_stream_and_vehicle_of_one_name_differ() -> None:
    low, high = vehicle_id("gnss")
    assert stream_id("gnss") not in (low, high)
    assert all(0.0 <= part < 2.0**32 and part == int(part) for part in (low, high, stream_id("gnss")))
    assert vehicle_id("") != vehicle_id(" ")
    assert vehicle_id("ação") != vehicle_id("acao")


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5, "7", None, float("nan")])
def test_bad_seeds(seed: object) -> None:
    with pytest.raises(InputError, match="is not a whole number from 0 to"):
        random_key(seed, "gnss")  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", [0, 2**64 - 1, np.int64(5), np.uint64(2**64 - 1)])
def test_good_seeds(seed: int) -> None:
    key = random_key(seed, "gnss")
    assert int(key.seed_low) + (int(key.seed_high) << 32) == int(seed)
