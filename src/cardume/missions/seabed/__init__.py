"""The seabed of a mission from files: CF NetCDF grids and ESRI ASCII grids."""

from cardume.missions.seabed.reading import numbers_only, read_seabed

__all__ = ["numbers_only", "read_seabed"]
