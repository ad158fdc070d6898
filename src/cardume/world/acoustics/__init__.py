"""Acoustic channels: `ideal`, `bernoulli`."""

from cardume.world.acoustics.base import acoustics_law, propagate
from cardume.world.acoustics.bernoulli import bernoulli
from cardume.world.acoustics.ideal import ideal

__all__ = ["acoustics_law", "bernoulli", "ideal", "propagate"]
