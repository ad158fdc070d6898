"""A seabed that is equally deep everywhere."""

from cardume.laws import Meters, Positive
from cardume.signals import Spot
from cardume.world.bathymetry.base import bathymetry_law


@bathymetry_law
def flat(spot: Spot, depth: Positive[Meters] = 30.0) -> Meters:
    """The same depth everywhere.

    b = depth

    Args:
        spot: where; not used but for its number of missions.
        depth: [m] of the seabed.

    Returns:
        Depth of the seabed [m].

    Source: definition.
    """
    return depth + 0.0 * spot.north
