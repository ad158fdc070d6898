"""The log: what goes in comes out, other programs can read it, and a damaged one says so."""

import math
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray
from netCDF4 import Dataset

from cardume.errors import DataError
from cardume.missions.log import MESSAGES, PATHS, VARIABLES, read_log, write_log
from cardume.simulation.flight import CHANNELS, MESSAGE_COLUMNS, Flight
from report.synthetic import make_flight

SOME_UNITS = {"north": "m", "yaw_rate": "rad/s", "curvature": "1/m", "yaw_moment": "N m", "shaft_speed_rpm": "rpm"}
MISSION = "cardume: 1\nname: figure-5  # São Jacinto\n"


@pytest.fixture(scope="module")
def flight() -> Flight:
    return make_flight()


@pytest.fixture
def log(tmp_path: Path, flight: Flight) -> Path:
    write_log(tmp_path / "log.nc", flight, mission=MISSION, version="0.1.0")
    return tmp_path / "log.nc"


def test_every_number_comes_back_as_it_was(log: Path, flight: Flight) -> None:
    mission, version, back = read_log(log)
    assert (mission, version) == (MISSION, "0.1.0")
    assert set(back.channels) == set(CHANNELS)
    for name in CHANNELS:
        assert type(back.channels[name]) is np.ndarray  # not masked
        assert back.channels[name].tobytes() == np.ascontiguousarray(flight.channels[name], "f8").tobytes(), name
    for name in MESSAGE_COLUMNS:
        np.testing.assert_array_equal(back.messages[name], flight.messages[name])
    np.testing.assert_array_equal(back.times, flight.times)
    np.testing.assert_array_equal(back.neighbor_state_estimate, flight.neighbor_state_estimate)
    np.testing.assert_array_equal(back.reference_path, flight.reference_path)
    assert len(back.own_paths) == 3
    for mine, theirs in zip(back.own_paths, flight.own_paths, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    said = ("mission_name", "seed", "vehicle_names", "reason", "failure", "flown")
    assert [getattr(back, name) for name in said] == [getattr(flight, name) for name in said]


def test_nan_infinity_and_the_library_s_own_fill_value_come_back(tmp_path: Path, flight: Flight) -> None:
    odd = np.zeros_like(flight.channels["north"])
    odd[:4, 0] = [math.nan, math.inf, -math.inf, 9.969209968386869e36]
    changed = replace(flight, channels={**flight.channels, "thrust": odd}, reason="failed", failure="port, surge")
    write_log(tmp_path / "log.nc", changed, mission=MISSION, version="0.1.0")
    back = read_log(tmp_path / "log.nc").flight
    np.testing.assert_array_equal(back.channels["thrust"], odd)
    assert (back.reason, back.failure) == ("failed", "port, surge")


def test_a_flight_stopped_at_once_has_a_log(tmp_path: Path, flight: Flight) -> None:
    nothing = replace(
        flight,
        times=flight.times[:0],
        channels={name: values[:0] for name, values in flight.channels.items()},
        neighbor_state_estimate=flight.neighbor_state_estimate[:0],
        messages={name: values[:0] for name, values in flight.messages.items()},
        reason="interrupted",
        flown=0.0,
    )
    write_log(tmp_path / "log.nc", nothing, mission=MISSION, version="0.1.0")
    back = read_log(tmp_path / "log.nc").flight
    assert len(back.times) == 0
    assert back.channels["north"].shape == (0, 3)
    assert len(back.messages["lost"]) == 0


def test_xarray_opens_it_and_everything_says_what_it_is(log: Path, flight: Flight) -> None:
    with xarray.open_dataset(log) as data:
        assert dict(data.sizes) == {"time": 701, "vehicle": 3, "neighbor": 3}
        assert set(data.variables) == set(VARIABLES) == {*CHANNELS, "neighbor_state_estimate", *data.sizes}
        for name, variable in data.variables.items():
            assert variable.attrs["units"] == VARIABLES[str(name)].units, name
            assert variable.attrs["long_name"], name
        assert {name: data[name].units for name in SOME_UNITS} == SOME_UNITS
        assert np.isnan(data.north.encoding["_FillValue"])
        assert "_FillValue" not in data.time.encoding
        assert data.north.dims == ("time", "vehicle")
        assert data.neighbor_state_estimate.dims == ("time", "vehicle", "neighbor")
        assert data.time.dtype == np.float64  # seconds, not made into dates
        assert float(data.north.sel(vehicle="port", time=100.0)) == flight.channels["north"][100, 1]
        assert data.attrs["mission"] == MISSION
        assert (data.attrs["seed"], data.attrs["version"], data.attrs["reason"]) == (7, "0.1.0", "completed")
    for group, meanings in (("messages", MESSAGES), ("paths", PATHS)):
        with xarray.open_dataset(log, group=group) as data:
            assert set(data.variables) == set(meanings)
            assert all(data[name].attrs["long_name"] and data[name].attrs["units"] for name in meanings)
    with xarray.open_dataset(log, group="messages") as data:
        assert data.sender.attrs["flag_meanings"].split() == list(flight.vehicle_names)
        assert np.isnan(data.time_received.values[data.lost.values == 1]).all()


def test_the_same_flight_gives_the_same_bytes(log: Path, flight: Flight) -> None:
    first = log.read_bytes()
    time.sleep(1.1)  # HDF5 can write times of change, in seconds
    write_log(log, flight, mission=MISSION, version="0.1.0")
    assert log.read_bytes() == first


def test_a_large_seed_and_a_mission_longer_than_an_attribute_of_hdf5(tmp_path: Path, flight: Flight) -> None:
    mission = MISSION + "# long\n" * 20_000
    write_log(tmp_path / "log.nc", replace(flight, seed=2**63 - 1), mission=mission, version="0.1.0")
    back = read_log(tmp_path / "log.nc")
    assert back.flight.seed == 2**63 - 1
    assert back.mission == mission


def test_a_fleet_of_thousands_can_be_addressed(tmp_path: Path, flight: Flight) -> None:
    messages = {
        **flight.messages,
        **dict.fromkeys(("sender", "receiver"), np.full(len(flight.messages["lost"]), 70_000)),
    }
    write_log(tmp_path / "log.nc", replace(flight, messages=messages), mission=MISSION, version="0.1.0")
    back = read_log(tmp_path / "log.nc").flight.messages
    assert back["sender"][0] == back["receiver"][-1] == 70_000


def test_it_is_fast_and_small(tmp_path: Path, flight: Flight) -> None:
    seconds = []
    for _ in range(5):
        started = time.process_time()
        write_log(tmp_path / "log.nc", flight, mission=MISSION, version="0.1.0")
        seconds.append(time.process_time() - started)
    assert min(seconds) < 0.1
    assert (tmp_path / "log.nc").stat().st_size < 700_000


def test_writing_leaves_the_old_log_or_the_new_one(log: Path, flight: Flight, monkeypatch: pytest.MonkeyPatch) -> None:
    before = log.read_bytes()

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", refuse)
    with pytest.raises(OSError, match="No space"):
        write_log(log, replace(flight, seed=8), mission=MISSION, version="0.1.0")
    assert log.read_bytes() == before
    assert os.listdir(log.parent) == ["log.nc"]


# ---- what is not a log -----------------------------------------------------------------------------------------------


def spoil(log: Path, how: str) -> None:
    content = log.read_bytes()
    if how == "missing":
        log.unlink()
    elif how == "directory":
        log.unlink()
        log.mkdir()
    elif how == "empty":
        log.write_bytes(b"")
    elif how == "text":
        log.write_text("time,north\n0,1\n")
    elif how == "other":
        with Dataset(log, "w") as file:
            file.createDimension("time", 3)
    elif how == "newer":
        with Dataset(log, "a") as file:
            file.cardume_log = 9
    elif how == "channel":
        with Dataset(log, "a") as file:
            file.renameVariable("surge", "speed_forward")
    elif how == "truncated":
        log.write_bytes(content[: len(content) // 2])
    elif how == "flipped":
        middle = len(content) // 3
        log.write_bytes(
            content[:middle] + bytes(b ^ 0x5A for b in content[middle : middle + 8]) + content[middle + 8 :]
        )


@pytest.mark.parametrize(
    ("how", "complaint"),
    [
        ("missing", r"cannot be read: No such file"),
        ("directory", r"cannot be read: Is a directory"),
        ("empty", "is empty"),
        ("text", "is not a NetCDF-4 file"),
        ("other", "but not a log of cardume"),
        ("newer", "is a log of format 9; this cardume reads format 1"),
        ("channel", r"is damaged \(surge not found"),
        ("truncated", "is damaged"),
        ("flipped", "is damaged"),
    ],
)
def test_what_is_not_a_log_is_named(log: Path, how: str, complaint: str) -> None:
    spoil(log, how)
    with pytest.raises(DataError, match=complaint) as error:
        read_log(log)
    assert str(log) in str(error.value)
    assert "\n" not in str(error.value)


def test_no_damage_ends_the_process_or_goes_unnoticed(log: Path) -> None:
    """Any eight bytes changed: an error, or the very same numbers (they were padding). Never a crash, never others."""
    script = """
import hashlib, random, sys
from pathlib import Path
from cardume.errors import DataError
from cardume.missions.log import read_log
log = Path(sys.argv[1]); content = log.read_bytes(); draw = random.Random(1)
def digest():
    channels = read_log(log).flight.channels
    return hashlib.sha256(b"".join(channels[name].tobytes() for name in sorted(channels))).hexdigest()
good = digest()
for _ in range(60):
    at = draw.randrange(len(content) - 8)
    log.write_bytes(content[:at] + draw.randbytes(8) + content[at + 8:])
    try:
        assert digest() == good, at
    except DataError:
        pass
"""
    done = subprocess.run([sys.executable, "-c", script, str(log)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.parametrize(
    ("where", "name", "kind", "dimensions"),
    [
        ("", "east", "f8", ()),
        ("", "north", "f8", ("vehicle", "time")),
        ("messages", "lost", "S1", ()),
        ("paths", "east", str, ("point",)),
    ],
)
def test_a_variable_that_lies_about_its_shape_or_kind(
    log: Path, where: str, name: str, kind: str | type, dimensions: tuple[str, ...]
) -> None:
    with Dataset(log, "a") as file:
        group = file[where] if where else file
        group.renameVariable(name, "away")
        group.createVariable(name, kind, dimensions)
    with pytest.raises(DataError, match=f"is damaged \\({name} is .* not numbers of shape"):
        read_log(log)
