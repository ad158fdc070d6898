"""Coordination: from being ahead of the others to a correction of speed.

A law gets the vehicle's `Disagreement` and gives a correction [m/s] to v_L on the reference path.
"""

from cardume.laws import law_family
from cardume.signals import Disagreement

coordination_law, correct_speed = law_family("coordination", (Disagreement,))
