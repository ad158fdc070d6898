"""A circle, flown until the mission ends."""

import math
from typing import NamedTuple

from cardume.laws import Meters, Number, Positive, Radians
from cardume.paths.segment import (
    GeometryError,
    ReferencePath,
    Start,
    Turn,
    bend,
    chain,
    check_start,
    positive,
    sense,
)

MOST_LAPS = 1e5  # angles beyond 2^20 rad have no sine


class Center(NamedTuple):
    """The middle of a circle."""

    north: Meters = 0.0  # [m]
    east: Meters = 0.0  # [m]


def circle(
    center: Center,
    radius: Positive[Meters],
    turn: Turn = "starboard",
    start_bearing: Radians = 0.0,
    laps: Positive[Number] = 10000.0,
) -> ReferencePath:
    """A circle as one long arc, so that gamma grows from lap to lap and never wraps.

    Args:
        center: its middle.
        radius: [m] > 0.
        turn: starboard (clockwise seen from above) or port.
        start_bearing: [rad] from the center to where it starts.
        laps: [-] > 0 after which the path ends; the default is more than a mission flies.

    Returns:
        The reference path.

    Raises:
        GeometryError: a number that is not positive, or too many laps.
    """
    if laps > MOST_LAPS:
        raise GeometryError(f"laps is {laps:g}; at most {MOST_LAPS:g} can be told apart")
    check_start(Start(center.north, center.east, start_bearing))
    start = Start(
        center.north + positive("radius", radius) * math.cos(start_bearing),
        center.east + radius * math.sin(start_bearing),
        start_bearing + sense(turn) * 0.5 * math.pi,
    )
    return chain(start, [bend(radius, turn, 2.0 * math.pi * positive("laps", laps, ""))])
