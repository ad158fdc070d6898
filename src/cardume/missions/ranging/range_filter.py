"""Position from ranges and dead reckoning over recorded data: a bank of extended Kalman filters.

    p' = (1 + s) R(b) d + c dt,   z = (1 + k) |p - p_s| + o

d is the way measured in the vehicle's own axes of dead reckoning, b how far these are turned to starboard
of north, s the scale error of the way, c a current, k and o scale and bias of the ranges.  Where the vehicle
is or how its axes are turned may be unknown: many filters start in different places and directions,
and those that the ranges contradict are left behind.
"""

from typing import NamedTuple

import numpy as np

NORTH, EAST, CURRENT_NORTH, CURRENT_EAST, TURN, WAY_SCALE, RANGE_SCALE, RANGE_BIAS, SIZE = range(9)
FORGOTTEN = 1e-6  # share of the likelihood below which a filter is left behind
NEAREST = 0.01  # [m] a source nearer than this has no direction
MOST_LIKELY = 1  # filter at least that goes on


class Doubt(NamedTuple):
    """How uncertain everything is at first, standard deviations, and how it changes; 0: known, constant."""

    position: float = 1.0  # [m] per axis
    current: float = 0.0  # [m/s] per axis
    turn: float = 0.1  # [rad]
    way_scale: float = 0.0  # [-]
    range_scale: float = 0.0  # [-]
    range_bias: float = 0.0  # [m]
    range: float = 0.5  # [m] of each range
    way: float = 0.05  # [m] per square root of a meter made
    heading: float = 0.01  # [rad] per square root of a second
    current_change: float = 0.0  # [m/s] per square root of a second
    calibration: float = 0.0  # [-] of range scale, and [m] of its bias, per square root of a second
    gate: float = 16.0  # [-] largest believable squared innovation over its variance
    outlier: float = 1e-3  # [-] share of ranges that are thought to be wrong, for the likelihood of a filter


class RangeFilter:
    """A bank of filters over one record.

    Attributes:
        means: (m, SIZE) state of each filter: [m], [m/s], [rad], [-], [m].
        covariances: (m, SIZE, SIZE)
        weights: (m,) [-] their likelihoods, summing to 1.
    """

    def __init__(self, means: np.ndarray, spread: np.ndarray, doubt: Doubt) -> None:
        self.means = np.atleast_2d(np.asarray(means, float)).copy()
        self.covariances = np.tile(spread, (len(self.means), 1, 1)).astype(float)
        self.weights = np.full(len(self.means), 1.0 / len(self.means))
        self.doubt = doubt

    @property
    def mean(self) -> np.ndarray:
        """(SIZE,) state of the likeliest filter."""
        return np.asarray(self.means[np.argmax(self.weights)])

    @property
    def covariance(self) -> np.ndarray:
        """(SIZE, SIZE) of the likeliest filter."""
        return np.asarray(self.covariances[np.argmax(self.weights)])

    @property
    def spread(self) -> float:
        """RMS distance [m] of all filters' positions, by their weights, from their mean, and of each from its own."""
        places = self.means[:, :2]
        center = self.weights @ places
        own = self.covariances[:, NORTH, NORTH] + self.covariances[:, EAST, EAST]
        return float(np.sqrt(self.weights @ (np.sum((places - center) ** 2, axis=1) + own)))

    def move(self, ahead: float, aside: float, dt: float) -> None:
        """Dead reckoning over a step.

        Args:
            ahead: [m] way in the axes of dead reckoning, along their north.
            aside: [m] and along their east.
            dt: [s]
        """
        doubt, x = self.doubt, self.means
        sine, cosine, scale = np.sin(x[:, TURN]), np.cos(x[:, TURN]), 1.0 + x[:, WAY_SCALE]
        north, east = cosine * ahead - sine * aside, sine * ahead + cosine * aside
        f = np.tile(np.eye(SIZE), (len(x), 1, 1))
        f[:, NORTH, CURRENT_NORTH] = f[:, EAST, CURRENT_EAST] = dt
        f[:, NORTH, TURN], f[:, EAST, TURN] = -scale * east, scale * north
        f[:, NORTH, WAY_SCALE], f[:, EAST, WAY_SCALE] = north, east
        x[:, NORTH] += scale * north + dt * x[:, CURRENT_NORTH]
        x[:, EAST] += scale * east + dt * x[:, CURRENT_EAST]
        of_way = doubt.way**2 * np.hypot(ahead, aside)
        of_calibration = doubt.calibration**2 * dt
        noise = np.zeros(SIZE)
        noise[[NORTH, EAST]] = of_way
        noise[[CURRENT_NORTH, CURRENT_EAST]] = doubt.current_change**2 * dt
        noise[TURN] = doubt.heading**2 * dt
        noise[RANGE_SCALE] = of_calibration if doubt.range_scale else 0.0
        noise[RANGE_BIAS] = of_calibration if doubt.range_bias else 0.0
        self.covariances = f @ self.covariances @ f.transpose(0, 2, 1) + np.diag(noise)

    def hear(self, measured: float, north: float, east: float) -> None:
        """Work a range in, and weigh the filters by how they expected it.

        Args:
            measured: [m] level range.
            north: [m] of the source.
            east: [m]

        Source: the extended Kalman filter; likelihoods as in a Gaussian sum filter, with a floor for outliers.
        """
        if not np.isfinite(measured):
            return
        x, p = self.means, self.covariances
        apart_north, apart_east = x[:, NORTH] - north, x[:, EAST] - east
        distance = np.maximum(np.hypot(apart_north, apart_east), NEAREST)
        scale = 1.0 + x[:, RANGE_SCALE]
        h = np.zeros_like(x)
        h[:, NORTH], h[:, EAST] = scale * apart_north / distance, scale * apart_east / distance
        h[:, RANGE_SCALE], h[:, RANGE_BIAS] = distance, 1.0
        aside = np.stack([-h[:, EAST], h[:, NORTH]], axis=1) / scale[:, None]
        bend = np.einsum("mi,mij,mj->m", aside, p[:, :2, :2], aside) / (2.0 * distance)
        cross = np.einsum("mij,mj->mi", p, h)
        variance = np.einsum("mi,mi->m", h, cross) + self.doubt.range**2 + 2.0 * bend**2
        odd = measured - scale * distance - x[:, RANGE_BIAS] - bend
        believed = odd**2 <= self.doubt.gate * variance
        gain = np.where(believed[:, None], cross / variance[:, None], 0.0)
        self.means = x + gain * odd[:, None]
        self.covariances = p - gain[:, :, None] * cross[:, None, :]
        likelihood = np.exp(-0.5 * odd**2 / variance) / np.sqrt(variance) + self.doubt.outlier
        self.weights = self.weights * likelihood
        self.weights /= self.weights.sum()
        self._leave_behind()

    def _leave_behind(self) -> None:
        if len(self.weights) > MOST_LIKELY:
            kept = self.weights > FORGOTTEN * self.weights.max()
            self.means, self.covariances = self.means[kept], self.covariances[kept]
            self.weights = self.weights[kept] / self.weights[kept].sum()


