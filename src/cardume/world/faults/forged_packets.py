"""Packets of somebody who pretends to be a vehicle of the fleet, knows where all are, and tells them otherwise."""

from cardume.compiler import compiled, where
from cardume.signals import NOTHING, Report, Sighting, VesselState


@compiled
def forged_report(heard: Report, time: float, state: float) -> Report:
    """The head of a forged packet: the next number, valid now, with a false coordination state.

    Args:
        heard: what the listener last heard of the one whose name is used.
        time: [s] now.
        state: [m] the false one.
    """
    is_known = heard.sequence == heard.sequence
    return Report(
        1.0 + 0.0 * state,
        where(is_known, heard.sequence + 1.0, 1.0),
        time + 0.0 * state,
        state,
        where(is_known, heard.path_speed, 0.0),
        where(is_known, heard.phase, 4.0),
        0.0 * state - 1.0,
    )


@compiled
def forged_sighting(seen: Sighting, vessel: VesselState, state: float, time: float, size: float) -> Sighting:
    """What it says of another vehicle: a fix beside the truth, to the north, with the covariance that was told last.

    Args:
        seen: what the genuine one last said of that vehicle.
        vessel: where it truly is.
        state: [m] the coordination state to tell.
        time: [s] now.
        size: [m] how far beside.
    """
    is_known, nothing = seen.phase == seen.phase, NOTHING * state
    return Sighting(
        vessel.north + size,
        vessel.east,
        time + 0.0 * state,
        state,
        where(is_known, seen.path_speed, 0.0),
        time + 0.0 * state,
        where(is_known, seen.phase, 4.0),
        seen.north_variance,
        seen.covariance,
        seen.east_variance,
        nothing,
        nothing,
        nothing,
    )
