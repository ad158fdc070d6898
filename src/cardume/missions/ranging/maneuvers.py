"""How a vehicle that measures ranges moves so that they tell more: about the predicted track of its target.

Circle, spiral and zig-zag have a shape; `steered` looks ahead and turns to where the information grows most.
All stay within the speed that the vehicle has.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from cardume.missions.ranging.information import log_determinant, mission_information

COURSES = 24  # that `steered` chooses among
HORIZON = 4  # legs that it looks ahead along each


class Choice(NamedTuple):
    """The maneuver that tells most, and what each tells."""

    name: str
    told: Mapping[str, float]  # [-] log det of the information of each that is not too fast


def circle(
    target: np.ndarray, times: np.ndarray, *, radius: float, speed_max: float, bearing: float = 0.0
) -> np.ndarray:
    """Around the target, clockwise seen from it, always at the same speed over ground.

    Args:
        target: (n, 2) [m] its predicted track, north and east.
        times: (n,) [s]
        radius: [m]
        speed_max: [m/s] over ground.
        bearing: [rad] at first, from the target.

    Returns:
        (n, 2) [m] the track of the source.

    Raises:
        ValueError: the target is as fast as the source.
    """
    return spiral(target, times, radius=radius, growth=0.0, speed_max=speed_max, bearing=bearing)


def spiral(
    target: np.ndarray, times: np.ndarray, *, radius: float, growth: float, speed_max: float, bearing: float = 0.0
) -> np.ndarray:
    """Around the target, farther with every turn, always at the same speed over ground.

    r' = g,   r theta' = -v . t + sqrt(U^2 - (v . l + g)^2)

    with v the target's velocity, l from it to the source, t across l, clockwise, and U the speed: with the target it
    goes round slowly, against it quickly, and it never has to stop.

    Args:
        target: (n, 2) [m]
        times: (n,) [s]
        radius: [m] r at first.
        growth: [m/s] g, >= 0.
        speed_max: [m/s] U.
        bearing: [rad] theta at first.

    Returns:
        (n, 2) [m]

    Raises:
        ValueError: the target is as fast as the source, or what is left is less than the growth.
    """
    spare = _spare(target, times, speed_max)
    if growth >= spare:
        raise ValueError(f"a radius that grows by {growth:g} m/s leaves nothing of {spare:g} m/s; let it grow slower")
    velocity, radii = np.gradient(target, times, axis=0), radius + growth * (times - times[0])

    def rate(angle: float, velocity: np.ndarray, radius: float) -> float:
        sine, cosine = math.sin(angle), math.cos(angle)
        out = float(velocity @ (cosine, sine)) + growth
        return (math.sqrt(speed_max**2 - out**2) - float(velocity @ (-sine, cosine))) / radius

    angles = [bearing]
    for k, step in enumerate(np.diff(times)):
        middle, between = 0.5 * (velocity[k] + velocity[k + 1]), 0.5 * (radii[k] + radii[k + 1])
        first = rate(angles[-1], velocity[k], radii[k])
        second = rate(angles[-1] + 0.5 * step * first, middle, between)
        third = rate(angles[-1] + 0.5 * step * second, middle, between)
        last = rate(angles[-1] + step * third, velocity[k + 1], radii[k + 1])
        angles.append(angles[-1] + step / 6.0 * (first + 2.0 * second + 2.0 * third + last))
    return np.asarray(target + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def zigzag(target: np.ndarray, times: np.ndarray, *, width: float, astern: float, speed_max: float) -> np.ndarray:
    """From side to side across the target's course, behind it.

    Args:
        target: (n, 2) [m]
        times: (n,) [s]
        width: [m] from one side to the other.
        astern: [m] how far behind.
        speed_max: [m/s] over ground.

    Returns:
        (n, 2) [m]

    Raises:
        ValueError: the target is as fast as the source.
    """
    _spare(target, times, speed_max)
    velocity = np.gradient(target, times, axis=0)
    speed = np.hypot(*velocity.T)
    ahead = velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    across = math.sqrt(speed_max**2 - float(speed.max()) ** 2)
    phase = (across * (times - times[0]) / width + 0.5) % 2.0
    place = width * (np.abs(phase - 1.0) - 0.5)
    return np.asarray(target - astern * ahead + place[:, None] * aside)


def steered(
    target: np.ndarray,
    times: np.ndarray,
    *,
    start: np.ndarray,
    speed_max: float,
    sigma: float,
    prior: np.ndarray,
    leg: int = 10,
    nearest: float = 10.0,
    farthest: float = 200.0,
) -> np.ndarray:
    """Leg by leg on the course along which the information at the horizon is largest: max log det.

    Args:
        target: (n, 2) [m] predicted.
        times: (n,) [s] of ranges.
        start: (2,) [m] of the source.
        speed_max: [m/s] over ground.
        sigma: [m] of each range.
        prior: (4, 4) information of position and current before the first.
        leg: [-] ranges on each leg.
        nearest: [m] to the predicted target.
        farthest: [m]

    Returns:
        (n, 2) [m]
    """
    track = [np.asarray(start, float)]
    courses = 2.0 * np.pi * np.arange(COURSES) / COURSES
    ways = np.stack([np.cos(courses), np.sin(courses)], axis=1)
    while len(track) < len(times):
        first, last = len(track) - 1, min(len(track) + leg - 1, len(times) - 1)
        horizon = min(len(track) + HORIZON * leg - 1, len(times) - 1)
        before = times[: horizon + 1]
        best, best_told = track[-1] + 0.0 * times[first + 1 : last + 1, None], -math.inf
        for way in (*ways, np.zeros(2)):
            ahead = track[-1] + speed_max * (times[first + 1 : horizon + 1] - times[first])[:, None] * way
            apart = np.hypot(*(target[first + 1 : horizon + 1] - ahead).T)
            if apart.min() < nearest or apart.max() > farthest:
                continue
            offsets = target[: horizon + 1] - np.vstack([*track, ahead])
            told = log_determinant(mission_information(before, offsets, sigma, prior))
            if told > best_told:
                best, best_told = ahead[: last - first], told
        track.extend(best)
    return np.array(track)


def best_of(
    maneuvers: Mapping[str, np.ndarray],
    target: np.ndarray,
    times: np.ndarray,
    *,
    sigma: float,
    speed_max: float,
    prior: np.ndarray | None = None,
) -> Choice:
    """The maneuver with the largest log det of the information at its end, of those that are not too fast.

    Args:
        maneuvers: by name, (n, 2) [m] tracks of the source.
        target: (n, 2) [m] predicted.
        times: (n,) [s] of ranges.
        sigma: [m] of each range.
        speed_max: [m/s] over ground.
        prior: (4, 4) information of position and current before the first; None: none.

    Raises:
        ValueError: all are too fast.
    """
    told = {
        name: log_determinant(mission_information(times, target - track, sigma, prior))
        for name, track in maneuvers.items()
        if fastest(track, times) <= 1.001 * speed_max
    }
    if not told:
        raise ValueError(
            f"all of {', '.join(maneuvers)} are faster than {speed_max:g} m/s; make them slower or smaller"
        )
    return Choice(max(told, key=lambda name: told[name]), told)


def fastest(track: np.ndarray, times: np.ndarray) -> float:
    """Largest speed [m/s] along a track.

    Args:
        track: (n, 2) [m]
        times: (n,) [s]
    """
    return float((np.hypot(*np.diff(track, axis=0).T) / np.diff(times)).max())


def _spare(target: np.ndarray, times: np.ndarray, speed_max: float) -> float:
    """What is left [m/s] of a speed beside the target's."""
    spare = speed_max - fastest(target, times)
    if spare <= 0.0:
        raise ValueError(
            f"the target goes at {speed_max - spare:.3g} m/s, the source at most at {speed_max:g} m/s;"
            " make the source faster or the target slower"
        )
    return spare
