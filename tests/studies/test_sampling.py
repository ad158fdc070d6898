"""Samplings: what makes a Latin hypercube one, what makes Sobol points even, and values made of them."""

import numpy as np
import pytest

from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.studies.flying import fly_seeds
from cardume.studies.sampling import SAMPLINGS, needed, sample_chances, sampling_note
from studies.missions import LINE

KEYS = ["current.speed", "acoustics.loss", "vehicles.a.depth"]


@pytest.mark.parametrize("runs", [1, 7, 64])
def test_a_latin_hypercube_has_one_run_in_each_slice_of_every_key(runs: int) -> None:
    found = sample_chances(KEYS, runs, "latin_hypercube", 3)
    for values in found.values():
        assert sorted((values * runs).astype(int)) == list(range(runs))


def test_sobol_points_fill_every_elementary_box_of_two_keys() -> None:
    """The first two dimensions are a (0, m, 2) net in base 2, scrambled or not: one point in each box of area 1 / n."""
    one, two = list(sample_chances(["a", "b"], 64, "sobol", 5).values())
    for bits in range(7):
        boxes = set(zip((one * 2**bits).astype(int), (two * 2 ** (6 - bits)).astype(int), strict=True))
        assert len(boxes) == 64


def test_a_number_of_runs_between_powers_of_two_begins_with_the_same_sobol_points() -> None:
    for key, values in sample_chances(KEYS, 40, "sobol", 5).items():
        assert np.array_equal(values, sample_chances(KEYS, 64, "sobol", 5)[key][:40])


@pytest.mark.parametrize("sampling", ["latin_hypercube", "sobol"])
def test_chances_depend_on_the_seed_and_not_on_the_order_of_the_keys(sampling: str) -> None:
    found, again = sample_chances(KEYS, 16, sampling, 1), sample_chances(KEYS[::-1], 16, sampling, 1)
    other = sample_chances(KEYS, 16, sampling, 2)
    assert found.keys() == set(KEYS)
    for key in KEYS:
        assert np.array_equal(found[key], again[key])
        assert not np.array_equal(found[key], other[key])
        assert found[key].min() > 0.0
        assert found[key].max() < 1.0


def test_by_chance_alone_each_seed_draws_for_itself() -> None:
    assert sample_chances(KEYS, 16, "monte_carlo", 1) == {}
    assert sample_chances([], 16, "sobol", 1) == {}


def test_values_lie_where_the_chances_say() -> None:
    overrides = [
        "current.speed={uniform: [0.1 m/s, 0.3 m/s]}",
        "current.towards={normal: [90 deg, 10 deg]}",
        "guidance.lookahead={choose: [2 m, 3 m]}",
    ]
    mission = parse_mission(LINE, catalog(), [*overrides, "duration=1 s"])
    chances = sample_chances(["current.speed", "current.towards", "guidance.lookahead"], 8, "latin_hypercube", 1)
    drawn = fly_seeds(mission, range(8), chances=chances).drawn
    assert drawn["current.speed"] == pytest.approx(0.1 + 0.2 * chances["current.speed"], rel=1e-15)
    assert sorted(drawn["guidance.lookahead"]) == [2.0] * 4 + [3.0] * 4
    assert np.array_equal(drawn["guidance.lookahead"] == 3.0, chances["guidance.lookahead"] >= 0.5)
    normal = pytest.importorskip("scipy.stats").norm(np.pi / 2, np.radians(10.0))
    assert drawn["current.towards"] == pytest.approx(normal.ppf(chances["current.towards"]), rel=1e-9)


def test_what_is_worth_knowing_is_told() -> None:
    assert "64 or 128 instead of 100" in sampling_note("sobol", 100, KEYS)
    assert sampling_note("sobol", 128, KEYS) == ""
    assert "nothing to spread" in sampling_note("latin_hypercube", 100, [])
    assert all(sampling_note(sampling, 64, KEYS) == "" for sampling in SAMPLINGS)


def test_an_unknown_sampling_and_a_missing_extra_are_told() -> None:
    with pytest.raises(InputError, match="valid are monte_carlo, latin_hypercube, sobol"):
        sample_chances(KEYS, 4, "halton", 1)
    with pytest.raises(InputError, match=r"pip install 'cardume\[study\]'"):
        needed("no_such_module_at_all", "zarr")
