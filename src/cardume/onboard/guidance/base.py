"""Guidance: from the error to the path to the course that leads back to it.

A law gets a `PathError` and gives the desired course over ground [rad].  It may keep a memory.
"""

from cardume.laws import law_family
from cardume.signals import PathError

guidance_law, guide = law_family("guidance", (PathError,))
