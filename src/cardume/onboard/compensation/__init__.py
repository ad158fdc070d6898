"""Compensation of the current by heading and speed, apart from guidance."""

from cardume.onboard.compensation.base import Steering, compensate, compensation_law
from cardume.onboard.compensation.crab import crab
from cardume.onboard.compensation.none import none

__all__ = ["Steering", "compensate", "compensation_law", "crab", "none"]
