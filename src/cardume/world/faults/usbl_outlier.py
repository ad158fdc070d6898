"""USBL readings of an echo: from time to time a target is heard where it is not."""

from cardume.compiler import compiled, where
from cardume.maths import sincos_turns
from cardume.signals import Baseline


@compiled
def displaced(baseline: Baseline, size: float, happens: bool, turns: float) -> Baseline:
    """The baseline to where the echo seems to come from, level with the target.

    b' = b + d (cos a, sin a, 0),   a = 2 pi turns

    Args:
        baseline: to the target.
        size: [m] d.
        happens: [-] whether this reading is an outlier.
        turns: [-] uniform in (0, 1).
    """
    sine, cosine = sincos_turns(turns)
    beside = Baseline(baseline.ahead + size * cosine, baseline.starboard + size * sine, baseline.down)
    return where(happens, beside, baseline)
