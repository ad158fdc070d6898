"""Predict a neighbor by what the coordination law makes it do."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import Seconds
from cardume.onboard.estimation.neighbors.base import neighbor_law
from cardume.signals import NeighborReport


class Predicted(NamedTuple):
    """The neighbor's coordination state at the last tick."""

    state: float = 0.0  # [m]


@neighbor_law
def coordinated(report: NeighborReport, memory: Predicted, dt: Seconds) -> tuple[float, Predicted]:
    """Run the neighbor's own speed law between its reports.

    gamma_hat(k) = gamma_hat(k-1) + dt (v_L + correction);  at a report gamma_hat = gamma + gamma' age

    `correction` is -k tanh((D^-1 L gamma_hat)_j / gamma_0) of the neighbor j at the last tick.
    The report is brought up to date by the path speed it carries, which holds for offset paths and in a
    current, where the printed (53) is up to 15 % off.

    Args:
        report: last report of the neighbor.
        memory: predicted state.
        dt: [s] tick.

    Returns:
        Its coordination state now [m], and the next memory.

    Source: paper eqs. (53)-(55), corrected: arc-length gamma, reported path speed, age.
    """
    known = report.state + report.path_speed * report.age
    reckoned = memory.state + dt * (report.nominal_speed + report.correction)
    now = where(report.is_new > 0.5, known, reckoned)
    return now, Predicted(now)
