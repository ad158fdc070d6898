"""Prediction of the neighbors between their reports."""

from cardume.onboard.estimation.neighbors.base import neighbor_law, predict
from cardume.onboard.estimation.neighbors.coordinated import coordinated
from cardume.onboard.estimation.neighbors.last_report import last_report
from cardume.onboard.estimation.neighbors.reported_speed import reported_speed

__all__ = ["coordinated", "last_report", "neighbor_law", "predict", "reported_speed"]
