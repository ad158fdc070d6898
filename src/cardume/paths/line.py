"""A straight path."""

from cardume.laws import Meters, Positive
from cardume.paths.segment import ReferencePath, Start, chain, straight


def line(start: Start, length: Positive[Meters]) -> ReferencePath:
    """A straight line.

    Args:
        start: where it begins, and its course.
        length: [m] > 0.

    Returns:
        The reference path.
    """
    return chain(start, [straight(length)])
