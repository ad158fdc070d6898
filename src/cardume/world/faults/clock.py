"""A clock that is set wrong, or that runs too fast or too slow."""

from cardume.compiler import compiled


@compiled
def shifted(time: float, begin: float, offset: float, drift: float) -> float:
    """What a clock with this fault says [s].

    t_own = t + offset + drift (t - t_begin)

    Args:
        time: [s] true.
        begin: [s] since when.
        offset: [s] > 0 is ahead of time.
        drift: [-] > 0 is too fast; 1e-6 is a good quartz, 1e-4 a bad one.
    """
    return time + (offset + drift * (time - begin))
