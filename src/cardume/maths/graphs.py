"""Who hears whom: adjacency matrices, their Laplacians, and whether a fleet can agree.  Used when a mission is built.

Rows are listeners: adjacency[i, j] > 0 says that vehicle i hears vehicle j, and how much it counts.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cardume.errors import InputError

__all__ = [
    "Agreement",
    "adjacency_of",
    "agreement_rate",
    "algebraic_connectivity",
    "can_agree",
    "check_adjacency",
    "complete",
    "degree",
    "laplacian",
    "normalized_laplacian",
    "path",
    "ring",
    "spectrum",
    "star",
]

Matrix = np.ndarray  # (N, N) float64


class Agreement(NamedTuple):
    """Whether the coordination states of a fleet can come together, and why."""

    possible: bool
    reason: str


def complete(num_vehicles: int) -> Matrix:
    """Everyone hears everyone.

    Args:
        num_vehicles: [-] N >= 1.

    Returns:
        Adjacency (N, N).
    """
    return np.ones((num_vehicles, num_vehicles)) - np.eye(num_vehicles)


def star(num_vehicles: int, center: int = 0) -> Matrix:
    """The center hears everyone, and everyone hears the center only.

    Args:
        num_vehicles: [-] N >= 1.
        center: [-] index of the vehicle in the middle, such as the surface vehicle.

    Returns:
        Adjacency (N, N).

    Raises:
        InputError: there is no vehicle of that index.
    """
    if not 0 <= center < num_vehicles:
        raise InputError(f"star: center {center} is not one of the {num_vehicles} vehicles 0 to {num_vehicles - 1}")
    adjacency = np.zeros((num_vehicles, num_vehicles))
    adjacency[center, :] = adjacency[:, center] = 1.0
    adjacency[center, center] = 0.0
    return adjacency


def path(num_vehicles: int) -> Matrix:
    """Each hears the one before and the one after it.

    Args:
        num_vehicles: [-] N >= 1.

    Returns:
        Adjacency (N, N).
    """
    return np.eye(num_vehicles, k=1) + np.eye(num_vehicles, k=-1)


def ring(num_vehicles: int) -> Matrix:
    """A path whose ends hear each other; two vehicles make a pair, not a double link.

    Args:
        num_vehicles: [-] N >= 1.

    Returns:
        Adjacency (N, N).
    """
    adjacency = path(num_vehicles)
    if num_vehicles > 2:
        adjacency[0, -1] = adjacency[-1, 0] = 1.0
    return adjacency


TOPOLOGIES = {"complete": complete, "path": path, "ring": ring, "star": star}


def adjacency_of(topology: str | Sequence[Sequence[float]] | Matrix, num_vehicles: int) -> Matrix:
    """The adjacency that a mission's `topology` names.

    Args:
        topology: complete, path, ring or star (around the first vehicle), or a matrix of rows that listen.
        num_vehicles: [-] N >= 1.

    Returns:
        Adjacency (N, N).

    Raises:
        InputError: an unknown name, or no adjacency matrix of that size.
    """
    if isinstance(topology, str):
        if topology not in TOPOLOGIES:
            raise InputError(f"topology {topology!r} is none of {', '.join(TOPOLOGIES)}, nor a matrix")
        return TOPOLOGIES[topology](num_vehicles)
    return check_adjacency(topology, num_vehicles)


def check_adjacency(matrix: Sequence[Sequence[float]] | Matrix, num_vehicles: int) -> Matrix:
    """A matrix given by hand, checked.

    Args:
        matrix: (N, N) [-] row i: how much vehicle i counts each of the vehicles it hears, 0 where it hears none.
        num_vehicles: [-] N.

    Returns:
        A new float64 matrix (N, N).

    Raises:
        InputError: it is not N by N, or holds a number that is not finite or below 0, or a vehicle hears itself.
    """
    try:
        adjacency = np.array(matrix, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("topology: the rows of the matrix must hold numbers and be of equal length") from None
    wanted = (num_vehicles, num_vehicles)
    if adjacency.shape != wanted:
        shape = " x ".join(map(str, adjacency.shape)) or "a single number"
        raise InputError(f"topology: the matrix is {shape}; {num_vehicles} vehicles need {wanted[0]} x {wanted[1]}")
    bad = np.argwhere(~(np.isfinite(adjacency) & (adjacency >= 0.0)))
    if bad.size:
        i, j = bad[0]
        raise InputError(f"topology: row {i}, column {j} is {adjacency[i, j]:g}; weights are finite and >= 0")
    loops = np.flatnonzero(np.diag(adjacency))
    if loops.size:
        raise InputError(f"topology: row {loops[0]}, column {loops[0]} is not 0; a vehicle is not its own neighbor")
    return adjacency


def degree(adjacency: Matrix) -> np.ndarray:
    """How much each vehicle hears in all: the row sums.

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        Degrees (N,).
    """
    degrees: np.ndarray = np.sum(adjacency, axis=1)
    return degrees


def laplacian(adjacency: Matrix) -> Matrix:
    """L = D - A, with D the degrees on the diagonal.

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        L (N, N); its rows sum to 0.
    """
    return np.diag(degree(adjacency)) - adjacency


def normalized_laplacian(adjacency: Matrix) -> Matrix:
    """L_D = D^-1 L, so that (L_D gamma)_i is gamma_i less the weighted mean of what vehicle i hears.

    The random-walk form; D^-1/2 L D^-1/2 has another null vector, and on a star its equilibrium is no agreement.

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        L_D (N, N); a vehicle that hears nobody has a row of zeros: it corrects nothing.
    """
    degrees = degree(adjacency)
    normalized: Matrix = laplacian(adjacency) / np.where(degrees > 0.0, degrees, 1.0)[:, None]
    return normalized


def spectrum(adjacency: Matrix) -> np.ndarray:
    """Eigenvalues of D^-1 L by their real parts, the slowest mode first.

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        Eigenvalues (N,), complex; real for a graph in which hearing is mutual.
    """
    values = np.linalg.eigvals(normalized_laplacian(adjacency)).astype(np.complex128)
    return values[np.lexsort((values.imag, values.real))]


def agreement_rate(adjacency: Matrix) -> float:
    """Re lambda_2 of D^-1 L: a linear law of gain k closes the slowest disagreement as exp(-k rate t).

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        The rate; 0 where the fleet cannot agree, inf for a single vehicle.
    """
    return _second(spectrum(adjacency))


def algebraic_connectivity(adjacency: Matrix) -> float:
    """Re lambda_2 of L = D - A: Fiedler's number where hearing is mutual.

    Args:
        adjacency: (N, N) [-] rows listen.

    Returns:
        The connectivity; 0 where the fleet cannot agree, inf for a single vehicle.
    """
    return _second(np.linalg.eigvals(laplacian(adjacency)))


def _second(eigenvalues: np.ndarray) -> float:
    if eigenvalues.size < 2:
        return float("inf")
    return max(0.0, float(np.sort(eigenvalues.real)[1]))


def can_agree(adjacency: Matrix, names: Sequence[str] | None = None) -> Agreement:
    """Whether news from one vehicle reaches all the others, over however many listeners: a directed spanning tree.

    Without one the fleet falls into groups that never learn of each other, whatever the gains.

    Args:
        adjacency: (N, N) [-] rows listen.
        names: of the vehicles, for the reason; their numbers if None.

    Returns:
        The answer and a sentence that gives the reason.
    """
    size = len(adjacency)
    names = [str(i) for i in range(size)] if names is None else names
    reached = [_reached_from(adjacency, i) for i in range(size)]
    for i in range(size):
        if len(reached[i]) == size:
            return Agreement(True, f"what {names[i]} says reaches every vehicle")
    best = max(range(size), key=lambda i: len(reached[i]))
    missed = ", ".join(names[j] for j in range(size) if j not in reached[best])
    return Agreement(
        False, f"no vehicle is heard by all others, even over others: {names[best]} never reaches {missed}"
    )


def _reached_from(adjacency: Matrix, source: int) -> set[int]:
    """The vehicles that hear a source, directly or through others, and the source."""
    reached, edge = {source}, [source]
    while edge:
        speaker = edge.pop()
        listeners = {int(i) for i in np.flatnonzero(adjacency[:, speaker])} - reached
        reached |= listeners
        edge.extend(listeners)
    return reached
