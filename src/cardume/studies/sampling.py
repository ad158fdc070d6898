"""Where in their distributions the values of each run lie: by chance, or spread more evenly than chance does."""

import importlib
from collections.abc import Sequence
from types import ModuleType

import numpy as np

from cardume.errors import InputError
from cardume.studies.constants import SAMPLINGS

SMALLEST = 2.0**-60
LARGEST = 1.0 - 2.0**-53
SOBOL_BITS = 52  # of a point; half a step more lies between 0 and 1 and is a float64
MOST_KEYS = 21_201  # that Sobol points are known for


def sample_chances(keys: Sequence[str], runs: int, sampling: str, seed: int) -> dict[str, np.ndarray]:
    """For each key the chance (runs,) in (0, 1) below which the value of each run lies in its distribution.

    A Latin hypercube has one run in each of `runs` equally likely slices of every distribution; Sobol points are even
    also in pairs of distributions, best where their number is a power of two.  By chance alone the seed of each run
    draws, and nothing is given here.

    Args:
        keys: of the distributions; their order in the file does not matter.
        runs: how many.
        sampling: one of SAMPLINGS.
        seed: of the shuffling and scrambling.

    Raises:
        InputError: no such sampling, more keys than it can take, or scipy is not installed.

    Source: McKay, Beckman & Conover (1979), Technometrics 21(2); Owen (1998), Scrambling Sobol' and
    Niederreiter-Xing points, J. Complexity 14(4); both by scipy.stats.qmc.
    """
    if sampling not in SAMPLINGS:
        raise InputError(f"there is no sampling '{sampling}'; valid are {', '.join(SAMPLINGS)}")
    if sampling == "monte_carlo" or not keys:
        return {}
    names = sorted(keys)
    points = _points(len(names), runs, sampling, seed)
    return {key: np.ascontiguousarray(points[:, k]) for k, key in enumerate(names)}


def sampling_note(sampling: str, runs: int, keys: Sequence[str]) -> str:
    """What is worth knowing of a sampling before it is flown, or nothing.

    Args:
        sampling: one of SAMPLINGS.
        runs: how many.
        keys: of the distributions.
    """
    if sampling != "monte_carlo" and not keys:
        return f"no value is drawn, so {sampling} has nothing to spread; noise and losses are by chance"
    if sampling == "sobol" and runs & (runs - 1):
        below = 1 << (runs.bit_length() - 1)
        return f"Sobol points are even when their number is a power of two: {below} or {2 * below} instead of {runs}"
    return ""


def _points(dimensions: int, runs: int, sampling: str, seed: int) -> np.ndarray:
    qmc = needed("scipy.stats.qmc", "scipy")
    if sampling == "latin_hypercube":
        points = qmc.LatinHypercube(dimensions, rng=np.random.default_rng(seed)).random(runs)
        return np.asarray(np.clip(points, SMALLEST, LARGEST))
    if dimensions > MOST_KEYS:
        raise InputError(f"{dimensions} values are drawn; sobol spreads at most {MOST_KEYS}; use latin_hypercube")
    sobol = qmc.Sobol(dimensions, scramble=True, bits=SOBOL_BITS, rng=np.random.default_rng(seed))
    whole = 1 << (runs - 1).bit_length()  # of a power of two scipy has nothing to warn of
    return np.asarray(sobol.random(whole)[:runs] + 2.0 ** -(SOBOL_BITS + 1))


def needed(module: str, package: str) -> ModuleType:
    """A module of the extra `study`.

    Args:
        module: its name.
        package: that it comes with.

    Raises:
        InputError: it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as problem:
        why = "" if isinstance(problem, ModuleNotFoundError) else f" ({problem})"
        raise InputError(
            f"a study needs {package}, which is not installed{why}; install it with: pip install 'cardume[study]'"
        ) from None
