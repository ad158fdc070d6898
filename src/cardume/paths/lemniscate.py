"""A lemniscate of Bernoulli: a figure of eight, flown for any number of laps."""

import math

import numpy as np

from cardume.laws import Meters, PerSecond, Positive, Radians
from cardume.paths.circle import Center
from cardume.paths.segment import ReferencePath, Turn, positive, sense
from cardume.paths.tracing import Trace, laps_of, trace

PIECES = 24  # of a lap, before any is halved


def lemniscate(
    center: Center,
    half_width: Positive[Meters],
    axis: Radians = 0.0,
    turn: Turn = "starboard",
    *,
    start_parameter: Radians = 0.0,
    parameter_rate: PerSecond | None = None,
    laps: int = 1,
) -> ReferencePath:
    """A lemniscate, from one of its points round to the same.

    x = a cos t / (1 + sin^2 t),   y = a sin t cos t / (1 + sin^2 t)

    x along the axis, y to starboard of it; c = 3 cos t / (a sqrt(1 + sin^2 t)), 3 / a at both tips and 0
    at the crossing.  A rate k of the parameter is a speed that changes along the path,
    v_L = k |dp/dt| = k a / sqrt(1 + sin^2 t).

    Args:
        center: of the crossing.
        half_width: [m] a > 0, from the crossing to a tip.
        axis: [rad] course from the crossing to the first tip, where t = 0.
        turn: starboard or port, round the first tip.
        start_parameter: [rad] t where the path begins.
        parameter_rate: [1/s] k > 0; None: the formation's speed.
        laps: [-] how many times round.

    Returns:
        The reference path.

    Raises:
        GeometryError: a number that is not positive, or too many laps.

    Source: Hung et al., "A review of path following control strategies for autonomous robotic vehicles",
    J. Field Robotics (2022), section 5, `path_eq.m` of its toolbox; curvature from `paths.m`.
    """
    a = positive("half_width", half_width)
    side = sense(turn)
    rate = None if parameter_rate is None else positive("parameter_rate", parameter_rate, "1/s")
    along, across = np.array([math.cos(axis), math.sin(axis)]), side * np.array([-math.sin(axis), math.cos(axis)])

    def in_plane(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return x[:, None] * along + y[:, None] * across

    def point(t: np.ndarray) -> np.ndarray:
        share = a * np.cos(t) / (1.0 + np.sin(t) ** 2)
        return np.array(center) + in_plane(share, share * np.sin(t))

    def derivative(t: np.ndarray) -> np.ndarray:
        squared = np.sin(t) ** 2
        scale = a / (1.0 + squared) ** 2
        return in_plane(scale * np.sin(t) * (squared - 3.0), scale * (1.0 - 3.0 * squared))

    def speed(t: np.ndarray) -> np.ndarray:
        return (rate or 0.0) * a / np.sqrt(1.0 + np.sin(t) ** 2)

    ends = start_parameter + 2.0 * math.pi * np.arange(PIECES + 1) / PIECES
    eight = Trace(point=point, derivative=derivative, speed=speed if rate else None, label="lemniscate")
    return laps_of(trace(eight, [float(t) for t in ends]), laps)
