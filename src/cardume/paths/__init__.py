"""Paths: chains of lines and arcs, their offsets for each vehicle, and where a vehicle is beside them."""
