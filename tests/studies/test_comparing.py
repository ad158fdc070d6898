"""Comparisons flown through the real engine: pairs, common random numbers, known differences, interruption."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

import cardume
from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.results import choose_destination
from cardume.studies import flying, work
from cardume.studies.comparing import Comparison, check_seeds
from cardume.studies.keeping import keep_comparison, read_comparison, to_csv
from studies.missions import LINE, NOISY

LAWS = {"guidance.law": ["line_of_sight", "arcsine"]}


def read(text: str, *overrides: str) -> Mission:
    return parse_mission(text, catalog(), overrides)


@pytest.fixture(scope="module")
def noisy() -> Comparison:
    return cardume.compare(read(NOISY), LAWS, runs=6)


def test_the_difference_of_two_laws_in_a_current_is_that_of_theory() -> None:
    """Without compensation: line of sight d V / sqrt(u^2 - V^2), arcsine V / k1; closed form D."""
    settled = ["duration=300 s", "transient.threshold=1.5 m", "transient.hold=100 s"]
    arms = {"guidance": [{"law": "line_of_sight", "lookahead": 5}, {"law": "arcsine", "gain": 0.1}]}
    found = cardume.compare(read(LINE), arms, runs=2, overrides=settled, metrics=["cross_track_rms"])
    sight, arcsine = found.estimates["cross_track_rms"]
    assert sight.mean == pytest.approx(5.0 * 0.1 / math.sqrt(0.25 - 0.01), rel=1e-3)
    assert arcsine.mean == pytest.approx(1.0, rel=1e-3)
    (difference,) = found.differences["cross_track_rms"]
    assert difference.mean == pytest.approx(1.0 - 1.0206207262, abs=1e-3)
    assert difference.low == difference.high  # nothing is random
    assert found.is_real["cross_track_rms"] == (True,)


def test_every_number_is_that_of_the_mission_flown_alone(noisy: Comparison) -> None:
    for arm, law in enumerate(LAWS["guidance.law"]):
        for place, seed in enumerate(noisy.seeds):
            alone = cardume.fly(read(NOISY, f"guidance.law={law}", f"seed={seed}"))
            assert noisy.values("cross_track_rms")[arm, place] == alone.metrics.worst("cross_track_rms")[0]
            assert noisy.values("a.position_error_rms")[arm, place] == alone.metrics.vehicles["a"]["position_error_rms"]


def test_arms_meet_the_same_noise_so_pairs_differ_less_than_runs(noisy: Comparison) -> None:
    same = cardume.compare(read(NOISY), {"guidance.lookahead": ["2 m", "2.0001 m"]}, runs=6)
    one, other = same.values("cross_track_rms")
    assert np.std(other - one) < 0.01 * np.std(one)
    assert noisy.seeds == (1, 2, 3, 4, 5, 6)
    assert np.std(noisy.values("position_error_rms")[0]) > 0.0


def test_draws_are_common_too() -> None:
    text = LINE.replace("speed: 0.1 m/s, towards", "speed: {uniform: [0 m/s, 0.2 m/s]}, towards")
    found = cardume.compare(read(text), {"compensation.law": ["none"], "end": ["hold", "continue"]}, seeds=[3, 9, 4])
    one, other = found.values("cross_track_rms")
    assert len(set(one)) == 3  # each seed another current
    assert (one == other).all()
    assert not any(found.is_real["cross_track_rms"])


def test_lanes_and_scalars_give_the_same_bits(noisy: Comparison, monkeypatch: pytest.MonkeyPatch) -> None:
    used: list[int] = []
    real = flying.fly_joined

    def spy(plans, *rest):  # type: ignore[no-untyped-def]
        used.append(len(plans))
        return real(plans, *rest)

    monkeypatch.setattr(work, "LANES_FROM", 0)
    monkeypatch.setattr(flying, "fly_joined", spy)
    laned = cardume.compare(read(NOISY), LAWS, runs=6)
    assert used == [6, 6]
    for metric in noisy.metrics:
        assert (laned.values(metric) == noisy.values(metric)).all()
    # missions of different length share lanes too, each to its own end
    ragged = "duration={choose: [20 s, 30 s]}"
    drawn = cardume.compare(read(NOISY, ragged), LAWS, runs=6)
    assert used[2:] == [6, 6]
    monkeypatch.setattr(work, "LANES_FROM", 10**12)
    alone = cardume.compare(read(NOISY, ragged), LAWS, runs=6, metrics=drawn.metrics)
    for metric in drawn.metrics:
        assert np.array_equal(drawn.values(metric), alone.values(metric), equal_nan=True)


def test_requirements_and_what_never_settled_are_counted() -> None:
    found = cardume.compare(
        read(LINE, "require={cross_track_max: 1 m}"), {"guidance.lookahead": ["2 m", "200 m"]}, runs=2
    )
    assert found.met(0) == (2, 2)
    assert found.met(1) == (0, 2)
    assert found.estimates["settling_time"][1].size == 0
    assert found.differences["settling_time"][0].size == 0
    assert cardume.compare(read(LINE), LAWS, runs=1).met(0) is None


def test_an_arm_that_fails_is_told_and_the_others_stand(tmp_path: Path) -> None:
    (tmp_path / "law_that_fails.py").write_text(
        "from cardume.compiler import where\nfrom cardume.maths import sqrt\n"
        "from cardume.onboard.guidance import guidance_law\n"
        "from cardume.signals import PathError\n\n@guidance_law\ndef lost(error: PathError) -> float:\n"
        '    """Lost.\n\n    Source: own.\n    """\n'
        "    return where(error.cross_track < 2.9, sqrt(-error.cross_track), error.path_course - 1.0)\n"
    )
    found = cardume.compare(
        read(LINE),
        {"guidance.law": ["line_of_sight", "law_that_fails:lost"]},
        runs=2,
        allow_code=[tmp_path],
    )
    assert found.failures(0) == []
    assert [seed for seed, _ in found.failures(1)] == [1, 2]
    assert "reference of vehicle a" in found.failures(1)[0][1]
    assert np.isnan(found.values("cross_track_rms")[1]).all()


DRAWN_PATH = """
cardume: 1
name: narrow
duration: 30 s
path:
  {type: lawnmower, start: {north: 0, east: 0, course: 0},
   leg: 60, legs: 4, turn: starboard, spacing: {uniform: [1, 24]}}
