"""Positioning from ranges: what they tell, how to move so that they tell more, and an estimator over recorded data."""
