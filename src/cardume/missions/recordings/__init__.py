"""Recorded data: read from many formats, played through the navigation that flies, scored and kept."""