formation: {speed: 0.5 m/s}
vehicles: [{name: a, offset: {starboard: -3 m}, start: {north: 0, east: -2.5, heading: 0}}]
model: kinematic
"""  # too narrow for the offset where the spacing drawn is below 6 m


def test_a_seed_that_draws_what_does_not_fit_is_told_and_the_others_stand() -> None:
    found = cardume.compare(read(DRAWN_PATH), LAWS, runs=12)
    assert len(found.seeds) == 12
    for arm in range(2):
        refused = [seed for seed, _ in found.failures(arm)]
        assert refused == [seed for seed in found.seeds if not fits(seed)]
        assert 0 < len(refused) < 12
        assert all("does not fit" in why for _, why in found.failures(arm))
        has = ~np.isnan(found.values("cross_track_max")[arm])
        assert has.tolist() == [seed not in refused for seed in found.seeds]


def test_a_mission_that_no_seed_lets_fly_is_refused_before_any_flies() -> None:
    stages: list[str] = []
    with pytest.raises(InputError, match="does not fit"):
        cardume.compare(
            read(DRAWN_PATH, "path.spacing={uniform: [1 m, 2 m]}"),
            LAWS,
            runs=3,
            progress=lambda stage, done, total: stages.append(stage),
        )
    assert not stages


def fits(seed: int) -> bool:
    return draw(read(DRAWN_PATH), seed).path.spacing >= 6.0


def test_what_was_flown_before_a_stop_is_compared() -> None:
    seen = []

    def note(stage: str, done: int, total: int) -> None:
        if stage == "compare":
            seen.append((done, total))

    found = cardume.compare(
        read(NOISY), LAWS, runs=50, progress=note, should_stop=lambda: bool(seen) and seen[-1][0] >= 8
    )
    assert found.is_interrupted
    assert 4 <= len(found.seeds) < 50
    assert found.values("cross_track_rms").shape == (2, len(found.seeds))
    assert np.isfinite(found.values("cross_track_rms")).all()
    assert seen[0] == (0, 100)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})


@pytest.mark.parametrize(
    ("seeds", "complaint"),
    [([], "no seeds are given"), ([1, 2, 1], "the seed 1 is given twice"), ([-1], "-1 is no seed")],
)
def test_seeds_that_cannot_be_flown(seeds: list[int], complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        check_seeds(seeds)


def test_numbers_of_numpy_are_seeds_and_fractions_are_not() -> None:
    assert cardume.compare(read(LINE), LAWS, seeds=np.arange(1, 3)).seeds == (1, 2)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        cardume.compare(read(LINE), LAWS, seeds=[1.5])  # type: ignore[list-item]


# ---- what is kept ----------------------------------------------------------------------------------------------------


def test_all_numbers_and_what_they_say_are_kept(noisy: Comparison, tmp_path: Path) -> None:
    target = tmp_path / "out"
    where, told = keep_comparison(
        choose_destination("x", target, read_comparison), "x", noisy, words=["so it is"], version="1", draw=None
    )
    assert where == target
    assert read_comparison(target) == told
    assert told["files"] == ["compare.csv", "compare.json"]
    assert told["conclusions"] == ["so it is"]
    assert told["arms"][1]["differences"]["cross_track_rms"]["size"] == 6
    rows = list(csv.DictReader((target / "compare.csv").open(encoding="utf-8")))
    assert [(row["arm"], row["seed"]) for row in rows[5:7]] == [("line_of_sight", "6"), ("arcsine", "1")]
    shown = [float(row["cross_track_rms [m]"]) for row in rows if row["arm"] == "arcsine"]
    assert (np.array(shown) == noisy.values("cross_track_rms")[1]).all()
    assert "coordination_error_rms" not in rows[0]  # one vehicle has none
    assert to_csv(noisy).count("\n") == 13


def test_a_second_comparison_takes_the_place_of_the_first_but_of_nothing_else(
    noisy: Comparison, tmp_path: Path
) -> None:
    target = tmp_path / "out"
    for _ in range(2):
        keep_comparison(choose_destination("x", target, read_comparison), "x", noisy, version="1")
    (target / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match=r"mine\.txt"):
        choose_destination("x", target, read_comparison)
    (target / "mine.txt").unlink()
    (target / "compare.json").write_text(json.dumps({"cardume_summary": 1}))
    with pytest.raises(InputError, match="not a run of cardume"):
        choose_destination("x", target, read_comparison)


def test_a_disk_that_fills_leaves_nothing(noisy: Comparison, tmp_path: Path) -> None:
    from cardume.missions.results import ResultsError

    def draw(folder: Path) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(ResultsError, match="full"):
        keep_comparison(choose_destination("x", tmp_path / "out", read_comparison), "x", noisy, version="1", draw=draw)
    assert list(tmp_path.iterdir()) == []
