"""Autopilots: the inner loops that the paper assumes and a vehicle needs."""

from cardume.onboard.control.base import autopilot_law, steer
from cardume.onboard.control.feedforward_pid import feedforward_pid
from cardume.onboard.control.none import none

__all__ = ["autopilot_law", "feedforward_pid", "none", "steer"]
