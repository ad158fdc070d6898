"""Estimation aboard: position, current, speed, and what the neighbors do meanwhile."""
