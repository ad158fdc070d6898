"""Closed form M: the spectra of D^-1 L, read from fleets that fly with small differences."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest

from flying import limit
from oracles.test_consensus import final_states, tanh_law

SMALL = 1e-4  # of the length scale: its square is below every tolerance here
SQRT5 = math.sqrt(5.0)
PRINTED = {
    "pair": ("complete", [0.0, 2.0]),
    "star of 3": ("star", [0.0, 1.0, 2.0]),
    "complete of 3": ("complete", [0.0, 1.5, 1.5]),
    "path of 4": ("path", [0.0, 0.5, 1.5, 2.0]),
    "ring of 5": ("ring", [0.0, 0.69098301, 0.69098301, 1.80901699, 1.80901699]),
    "complete of 4": ("complete", [0.0, 4.0 / 3.0, 4.0 / 3.0, 4.0 / 3.0]),
    "complete of 6": ("complete", [0.0, *[6.0 / 5.0] * 5]),
}


def response(size: int, topology: object, rate: float, scale: float, until: float, tick: float) -> np.ndarray:
    """What the fleet makes of each start that differs in one state: the columns of exp(-rate D^-1 L until)."""
    law = tanh_law(rate * scale, scale)
    starts = SMALL * scale * np.eye(size)
    return np.array([final_states(s, law, tick, until, topology=topology) for s in starts]).T / (SMALL * scale)


def spectrum(size: int, topology: object, rate: float, scale: float, until: float) -> Callable[[float], np.ndarray]:
    """The eigenvalues of D^-1 L, in order, that flights at a tick [s] show."""

    def found(tick: float) -> np.ndarray:
        modes = np.linalg.eigvals(response(size, topology, rate, scale, until, tick))
        return np.sort(-np.log(modes.real) / (rate * until))

    return found


def check_spectrum(size: int, topology: object, wanted: Sequence[float], rate: float = 0.2, scale: float = 1.0) -> None:
    until = 1.0 / rate
    ticks = tuple(until / count for count in (100, 200, 400))
    flown = dict(zip(ticks, map(spectrum(size, topology, rate, scale, until), ticks), strict=True))
    for k, value in enumerate(wanted):
        found, order = limit(lambda tick, k=k: float(flown[tick][k]), ticks)
        print(f"{value:.8f}: error {found - value:.1e}, order {order:.2f}")
        assert found == pytest.approx(value, abs=1e-5)
        assert abs(value) < 1e-12 or order > 0.85  # what is symmetric, as a pair is, is approached at second order


@pytest.mark.parametrize("name", PRINTED)
def test_printed_spectra(name: str) -> None:
    """Row M: a difference along an eigenvector of D^-1 L decays at k / gamma_0 times its eigenvalue."""
    topology, wanted = PRINTED[name]
    if name == "ring of 5":
        assert wanted[1:4:2] == pytest.approx([1.0 - (SQRT5 - 1.0) / 4.0, 1.0 + (1.0 + SQRT5) / 4.0], abs=5e-9)
    check_spectrum(len(wanted), topology, wanted)


@pytest.mark.parametrize("seed", range(3))
def test_spectra_of_random_graphs(seed: int) -> None:
    """Row M on random undirected graphs, k and gamma_0 drawn; the least but 0 says how fast they agree."""
    draw = np.random.default_rng([31, seed])
    size = int(draw.integers(4, 7))
    links = (draw.random((size, size)) < 0.4) | (np.roll(np.eye(size), 1, axis=1) > 0)
    hears = np.triu(links, 1) | np.triu(links.T, 1)
    hears = (hears | hears.T).astype(float)
    rate, scale = draw.uniform(0.05, 0.3), draw.uniform(0.5, 3.0)
    # The similar matrix I - D^-1/2 A D^-1/2, by a solver for symmetric ones.
    root = np.sqrt(hears.sum(axis=1))
    wanted = np.linalg.eigvalsh(np.eye(size) - hears / root[:, None] / root[None, :])
    check_spectrum(size, hears.tolist(), wanted, rate, scale)


@pytest.mark.parametrize("seed", range(2))
def test_they_agree_on_the_mean_weighted_by_degrees(seed: int) -> None:
    """Row M: the left null vector of D^-1 L on an undirected graph is the vertices' degrees."""
    draw = np.random.default_rng([32, seed])
    size = 5
    hears = np.triu(draw.random((size, size)) < 0.5, 1) | (np.triu(np.roll(np.eye(size), 1, axis=1), 1) > 0)
    hears = (hears | hears.T).astype(float)
    degrees = hears.sum(axis=1)
    kept = response(size, hears.tolist(), 0.2, 1.0, 200.0, 0.5)
    assert np.abs(kept - degrees / degrees.sum()).max() < 1e-6
