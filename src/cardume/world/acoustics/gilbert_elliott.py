"""Outages: a link that is there or not, for some time each."""

from cardume.compiler import compiled, where
from cardume.maths import exp


@compiled
def is_out(was_out: float, elapsed: float, share: float, burst: float, draw: float) -> float:
    """Whether a link is out [-], 1 or 0, some time after it was seen to be so or not.

    P(out at t + s | state at t) = L + (state - L) exp(-s / T),   T = B (1 - L)

    A Markov chain of two states in continuous time, left out after B on average and entered so that it is out for a
    share L of the time.  The step is exact over any time, so neither tick nor traffic changes the link; it is drawn
    only when something is sent.  Messages at intervals s are lost in runs of 1 / ((1 - L) (1 - exp(-s / T))), the mean.

    Args:
        was_out: [-] 1 when it was out.
        elapsed: [s] s, since then; very long ago: it is forgotten.
        share: [-] L, of the time that it is out.
        burst: [s] B, mean length of an outage; 0: each message is lost by itself.
        draw: [-] uniform in (0, 1).

    Source: Gilbert (1960), Capacity of a burst-noise channel, with its chain in continuous time; nothing is lost in
        the good state and everything in the bad one.
    """
    memory = burst * (1.0 - share)
    kept = where(memory > 0.0, exp(-elapsed / where(memory > 0.0, memory, 1.0)), 0.0)
    return where(draw < share + (was_out - share) * kept, 1.0, 0.0)
