"""Bathymetry: the depth of the seabed at a place.

A law gets a place (`Spot`) and gives the depth of the seabed [m] below the surface, NaN where it is not known.
"""

from cardume.laws import law_family
from cardume.signals import Spot

bathymetry_law, sound = law_family("bathymetry", (Spot,))
