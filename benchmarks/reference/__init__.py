"""The reference workload: one mission, flown by cardume and by other programs that do the same work."""
