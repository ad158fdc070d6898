"""The figures: drawn for any flight, the same for the same flight, and showing what they are to show."""

import os
import subprocess
import sys
import warnings
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cardume.report import style
from cardume.report.ellipse import LABEL
from cardume.report.error_panels import draw_errors
from cardume.report.figures import FIGURES, save_figures
from cardume.report.plan import draw_plan
from cardume.simulation.flight import Flight, Metrics
from report.synthetic import make_flight, with_certainty


@pytest.fixture(scope="module")
def flight() -> Flight:
    return make_flight(num_rows=351)


def texts(figure: Any) -> list[str]:
    import matplotlib.text

    return [text.get_text() for text in figure.findobj(matplotlib.text.Text) if text.get_text()]


def rows(flight: Flight, stop: int) -> Flight:
    """The flight's first rows only."""
    channels = {name: values[:stop] for name, values in flight.channels.items()}
    estimate = flight.neighbor_state_estimate[:stop]
    return replace(flight, times=flight.times[:stop], channels=channels, neighbor_state_estimate=estimate)


@cache
def odd_flights() -> dict[str, Flight]:
    """Flights that are no fun to draw."""
    good = make_flight(num_rows=51)
    lost = {name: np.where(np.arange(51)[:, None] > 30, np.nan, values) for name, values in good.channels.items()}
    still = {name: np.zeros_like(values) for name, values in good.channels.items()}
    point = np.zeros((2, 2))
    huge = {name: values * 1e7 for name, values in good.channels.items()}
    return {
        "no rows": rows(good, 0),
        "one row": rows(good, 1),
        "two rows": rows(good, 2),
        "lost halfway": replace(good, channels=lost, reason="failed"),
        "all lost": replace(good, channels={name: values * np.nan for name, values in good.channels.items()}),
        "standing still": replace(good, channels=still, reference_path=point, own_paths=(point,) * 3),
        "huge": replace(good, channels=huge),
        "no metrics": replace(good, metrics=Metrics()),
        "alone": make_flight(num_rows=51, names=("alone",)),
        "twenty": make_flight(num_rows=51, names=tuple(f"vehicle-{k}" for k in range(20))),
    }


@pytest.mark.parametrize("name", odd_flights())
@pytest.mark.parametrize("width", [3.5, 7.2])
def test_any_flight_can_be_drawn_without_a_murmur(name: str, width: float, caplog: pytest.LogCaptureFixture) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for draw in (draw_plan, draw_errors):
            draw(odd_flights()[name], width).canvas.draw()
    assert caplog.records == []


@pytest.mark.parametrize("figure", sorted(set(FIGURES) - {"plan", "errors"}))
@pytest.mark.parametrize("name", ["no rows", "lost halfway", "all lost", "standing still", "alone"])
def test_any_figure_can_be_drawn_without_a_murmur(figure: str, name: str, caplog: pytest.LogCaptureFixture) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        FIGURES[figure](odd_flights()[name], 3.5).canvas.draw()
    assert caplog.records == []


def test_the_same_flight_gives_the_same_files(flight: Flight, tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        save_figures(flight, tmp_path / name)
    names = sorted(os.listdir(tmp_path / "one"))
    assert names == ["errors.png", "errors.svg", "plan.png", "plan.svg"]
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name
        assert (tmp_path / "one" / name).stat().st_size < 1_000_000


def stretched(flight: Flight, north: float, east: float) -> Flight:
    """The same flight over a narrower area."""
    factors = {"north": north, "north_estimate": north, "east": east, "east_estimate": east}
    channels = {name: values * factors.get(name, 1.0) for name, values in flight.channels.items()}
    lines = [line * [north, east] for line in (flight.reference_path, *flight.own_paths)]
    return replace(flight, channels=channels, reference_path=lines[0], own_paths=tuple(lines[1:]))


@pytest.mark.parametrize(("north", "east"), [(1.0, 1.0), (0.01, 1.0), (1.0, 0.01)])
def test_north_is_up_and_scales_are_equal(flight: Flight, north: float, east: float) -> None:
    for width in (3.5, 7.2):
        figure = draw_plan(stretched(flight, north, east), width)
        figure.canvas.draw()
        axes = figure.axes[0]
        (x0, y0), (x1, y1) = axes.transData.transform([(0.0, 0.0), (10.0, 10.0)])
        assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-6)
        assert x1 > x0
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("east [m]", "north [m]")


def test_the_plan_shows_truth_beliefs_paths_and_starts(flight: Flight) -> None:
    axes = draw_plan(flight).axes[0]
    drawn = [np.column_stack([line.get_ydata(), line.get_xdata()]) for line in axes.lines]

    def has(north: np.ndarray, east: np.ndarray) -> bool:
        wanted = np.column_stack([north, east])
        return any(points.shape == wanted.shape and np.allclose(points, wanted) for points in drawn)

    for k in range(3):
        assert has(flight.channels["north"][:, k], flight.channels["east"][:, k])
        assert has(flight.channels["north_estimate"][:, k], flight.channels["east_estimate"][:, k])
        assert has(*flight.own_paths[k].T)
        assert has(flight.channels["north"][:1, k], flight.channels["east"][:1, k])


