"""The seabed: flat, a slope, or a grid from a file."""

from cardume.world.bathymetry.base import bathymetry_law, sound
from cardume.world.bathymetry.flat import flat
from cardume.world.bathymetry.gridded import gridded
from cardume.world.bathymetry.slope import slope

__all__ = ["bathymetry_law", "flat", "gridded", "slope", "sound"]
