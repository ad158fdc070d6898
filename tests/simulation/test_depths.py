"""Depths that change: over time, along the path, and above a seabed that only the altimeter tells of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cardume.missions.available import catalog
from cardume.missions.flying import fly_mission
from cardume.missions.loading import parse_mission
from cardume.simulation.flight import Flight

HEAD = """
cardume: 1
name: depths
duration: {duration} s
log_period: 0.5 s
path: {{type: line, length: 300 m}}
formation: {{speed: 0.5 m/s}}
model: {model}
"""


def flown(text: str, duration: float = 200.0, model: str = "medusa", directory: Path | str = ".") -> Flight:
    whole = HEAD.format(duration=duration, model=model) + text
    return fly_mission(parse_mission(whole, catalog(), directory=directory))


def column(flight: Flight, name: str) -> np.ndarray:
    return flight.channels[name][:, 0]


def test_a_profile_over_time_and_one_along_the_path_are_kept_exactly_by_a_kinematic_vehicle() -> None:
    start = "vehicles: [{name: alone, start: {speed: 0.5 m/s}, depth: {profile: "
    points = "points: [[10, 5], [30, 15], [40, 15]]}}]\n"
    over_time = flown(f"{start}time, {points}", 60.0, "kinematic")
    wanted = np.interp(over_time.times - 0.1, [10.0, 30.0, 40.0], [5.0, 15.0, 15.0])  # asked for in the tick before
    assert abs(column(over_time, "depth") - wanted)[1:].max() < 1e-9
    on_path = flown(f"{start}path, {points}", 90.0, "kinematic")
    state = column(on_path, "coordination_state")
    assert abs(column(on_path, "depth_desired") - np.interp(state, [10.0, 30.0, 40.0], [5.0, 15.0, 15.0])).max() < 1e-9


def test_medusa_follows_a_profile_of_depth() -> None:
    flight = flown(
        "vehicles: [{name: alone, sensors: {gnss: {deepest: 99 m}}, start: {speed: 0.5 m/s},"
        " depth: {profile: path, points: [[20, 5], [70, 12]]}}]\n"
    )
    lag = column(flight, "depth_desired") - column(flight, "depth")
    assert abs(lag).max() < 0.07 / 0.25 + 0.1  # w / k on a ramp of 0.07 m/s, and a swing
    assert abs(lag[-20:]).max() < 0.12


RAMP = "bathymetry: {type: slope, depth: 14 m, gradient: -0.04}\n"  # 0.02 m/s upwards
SURVEYOR = (
    "vehicles: [{name: alone, depth: 6 m, altitude: 4 m, start: {speed: 0.5 m/s},"
    " sensors: {gnss: {deepest: 99 m}%s}}]\n"
)


def test_medusa_keeps_its_altitude_over_a_ramp() -> None:
    flight = flown(RAMP + SURVEYOR % "")
    altitude = column(flight, "altitude")
    settled = flight.times > 60.0
    assert abs(altitude[settled] - 4.0).max() < 0.3
    assert abs(np.mean(altitude[settled]) - 4.0) < 0.12
    assert flight.metrics.vehicles["alone"]["altitude_min"] > 3.0
    assert np.ptp(column(flight, "depth")[settled]) > 2.0  # it did climb


def test_a_bias_of_the_altimeter_is_kept_as_altitude_so_no_truth_leaks() -> None:
    ramp = "bathymetry: {type: flat, depth: 14 m}\n"
    plain, biased = flown(ramp + SURVEYOR % ""), flown(ramp + SURVEYOR % ", altimeter: {bias: 0.7 m}")
    difference = column(biased, "altitude")[-1] - column(plain, "altitude")[-1]
    assert difference == pytest.approx(-0.7, abs=0.05)


def test_medusa_follows_a_gridded_seabed(tmp_path: Path) -> None:
    """A ridge of 3 m, 60 m wide, across the path."""
    norths = np.arange(-50.0, 401.0, 10.0)
    depths = 14.0 - 3.0 * np.exp(-(((norths - 60.0) / 20.0) ** 2))
    rows = "\n".join(f"{d} {d} {d}" for d in depths[::-1])
    text = f"ncols 3\nnrows {len(norths)}\nxllcenter -50\nyllcenter -50\ncellsize 10\nNODATA_value -1\n{rows}\n"
    (tmp_path / "ridge.asc").write_text(text.replace("-50\nyll", "-10\nyll"))
    flight = flown("bathymetry: {type: gridded, file: ridge.asc}\n" + SURVEYOR % "", directory=tmp_path)
    altitude, settled = column(flight, "altitude"), flight.times > 50.0
    steepest = 3.0 / 20.0 * np.sqrt(2.0 / np.e) * 0.5  # [m/s]
    assert abs(altitude[settled] - 4.0).max() < steepest * (4.0 + 1.0) + 0.3  # lag of loop and filter, and noise
    assert flight.metrics.vehicles["alone"]["altitude_min"] > 3.0


def test_without_an_echo_it_keeps_the_depth_it_had(tmp_path: Path) -> None:
    """From 50 m to 80 m along the path the seabed falls out of the altimeter's reach."""
    norths = np.arange(-50.0, 401.0, 5.0)
    depths = np.where((norths > 47.0) & (norths < 83.0), 60.0, 14.0)
    rows = "\n".join(" ".join([str(d)] * 9) for d in depths[::-1])
    header = f"ncols 9\nnrows {len(norths)}\nxllcenter -20\nyllcenter -50\ncellsize 5\n"
    (tmp_path / "gap.asc").write_text(f"{header}{rows}\n")
    nearsighted = SURVEYOR % ", altimeter: {range: 11 m}"
    flight = flown("bathymetry: {type: gridded, file: gap.asc}\n" + nearsighted, directory=tmp_path)
    north, depth = column(flight, "north"), column(flight, "depth")
    lost = (north > 53.0) & (north < 77.0)
    kept = column(flight, "depth_desired")[lost]
    assert np.ptp(kept) == 0.0
    assert 10.0 < kept[0] < 17.0  # the last echoes came from the edge, at most 21 m deep
    assert abs(depth[lost][-10:] - kept[0]).max() < 0.2
    assert abs(depth[-20:] - 10.0).max() < 0.3  # the echo came back


def test_before_the_first_echo_it_keeps_the_depth_of_the_mission() -> None:
    flight = flown("bathymetry: {type: flat, depth: 100 m}\n" + SURVEYOR % "", 40.0)
    assert (column(flight, "depth_desired") == 6.0).all()


def test_a_limit_of_depth_holds_a_vehicle_that_follows_the_seabed_down() -> None:
    falling = "bathymetry: {type: slope, depth: 9 m, gradient: 0.05}\nlimits: {depth: 8 m}\nphases: {hold: 0 s}\n"
    flight = flown(falling + SURVEYOR % "")
    assert column(flight, "depth_desired").max() == 8.0
    assert flight.metrics.vehicles["alone"]["depth_max"] < 8.2
