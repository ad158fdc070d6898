"""Guidance laws: where to head so as to come to the path and stay on it."""

from cardume.onboard.guidance.along_path import along_path
from cardume.onboard.guidance.arcsine import arcsine
from cardume.onboard.guidance.base import guidance_law, guide
from cardume.onboard.guidance.line_of_sight import line_of_sight

__all__ = ["along_path", "arcsine", "guidance_law", "guide", "line_of_sight"]