def test_nothing_is_drawn_outside_the_figure(flight: Flight) -> None:
    for draw in (draw_plan, draw_errors):
        for width in (3.5, 7.2):
            figure = draw(flight, width)
            figure.canvas.draw()
            drawn = figure.get_tightbbox(figure.canvas.get_renderer())
            assert min(drawn.x0, drawn.y0) >= 0.0, (draw.__name__, width)
            assert drawn.x1 <= width, (draw.__name__, width)
            assert drawn.y1 <= figure.get_figheight(), (draw.__name__, width)


def test_instants_are_round_times(flight: Flight) -> None:
    assert {"150 s", "300 s", "450 s", "600 s", "700 s"} <= set(texts(draw_plan(flight)))


def test_the_plan_shows_what_vehicles_expect_of_their_error(flight: Flight) -> None:
    """About the believed positions midway between 0, 150, 300, 450, 600 and 700 s: n' P^-1 n = 5.991, all around."""
    sure = with_certainty(flight)
    figure, plain = draw_plan(sure), draw_plan(flight)
    curves = [np.column_stack(line.get_data())[:, ::-1] for line in figure.axes[0].lines if line.get_lw() == 0.6]
    wanted = [(k, t) for k, first in ((1, 0), (2, 200)) for t in (74, 224, 374, 524, 650) if t >= first]
    assert len(curves) == len(wanted)
    for (k, time), curve in zip(wanted, curves, strict=True):
        now = {name: values[time // 2, k] for name, values in sure.channels.items()}
        away = curve - [now["north_estimate"], now["east_estimate"]]
        both = now["north_east_covariance"]
        matrix = np.array([[now["north_variance"], both], [both, now["east_variance"]]])
        np.testing.assert_allclose(np.einsum("pi,ij,pj->p", away, np.linalg.inv(matrix), away), 5.991, rtol=2e-4)
        np.testing.assert_allclose(np.ptp(away, axis=0), 2 * np.sqrt(5.991 * np.diag(matrix)), rtol=3e-3)
    assert LABEL in texts(figure)
    assert LABEL not in texts(plain)
    assert len(plain.axes[0].lines) == len(figure.axes[0].lines) - len(wanted)
    draw_plan(sure, 3.5).canvas.draw()


def test_the_current_is_shown_where_there_is_one(flight: Flight) -> None:
    assert "current 0.1 m/s" in texts(draw_plan(flight))
    still = {name: np.zeros_like(values) if "current" in name else values for name, values in flight.channels.items()}
    calm = replace(flight, channels=still)
    assert not any("current" in text for text in [*texts(draw_plan(calm)), *texts(draw_errors(calm))])


def test_panels_that_say_nothing_are_left_out(flight: Flight) -> None:
    assert len(draw_errors(flight).axes) == 5
    assert len(draw_errors(make_flight(num_rows=51, names=("alone",))).axes) == 4


def test_a_large_transient_does_not_flatten_the_rest(flight: Flight) -> None:
    far = flight.channels["cross_track"] + 50.0 * np.exp(-flight.times / 5.0)[:, None]
    figure = draw_errors(replace(flight, channels={**flight.channels, "cross_track": far}))
    assert figure.axes[0].get_ylim()[1] < 5.0
    assert any(text.startswith("before settling up to 5") for text in texts(figure))


def test_colors_can_be_told_apart_without_color_vision() -> None:
    """Brightness, and what deuteranopes and protanopes see (Vienot et al. 1999), keep the first six apart."""
    kinds = {
        "normal": np.eye(3),
        "protan": np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]]),
        "deutan": np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]]),
    }
    colors = [np.array([int(c[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0 for c in style.PALETTE[:6]]
    for name, seen in kinds.items():
        linear = [seen @ c**2.2 for c in colors]
        shown = [np.clip(c, 0, 1) ** (1 / 2.2) for c in linear]
        nearest = min(np.linalg.norm(a - b) for i, a in enumerate(shown) for b in shown[:i])
        assert nearest > 0.1, name


def test_a_user_s_own_style_is_neither_used_nor_changed() -> None:
    script = """
import matplotlib
matplotlib.rcParams["lines.linewidth"] = 9.0
matplotlib.rcParams["font.size"] = 30.0
matplotlib.rcParams["axes.facecolor"] = "red"
before = dict(matplotlib.rcParams)
from cardume.report.plan import draw_plan
from report.synthetic import make_flight
figure = draw_plan(make_flight(num_rows=51))
assert dict(matplotlib.rcParams) == before
assert figure.axes[0].xaxis.label.get_fontsize() == 8.0
assert figure.axes[0].get_facecolor() == (1.0, 1.0, 1.0, 1.0)
import sys
assert "matplotlib.pyplot" not in sys.modules
"""
    path = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
    done = subprocess.run([sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": path}, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()[-2000:]
