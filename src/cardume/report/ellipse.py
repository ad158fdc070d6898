"""Where a vehicle is, by its own filter: the ellipse that holds it in 95 of 100 cases."""

import math

import numpy as np

from cardume.simulation.flight import CERTAINTY, Flight

LABEL = "expected error, 95 %"
# A Gaussian in a plane lies within n' P^-1 n <= bound with probability 1 - exp(-bound / 2), chi-square of 2 degrees.
BOUND = -2.0 * math.log(1.0 - 0.95)  # [1] 5.991


def certainty(flight: Flight) -> np.ndarray:
    """What the vehicles believe of their own error.

    Args:
        flight: whose log may lack it, as those of older versions do.

    Returns:
        (3, time, vehicle) [m^2] variance north, covariance, variance east; NaN where there is none.
    """
    nothing = np.full((len(flight.times), len(flight.vehicle_names)), np.nan)
    found = np.array([flight.channels.get(name, nothing) for name in CERTAINTY], float)
    told = np.isfinite(found).all(axis=0) & (found[0] + found[2] > 0.0)
    return np.where(told, found, np.nan)


def vehicles_with_certainty(flight: Flight) -> list[int]:
    """Places in the fleet of those that tell an error of their own at any time.

    Args:
        flight: whose log is asked.
    """
    told = np.isfinite(certainty(flight)[0]).any(axis=0)
    return [int(vehicle) for vehicle in np.flatnonzero(told)]


def ellipse(covariance: np.ndarray, count: int = 49) -> np.ndarray:
    """The closed curve n' P^-1 n = BOUND; its half axes are sqrt(BOUND lambda) along the eigenvectors of P.

    Args:
        covariance: (3,) [m^2] variance north, covariance, variance east.
        count: of points, the first again as the last.

    Returns:
        (count, 2) [m] north, east about the middle.
    """
    north, both, east = covariance
    values, axes = np.linalg.eigh(np.array([[north, both], [both, east]]))
    angle = np.linspace(0.0, 2.0 * np.pi, count)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    points: np.ndarray = (circle * np.sqrt(BOUND * np.maximum(values, 0.0))) @ axes.T
    return points
