"""Saturated consensus on the normalized graph Laplacian."""

from cardume.laws import Meters, MetersPerSecond, NotNegative, Positive
from cardume.maths import tanh
from cardume.onboard.coordination.base import coordination_law
from cardume.signals import Disagreement


@coordination_law
def laplacian_tanh(
    disagreement: Disagreement,
    gain: NotNegative[MetersPerSecond] = 0.15,
    length_scale: Positive[Meters] = 1.0,
) -> MetersPerSecond:
    """Slow down when ahead of the mean of those one hears, at most by the gain.

    v_i = v_L - k tanh((D^-1 L gamma)_i / gamma_0),   (D^-1 L gamma)_i = gamma_i - mean of neighbors

    L_D is the random-walk Laplacian I - D^-1 A; with D^-1/2 L D^-1/2 the equilibrium is no consensus.
    Stable in steps of dt while k dt / gamma_0 < 1 on any graph.

    Args:
        disagreement: of this vehicle [m], 0 when it hears nobody.
        gain: [m/s] k, the largest correction.
        length_scale: [m] gamma_0, where the correction begins to saturate.

    Returns:
        The correction -k tanh(...) [m/s].

    Source: paper eqs. (44), (45), matrix and length scale made definite.
    """
    return -gain * tanh(disagreement.disagreement / length_scale)
