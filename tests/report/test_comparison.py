"""The table, the sentences and the figure of a comparison, from numbers made up for it."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cardume.report.comparison_figure import save_comparison
from cardume.report.comparison_table import comparison_table, decimals_for, shortened
from cardume.report.comparison_words import conclusions
from cardume.studies.arms import Arm
from cardume.studies.comparing import Comparison
from cardume.studies.run_table import RunTable
from cardume.studies.statistics import Estimate


def make_comparison(labels: list[str], columns: dict[str, np.ndarray], **changes: Any) -> Comparison:
    """Runs whose metrics are (arm, seed) arrays."""
    mission: Any = SimpleNamespace(vehicles=(SimpleNamespace(name="a"), SimpleNamespace(name="b")))
    arms = tuple(Arm(label, mission, "mission.yaml", (f"key={label}",)) for label in labels)
    count = next(iter(columns.values())).shape[1]
    runs = tuple(
        make_runs(count, {f"fleet_{name}": of[k].astype(float) for name, of in columns.items()})
        for k in range(len(labels))
    )
    made = Comparison(arms, ("key",), tuple(range(1, count + 1)), count, tuple(columns), runs)
    return replace(made, **changes)


def make_runs(count: int, metrics: dict[str, np.ndarray]) -> RunTable:
    """Runs in which nothing is required and nothing failed."""
    none = np.zeros((count, 0))
    well = ("",) * count
    return RunTable(
        np.arange(1, count + 1), {}, metrics, (), none, none.astype(bool), np.full(count, np.nan), well, none
    )


def noise(seed: int, mean: float, deviation: float, count: int = 20) -> np.ndarray:
    return np.random.default_rng(seed).normal(mean, deviation, count)


@pytest.fixture
def three() -> Comparison:
    weather = noise(1, 0.3, 0.03)
    columns = {
        "cross_track_rms": np.array([weather, weather + noise(2, -0.05, 0.01), weather + noise(3, 0.2, 0.01)]),
        "settling_time": np.array([noise(4, 40.0, 5.0), noise(5, 40.0, 5.0), np.full(20, np.nan)]),
        "path_speed_mean": np.array([noise(6, 0.5, 0.01), noise(7, 0.6, 0.01), noise(8, 0.5, 0.01)]),
    }
    columns["settling_time"][1, :3] = np.nan
    return make_comparison(["first", "second", "a third one with a very long name, longer than its column"], columns)


@pytest.mark.parametrize("width", [60, 80, 100, 120])
def test_the_table_fits(three: Comparison, width: int) -> None:
    text = comparison_table(three, width)
    assert text.isascii()
    assert max(map(len, text.splitlines())) <= max(width, 76)
    assert "nan" not in text


def test_the_table_says_what_is_real_and_how_many_have_a_number(three: Comparison) -> None:
    lines = comparison_table(three, 120).splitlines()
    rows = [line.split() for line in lines]
    first, second, third = rows[4:7]
    assert first[0] == "first"
    assert second[-1] == "real"
    assert third[-1] == "real"
    assert "%" in second
    settled = rows[8:11]
    assert settled[1][5] == "17"  # of 20
    assert settled[2][-3:-1] != ["real"]
    assert any("of 20: runs that have the number" in line for line in lines)


def test_better_and_worse_depend_on_what_is_wanted(three: Comparison) -> None:
    second, third, *lost = conclusions(three)
    assert lost == [
        f"{label} did not settle on its path in {count} of 20 missions: most numbers are missing there."
        for label, count in (("second", 3), (three.labels[2], 20))
    ]
    assert "second against first: really better in cross_track_rms (-" in second
    assert "path_speed_mean (+18 %)" in second  # at least is wanted
    assert "20 seeds show no difference in settling_time." in second
    assert "really worse in cross_track_rms (+" in third
    assert "settling_time" not in third  # nothing is known of it


def test_what_only_one_interval_says_is_no_more_than_a_maybe() -> None:
    values = {name: np.array([noise(1, 1.0, 0.1), noise(1, 1.0, 0.1)]) for name in ("energy", "yaw_effort")}
    shift = noise(9, 0.0, 0.1)
    values["energy"][1] += shift - shift.mean() + 2.3 * shift.std(ddof=1) / np.sqrt(20)  # t = 2.3: between the two
    made = make_comparison(["one", "other"], values)
    assert made.is_real["energy"] == (False,)
    assert "maybe" in comparison_table(made, 80)
    assert "perhaps different in energy" in conclusions(made)[0]


def test_failures_interruptions_and_requirements_are_told(three: Comparison) -> None:
    runs = list(three.runs)
    failure = ("",) * 4 + ("the state of vehicle a was no number at 3 s",) + ("",) * 15
    runs[1] = replace(runs[1], failure=failure)
    runs[0] = replace(runs[0], requirements=("a <= 1 m",), met=np.ones((20, 1), bool))
    made = replace(three, asked=50, runs=tuple(runs))
    said = [sentence for sentence in conclusions(made) if "settle" not in sentence or "seeds show" in sentence]
    assert said[0] == "Interrupted: all arms were flown with 20 of 50 seeds."
    assert said[-1] == "second failed in 1 of 20 missions; with seed 5 the state of vehicle a was no number at 3 s."
    table = comparison_table(made, 80)
    assert "required, met in" in table
    assert "84 to 100 %" in table


def test_many_arms_are_not_all_told_in_words() -> None:
    made = make_comparison([f"arm {k}" for k in range(12)], {"energy": np.array([noise(k, k, 0.1) for k in range(12)])})
    assert conclusions(made)[6] == "Of 5 more arms the table tells."


def test_digits_follow_the_interval() -> None:
    assert decimals_for([Estimate(3115.0, 3098.0, 3132.0, 20)]) == 0
    assert decimals_for([Estimate(0.317, 0.304, 0.331, 20)]) == 3
    assert decimals_for([Estimate(0.5, 0.5, 0.5, 2)]) == 4
    assert decimals_for([Estimate(np.nan, np.nan, np.nan, 0)]) == 3
    assert decimals_for([Estimate(0.0, 0.0, 0.0, 5)]) == 3


def test_long_labels_keep_both_ends() -> None:
    assert shortened("line_of_sight", 20) == "line_of_sight"
    assert shortened("abcdefghijklmnop", 9) == "abcd..nop"
    assert len(shortened("x" * 50, 12)) == 12


def test_the_figure_is_the_same_every_time(three: Comparison, tmp_path: Path) -> None:
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        save_comparison(three, tmp_path / name)
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert files == ["compare.png", "compare.svg"]
    for file in files:
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "other" / file).read_bytes()
    svg = (tmp_path / "one" / "compare.svg").read_text(encoding="utf-8")
    assert svg.count("<svg") == 1


def test_a_figure_of_one_seed_and_many_arms_can_be_drawn(tmp_path: Path) -> None:
    values = {name: np.arange(40.0).reshape(40, 1) for name in ("energy", "yaw_effort", "settling_time")}
    values["settling_time"][:] = np.nan
    save_comparison(make_comparison([f"arm {k}" for k in range(40)], values), tmp_path)
