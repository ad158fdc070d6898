"""Compensation: from a course over ground to a heading and a speed through the water.

A law gets the wanted `Course` and the vehicle's `Motion`, and gives a heading and a speed.
"""

from typing import NamedTuple

from cardume.laws import law_family
from cardume.signals import Course, Motion


class Steering(NamedTuple):
    """Heading and speed through the water."""

    heading: float  # [rad]
    speed: float  # [m/s]


compensation_law, compensate = law_family("compensation", (Course, Motion), Steering)
