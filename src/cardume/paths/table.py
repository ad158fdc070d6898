"""The table by which one vehicle knows its path: a header, then one row of numbers per segment.

A vehicle's own path is the formation's reference path, offset to starboard by a constant.  Each row
describes one segment of the own path and says which part of the reference path it stands for, so
that an arc length on the own path and gamma, the arc length on the reference path, are a straight
line of each other within a line or an arc.  `offset_path` writes the table; compiled code reads it.

Where the own path rounds a corner of the reference path on its outer side, `reference_length` is 0:
gamma waits, `reference_rate` is 0, and `stretch` is 1 by convention, so that the vehicle goes round
at v_L plus its correction.

A curve is a segment whose curvature varies.  Its row also holds polynomials in tau, the share of its
reference length gone by: turned angle, place in the axes of its start, and v_L.  They describe the
*reference* curve; `OFFSET` says how far to starboard of it the own path lies.  `on_curve.py` reads them.
"""

from typing import NamedTuple

import numpy as np

from cardume.compiler import Layout, Rows, at, compiled, gather, inlined, load, some, where

MAX_SEGMENTS = 4096  # what the search in `segment_at` covers

# The header.
NUM_SEGMENTS = 0
LENGTH_OWN = 1
LENGTH_REFERENCE = 2
AHEAD = 3
NUM_CURVES = 4
HEADER_WIDTH = 5

# A segment.
START_NORTH = 0
START_EAST = 1
START_COURSE = 2
SIN_COURSE = 3
COS_COURSE = 4
CURVATURE = 5  # [1/m] of the own path, > 0 to starboard; 0 for a line and, where it varies, for a curve
CENTER_NORTH = 6
CENTER_EAST = 7
RADIUS = 8  # [m] of the own path; 0 for a line and a curve
LENGTH = 9  # [m] of the own path
ARC_START = 10  # [m] own arc length at the start
REFERENCE_START = 11  # [m] gamma at the start
REFERENCE_LENGTH = 12  # [m] of the part of the reference path that it stands for
SPEED = 13  # [m/s] v_L there; of a curve at its start
STRETCH = 14  # [-] own length per reference length; 1 where the latter is 0; of a curve its mean
REFERENCE_RATE = 15  # [-] reference length per own length; of a curve its mean

# A curve besides.  A polynomial is what multiplies tau, tau^2, ..., all 0 in the row of a line or an arc.
IS_CURVE = 16  # [-] 1
OFFSET = 17  # [m] of the own path to starboard of the reference curve
DEGREE = 10  # of the turned angle and of v_L
PLACE_DEGREE = 11
TURNED = 18  # [rad] by which the course has changed
GONE_AHEAD = TURNED + DEGREE  # [m] place of the reference curve along its first course
GONE_STARBOARD = GONE_AHEAD + PLACE_DEGREE  # [m] and to starboard of it
GAINED_SPEED = GONE_STARBOARD + PLACE_DEGREE  # [m/s] v_L beyond that at the start
SEGMENT_WIDTH = GAINED_SPEED + DEGREE
ROW = float(SEGMENT_WIDTH)


class Segment(NamedTuple):
    """The numbers of a segment that lines, arcs and curves have, in the order of its row."""

    start_north: float  # [m]
    start_east: float  # [m]
    start_course: float  # [rad]
    sin_course: float  # [-] at the start
    cos_course: float  # [-]
    curvature: float  # [1/m] of the own path, > 0 to starboard; 0 for a line and for a curve
    center_north: float  # [m]
    center_east: float  # [m]
    radius: float  # [m] 0 for a line and a curve
    length: float  # [m] of the own path
    arc_start: float  # [m] own arc length at the start
    reference_start: float  # [m] gamma at the start
    reference_length: float  # [m]
    speed: float  # [m/s] v_L there
    stretch: float  # [-] own length per reference length
    reference_rate: float  # [-] reference length per own length


_pick_segment = Layout(Segment, width=SEGMENT_WIDTH).picker(Segment)


class PathPlace(NamedTuple):
    """Where on its own path a vehicle was last: what keeps gamma from wrapping and from jumping."""

    segment: float = 0.0  # [-] number of the segment
    arc_length: float = 0.0  # [m] on the own path


def rows_on_path(path: np.ndarray) -> np.ndarray:
    """The rows of a path, without those that say how a closed one goes on beyond its ends.

    Args:
        path: [any] (n,) path table.

    Returns:
        [any] (segments, SEGMENT_WIDTH).
    """
    rows: np.ndarray = path[HEADER_WIDTH:].reshape(-1, SEGMENT_WIDTH)
    begins = rows[:, ARC_START]
    return rows[(begins >= 0.0) & (begins < path[LENGTH_OWN])]


@compiled
def segment_value(path: Rows, segment: float, column: int) -> float:
    """One number of a segment's row.

    Args:
        path: (n,) path table.
        segment: [-] number of the segment, 0 for the first.
        column: one of the names above.
    """
    return gather(at(path, HEADER_WIDTH + column), segment * ROW)


@inlined
def segment_of(path: Rows, number: float) -> Segment:
    """A segment of a path.

    Args:
        path: (n,) path table.
        number: [-] 0 for the first.
    """
    return _pick_segment(at(path, HEADER_WIDTH), number)


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
    onward, back = _beside(path, value, column, guess)
    found = guess
    if some(onward | back):
        found = guess + where(onward, 1.0, where(back, -1.0, 0.0))
        beyond, before = _beside(path, value, column, found)
        if some(beyond | before):
            found = segment_at(path, value, column)
    return found


@inlined
def _beside(path: Rows, value: float, column: int, guess: float) -> tuple[bool, bool]:
    """Whether the segment of a value is one after a guess, and whether it is one before it."""
    has_next, has_last = guess < load(path, NUM_SEGMENTS) - 1.0, guess > 0.0
    onward = has_next & (segment_value(path, where(has_next, guess + 1.0, guess), column) <= value)
    return onward, has_last & (segment_value(path, guess, column) > value)


@compiled
def has_curves(path: Rows) -> bool:
    """Whether any segment is a curve, in any lane: what a mission of lines and arcs need not pay for."""
    return some(load(path, NUM_CURVES) > 0.0)


@compiled
def start_at(path: Rows, arc_length: float) -> PathPlace:
    """Memory of a vehicle that starts beside this arc length of its own path.

    A vehicle whose start is given in absolute coordinates begins its search at the path's start, 0.

    Args:
        path: (n,) path table.
        arc_length: [m] on the own path.
    """
    return PathPlace(segment_at(path, arc_length, ARC_START), arc_length)


@compiled
def place_near(path: Rows, path_parameter: float, guess: float) -> PathPlace:
    """Memory of a vehicle that is abeam of where its formation has come to.

    Args:
        path: (n,) path table.
        path_parameter: [m] gamma of the vehicle.
        guess: [-] number of the segment where it probably is.
    """
    gamma = path_parameter + load(path, AHEAD)
    number = segment_near(path, gamma, REFERENCE_START, guess)
    segment = segment_of(path, number)
    return PathPlace(number, segment.arc_start + (gamma - segment.reference_start) * segment.stretch)
