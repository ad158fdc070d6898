"""Which maneuver tells most: circles and zig-zags of many sizes, by the information that their ranges leave."""

from typing import NamedTuple

import numpy as np

from cardume.missions.ranging.information import log_determinants_along
from cardume.missions.ranging.maneuvers import circle, zigzag

SIZES = 13  # circles, and zig-zags, from the nearest to the farthest


class Knowledge(NamedTuple):
    """What is known of those below, and how well a range is measured."""

    sigma: float  # [m] of each slant range, the error of the source's own place among it
    below: float  # [m] how much deeper they are
    position_sigma: float = 10.0  # [m] at first, per axis
    current_sigma: float = 0.3  # [m/s] at first, per axis
    velocity_noise: float = 3e-3  # [m^2/s] q_v
    current_noise: float = 1e-6  # [m^2/s^3] q_c


class Chosen(NamedTuple):
    """A maneuver and what it tells."""

    name: str  # of its kind
    size: float  # [m] radius of a circle, width of a zig-zag
    track: np.ndarray  # (n, 2) [m]
    told: float  # [-] log det of the information, the mean over the mission


def most_telling(
    target: np.ndarray,
    times: np.ndarray,
    *,
    speed_max: float,
    known: Knowledge,
    nearest: float,
    farthest: float,
) -> Chosen:
    """The maneuver with the largest log det of the information, on average over the mission.

    Args:
        target: (n, 2) [m] predicted track, north and east.
        times: (n,) [s] of the ranges.
        speed_max: [m/s] over ground.
        known: of the target.
        nearest: [m] that the source may come to it, in plan.
        farthest: [m] that it may go from it.

    Raises:
        ValueError: the target is as fast as the source.
    """
    sizes = np.geomspace(nearest, farthest, SIZES)
    made = [("circle", size, circle(target, times, radius=size, speed_max=speed_max)) for size in sizes]
    # Behind by half of its width, a zig-zag passes no nearer than that and goes no farther than sqrt(2) times as far.
    made += [
        ("zigzag", 2.0 * size, zigzag(target, times, width=2.0 * size, astern=size, speed_max=speed_max))
        for size in sizes
        if np.sqrt(2.0) * size <= farthest
    ]
    told = log_determinants_along(
        times,
        np.stack([target - track for _, _, track in made]),
        known.sigma,
        np.diag([known.position_sigma**2] * 2 + [known.current_sigma**2] * 2),
        velocity_noise=known.velocity_noise,
        current_noise=known.current_noise,
        below=known.below,
    ).mean(axis=-1)
    best = int(np.argmax(told))
    name, size, track = made[best]
    return Chosen(name, float(size), track, float(told[best]))
