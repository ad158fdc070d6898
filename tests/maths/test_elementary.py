"""The edges that the table in elementary.py promises, exact symmetries, and the same bits however the code runs."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume import maths
from maths.evaluate import IN_PYTHON, lanes, nearly, plain, same_bits, scalar

INF, NAN = math.inf, math.nan
PI, HALF_PI = maths.PI, maths.HALF_PI
BEYOND = np.nextafter(maths.ANGLE_LIMIT, INF)
TINY, SMALLEST_NORMAL, LARGEST = 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308

EDGES = [
    *[("sin", (x,), NAN) for x in (INF, -INF, NAN, BEYOND, -BEYOND, 1e300)],
    *[("cos", (x,), NAN) for x in (INF, -INF, NAN, BEYOND, -BEYOND, 1e300)],
    *[("tan", (x,), NAN) for x in (INF, -INF, NAN, BEYOND, -BEYOND, 1e300)],
    ("sin", (0.0,), 0.0), ("sin", (-0.0,), 0.0), ("cos", (0.0,), 1.0), ("cos", (-0.0,), 1.0), ("tan", (-0.0,), 0.0),
    ("sin", (TINY,), TINY), ("sin", (HALF_PI,), 1.0), ("cos", (PI,), -1.0),
    *[(f, (x,), NAN) for f in ("asin", "acos") for x in (1.0000000000000002, -2.0, INF, -INF, NAN)],
    ("asin", (1.0,), HALF_PI), ("asin", (-1.0,), -HALF_PI), ("asin", (-0.0,), 0.0), ("asin", (TINY,), TINY),
    ("acos", (1.0,), 0.0), ("acos", (-1.0,), PI), ("acos", (0.0,), HALF_PI), ("acos", (-0.0,), HALF_PI),
    ("atan", (INF,), HALF_PI), ("atan", (-INF,), -HALF_PI), ("atan", (-0.0,), 0.0), ("atan", (NAN,), NAN),
    ("atan", (1.0,), PI / 4.0), ("atan", (LARGEST,), HALF_PI), ("atan", (TINY,), TINY),
    *[("atan2", (y, x), 0.0) for y in (0.0, -0.0) for x in (0.0, -0.0, 1.0, TINY, INF)],
    *[("atan2", (y, x), PI) for y in (0.0, -0.0, 1e-300) for x in (-1.0, -INF)],
    ("atan2", (-1e-300, -1.0), -PI), ("atan2", (1.0, 0.0), HALF_PI), ("atan2", (-1.0, -0.0), -HALF_PI),
    ("atan2", (INF, 1e300), HALF_PI), ("atan2", (-INF, -1e300), -HALF_PI), ("atan2", (1.0, INF), 0.0),
    ("atan2", (-1.0, -INF), -PI), ("atan2", (INF, INF), PI / 4.0), ("atan2", (INF, -INF), 3.0 * PI / 4.0),
    ("atan2", (-INF, INF), -PI / 4.0), ("atan2", (-INF, -INF), -3.0 * PI / 4.0),
    ("atan2", (1e307, 1e307), PI / 4.0), ("atan2", (TINY, TINY), PI / 4.0),
    *[("atan2", (y, x), NAN) for y, x in ((NAN, 1.0), (1.0, NAN), (NAN, INF), (INF, NAN), (NAN, 0.0), (NAN, NAN))],
    ("tanh", (INF,), 1.0), ("tanh", (-INF,), -1.0), ("tanh", (NAN,), NAN), ("tanh", (-0.0,), 0.0),
    ("tanh", (TINY,), TINY), ("tanh", (40.0,), 1.0), ("tanh", (-1e300,), -1.0),
    ("exp", (INF,), INF), ("exp", (-INF,), 0.0), ("exp", (NAN,), NAN), ("exp", (0.0,), 1.0), ("exp", (-0.0,), 1.0),
    ("exp", (709.7827128933841,), INF), ("exp", (-708.3964185322642,), 0.0), ("exp", (-800.0,), 0.0),
    ("log", (0.0,), -INF), ("log", (-0.0,), -INF), ("log", (-1.0,), NAN), ("log", (-TINY,), NAN), ("log", (-INF,), NAN),
    ("log", (INF,), INF), ("log", (NAN,), NAN), ("log", (1.0,), 0.0), ("log", (TINY,), -744.4400719213812),
    ("log", (SMALLEST_NORMAL,), -708.3964185322641), ("log", (LARGEST,), 709.782712893384),
    ("hypot", (3.0, -4.0), 5.0), ("hypot", (0.0, -0.0), 0.0), ("hypot", (INF, 1.0), INF), ("hypot", (1.0, NAN), NAN),
    ("hypot", (1e155, 0.0), INF), ("hypot", (1e150, 0.0), 1e150), ("hypot", (NAN, INF), NAN),
    ("round_even", (0.5,), 0.0), ("round_even", (1.5,), 2.0), ("round_even", (-2.5,), -2.0),
    ("round_even", (NAN,), NAN),
    ("clip", (NAN, -1.0, 1.0), NAN), ("clip", (INF, -1.0, 1.0), 1.0), ("clip", (-2.0, -1.0, 1.0), -1.0),
    ("clip", (0.5, -1.0, 1.0), 0.5), ("sign", (-3.0,), -1.0), ("sign", (TINY,), 1.0), ("sign", (NAN,), NAN),
    ("sign", (0.0,), 0.0), ("minimum", (1.0, 2.0), 1.0), ("minimum", (NAN, 2.0), 2.0), ("maximum", (1.0, 2.0), 2.0),
    ("maximum", (2.0, NAN), NAN), ("signed_square", (-3.0,), -9.0), ("signed_root", (-9.0,), -3.0),
    ("signed_root", (NAN,), NAN), ("sqrt", (-1.0,), NAN), ("sqrt", (INF,), INF), ("floor", (-0.5,), -1.0),
]  # fmt: skip
ODD, EVEN = ("sin", "tan", "asin", "atan", "tanh", "signed_square", "signed_root", "round_even"), ("cos",)
DOMAIN = {"asin": 1.0, "acos": 1.0}
ONE_ARGUMENT = [*ODD, *EVEN, "acos", "exp", "log"]


def samples(name: str, size: int = 4096) -> np.ndarray:
    random = np.random.default_rng(11)
    end = DOMAIN.get(name, 30.0)
    special = [0.0, -0.0, INF, -INF, NAN, 1e300, -1e300, TINY, SMALLEST_NORMAL, 1.0, -1.0, 0.5, 709.78, -708.39, 1e6]
    return np.concatenate([special, random.uniform(-end, end, size - len(special))])


@pytest.mark.parametrize("way", [scalar, plain])
@pytest.mark.parametrize(("name", "arguments", "want"), EDGES)
def test_edges(name: str, arguments: tuple[float, ...], want: float, way: Callable[..., Any]) -> None:
    got = float(way(getattr(maths, name), *[np.array([x]) for x in arguments])[0])
    assert same_bits(np.array([got]), np.array([want])), f"{name}{arguments} = {got}, not {want}"


@pytest.mark.skipif(IN_PYTHON, reason="there is nothing to compare with")
@pytest.mark.parametrize("name", [*ONE_ARGUMENT, "atan2", "hypot", "minimum", "maximum", "sign", "clip"])
def test_lanes_give_the_same_bits_and_plain_python_nearly(name: str) -> None:
    function, x = getattr(maths, name), samples(name)
    columns = {"clip": [x, -np.ones_like(x), np.ones_like(x)]}.get(name, [x])
    if name in ("atan2", "hypot", "minimum", "maximum"):
        columns = [np.repeat(x[:64], 64), np.tile(x[:64], 64)]
    wanted = scalar(function, *columns)
    assert same_bits(wanted, lanes(function, *columns))
    assert nearly(wanted, plain(function, *columns))


@pytest.mark.skipif(IN_PYTHON, reason="there is nothing to compare with")
@pytest.mark.parametrize("function", [maths.sincos, maths.sincos_turns])
def test_pairs_too(function: Callable[..., Any]) -> None:
    x = samples("sin")
    x = np.where(np.abs(x) < 1e9, x, 0.5)  # sincos_turns states no edge beyond
    wanted = scalar(function, x, num_results=2)
    assert same_bits(wanted, lanes(function, x, num_results=2))
    assert nearly(wanted, plain(function, x, num_results=2))


@pytest.mark.parametrize("name", ODD)
def test_odd_to_the_last_bit(name: str) -> None:
    x = samples(name)
    there, back = scalar(getattr(maths, name), x), scalar(getattr(maths, name), -x)
    assert np.array_equal(there, -back, equal_nan=True)


@pytest.mark.parametrize("name", EVEN)
def test_even_to_the_last_bit(name: str) -> None:
    x = samples(name)
    assert np.array_equal(scalar(getattr(maths, name), x), scalar(getattr(maths, name), -x), equal_nan=True)


@given(x=st.floats(-700.0, 700.0))
def test_logarithm_inverts_the_exponential(x: float) -> None:
    assert maths.log(maths.exp(x)) == pytest.approx(x, rel=3e-16, abs=3e-16)


@given(x=st.floats(-maths.ANGLE_LIMIT, maths.ANGLE_LIMIT))
def test_sine_and_cosine_lie_on_the_unit_circle(x: float) -> None:
    s, c = maths.sincos(x)
    assert abs(s * s + c * c - 1.0) < 7e-16
    assert -1.0 <= s <= 1.0
    assert -1.0 <= c <= 1.0


@given(x=st.floats(0.0, INF), y=st.floats(0.0, INF))
def test_monotonic_where_a_controller_counts_on_it(x: float, y: float) -> None:
    """tanh saturates without passing 1, and a larger error never asks for less."""
    low, high = min(x, y), max(x, y)
    assert 0.0 <= maths.tanh(low) <= 1.0
    if high > low * (1.0 + 1e-14):
        assert maths.tanh(low) <= maths.tanh(high)
        assert maths.atan(low) <= maths.atan(high)


@given(x=st.floats(-1e100, 1e100))
def test_signed_root_inverts_signed_square(x: float) -> None:
    assert maths.signed_root(maths.signed_square(x)) == pytest.approx(x, rel=3e-16, abs=1e-150)
