"""A memory of the last values of a signal: the one thing that a law edits in place."""

from cardume.compiler import Rows, compiled, gather, scatter
from cardume.maths.elementary import floor


@compiled
def push(history: Rows, size: int, tick: float, value: float) -> None:
    """Remember the value of this tick, in place of the oldest.

    Args:
        history: (size,) rows.
        size: [-] how many values are remembered.
        tick: [-] a whole number that grows by one each time.
        value: [any] what to remember.
    """
    scatter(history, tick - size * floor(tick / size), True, value)


@compiled
def recall(history: Rows, size: int, tick: float) -> float:
    """The value at a past tick, between two of them the straight line.

    Args:
        history: (size,) rows.
        size: [-] how many values are remembered.
        tick: [-] from the newest tick back to size - 1 before it.

    Returns:
        The value then [any].
    """
    before = floor(tick)
    share = tick - before
    first = gather(history, before - size * floor(before / size))
    after = before + 1.0
    second = gather(history, after - size * floor(after / size))
    return first + share * (second - first)
