"""Faults: one row each, that says what goes wrong with whom from when to when, and by how much.

A kind that has a behavior of its own has its own file.  What a fault does reaches the laws aboard through what is
measured and heard, and nothing else.  The kinds of a mission file are made of these: a lost vehicle is LOST and
SILENT, a GNSS that is lost is BLANK.
"""

from typing import NamedTuple

from cardume.compiler import compiled
from cardume.maths import floor

SILENT, FROZEN, BLANK, BIASED, OUTLIER, WEAK, LOST, STIRRED, FORGED, REPLAYED, CLOCK = range(11)
NEARLY = 1e-6  # of a period: rounding of times


class Fault(NamedTuple):
    """What a row says; what its kind does not need is 0."""

    begin: float = 0.0  # [s] a whole number of ticks
    end: float = 0.0  # [s]
    size: float = 0.0  # [any] of a bias, jump, step or offset
    more: float = 0.0  # [any] its second number: bias of the east, of an azimuth; drift of a clock
    chance: float = 0.0  # [-] that a reading is an outlier; that a packet is taken for genuine
    period: float = 1.0  # [s] between packets


class Kept(NamedTuple):
    """What a fault remembers: the position that a GNSS has frozen at, or packets sent and packets taken."""

    first: float = 0.0  # [any]
    second: float = 0.0  # [any]


@compiled
def is_active(fault: Fault, time: float) -> bool:
    """Whether a fault is there at a time [s]."""
    return (fault.begin <= time) & (time < fault.end)


@compiled
def beats(fault: Fault, time: float, tick: float) -> bool:
    """Whether a fault that comes again and again is due in this tick: at its beginning, and then every period.

    Args:
        fault: with its period.
        time: [s] now.
        tick: [s]
    """
    since = time - fault.begin + NEARLY
    is_due = floor(since / fault.period) > floor((since - tick) / fault.period)
    return is_due & is_active(fault, time)
