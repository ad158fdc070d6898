"""Coordination laws with another sign, another matrix or no saturation."""

from typing import NamedTuple

from cardume.laws import Meters, MetersPerSecond, Number, PerSecond, Positive, Seconds
from cardume.maths import tanh
from cardume.onboard.coordination import coordination_law
from cardume.signals import Disagreement


class Elapsed(NamedTuple):
    """Since the start of the mission."""

    time: float = 0.0


@coordination_law
def plus_sign(
    disagreement: Disagreement, gain: MetersPerSecond = 0.15, length_scale: Positive[Meters] = 1.0
) -> MetersPerSecond:
    """v_i = v_L + k tanh((D^-1 L gamma)_i / gamma_0).   Source: paper eqs. (44), (45), the other sign."""
    return gain * tanh(disagreement.disagreement / length_scale)


@coordination_law
def symmetric(
    disagreement: Disagreement,
    memory: Elapsed,
    dt: Seconds,
    gain: MetersPerSecond = 0.15,
    root: Positive[Number] = 1.0,
    speed: MetersPerSecond = 0.5,
) -> tuple[MetersPerSecond, Elapsed]:
    """v_i = v_L - k tanh((D^-1/2 L D^-1/2 gamma)_i), where all whom i hears have the same degree d_j.

    (D^-1/2 A D^-1/2 gamma)_i = sum_j gamma_j / sqrt(d_i d_j) = sqrt(d_i / d_j) times the mean of the gamma_j, and
    root = sqrt(d_i / d_j).  Its null vector is not 1, so gamma is counted in the frame that moves with v_L = speed.

    Source: paper eq. (45), the other reading of its matrix.
    """
    moved = speed * memory.time
    apart = (disagreement.state - moved) - root * (disagreement.mean_of_neighbors - moved)
    return -gain * tanh(apart), Elapsed(memory.time + dt)


@coordination_law
def linear(disagreement: Disagreement, gain: PerSecond = 0.1) -> MetersPerSecond:
    """v_i = v_L - k (D^-1 L gamma)_i.   Source: paper eq. (44) without its tanh."""
    return -gain * disagreement.disagreement
