"""The table by which one vehicle knows its path: a header, then one row of numbers per segment.

A vehicle's own path is the formation's reference path, offset to starboard by a constant.  Each row
describes one segment of the own path and says which part of the reference path it stands for, so
that an arc length on the own path and gamma, the arc length on the reference path, are a straight
line of each other within a segment.  `offset_path` writes the table; compiled code reads it.

Where the own path rounds a corner of the reference path on its outer side, `reference_length` is 0:
gamma waits, `reference_rate` is 0, and `stretch` is 1 by convention, so that the vehicle goes round
at v_L plus its correction.
"""

from typing import NamedTuple

from cardume.compiler import Rows, at, compiled, gather, load, some, where

SEGMENT_WIDTH = 16
MAX_SEGMENTS = 4096  # what the search in `segment_at` covers

# The header.
NUM_SEGMENTS = 0
LENGTH_OWN = 1
LENGTH_REFERENCE = 2
AHEAD = 3
HEADER_WIDTH = 4

# A segment.
START_NORTH = 0
START_EAST = 1
START_COURSE = 2
SIN_COURSE = 3
COS_COURSE = 4
CURVATURE = 5  # [1/m] of the own path, > 0 to starboard; 0 for a line
CENTER_NORTH = 6
CENTER_EAST = 7
RADIUS = 8  # [m] of the own path; 0 for a line
LENGTH = 9  # [m] of the own path
ARC_START = 10  # [m] own arc length at the start
REFERENCE_START = 11  # [m] gamma at the start
REFERENCE_LENGTH = 12  # [m] of the part of the reference path that it stands for
SPEED = 13  # [m/s] v_L there
STRETCH = 14  # [-] own length per reference length; 1 where the latter is 0
REFERENCE_RATE = 15  # [-] reference length per own length


class PathPlace(NamedTuple):
    """Where on its own path a vehicle was last: what keeps gamma from wrapping and from jumping."""

    segment: float = 0.0  # [-] number of the segment
    arc_length: float = 0.0  # [m] on the own path


@compiled
def segment_value(path: Rows, segment: float, column: int) -> float:
    """One number of a segment's row.

    Args:
        path: (n,) path table.
        segment: [-] number of the segment, 0 for the first.
        column: one of the names above.
    """
    return gather(at(path, HEADER_WIDTH + column), segment * 16.0)


@compiled
def segment_at(path: Rows, value: float, column: int) -> float:
    """Number of the last segment whose `column` is at most `value`; the first if there is none.

    A binary search that takes the same steps in every lane.

    Args:
        path: (n,) path table.
        value: [m] what is looked for.
        column: ARC_START or REFERENCE_START, which never decrease.
    """
    num_segments = load(path, NUM_SEGMENTS)
    found = 0.0 * num_segments
    stride = 2048.0
    for _ in range(12):
        probe = found + stride
        if some(probe < num_segments):
            inside = probe < num_segments
            begins = segment_value(path, where(inside, probe, found), column)
            found = where(inside & (begins <= value), probe, found)
        stride = 0.5 * stride
    return found


@compiled
def segment_near(path: Rows, value: float, column: int, guess: float) -> float:
    """The same as `segment_at`, at once where the guess is right or a neighbor is.

    Args:
        path: (n,) path table.
        value: [m] what is looked for.
        column: ARC_START or REFERENCE_START.
        guess: [-] number of a segment of this path.
    """
    last = load(path, NUM_SEGMENTS) - 1.0
    onward = (guess < last) & (segment_value(path, where(guess < last, guess + 1.0, guess), column) <= value)
    back = (guess > 0.0) & (segment_value(path, guess, column) > value)
    found = guess + where(onward, 1.0, where(back, -1.0, 0.0))
    beyond = (found < last) & (segment_value(path, where(found < last, found + 1.0, found), column) <= value)
    before = (found > 0.0) & (segment_value(path, found, column) > value)
    if some(beyond | before):
        found = segment_at(path, value, column)
    return found


@compiled
def arc_length_at(path: Rows, path_parameter: float) -> float:
    """Own arc length at which a vehicle has this coordination state; extends beyond both ends.

    Args:
        path: (n,) path table.
        path_parameter: [m] gamma less the vehicle's `ahead`.

    Returns:
        [m] on the own path; behind a corner that the vehicle rounds, its far side.
    """
    gamma = path_parameter + load(path, AHEAD)
    segment = segment_at(path, gamma, REFERENCE_START)
    beyond = gamma - segment_value(path, segment, REFERENCE_START)
    return segment_value(path, segment, ARC_START) + beyond * segment_value(path, segment, STRETCH)


@compiled
def path_parameter_at(path: Rows, arc_length: float) -> float:
    """Coordination state of a vehicle at an arc length of its own path; extends beyond both ends.

    Args:
        path: (n,) path table.
        arc_length: [m] on the own path.

    Returns:
        [m] gamma less the vehicle's `ahead`.
    """
    segment = segment_at(path, arc_length, ARC_START)
    beyond = arc_length - segment_value(path, segment, ARC_START)
    gamma = segment_value(path, segment, REFERENCE_START) + beyond * segment_value(path, segment, REFERENCE_RATE)
    return gamma - load(path, AHEAD)


@compiled
def start_at(path: Rows, arc_length: float) -> PathPlace:
    """Memory of a vehicle that starts beside this arc length of its own path.

    A vehicle whose start is given in absolute coordinates starts with `PathPlace()`, the path's start.

    Args:
        path: (n,) path table.
        arc_length: [m] on the own path.
    """
    return PathPlace(segment_at(path, arc_length, ARC_START), arc_length)