def known_start(north: float, east: float, turn: float, doubt: Doubt) -> RangeFilter:
    """One filter, of a vehicle that knows where it starts.

    Args:
        north: [m]
        east: [m]
        turn: [rad] of its axes of dead reckoning, to starboard of north.
        doubt: of all that.
    """
    mean = np.zeros(SIZE)
    mean[[NORTH, EAST, TURN]] = north, east, turn
    return RangeFilter(mean, _first_spread(doubt), doubt)


def unknown_start(
    measured: float, north: float, east: float, doubt: Doubt, bearings: int = 48, turns: int = 24
) -> RangeFilter:
    """Many filters around the source of a first range: as many directions from it as wanted, and as many of the axes.

    A vehicle with a compass needs one turn only; the mirror images that a source on a straight line cannot tell
    apart are among them, and stay until the line bends.

    Args:
        measured: [m] level range.
        north: [m] of the source.
        east: [m]
        doubt: of everything else; that of the position becomes what half of the distance between two filters is.
        bearings: [-] directions in which the vehicle may be.
        turns: [-] of its axes of dead reckoning; 1: these are known to be north.
    """
    spread = _first_spread(doubt)
    around = 2.0 * np.pi * np.arange(bearings) / bearings
    turned = 2.0 * np.pi * np.arange(turns) / turns
    means = np.zeros((bearings * turns, SIZE))
    means[:, NORTH] = np.repeat(north + measured * np.cos(around), turns)
    means[:, EAST] = np.repeat(east + measured * np.sin(around), turns)
    means[:, TURN] = np.tile(turned, bearings)
    apart = np.pi * measured / bearings
    spread[NORTH, NORTH] = spread[EAST, EAST] = max(apart, doubt.range) ** 2
    if turns > 1:
        spread[TURN, TURN] = (np.pi / turns) ** 2
    return RangeFilter(means, spread, doubt)


def _first_spread(doubt: Doubt) -> np.ndarray:
    sigmas = np.zeros(SIZE)
    sigmas[[NORTH, EAST]], sigmas[[CURRENT_NORTH, CURRENT_EAST]] = doubt.position, doubt.current
    sigmas[[TURN, WAY_SCALE, RANGE_SCALE, RANGE_BIAS]] = (
        doubt.turn,
        doubt.way_scale,
        doubt.range_scale,
        doubt.range_bias,
    )
    return np.diag(sigmas**2)
