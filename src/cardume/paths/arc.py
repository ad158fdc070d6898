"""A path that is one arc."""

from cardume.laws import Meters, Positive, Radians
from cardume.paths.segment import ReferencePath, Start, Turn, bend, chain


def arc(start: Start, radius: Positive[Meters], turn: Turn, angle: Positive[Radians]) -> ReferencePath:
    """An arc of a circle.

    Args:
        start: where it begins, and its course there.
        radius: [m] > 0.
        turn: starboard (clockwise seen from above) or port.
        angle: [rad] > 0 through which it turns; more than one lap is allowed.

    Returns:
        The reference path.
    """
    return chain(start, [bend(radius, turn, angle)])
