"""Water that of a sudden moves otherwise: on top of any current."""

from cardume.compiler import compiled, where
from cardume.signals import Water


@compiled
def stirred(water: Water, north: float, east: float, is_there: bool) -> Water:
    """The water with the step in it.

    V_c' = V_c + (north, east)

    Args:
        water: without.
        north: [m/s]
        east: [m/s]
        is_there: [-] whether it is, in each lane.
    """
    return where(is_there, Water(water.north + north, water.east + east), water)
