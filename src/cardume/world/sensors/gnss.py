"""Position by satellite: white noise, errors that drift, and nothing under water."""

from typing import NamedTuple

from cardume.compiler import some, where
from cardume.laws import Meters, NotNegative, Positive, Seconds
from cardume.maths.gauss_markov import gauss_markov
from cardume.signals import NOTHING, GnssReading, Noise, Sampling, VesselState
from cardume.world.sensors.base import gnss_sensor


class Drift(NamedTuple):
    """The part of the error that the last fix had too."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    started: float = 0.0  # [-] 0 before the first fix


@gnss_sensor(period=1.0)
def gnss(
    truth: VesselState,
    noise: Noise,
    sampling: Sampling,
    memory: Drift,
    sigma: NotNegative[Meters] = 0.5,
    correlated_sigma: NotNegative[Meters] = 0.0,
    correlation_time: Positive[Seconds] = 100.0,
    deepest: NotNegative[Meters] = 0.2,
) -> tuple[GnssReading, Drift]:
    """True position plus an error that is white and, if wanted, one that changes slowly; NaN below `deepest`.

    reading = truth + sigma n + x,   x first-order Gauss-Markov, <x(t) x(t + s)> = correlated_sigma^2 exp(-|s| / T)

    All sigmas are per axis: the distance from the truth is sqrt(2) sigma RMS.  0.5 m is our value for a differential
    fix (NMEA quality 2); others of ours are 2 m for a plain one, 0.02 m and 0.3 m for a fixed and a floating RTK
    solution.  The slow part goes on changing under water.

    Args:
        truth: where the antenna is; at depth 0 it is above the water.
        noise: a and b make the white part, c and d drive the slow one.
        sampling: time since the last fix.
        memory: the slow part of the last fix.
        sigma: [m] standard deviation of the white part, in each of north and east.
        correlated_sigma: [m] standard deviation of the slow part, in each of north and east.
        correlation_time: [s] T; 60 to 300 s is usual.
        deepest: [m] depth below which there is no fix.

    Returns:
        Position [m], exactly the truth when both sigmas are 0, and the next memory.

    Source: no fix below 0.2 m as in LSTS DUNE, Simulators/GPS, "Activation Depth"; the process is derived in
    `gauss_markov`.
    """
    north, east = memory.north, memory.east
    if some(correlated_sigma > 0.0):
        north = gauss_markov(north, memory.started, sampling.elapsed, noise.c, correlated_sigma, correlation_time)
        east = gauss_markov(east, memory.started, sampling.elapsed, noise.d, correlated_sigma, correlation_time)
    in_sight = truth.depth <= deepest
    reading = GnssReading(
        where(in_sight, truth.north + north + sigma * noise.a, NOTHING),
        where(in_sight, truth.east + east + sigma * noise.b, NOTHING),
    )
    return reading, Drift(north, east, 1.0)
