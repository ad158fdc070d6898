"""Coordination along the paths."""

from cardume.onboard.coordination.base import coordination_law, correct_speed
from cardume.onboard.coordination.laplacian_tanh import laplacian_tanh
from cardume.onboard.coordination.none import none

__all__ = ["coordination_law", "correct_speed", "laplacian_tanh", "none"]
