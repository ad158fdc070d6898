"""Arc length on a vehicle's own path and gamma on the formation's, from one to the other."""

from cardume.compiler import Rows, compiled, load, where
from cardume.paths.on_curve import is_curve, own_along, reference_along
from cardume.paths.table import (
    AHEAD,
    ARC_START,
    REFERENCE_RATE,
    REFERENCE_START,
    STRETCH,
    has_curves,
    segment_at,
    segment_value,
)


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
    along = beyond * segment_value(path, segment, STRETCH)
    if has_curves(path):
        along = where(is_curve(path, segment), own_along(path, segment, beyond), along)
    return segment_value(path, segment, ARC_START) + along


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
    along = beyond * segment_value(path, segment, REFERENCE_RATE)
    if has_curves(path):
        along = where(is_curve(path, segment), reference_along(path, segment, beyond), along)
    return segment_value(path, segment, REFERENCE_START) + along - load(path, AHEAD)
