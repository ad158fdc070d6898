"""Acoustic channels: `ideal`, `bernoulli`, `modem`."""

from cardume.world.acoustics.base import acoustics_law, propagate
from cardume.world.acoustics.bernoulli import bernoulli
from cardume.world.acoustics.ideal import ideal
from cardume.world.acoustics.modem import modem

__all__ = ["acoustics_law", "bernoulli", "ideal", "modem", "propagate"]
