"""A seabed that falls off in one direction."""

from typing import Annotated

from cardume.laws import Meters, Positive, Radians, Unit
from cardume.maths import maximum, sincos
from cardume.signals import Spot
from cardume.world.bathymetry.base import bathymetry_law

SHALLOWEST = 0.0  # [m] there the slope meets the surface: land


@bathymetry_law
def slope(
    spot: Spot,
    depth: Positive[Meters] = 20.0,
    gradient: Annotated[float, Unit("")] = 0.05,
    towards: Radians = 0.0,
) -> Meters:
    """A plane: so deep at the origin, and deeper by the gradient with every meter in one direction.

    b = max(depth + gradient (north cos towards + east sin towards), 0)

    Args:
        spot: where.
        depth: [m] at the origin.
        gradient: [-] meters of depth per meter of way, > 0: deeper in the direction `towards`.
        towards: [rad] clockwise from north.

    Returns:
        Depth of the seabed [m].

    Source: definition.
    """
    s, c = sincos(towards)
    return maximum(depth + gradient * (spot.north * c + spot.east * s), SHALLOWEST)
