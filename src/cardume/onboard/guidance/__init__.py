"""Guidance laws: where to head so as to come to the path and stay on it."""

from cardume.onboard.guidance.adaptive_line_of_sight import adaptive_line_of_sight
from cardume.onboard.guidance.along_path import along_path
from cardume.onboard.guidance.arcsine import arcsine
from cardume.onboard.guidance.arcsine_integral import arcsine_integral
from cardume.onboard.guidance.arcsine_with_current import arcsine_with_current
from cardume.onboard.guidance.base import guidance_law, guide
from cardume.onboard.guidance.body_frame_target import body_frame_target
from cardume.onboard.guidance.integral_line_of_sight import integral_line_of_sight
from cardume.onboard.guidance.line_of_sight import line_of_sight
from cardume.onboard.guidance.path_frame_backstepping import path_frame_backstepping
from cardume.onboard.guidance.trajectory_tracking import trajectory_tracking
from cardume.onboard.guidance.vector_field import vector_field

__all__ = [
    "adaptive_line_of_sight",
    "along_path",
    "arcsine",
    "arcsine_integral",
    "arcsine_with_current",
    "body_frame_target",
    "guidance_law",
    "guide",
    "integral_line_of_sight",
    "line_of_sight",
    "path_frame_backstepping",
    "trajectory_tracking",
    "vector_field",
]
