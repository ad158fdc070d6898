"""Autopilots: from what is asked to forces and moments, at the plant step.

A law gets `Feedback` (measured values, held or extrapolated between ticks, and the reference) and
gives a `Command`.
"""

from cardume.laws import law_family
from cardume.signals import Command, Feedback

autopilot_law, steer = law_family("autopilot", (Feedback,), Command)
