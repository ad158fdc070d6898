"""A first-order Gauss-Markov process, the simplest noise that remembers."""

from cardume.compiler import compiled, where
from cardume.maths import exp, sqrt

__all__ = ["gauss_markov"]


@compiled
def gauss_markov(
    value: float, started: float, elapsed: float, draw: float, sigma: float, time_constant: float
) -> float:
    """The next value of a stationary process whose memory fades with a time constant.

    x' = a x + sigma sqrt(1 - a^2) n,   a = exp(-elapsed / T),   and x = sigma n the first time

    This is the exact solution of dx = -x / T dt + sigma sqrt(2 / T) dW, so the steps need not be equal, and their
    length changes neither the variance sigma^2 nor the autocorrelation exp(-|lag| / T).

    Args:
        value: [any] x, what this function returned the time before.
        started: [-] 0 the first time, 1 from then on.
        elapsed: [s] since the time before; not used the first time.
        draw: [-] n, standard normal and new each time.
        sigma: [any] standard deviation in the unit of the value; 0 gives exactly 0.
        time_constant: [s] T > 0.

    Returns:
        The next value, in the unit of sigma.
    """
    decay = where(started > 0.5, exp(-elapsed / time_constant), 0.0)
    return decay * value + sigma * sqrt(1.0 - decay * decay) * draw
