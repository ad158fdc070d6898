"""The figures for papers: from a log in xarray as from a flight, showing the numbers that they are said to show."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib.collections
import numpy as np
import pytest
import xarray

from cardume.errors import DataError
from cardume.report.command_panels import draw_commands
from cardume.report.figures import FIGURES, save_figure
from cardume.report.limits import limits_of
from cardume.report.logs import as_flight, limits_in
from cardume.report.message_lanes import draw_messages
from cardume.simulation.flight import CHANNELS, Flight
from report.runs import kept_run, make_run
from report.synthetic import make_flight


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log on disk."""
    return kept_run(tmp_path_factory.mktemp("kept") / "run", make_flight(num_rows=71)) / "log.nc"


def drawn(figure: Any) -> list[np.ndarray]:
    """All lines of a figure, point by point."""
    lines = [np.column_stack(line.get_data()) for axes in figure.axes for line in axes.lines]
    segments = [
        np.concatenate(found.get_segments()) if len(found.get_segments()) else np.zeros((0, 2))
        for axes in figure.axes
        for found in axes.collections
        if isinstance(found, matplotlib.collections.LineCollection)
    ]
    return [*lines, *segments]


@pytest.mark.parametrize("name", FIGURES)
def test_a_log_in_xarray_is_drawn_as_the_flight_itself(log: Path, name: str) -> None:
    with xarray.open_dataset(log) as dataset:
        found = drawn(FIGURES[name](dataset, 3.5))
    wanted = drawn(FIGURES[name](make_flight(num_rows=71), 3.5))
    assert len(found) == len(wanted)
    for first, second in zip(found, wanted, strict=True):
        np.testing.assert_array_equal(first, second)


def test_a_selection_is_drawn_as_it_was_selected(log: Path) -> None:
    whole = make_flight(num_rows=71)
    with xarray.open_dataset(log) as dataset:
        part = as_flight(dataset.sel(vehicle=["starboard", "surface"], time=slice(100, 300)))
        one = as_flight(dataset.sel(vehicle="port"))
    rows = (whole.times >= 100) & (whole.times <= 300)
    assert part.vehicle_names == ("starboard", "surface")
    for channel in CHANNELS:
        np.testing.assert_array_equal(part.channels[channel], whole.channels[channel][rows][:, [2, 0]])
        np.testing.assert_array_equal(one.channels[channel][:, 0], whole.channels[channel][:, 1])
    np.testing.assert_array_equal(part.own_paths[0], whole.own_paths[2])
    sent = part.messages["time_sent"]
    assert (100 <= sent).all()
    assert (sent <= 300).all()
    pairs = {(int(a), int(b)) for a, b in zip(part.messages["sender"], part.messages["receiver"], strict=True)}
    assert pairs == {(0, 1), (1, 0)}  # starboard and the surface vehicle, by their new places


@pytest.mark.parametrize("given", [{"north": 1}, xarray.Dataset({"depth": ("time", [1.0])})])
def test_what_is_no_log_is_refused(given: Any) -> None:
    with pytest.raises(DataError, match=r"Flight, a Run, or a log opened in xarray|time, north and east"):
        as_flight(given)


def mission(thrust: Any, shaft: Any = 471.0) -> Any:
    laws = {"autopilot": {"thrust_max": thrust, "yaw_moment_max": 10.0}, "model": {"max_shaft_speed": shaft}}
    vehicle = SimpleNamespace(**{name: SimpleNamespace(parameters=values) for name, values in laws.items()})
    return SimpleNamespace(vehicles=(vehicle, vehicle))


def test_limits_come_from_the_mission() -> None:
    found = limits_of(mission(72.0))
    assert found["thrust"] == (72.0, 72.0)
    assert found["shaft_speed_rpm"][0] == pytest.approx(471.0 * 60.0 / (2.0 * np.pi), rel=1e-12)
    assert set(limits_of(mission(None))) == {"yaw_moment", "shaft_speed_rpm"}
    assert limits_of(None) == {}


def test_commands_are_drawn_with_their_limits() -> None:
    flight = make_flight(num_rows=71)
    used = {name: np.full_like(flight.channels[name], 50.0) for name in ("thrust", "yaw_moment", "shaft_speed_rpm")}
    run = replace(make_run(replace(flight, channels={**flight.channels, **used})), mission=mission(72.0))
    assert limits_in(run)["thrust"] == (72.0, 72.0)
    axes = {a.get_ylabel(): a for a in draw_commands(run).axes}
    levels = {label: {round(float(line.get_ydata()[0]), 6) for line in a.lines} for label, a in axes.items()}
    assert 72.0 in levels["thrust\n[N]"]
    assert -72.0 not in levels["thrust\n[N]"]  # nothing was near it
    assert all(abs(level) < 4000 for level in levels["shafts\n[rpm]"])  # 4498 rpm is told above, and far away
    assert any("4498 rpm either way" in a.get_title(loc="left") for a in axes.values())


def test_every_message_is_drawn_once_delivered_up_lost_down() -> None:
    flight: Flight = make_flight(num_rows=71)
    axes = draw_messages(flight).axes[0]
    ups, downs = [], []
    for found in axes.collections:
        for (x, start), (_, end) in found.get_segments():
            (ups if end < start else downs).append(x)
    lost = flight.messages["lost"] > 0.5
    np.testing.assert_array_equal(np.sort(downs), np.sort(flight.messages["time_sent"][lost]))
    np.testing.assert_array_equal(np.sort(ups), np.sort(flight.messages["time_sent"][~lost]))


@pytest.mark.parametrize("kind", ["svg", "pdf", "png"])
def test_the_same_run_gives_the_same_bytes(tmp_path: Path, kind: str) -> None:
    for name in ("one", "two"):
        save_figure(tmp_path / f"{name}.{kind}", "coordination", make_flight(num_rows=71), 3.5)
    assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.{kind}").read_bytes()
