"""Equation (53) as printed: a neighbor advances at its speed through the water."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import MetersPerSecond, Seconds
from cardume.onboard.estimation.neighbors import neighbor_law
from cardume.signals import NeighborReport


class Predicted(NamedTuple):
    """The neighbor's coordination state at the next tick."""

    state: float = 0.0


@neighbor_law
def through_the_water(
    report: NeighborReport, memory: Predicted, dt: Seconds, speed: MetersPerSecond = 0.5
) -> tuple[float, Predicted]:
    """gamma_hat' = u between reports.   Source: paper eqs. (53), (54), printed, on a line."""
    now = where(report.is_new > 0.5, report.state + speed * report.age, memory.state)
    return now, Predicted(now + dt * speed)


@neighbor_law
def nominal_speed(report: NeighborReport) -> float:
    """gamma_hat = gamma + v_L age, whatever speed was reported.   Source: paper (54), as it is read by Rego et al."""
    return report.state + report.nominal_speed * report.age
