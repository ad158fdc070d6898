"""Neighbors: what the coordination states of the others are by now.

A law gets the last `NeighborReport` of one neighbor and gives its coordination state [m] now.
"""

from cardume.laws import law_family
from cardume.signals import NeighborReport

neighbor_law, predict = law_family("neighbors", (NeighborReport,))
