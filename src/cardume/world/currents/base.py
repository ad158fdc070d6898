"""Currents: the velocity of the water at a place and time.

A law gets a place (`Where`) and the tick's `Noise`, the same for all vehicles of a mission, and
gives the velocity of the `Water`.
"""

from cardume.laws import law_family
from cardume.signals import Noise, Water, Where

current_law, flow = law_family("current", (Where, Noise), Water)
