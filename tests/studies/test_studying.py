"""Studies flown through the real engine: every number is that of the mission flown alone, however it was cut."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import cardume
from cardume.errors import InputError, MissionError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.studies import layout
from studies.missions import LINE, NOISY

DRAWN = "current.speed={uniform: [0 m/s, 0.2 m/s]}"
SWEPT = "guidance.lookahead={sweep: [2 m, 3 m, 5 m]}"
LAWS = "guidance={sweep: [{law: line_of_sight, lookahead: 2 m}, {law: arcsine, gain: 0.1}]}"
REQUIRED = "require={cross_track_rms: 0.5 m, a: {settling_time: 20 s}}"
SHORT = "duration=12 s"


def read(text: str, *overrides: str) -> Mission:
    return parse_mission(text, catalog(), overrides)


@pytest.fixture(scope="module")
def small() -> xarray.Dataset:
    """Three cases, ten runs each."""
    return cardume.study(read(NOISY, DRAWN, SWEPT, REQUIRED), 10, seed=5).load()


def test_every_number_is_that_of_the_mission_flown_alone(small: xarray.Dataset) -> None:
    for option in (2.0, 5.0):
        for seed in (5, 9, 14):
            mission = read(NOISY, DRAWN, REQUIRED, f"guidance.lookahead={option} m", f"seed={seed}")
            alone = cardume.fly(mission)
            run = small.sel({"guidance.lookahead": option, "run": seed})
            for name, value in alone.metrics.vehicles["a"].items():
                assert np.array_equal(run[name].sel(vehicle="a"), value, equal_nan=True), name
                assert np.array_equal(run[f"fleet_{name}"], value, equal_nan=True), name
            assert float(run["drawn.current.speed"]) == draw(mission).current.parameters["speed"]
            assert int(run["status"]) == layout.FLOWN


def test_cases_meet_the_same_seeds_and_the_same_draws(small: xarray.Dataset) -> None:
    assert small["run"].values.tolist() == list(range(5, 15))
    speeds = small["drawn.current.speed"].values
    assert (speeds == speeds[0]).all()
    assert len(set(speeds[0])) == 10
    assert small["guidance.lookahead"].values.tolist() == [2.0, 3.0, 5.0]


def test_requirements_say_what_was_got_and_whether_it_is_met(small: xarray.Dataset) -> None:
    assert small["requirement"].values.tolist() == ["cross_track_rms <= 0.5 m", "a: settling_time <= 20 s"]
    got = small["got"].values
    assert np.array_equal(got[..., 0], small["fleet_cross_track_rms"].values, equal_nan=True)
    assert np.array_equal(small["met"].values, got <= np.array([0.5, 20.0]))
    assert 0 < small["met"].values.sum() < small["met"].size


def test_the_data_set_says_what_it_is(small: xarray.Dataset) -> None:
    assert small["cross_track_rms"].dims == ("guidance.lookahead", "run", "vehicle")
    assert small["cross_track_rms"].attrs["units"] == "m"
    assert small["fleet_path_speed_mean"].attrs["wanted"] == "at least"
    assert small["guidance.lookahead"].attrs["units"] == "m"
    assert {small[name].attrs["role"] for name in small.data_vars} == {
        "drawn",
        "metric",
        "verdict",
        "failure",
        "status",
    }
    assert small.attrs["sampling"] == "monte_carlo"
    assert (small.attrs["seed"], small.attrs["runs"]) == (5, 10)
    again = parse_mission(small.attrs["mission"], catalog())
    assert again == read(NOISY, DRAWN, SWEPT, REQUIRED, "seed=5")


@pytest.mark.parametrize("work", [1.0, 1e5, 1e9])
@pytest.mark.parametrize("threads", [1, 2])
def test_no_cut_changes_a_bit(
    small: xarray.Dataset, monkeypatch: pytest.MonkeyPatch, work: float, threads: int
) -> None:
    monkeypatch.setattr(layout, "PORTION_WORK", work)
    monkeypatch.setattr(layout, "SMALLEST_PORTION", 3)
    found = cardume.study(read(NOISY, DRAWN, SWEPT, REQUIRED), 10, seed=5, threads=threads)
    xarray.testing.assert_identical(found.load(), small)


def test_laws_are_swept_by_their_names() -> None:
    found = cardume.study(read(NOISY, DRAWN, LAWS, SHORT), 2)
    assert found["guidance"].values.tolist() == ["line_of_sight", "arcsine"]
    assert found["met"].shape == (2, 2, 0)
    for law in ("{law: line_of_sight, lookahead: 2 m}", "{law: arcsine, gain: 0.1}"):
        alone = cardume.fly(read(NOISY, DRAWN, SHORT, f"guidance={law}", "seed=1"))
        run = found.sel(guidance=law.strip("{}").removeprefix("law: ").split(",")[0], run=1)
        assert float(run["fleet_cross_track_iae"]) == alone.metrics.worst("cross_track_iae")[0]


def test_choices_are_told_in_words_and_numbers_as_numbers() -> None:
    choice = "guidance={choose: [line_of_sight, {law: arcsine, gain: {uniform: [0.1, 0.2]}}]}"
    found = cardume.study(read(NOISY, "current.speed={choose: [0 m/s, 0.1 m/s]}", choice, SHORT), 12)
    laws, gains = found["drawn.guidance"].values, found["drawn.guidance.gain"].values
    assert set(laws) == {"line_of_sight", "arcsine"}
    assert np.array_equal(np.isnan(gains), laws == "line_of_sight")
    assert set(found["drawn.current.speed"].values) == {0.0, 0.1}


def test_samplings_draw_what_their_chances_say() -> None:
    for sampling in ("latin_hypercube", "sobol"):
        found = cardume.study(read(NOISY, DRAWN, SWEPT, SHORT), 8, sampling=sampling)
        chances, speeds = found["chance.current.speed"].values, found["drawn.current.speed"].values
        assert sorted((chances * 8).astype(int)) == list(range(8))
        assert speeds == pytest.approx(np.broadcast_to(0.2 * chances, speeds.shape), rel=1e-15)


@pytest.mark.parametrize(
    ("overrides", "given", "said"),
    [
        ((), {"runs": 5}, "nothing varies.*--set 'current.speed"),
        ((SWEPT,), {"runs": 5}, "within a case nothing varies.*--runs 1"),
        ((DRAWN,), {"runs": 0}, "give at least 1"),
        ((DRAWN,), {"runs": -3}, "give at least 1"),
        ((DRAWN,), {"runs": 10**12}, "more missions than a study may have"),
        ((DRAWN,), {"runs": None}, "--runs 1000"),
        ((DRAWN,), {"runs": 5, "seed": 2**63 - 3}, "beyond the largest seed"),
        ((DRAWN,), {"runs": 5, "sampling": "halton"}, "valid are monte_carlo"),
        ((DRAWN,), {"runs": 5, "workers": 0}, "whole number from 1"),
        ((DRAWN,), {"runs": 5, "workers": 2, "scheduler": "tcp://here:1"}, "give one of them"),
        (("guidance.lookahead={sweep: [2 m, 2 m]}",), {"runs": 1}, "stands in the sweep twice"),
        (
            ("guidance.lookahead={linspace: [1 m, 5 m, 400]}", "current.speed={linspace: [0, 0.1, 400]}"),
            {"runs": 1},
            "160000 cases",
        ),
    ],
)
def test_what_cannot_be_studied_is_refused(overrides: tuple[str, ...], given: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        cardume.study(read(LINE, SHORT, *overrides), **given)


def test_a_sweep_of_what_is_not_random_is_flown_once_each() -> None:
    found = cardume.study(read(LINE, SWEPT), 1)
    assert found.sizes["run"] == 1
    assert len(set(found["fleet_cross_track_rms"].values[:, 0])) == 3


def test_noise_alone_is_enough(tmp_path: Path) -> None:
    notes: list[str] = []
    found = cardume.study(read(NOISY, SHORT), 3, announce=lambda forecast: notes.extend(forecast.notes))
    assert len(set(found["fleet_cross_track_iae"].values)) == 3
    assert "noise and lost messages alone" in notes[0]


def test_more_than_fits_on_the_disk_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cardume.studies.beginning.bytes_free", lambda place: 100_000)
    with pytest.raises(InputError, match=r"takes up to .* and 100 kB are free"):
        cardume.study(read(NOISY, DRAWN, SHORT), 5, directory=tmp_path / "it")
    assert not list(tmp_path.iterdir())


def test_a_stop_keeps_what_was_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layout, "PORTION_WORK", 1.0)
    monkeypatch.setattr(layout, "SMALLEST_PORTION", 2)
    done = []

    def progress(stage: str, some: int, total: int) -> None:
        done.append((stage, some, total))

    stop: Callable[[], bool] = lambda: any(stage == "study" and some >= 4 for stage, some, _ in done)  # noqa: E731
    found = cardume.study(read(NOISY, DRAWN, SHORT), 10, progress=progress, should_stop=stop)
    flown = found["status"].values == layout.FLOWN
    assert flown.sum() in (2, 4)
    assert flown[: flown.sum()].all()
    assert np.isnan(found["fleet_cross_track_iae"].values[~flown]).all()
    assert ("study", 0, 10) in done


TICKS = ("tick={choose: [0.1 s, 0.05 s]}", "plant_step={choose: [0.05 s, 0.1 s]}")


def fits(mission: Mission, seed: int) -> bool:
    """Whether the values that a seed draws can be flown."""
    try:
        draw(mission, seed)
    except MissionError:
        return False
    return True


def test_a_run_whose_values_do_not_fit_is_refused_and_not_the_study() -> None:
    """A quarter of the draws: a tick of 0.05 s is no whole multiple of a plant step of 0.1 s."""
    mission = read(NOISY, *TICKS, SHORT)
    start = next(seed for seed in range(100) if not fits(mission, seed))  # not even the first that is tried
    found = cardume.study(mission, 12, seed=start)
    for place, seed in enumerate(range(start, start + 12)):
        run, why, plain = found.isel(run=place), "", mission
        try:
            plain = draw(mission, seed)
        except MissionError as problem:
            why = str(problem)
        assert ("must be a whole multiple" in str(run["failure"].values)) == bool(why)
        assert run["status"] == (layout.REFUSED if why else layout.FLOWN)
        alone = np.nan if why else cardume.fly(plain).metrics.worst("cross_track_iae")[0]
        assert np.array_equal(run["fleet_cross_track_iae"], alone, equal_nan=True)
    assert set(found["status"].values) == {layout.FLOWN, layout.REFUSED}


def test_a_run_that_cannot_be_planned_is_refused_and_not_the_study() -> None:
    """Within a circle of 20 m a vehicle cannot be 30 m to starboard of it; the first run is such a one."""
    around = [
        "path={type: circle, radius: 20 m, centre: {north: 0 m, east: 0 m}}",
        "vehicles.a.offset.starboard={choose: [0 m, 30 m]}",
        "duration=8 s",
    ]
    mission = read(NOISY, *around)
    start = next(seed for seed in range(100) if draw(mission, seed).vehicles[0].offset.starboard)
    found = cardume.study(mission, 10, seed=start)
    is_outside = found["drawn.vehicles.a.offset.starboard"].values == 0.0
    assert np.array_equal(found["status"].values, np.where(is_outside, layout.FLOWN, layout.REFUSED))
    assert 0 < is_outside.sum() < 10
    assert found["status"][0] == layout.REFUSED


def test_a_case_that_does_not_fit_is_refused_and_not_the_study() -> None:
    swept = [override.replace("choose", "sweep") for override in TICKS]
    found = cardume.study(read(NOISY, *swept, SHORT), 3)
    assert (found["status"].values == layout.REFUSED).all(axis=-1).tolist() == [[False, False], [False, True]]
    assert "whole" in found["failure"].values[1, 1, 0]


LOST = """
from cardume.compiler import where
from cardume.maths import sqrt
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError

