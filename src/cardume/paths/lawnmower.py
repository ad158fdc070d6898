"""A lawnmower: parallel legs joined by half circles, to cover an area."""

import math

from cardume.laws import Meters, Positive
from cardume.paths.segment import (
    GeometryError,
    ReferencePath,
    Segment,
    Start,
    Turn,
    bend,
    chain,
    positive,
    sense,
    straight,
)


def lawnmower(
    start: Start,
    leg: Positive[Meters],
    legs: int,
    spacing: Positive[Meters],
    turn: Turn = "starboard",
) -> ReferencePath:
    """Straight legs, joined by half circles that turn to alternate sides.

    Args:
        start: where the first leg begins, and its course.
        leg: [m] > 0 length of each.
        legs: [-] how many, at least 1.
        spacing: [m] > 0 between neighboring legs, twice the radius of the half circles.
        turn: of the first half circle, starboard or port.

    Returns:
        The reference path.

    Raises:
        GeometryError: a length that is not positive, or no leg.
    """
    if legs != int(legs) or legs < 1:
        raise GeometryError(f"legs is {legs}; a lawnmower has a whole number of legs, 1 or more")
    other: Turn = "port" if sense(turn) > 0.0 else "starboard"
    pieces: list[Segment] = []
    for number in range(int(legs)):
        if number:
            side = turn if number % 2 else other
            pieces.append(bend(0.5 * positive("spacing", spacing), side, math.pi, "half the spacing"))
        pieces.append(straight(leg, "leg"))
    return chain(start, pieces)
