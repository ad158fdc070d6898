"""Table, sentences, figures and page of a study, from numbers made up for it."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import xarray

from cardume.report.study.blocks import study_blocks
from cardume.report.study.common import percent
from cardume.report.study.figures import STUDY_FIGURES, figures_that_matter, save_study_figure
from cardume.report.study.page.page import make_study_page
from cardume.report.study.table import study_table
from cardume.report.study.words import study_words
from cardume.studies.answers.results import Results
from studies.datasets import make_dataset

TEXTS = {"title": "study of <b>", "mission": "a: <i>\n"}
SCALE = "vehicles.starboard.sensors.thruster_speed.scale"


def rng(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def plain() -> xarray.Dataset:
    """One case of 200 runs: of the variance of one metric the current makes a half, of the other nothing."""
    draw = rng(1)
    speed, scale = draw.uniform(0.0, 0.3, 200), draw.normal(1.0, 0.1, 200)
    noise = 0.3 / np.sqrt(12.0) * draw.normal(size=200)
    metrics = {"cross_track_rms": 0.3 + speed + noise, "energy": draw.normal(3000.0, 30.0, 200)}
    status = np.ones(200, np.int8)
    status[7] = 2
    drawn = {"current.speed": (speed, "m/s"), SCALE: (scale, "")}
    required = ["cross_track_rms <= 0.6 m", "energy <= 3060 J"]
    return make_dataset(
        metrics, drawn=drawn, required=required, status=status, title="study of <b>", mission="a: <i>\n"
    )


def swept(laws: bool = False) -> xarray.Dataset:
    """A metric of two numbers, and of a law if wanted, with noise that all cases share."""
    period, loss = np.array([1.0, 2.0, 5.0, 20.0]), np.array([0.0, 0.25, 0.5])
    noise = 0.05 * rng(2).normal(size=(1, 1, 100))
    values = 0.3 + 0.03 * period[:, None, None] * (1.0 + 2.0 * loss[None, :, None]) + noise
    keys = {"messaging.period": (period, "s"), "acoustics.loss": (loss, "")}
    if not laws:
        return make_dataset({"formation_error_rms": values}, keys, required=["formation_error_rms <= 0.6 m"])
    more = np.stack([values[:, 0], values[:, 0] + 0.1])
    of_law = {"guidance": (["line_of_sight", "arcsine"], ""), "messaging.period": (period, "s")}
    return make_dataset({"formation_error_rms": more}, of_law, required=["formation_error_rms <= 0.6 m"])


STUDIES = {"plain": plain, "swept": swept, "laws": lambda: swept(laws=True)}


@pytest.mark.parametrize("width", [60, 80, 120])
@pytest.mark.parametrize("name", STUDIES)
def test_the_table_fits(name: str, width: int) -> None:
    text = study_table(STUDIES[name](), width)
    assert text.isascii()
    assert "nan" not in text
    assert max(map(len, text.splitlines())) <= max(width, 80)


def test_what_is_said_of_one_case() -> None:
    said = " ".join(study_words(plain()))
    results = Results(plain())
    met = int(results.all_met.sum())
    assert f"holds in {percent(met / 200)} of the missions" in said
    assert "1 mission failed in flight" in said
    assert "On cross_track_rms: current.speed makes" in said
    assert "more of it raises it" in said
    assert "No input has an influence on energy" in said
    assert "The worst run is seed 8: it failed in flight." in said
    required, *_ = study_blocks(results)
    assert required.rows[0][0] == "all of it"


def test_what_is_said_of_many_cases() -> None:
    said = " ".join(study_words(swept()))
    assert "12 cases with 100 runs each" in said
    assert re.search(r"surely in \d+ of 12 cases, surely not in \d+", said)
    assert "Along messaging.period it surely does from 1 s to 5 s with 0" in said


def test_laws_are_compared() -> None:
    said = " ".join(study_words(swept(laws=True)))
    assert "arcsine against line_of_sight: really worse in formation_error_rms (+" in said
    assert "real" in study_table(swept(laws=True), 80)


def test_few_runs_and_nothing_flown() -> None:
    few = swept().isel(run=slice(0, 20))
    assert "No case can be sure of it with fewer than 73 runs: fly more." in study_words(few)
    one = " ".join(study_words(swept().isel(run=slice(0, 1))))
    assert "of 12 cases, of one run each" in one
    none = swept()
    none["status"][:] = 0
    assert study_words(none) == ["Nothing was flown yet."]


def test_shares_are_not_rounded_to_all_or_nothing() -> None:
    assert [percent(share) for share in (0.0, 1.0, 0.99999, 1e-5, 0.5, float("nan"))] == [
        *("0 %", "100 %", "> 99.9 %", "< 0.01 %", "50 %", "-"),
    ]


def test_each_study_has_its_figures() -> None:
    found = {name: figures_that_matter(Results(make())) for name, make in STUDIES.items()}
    assert found["plain"] == ["distributions", "requirements", "influences"]
    assert found["swept"] == ["distributions", "requirements", "influences", "curves", "map"]
    assert found["laws"] == ["distributions", "requirements", "influences", "curves", "laws"]


def test_figures_are_the_same_every_time(tmp_path: Path) -> None:
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        for kind in ("svg", "png", "pdf"):
            save_study_figure(tmp_path / name / f"map.{kind}", STUDY_FIGURES["map"].draw(swept(), 7.2))
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    for file in files:
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "other" / file).read_bytes()


@pytest.mark.parametrize("name", ["influences", "distributions"])
def test_figures_fit_one_column_of_a_journal(name: str) -> None:
    figure = STUDY_FIGURES[name].draw(plain(), 3.46)
    assert figure.get_figwidth() == pytest.approx(3.46)


def test_the_page_holds_everything_and_runs_nothing_of_the_studys() -> None:
    page = make_study_page(plain())
    assert "<b>" not in re.search(r"<title>(.*?)</title>", page)[1]  # type: ignore[index]
    assert "a: &lt;i&gt;" in page
    (data,) = re.findall(r'<script type="application/json" id="report-data">(.*?)</script>', page, re.DOTALL)
    charts = json.loads(data)["charts"]
    assert {name.partition("-")[0] for name in charts} == {"distributions", "influences"}
    (bars, mean), limit = charts["distributions-0"]["data"], charts["distributions-0"]["layout"]["shapes"][-1]
    assert sum(bars["y"]) == 198  # one failed, and one lies apart, as the axis says
    assert charts["distributions-0"]["layout"]["yaxis"]["title"]["text"] == "runs, 1 further out"
    assert mean["x"][0] == pytest.approx(np.delete(plain()["fleet_cross_track_rms"].values, 7).mean(), rel=1e-5)
    assert limit["x0"] == 0.6


@pytest.mark.parametrize(
    ("typed", "sampling", "mission", "said"),
    [
        ("cardume study --runs 200 -o out line.yaml --set 'a=\"b c\"'", "monte_carlo", "a: 1\n", "--runs 200"),
        ("", "sobol", "a: 1\n", "--runs 200 --sampling sobol"),
        ("cardume study x --resume", "monte_carlo", "law: mine:straight\n", "--runs 200 --allow-code FOLDER"),
    ],
)
def test_what_flies_it_again_does_not_depend_on_how_it_was_typed(
    typed: str, sampling: str, mission: str, said: str
) -> None:
    study = plain().assign_attrs(command=typed, sampling=sampling, mission=mission)
    page = make_study_page(study)
    assert f"<pre>cardume study mission.yaml {said}</pre>" in page
    assert f"Seeds count from the one in the file, {study['run'].values[0]}:" in page


def test_stragglers_do_not_leave_the_bulk_a_single_bar() -> None:
    study = plain()
    study["fleet_cross_track_rms"][3] = 500.0
    (data,) = re.findall(r'id="report-data">(.*?)</script>', make_study_page(study), re.DOTALL)
    chart = json.loads(data)["charts"]["distributions-0"]
    bars = chart["data"][0]
    assert np.count_nonzero(bars["y"]) > 5
    assert max(bars["x"]) < 1.0


def test_the_pages_map_is_that_of_the_cases() -> None:
    data = re.findall(r'id="report-data">(.*?)</script>', make_study_page(swept()), re.DOTALL)[0]
    charts = json.loads(data)["charts"]
    chances = charts["map-0"]["data"][0]
    share = Results(swept()).all_met.mean(axis=-1)
    np.testing.assert_allclose(np.array(chances["z"]), 100.0 * share.T, atol=1e-3)  # loss upwards, period to the right