@guidance_law
def lost(error: PathError) -> float:
    '''Lost.

    Source: own.
    '''
    return where(error.cross_track < 2.9, sqrt(-error.cross_track), error.path_course - 1.0)
"""


def test_a_mission_that_fails_in_flight_says_when_and_why(tmp_path: Path) -> None:
    (tmp_path / "law_that_is_lost.py").write_text(LOST)
    laws = "guidance={choose: [line_of_sight, {law: 'law_that_is_lost:lost'}]}"
    (tmp_path / "mission.yaml").write_text(NOISY)
    how = {"overrides": [laws, SHORT, REQUIRED], "allow_code": [tmp_path]}
    found = cardume.study(tmp_path / "mission.yaml", 12, seed=1, **how)
    is_lost = found["drawn.guidance"].values != "line_of_sight"
    assert 0 < is_lost.sum() < 12
    assert np.array_equal(found["status"].values, np.where(is_lost, layout.FAILED, layout.FLOWN))
    assert all("reference of vehicle a" in why for why in found["failure"].values[is_lost])
    assert (found["failed_at"].values[is_lost] > 0.0).all()
    assert np.isnan(found["failed_at"].values[~is_lost]).all()
    assert np.isnan(found["fleet_cross_track_iae"].values[is_lost]).all()
    assert not found["met"].values[is_lost].any()
