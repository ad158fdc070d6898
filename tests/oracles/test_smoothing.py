"""Closed form V2: what later fixes add, and the smoother against the solution of all equations at once."""

import math

import numpy as np
import pytest

from cardume.missions.smoothing import Doubt, Seen, smooth, transition

ROW_TWO = Doubt(1e-3, 1e-6, 1.0, 0.2)


def steady(period, lag, rows=401):
    """Believed sigma of the position in the middle of a long record with a fix of 1 m at every row."""
    times = period * np.arange(rows)
    fixes = [Seen(k, np.zeros(2), np.eye(2)) for k in range(rows)]
    track = smooth(times, np.zeros((rows, 2)), fixes, start=np.zeros(2), doubt=ROW_TWO, lag=lag)
    return math.sqrt(track.covariances[rows // 2, 0, 0])


@pytest.mark.parametrize(
    ("lag", "printed"), [(0, 0.3904319741), (1, 0.3605450607), (5, 0.2764747944), (None, 0.2210925592)]
)
def test_steady_smoother_at_the_printed_numbers(lag, printed):
    """Row V2, T = 5 s: filter .3904, one fix later .3605, five .2765, all .2211 m: .566 of the filter's."""
    assert steady(5.0, lag) == pytest.approx(printed, abs=2e-9 if lag is not None else 1e-7)


def record(seed, rows=40):
    """A record at uneven times with some fixes, and the noise it was made of."""
    draw = np.random.default_rng([61, seed])
    times = np.cumsum(draw.uniform(0.2, 4.0, rows))
    doubt = Doubt(
        10.0 ** draw.uniform(-3, -1), 10.0 ** draw.uniform(-6, -4), draw.uniform(0.5, 3), draw.uniform(0.05, 0.3)
    )
    truth = [np.concatenate([doubt.initial_sigma * draw.normal(size=2), doubt.current_sigma * draw.normal(size=2)])]
    way = np.cumsum(draw.normal(size=(rows, 2)), axis=0)
    way -= way[0]
    for k in range(1, rows):
        f, q = transition(times[k] - times[k - 1], doubt)
        made = np.concatenate([way[k] - way[k - 1], [0.0, 0.0]])
        truth.append(f @ truth[-1] + made + np.linalg.cholesky(q) @ draw.normal(size=4))
    fixes = []
    for k in sorted(draw.choice(rows, rows // 3, replace=False)):
        root = draw.normal(size=(2, 2))
        covariance = root @ root.T + 0.05 * np.eye(2)
        fixes.append(Seen(int(k), truth[k][:2] + np.linalg.cholesky(covariance) @ draw.normal(size=2), covariance))
    return times, way, fixes, doubt, np.array(truth)


@pytest.mark.parametrize("seed", range(3))
def test_the_smoother_solves_all_equations_at_once(seed):
    """Its means and covariances are those of one dense least-squares problem over all states."""
    times, way, fixes, doubt, _ = record(seed)
    rows = len(times)
    information, right = np.zeros((4 * rows, 4 * rows)), np.zeros(4 * rows)

    def equation(matrix, columns, wanted, covariance):
        weight = np.linalg.inv(covariance)
        information[np.ix_(columns, columns)] += matrix.T @ weight @ matrix
        right[columns] += matrix.T @ weight @ wanted

    prior = np.diag([doubt.initial_sigma**2] * 2 + [doubt.current_sigma**2] * 2)
    equation(np.eye(4), np.arange(4), np.zeros(4), prior)
    for k in range(1, rows):
        f, q = transition(times[k] - times[k - 1], doubt)
        made = np.concatenate([way[k] - way[k - 1], [0.0, 0.0]])
        equation(np.hstack([-f, np.eye(4)]), np.arange(4 * k - 4, 4 * k + 4), made, q)
    for fix in fixes:
        equation(np.eye(2), np.arange(4 * fix.row, 4 * fix.row + 2), fix.position, fix.covariance)
    covariance = np.linalg.inv(information)
    track = smooth(times, way, fixes, start=np.zeros(2), doubt=doubt)
    assert track.means.ravel() == pytest.approx(covariance @ right, abs=1e-6)
    for k in (0, rows // 2, rows - 1):
        assert track.covariances[k] == pytest.approx(covariance[4 * k : 4 * k + 4, 4 * k : 4 * k + 4], abs=1e-7)


def test_later_fixes_make_it_better():
    """Over many records the smoother errs less than with a lag, that less than the filter; as much as it believes."""
    wrong = {0: [], 2: [], None: []}
    squares = []
    for seed in range(25):
        times, way, fixes, doubt, truth = record(seed)
        for lag, errors in wrong.items():
            track = smooth(times, way, fixes, start=np.zeros(2), doubt=doubt, lag=lag)
            errors.append(np.mean((track.means - truth)[:, :2] ** 2))
        apart = track.means - truth
        squares.append(np.mean(np.einsum("ti,tij,tj->t", apart, np.linalg.inv(track.covariances), apart)) / 4.0)
    assert np.mean(wrong[None]) < np.mean(wrong[2]) < np.mean(wrong[0])
    assert np.mean(squares) == pytest.approx(1.0, abs=3.5 * np.std(squares) / math.sqrt(len(squares)))


def test_a_record_out_of_order_is_refused():
    with pytest.raises(ValueError, match="must increase"):
        smooth(np.array([0.0, 2.0, 1.0]), np.zeros((3, 2)), [], start=np.zeros(2), doubt=ROW_TWO)
