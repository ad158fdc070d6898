"""From a flight to figures and words."""
