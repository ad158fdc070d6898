"""Graphs: the spectra of closed form M, the null vectors, and who can agree with whom."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.errors import InputError
from cardume.maths import graphs

GOLDEN = (5.0**0.5 - 1.0) / 4.0  # cos 72 deg
SPECTRA = [
    (graphs.path(2), [0.0, 2.0]),
    (graphs.star(3), [0.0, 1.0, 2.0]),
    (graphs.complete(3), [0.0, 1.5, 1.5]),
    (graphs.path(4), [0.0, 0.5, 1.5, 2.0]),
    (graphs.ring(5), [0.0, 0.69098301, 0.69098301, 1.80901699, 1.80901699]),
    (graphs.ring(5), [0.0, 1.0 - GOLDEN, 1.0 - GOLDEN, 1.0 + GOLDEN + 0.5, 1.0 + GOLDEN + 0.5]),
    *[(graphs.complete(n), [0.0] + [n / (n - 1.0)] * (n - 1)) for n in (2, 4, 7, 12)],
    *[(graphs.star(n, n - 1), [0.0] + [1.0] * (n - 2) + [2.0]) for n in (4, 9)],
]
connected = st.integers(2, 9).flatmap(lambda n: st.sampled_from([f(n) for f in graphs.TOPOLOGIES.values()]))


@pytest.mark.parametrize(("adjacency", "want"), SPECTRA)
def test_spectra(adjacency: np.ndarray, want: list[float]) -> None:
    values = graphs.spectrum(adjacency)
    assert values.real == pytest.approx(want, abs=6e-9)
    assert np.max(np.abs(values.imag)) < 1e-9
    assert graphs.agreement_rate(adjacency) == pytest.approx(want[1], abs=6e-9)


@pytest.mark.parametrize(
    ("adjacency", "want"),
    [
        (graphs.complete(5), 5.0), (graphs.star(6), 1.0), (graphs.path(4), 2.0 - 2.0**0.5),
        (graphs.ring(6), 1.0), (graphs.path(1), float("inf")), (np.zeros((3, 3)), 0.0),
    ],
)  # fmt: skip
def test_algebraic_connectivity(adjacency: np.ndarray, want: float) -> None:
    assert graphs.algebraic_connectivity(adjacency) == pytest.approx(want, abs=1e-12)


def test_the_star_by_hand() -> None:
    """The surface vehicle in the middle hears all; each of the others hears only it."""
    adjacency = graphs.star(3)
    assert adjacency.tolist() == [[0, 1, 1], [1, 0, 0], [1, 0, 0]]
    assert graphs.degree(adjacency).tolist() == [2, 1, 1]
    assert graphs.laplacian(adjacency).tolist() == [[2, -1, -1], [-1, 1, 0], [-1, 0, 1]]
    assert graphs.normalized_laplacian(adjacency).tolist() == [[1, -0.5, -0.5], [-1, 1, 0], [-1, 0, 1]]
    assert graphs.star(3, 1).tolist() == [[0, 1, 0], [1, 0, 1], [0, 1, 0]]


def test_rows_are_listeners() -> None:
    """0 hears 1, 1 hears nobody: 1 leads and corrects nothing."""
    adjacency = np.array([[0.0, 2.0], [0.0, 0.0]])
    assert (graphs.normalized_laplacian(adjacency) @ [5.0, 3.0]).tolist() == [2.0, 0.0]
    assert graphs.can_agree(adjacency, ["follower", "leader"]) == (True, "what leader says reaches every vehicle")
    assert graphs.agreement_rate(adjacency) == pytest.approx(1.0)


@given(adjacency=connected)
def test_null_vectors(adjacency: np.ndarray) -> None:
    """Equal states need no correction; the degrees weigh the mean that linear agreement keeps."""
    normalized = graphs.normalized_laplacian(adjacency)
    assert np.max(np.abs(normalized @ np.ones(len(adjacency)))) < 1e-12
    assert np.max(np.abs(graphs.degree(adjacency) @ normalized)) < 1e-12


def test_ring_and_path_of_few() -> None:
    assert graphs.ring(2).tolist() == graphs.path(2).tolist() == [[0, 1], [1, 0]]
    assert graphs.ring(3).tolist() == graphs.complete(3).tolist()
    for make in graphs.TOPOLOGIES.values():
        assert make(1).tolist() == [[0.0]]
        assert graphs.can_agree(make(1)).possible


def test_two_groups_cannot_agree_and_the_reason_names_one_left_out() -> None:
    adjacency = np.zeros((4, 4))
    adjacency[:2, :2] = adjacency[2:, 2:] = graphs.path(2)
    possible, reason = graphs.can_agree(adjacency, ["ana", "bia", "caio", "davi"])
    assert not possible
    assert reason == "no vehicle is heard by all others, even over others: ana never reaches caio, davi"
    assert graphs.agreement_rate(adjacency) == pytest.approx(0.0, abs=1e-12)


def test_two_leaders_cannot_agree() -> None:
    adjacency = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    assert not graphs.can_agree(adjacency).possible


@given(size=st.integers(1, 7), seed=st.integers(0, 2**32 - 1), share=st.floats(0.0, 0.6))
def test_a_spanning_tree_is_a_simple_null_eigenvalue(size: int, seed: int, share: float) -> None:
    """The theorem that `can_agree` stands on, on random directed graphs."""
    adjacency = (np.random.default_rng(seed).random((size, size)) < share).astype(float)
    np.fill_diagonal(adjacency, 0.0)
    num_null = size - np.linalg.matrix_rank(graphs.laplacian(adjacency))
    assert graphs.can_agree(adjacency).possible == (num_null == 1)


@pytest.mark.parametrize("name", ["complete", "path", "ring", "star"])
def test_topologies_by_name(name: str) -> None:
    assert graphs.adjacency_of(name, 4).tolist() == getattr(graphs, name)(4).tolist()


def test_a_matrix_is_copied() -> None:
    mine = np.array([[0.0, 1.0], [1.0, 0.0]])
    checked = graphs.adjacency_of(mine, 2)
    mine[0, 1] = 7.0
    assert checked[0, 1] == 1.0


@pytest.mark.parametrize(
    ("topology", "message"),
    [
        ("strar", "topology 'strar' is none of complete, path, ring, star, nor a matrix"),
        ([[0.0, 1.0]], "the matrix is 1 x 2; 2 vehicles need 2 x 2"),
        ([[0.0, 1.0], [1.0]], "equal length"),
        ([["a", "b"], ["c", "d"]], "must hold numbers"),
        (3.0, "the matrix is a single number"),
        ([[0.0, -1.0], [1.0, 0.0]], "row 0, column 1 is -1; weights are finite and >= 0"),
        ([[0.0, 1.0], [float("nan"), 0.0]], "row 1, column 0 is nan"),
        ([[0.0, float("inf")], [1.0, 0.0]], "row 0, column 1 is inf"),
        ([[0.0, 1.0], [1.0, 1.0]], "row 1, column 1 is not 0; a vehicle is not its own neighbor"),
    ],
)
def test_bad_topologies(topology: object, message: str) -> None:
    with pytest.raises(InputError, match=message.replace("(", "\\(")):
        graphs.adjacency_of(topology, 2)  # type: ignore[arg-type]


@pytest.mark.parametrize("center", [-1, 3])
def test_a_star_needs_a_center(center: int) -> None:
    with pytest.raises(InputError, match="is not one of the 3 vehicles 0 to 2"):
        graphs.star(3, center)
