"""The seabed of a mission from files: CF NetCDF grids and ESRI ASCII grids."""

from cardume.missions.seabed.reading import read_seabed

__all__ = ["read_seabed"]
