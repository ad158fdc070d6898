"""Take a neighbor to be where it last said it was."""

from cardume.onboard.estimation.neighbors.base import neighbor_law
from cardume.signals import NeighborReport


@neighbor_law
def last_report(report: NeighborReport) -> float:
    """Believe the last report as if it were fresh.

    gamma_hat = gamma

    Every delay tau becomes an error of v_L tau; here as the bad example, and for exact links.

    Args:
        report: last report of the neighbor.

    Returns:
        Its coordination state [m] as reported.

    Source: paper section 4.1, before prediction.
    """
    return report.state
