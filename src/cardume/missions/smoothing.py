"""Where a vehicle was, by all fixes before and after: for records and reports, not for flying.

The model is that of `kalman_replay` with speed and heading as measured: position p and current c,

    p' = V_m + c + white(q_v),   c' = white(q_c),   z = p + noise(R)

filtered forwards, then smoothed backwards (Rauch, Tung and Striebel).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Seen(NamedTuple):
    """A fix of a record."""

    row: int  # [-] at which of the times it was valid
    position: np.ndarray  # (2,) [m] north, east
    covariance: np.ndarray  # (2, 2) [m^2]


class Doubt(NamedTuple):
    """What is thought of the noise, as the parameters of `kalman_replay`."""

    velocity_noise: float = 3e-3  # [m^2/s]
    current_noise: float = 1e-6  # [m^2/s^3]
    initial_sigma: float = 10.0  # [m]
    current_sigma: float = 0.3  # [m/s]


class Track(NamedTuple):
    """Position and current with their covariance, at every time."""

    means: np.ndarray  # (n, 4) [m], [m/s] north, east, and of the current
    covariances: np.ndarray  # (n, 4, 4)


class _Step(NamedTuple):
    transition: np.ndarray
    before: np.ndarray
    covariance_before: np.ndarray


def smooth(
    times: np.ndarray,
    way: np.ndarray,
    fixes: Sequence[Seen],
    *,
    start: np.ndarray,
    doubt: Doubt,
    lag: int | None = None,
) -> Track:
    """Smooth a record.

    Args:
        times: (n,) [s] increasing.
        way: (n, 2) [m] made through the water since the first of them, as measured.
        fixes: in any order.
        start: (2,) [m] where the vehicle was thought to be at first.
        doubt: of the noise.
        lag: [-] only fixes up to so many rows later are used for each row (a fixed-lag smoother, as one that sends or
            draws its estimates late would run it); None: all.

    Returns:
        The track; with a lag of 0 the filter's own.

    Raises:
        ValueError: times that do not increase, or tables of different lengths.

    Source: Rauch, Tung & Striebel (1965): x_s = x + G (x_s+ - x-), P_s = P + G (P_s+ - P-) G', G = P F' (P-)^-1.
    """
    if len(times) != len(way) or len(times) < 1 or np.any(np.diff(times) <= 0.0):
        raise ValueError("times must increase, one for each row of the way; sort the record and drop what repeats")
    filtered, steps = _filter(times, way, fixes, start, doubt)
    if lag is None:
        return _backwards(filtered, steps, len(times) - 1, 0)
    found = [_backwards(filtered, steps, min(row + lag, len(times) - 1), row) for row in range(len(times))]
    return Track(np.array([t.means[0] for t in found]), np.array([t.covariances[0] for t in found]))


def transition(dt: float, doubt: Doubt) -> tuple[np.ndarray, np.ndarray]:
    """F and Q (4, 4) over a time [s]; blocks of two for the two axes.

    Args:
        dt: [s]
        doubt: of the noise.
    """
    f, q = np.array([[1.0, dt], [0.0, 1.0]]), doubt.current_noise * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    q[0, 0] += doubt.velocity_noise * dt
    return np.kron(f, np.eye(2)), np.kron(q, np.eye(2))


def _filter(
    times: np.ndarray, way: np.ndarray, fixes: Sequence[Seen], start: np.ndarray, doubt: Doubt
) -> tuple[Track, list[_Step]]:
    by_row: dict[int, list[Seen]] = {}
    for fix in fixes:
        by_row.setdefault(fix.row, []).append(fix)
    mean = np.concatenate([np.asarray(start, float), [0.0, 0.0]])
    covariance = np.diag([doubt.initial_sigma**2] * 2 + [doubt.current_sigma**2] * 2)
    means, covariances, steps = [], [], list[_Step]()
    for row in range(len(times)):
        if row:
            f, q = transition(times[row] - times[row - 1], doubt)
            mean = f @ mean + np.concatenate([way[row] - way[row - 1], [0.0, 0.0]])
            covariance = f @ covariance @ f.T + q
            steps.append(_Step(f, mean, covariance))
        for fix in by_row.get(row, ()):
            innovation = covariance[:2, :2] + fix.covariance
            gain = np.linalg.solve(innovation, covariance[:2]).T
            mean = mean + gain @ (fix.position - mean[:2])
            covariance = covariance - gain @ innovation @ gain.T
        means.append(mean)
        covariances.append(covariance)
    return Track(np.array(means), np.array(covariances)), steps


def _backwards(filtered: Track, steps: Sequence[_Step], last: int, first: int) -> Track:
    means, covariances = [filtered.means[last]], [filtered.covariances[last]]
    for row in range(last - 1, first - 1, -1):
        step, covariance = steps[row], filtered.covariances[row]
        gain = np.linalg.solve(step.covariance_before, step.transition @ covariance).T
        means.append(filtered.means[row] + gain @ (means[-1] - step.before))
        covariances.append(covariance + gain @ (covariances[-1] - step.covariance_before) @ gain.T)
    return Track(np.array(means[::-1]), np.array(covariances[::-1]))
