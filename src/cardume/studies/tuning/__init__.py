"""Tuning: the values of a few keys with which a mission does best, over all that it draws."""
