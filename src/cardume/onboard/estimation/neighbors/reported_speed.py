"""Predict a neighbor by the speed it last reported."""

from cardume.onboard.estimation.neighbors.base import neighbor_law
from cardume.signals import NeighborReport


@neighbor_law
def reported_speed(report: NeighborReport) -> float:
    """Add the reported path speed times the age of the report.

    gamma_hat = gamma + gamma' age

    Args:
        report: last report of the neighbor.

    Returns:
        Its coordination state now [m].

    Source: Rego, Hung & Pascoal's delay compensation with the reported speed instead of v_L
        (closed form O, docs/theory/closed-forms.md).
    """
    return report.state + report.path_speed * report.age
