"""The parts of a way on which (37) holds: steady shaft speed, no turn.

While a vehicle speeds up its thrust runs ahead of its speed, and in a turn it drifts sideways; the relation of shaft
speed and speed that is wanted is that of steady ways.
"""

import math

import numpy as np

from cardume.missions.calibration.track import Track

WINDOW = 10.0  # [s] over which steadiness is judged
MOST_TURN = math.radians(1.5)  # [rad/s] noisy fixes make a heading wander by 1 deg/s; an arc of 12 m at 0.5 m/s is 2.4
MOST_CHANGE = 0.1  # [-] of the mean shaft speed from one half of the window to the other
SLOWEST = 0.05  # of the fastest shaft speed of the track: slower counts as standing
SETTLING = 5.0  # [s] left out after a change
SHORTEST = 15.0  # [s]
LONGEST_GAP = 5.0  # [-] of the usual time between rows; a longer one ends a leg


def legs_of(track: Track) -> list[Track]:
    """The steady parts, in order.

    Args:
        track: with finite rows, by increasing time.
    """
    time, steady = track.time, _is_steady(track)
    ends = np.flatnonzero(np.diff(time) > LONGEST_GAP * np.median(np.diff(time))) + 1
    begins_new = np.zeros(len(time), bool)
    begins_new[ends] = True
    legs, start = [], None
    for k in range(len(time) + 1):
        goes_on = k < len(time) and steady[k] and not (begins_new[k] and start is not None)
        if goes_on and start is None:
            start = k
        elif not goes_on and start is not None:
            legs.append((start, k))
            start = k if k < len(time) and steady[k] else None
    settled = [(int(np.searchsorted(time, time[first] + SETTLING)), last) for first, last in legs]
    return [
        track.part(slice(first, last))
        for first, last in settled
        if last - first >= 3 and time[last - 1] - time[first] >= SHORTEST
    ]


def _is_steady(track: Track) -> np.ndarray:
    shaft = track.shaft_speed
    before, after = _half_means(track.time, shaft)
    typical = np.maximum(np.abs(before + after) / 2.0, 1e-12)
    steady = np.abs(after - before) <= MOST_CHANGE * typical
    steady &= np.abs(shaft) > SLOWEST * np.abs(shaft).max()
    if track.heading is not None:
        before, after = _half_means(track.time, np.unwrap(track.heading))
        steady &= np.abs(after - before) <= MOST_TURN * WINDOW / 2.0
    return np.asarray(steady)


def _half_means(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means over half a window before and after each time; at the ends over what there is."""
    summed = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time))])
    back, ahead = np.maximum(time - WINDOW / 2.0, time[0]), np.minimum(time + WINDOW / 2.0, time[-1])
    at_back, at_ahead = np.interp(back, time, summed), np.interp(ahead, time, summed)
    before = np.where(time > back, (summed - at_back) / np.maximum(time - back, 1e-12), values)
    after = np.where(ahead > time, (at_ahead - summed) / np.maximum(ahead - time, 1e-12), values)
    return before, after
