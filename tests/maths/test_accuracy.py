"""Elementary functions against references with more digits, at random places and at those chosen to be hard."""

import mpmath
import numpy as np
import pytest

from cardume import maths
from cardume.maths import elementary, trigonometry
from maths.evaluate import scalar
from maths.minimax import APPROXIMATIONS, coefficients

NUM_POINTS = 120_000
REFERENCE = np.longdouble  # 64 bits or more where there are such; elsewhere mpmath alone is the judge
HAS_REFERENCE = np.finfo(REFERENCE).eps < 1e-18
LIMIT = maths.ANGLE_LIMIT


def uniform(low: float, high: float, seed: int = 0, size: int = NUM_POINTS) -> np.ndarray:
    return np.random.default_rng(seed).uniform(low, high, size)


def decades(low: float, high: float, seed: int = 1, size: int = NUM_POINTS) -> np.ndarray:
    """Both signs, the exponent uniform."""
    random = np.random.default_rng(seed)
    return 10.0 ** random.uniform(low, high, size) * random.choice([-1.0, 1.0], size)


def near_quarter_turns(size: int = NUM_POINTS) -> np.ndarray:
    """The floats nearest to multiples of pi / 2: there the reduced angle is least and has most to lose."""
    return np.round(uniform(-667_543.0, 667_543.0, 2, size)) * maths.HALF_PI


ANGLES = [(uniform(-10.0, 10.0),), (decades(-300, 0),), (uniform(-LIMIT, LIMIT),), (near_quarter_turns(),)]
UNIT = [(uniform(-1.0, 1.0),), (decades(-300, 0),), (1.0 - np.abs(decades(-16, 0)),), (np.abs(decades(-16, 0)) - 1.0,)]
PLANE = [
    (uniform(-5.0, 5.0), uniform(-5.0, 5.0, 3)),
    (decades(-6, 6), decades(-6, 6, 4)),
    (decades(-140, 150), decades(-140, 150, 4)),
]
# Name: largest relative error allowed, as the table in elementary.py says, and where it is looked for.
CASES = {
    "sin": (4e-16, ANGLES),
    "cos": (4e-16, ANGLES),
    "tan": (7e-16, ANGLES),
    "asin": (4e-16, UNIT),
    "acos": (4e-16, UNIT),
    "atan": (4e-16, [(uniform(-3.0, 3.0),), (decades(-300, 300),)]),
    "atan2": (4e-16, PLANE),
    "tanh": (6e-16, [(uniform(-2.0, 2.0),), (decades(-300, 2),)]),
    "exp": (3e-16, [(uniform(-1.0, 1.0),), (uniform(-708.39, 709.78),), (decades(-20, 0),)]),
    "log": (3e-16, [(uniform(0.3, 3.0),), (np.abs(decades(-323, 308)),), (1.0 + decades(-16, -1),)]),
    "hypot": (3e-16, PLANE),
}
NUMPY_NAMES = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}


def relative_errors(got: np.ndarray, want: np.ndarray) -> np.ndarray:
    zero = want == 0
    return np.where(zero, np.abs(got), np.abs(got - want) / np.where(zero, 1, np.abs(want)))


@pytest.mark.skipif(not HAS_REFERENCE, reason="long double has no more digits than float64 here")
@pytest.mark.parametrize("name", CASES)
def test_random_points(name: str) -> None:
    allowed, samples = CASES[name]
    reference = getattr(np, NUMPY_NAMES.get(name, name))
    for columns in samples:
        want = reference(*[column.astype(REFERENCE) for column in columns])
        errors = relative_errors(scalar(getattr(maths, name), *columns), want)
        worst = int(np.argmax(errors))
        assert errors[worst] <= allowed, f"{name}{tuple(column[worst] for column in columns)}: {errors[worst]:.2e}"


@pytest.mark.parametrize("name", CASES)
def test_some_points_in_40_digits(name: str) -> None:
    """Independent of the processor's long double and of the C library's functions."""
    allowed, samples = CASES[name]
    with mpmath.workdps(40):
        for columns in samples:
            some = [column[:200] for column in columns]
            got = scalar(getattr(maths, name), *some)
            for value, *arguments in zip(got, *some, strict=True):
                want = getattr(mpmath, name)(*[mpmath.mpf(float(x)) for x in arguments])
                error = abs(mpmath.mpf(float(value)) - want) / abs(want)
                assert error <= allowed, (name, arguments)


def test_sine_and_cosine_are_good_to_absolute_rounding() -> None:
    x = uniform(-LIMIT, LIMIT, 5)
    with mpmath.workdps(40):
        want = np.array([(float(mpmath.sin(v)), float(mpmath.cos(v))) for v in map(float, x[:2000])]).T
    got = scalar(maths.sincos, x[:2000], num_results=2)
    assert np.max(np.abs(got - want)) <= 2.5e-16 + 1.2e-16  # want itself is rounded


def test_the_hardest_reductions() -> None:
    """Of the floats nearest to each multiple of pi / 2 below the limit, the 200 that come closest to it."""
    multiples = np.arange(1.0, 667_544.0) * maths.HALF_PI
    distance = np.min(np.abs(scalar(maths.sincos, multiples, num_results=2)), axis=0)
    hardest = multiples[np.argsort(distance)[:200]]
    assert np.min(distance) < 1e-15
    with mpmath.workdps(60):
        for x, s, c in zip(hardest, *scalar(maths.sincos, hardest, num_results=2), strict=True):
            small, want = (s, mpmath.sin(float(x))) if abs(s) < 0.5 else (c, mpmath.cos(float(x)))
            assert abs(mpmath.mpf(float(small)) - want) <= 4e-16 * abs(want), x


def test_whole_turns_come_off_exactly() -> None:
    turns = uniform(-3.0, 3.0)[:2000]
    with mpmath.workdps(40):
        want = np.array([(float(mpmath.sinpi(2 * t)), float(mpmath.cospi(2 * t))) for t in map(mpmath.mpf, turns)])
    assert np.max(np.abs(scalar(maths.sincos_turns, turns, num_results=2) - want.T)) <= 4e-16
    quarters = np.array([-0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1e6 + 0.25])
    s, c = scalar(maths.sincos_turns, quarters, num_results=2)
    assert s.tolist() == [0, -1, 0, 1, 0, -1, 1]
    assert c.tolist() == [-1, 0, 1, 0, -1, 0, 0]


@pytest.mark.parametrize("name", APPROXIMATIONS)
def test_the_coefficients_are_the_minimax_ones(name: str) -> None:
    written = getattr(trigonometry, name, None) or getattr(elementary, name)
    computed, error = coefficients(name)
    assert list(written) == pytest.approx(computed, rel=1e-12)
    assert error < 2e-17
