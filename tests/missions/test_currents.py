"""Currents from CF NetCDF files: every trait a real file may have, what is wrong explained, oracles for the rest."""

import itertools
import math
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from hypothesis import given, strategies as st
from netCDF4 import Dataset
from pyproj import Geod
from scipy.interpolate import RegularGridInterpolator
from scipy.io import netcdf_file

from cardume.errors import DataError
from cardume.missions.currents import CurrentField, Window, explain_coverage, read_current, synthetic_cadiz
from cardume.missions.currents.cf_units import length_factor, speed_factor
from cardume.missions.currents.classic import promised_size
from cardume.missions.currents.field import local_axes, meters_per_degree
from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.world.currents import water_at

DATA = Path(os.environ.get("CARDUME_DATA", Path(__file__).parents[2].parent / "shared" / "data"))
REAL = DATA / "currents" / "cadiz_hf_radar_2013-10-31T22.nc"
needs_real_file = pytest.mark.skipif(
    not REAL.is_file(), reason="the radar file is not there; CARDUME_DATA names its folder"
)

HOUR = 3600.0
TIMES = np.array([0.0, 1.0, 2.0, 3.0])  # [h]
DEPTHS = np.array([0.5, 1.5, 5.0, 40.0, 100.0])  # [m]
COORDINATES: dict[str, dict[str, Any]] = {
    "time": {"units": "hours since 2020-02-28 22:00:00", "standard_name": "time"},
    "depth": {"units": "m", "standard_name": "depth", "positive": "down"},
    "lat": {"units": "degrees_north", "standard_name": "latitude"},
    "lon": {"units": "degrees_east", "standard_name": "longitude"},
}


def place(latitude_deg: float, longitude_deg: float) -> GeoPoint:
    return GeoPoint(math.radians(latitude_deg), math.radians(longitude_deg))


def truth(hours: Any, depth: Any, north_deg: Any, east_deg: Any) -> tuple[Any, Any]:
    """East and north velocity [m/s], linear along each axis, so that interpolation finds it exactly."""
    east = 0.1 + 0.3 * north_deg - 0.2 * east_deg + 0.5 * north_deg * east_deg - 0.001 * depth + 0.02 * hours
    north = -0.2 - 0.1 * north_deg + 0.4 * east_deg + 0.002 * depth - 0.03 * hours * (1.0 + north_deg)
    return east, north


class Sample:
    """What a file to be written looks like; tests change what they are about."""

    def __init__(self, latitude_deg: float = 36.8, longitude_deg: float = -7.24) -> None:
        self.origin = place(latitude_deg, longitude_deg)
        self.latitudes = latitude_deg + 0.04 * np.arange(-7, 9)
        self.longitudes = longitude_deg + 0.05 * np.arange(-9, 8)
        self.center = (latitude_deg, longitude_deg)
        self.dimensions = ["time", "depth", "lat", "lon"]
        self.coordinates = {name: dict(attributes) for name, attributes in COORDINATES.items()}
        self.values = {"time": TIMES, "depth": DEPTHS, "lat": self.latitudes, "lon": self.longitudes}
        self.names = ("uo", "vo")
        self.attributes = [
            {"units": "m s-1", "standard_name": f"{way}ward_sea_water_velocity"} for way in ("east", "north")
        ]
        self.extra: dict[str, Any] = {}
        self.format, self.kind, self.fill, self.pack = "NETCDF4", "f8", None, None
        self.hole = np.nan
        self.holes: list[tuple[int, int]] = []

    def write(self, path: Path) -> Path:
        axes = ("time", "depth", "lat", "lon")
        given = [self.values[a] if a in self.dimensions else np.zeros(1) for a in axes]
        hours, depths, latitudes, longitudes = np.meshgrid(*given, indexing="ij")
        east_deg = (longitudes - self.center[1] + 180.0) % 360.0 - 180.0
        velocity = truth(hours, np.abs(depths), latitudes - self.center[0], east_deg)
        with Dataset(path, "w", format=self.format) as file:
            file.title = "a sample"
            for name in self.dimensions:
                file.createDimension(name, len(self.values[name]))
            for name in self.dimensions:
                if name in self.coordinates:
                    coordinate = file.createVariable(name, "f8", (name,))
                    coordinate.setncatts(self.coordinates[name])
                    coordinate[:] = self.values[name]
            for name, attributes, numbers in zip(self.names, self.attributes, velocity, strict=True):
                variable = file.createVariable(name, self.kind, tuple(self.dimensions), fill_value=self.fill)
                variable.setncatts(attributes)
                variable.setncatts(self.pack or {})
                for row, column in self.holes:
                    numbers[:, :, row, column] = self.hole
                if self.pack:  # a NaN has no whole number to be packed into
                    numbers = np.ma.array(np.nan_to_num(numbers), mask=np.isnan(numbers))
                kept = [a for a in axes if a in self.dimensions]
                flat = numbers.reshape([len(self.values[a]) for a in kept])
                order = [kept.index(a) if a in kept else None for a in self.dimensions]
                variable[:] = flat.transpose([o for o in order if o is not None]).reshape(variable.shape)
            for name, (dimensions, attributes, numbers) in self.extra.items():
                extra = file.createVariable(name, np.asarray(numbers).dtype, dimensions)
                extra.setncatts(attributes)
                extra[:] = numbers
        return path


def window(sample: Sample, **more: Any) -> Window:
    return Window(origin=sample.origin, radius=8e3, **more)


def check(field: CurrentField, sample: Sample, *, scale: float = 1.0, tolerance: float = 1e-12) -> None:
    """Look the field up at random and compare with the truth it was made of."""
    rows = field.to_rows(sample.origin)
    north_scale, east_scale = meters_per_degree(sample.origin.latitude)
    for north, east, depth, hours in np.random.default_rng(1).uniform(
        (-8e3, -8e3, 0.5, 0.0), (8e3, 8e3, 60.0, 3.0), size=(40, 4)
    ):
        seen = water_at(rows, north, east, depth, hours * HOUR)
        then = hours if "time" in sample.dimensions else 0.0
        level = depth if "depth" in sample.dimensions else 0.0
        east_velocity, north_velocity = truth(then, level, north / north_scale, east / east_scale)
        assert seen == pytest.approx((scale * north_velocity, scale * east_velocity), abs=tolerance)


# ---- traits of files that are read -----------------------------------------------------------------------------------


def flat(sample: Sample) -> None:
    sample.dimensions = ["lat", "lon"]


def netcdf3(sample: Sample) -> None:
    sample.format = "NETCDF3_CLASSIC"


def offset64(sample: Sample) -> None:
    sample.format = "NETCDF3_64BIT_OFFSET"


def southwards(sample: Sample) -> None:
    sample.values["lat"] = sample.latitudes[::-1]


def westwards(sample: Sample) -> None:
    sample.values["lon"] = sample.longitudes[::-1]


def to_360(sample: Sample) -> None:
    sample.values["lon"] = sample.longitudes % 360.0


def transposed(sample: Sample) -> None:
    sample.dimensions = ["lon", "time", "lat", "depth"]


def no_time(sample: Sample) -> None:
    sample.dimensions = ["depth", "lat", "lon"]


def no_depth(sample: Sample) -> None:
    sample.dimensions = ["time", "lat", "lon"]


def heights(sample: Sample) -> None:
    sample.values["depth"] = -DEPTHS
    sample.coordinates["depth"]["positive"] = "up"


def silent_heights(sample: Sample) -> None:
    sample.values["depth"] = -DEPTHS
    sample.coordinates["depth"] = {"units": "meters"}


def upside_down(sample: Sample) -> None:
    sample.values["depth"] = DEPTHS[::-1]


def axis_names_only(sample: Sample) -> None:
    sample.coordinates = {
        "time": {"units": "hours since 2020-02-28"},
        "depth": {"units": "m"},
        "lat": {"units": "degrees north"},
        "lon": {},
    }


def one_member(sample: Sample) -> None:
    sample.dimensions = ["member", "time", "depth", "lat", "lon"]
    sample.values["member"] = np.zeros(1)
    del sample.coordinates["depth"]["positive"]


def hycom(sample: Sample) -> None:
    sample.names = ("water_u", "water_v")


def roms_regridded(sample: Sample) -> None:
    sample.names, sample.attributes = ("u_eastward", "v_northward"), [{"units": "meter second-1"}] * 2


def globcurrent(sample: Sample) -> None:
    sample.names = ("eastward_eulerian_current_velocity", "northward_eulerian_current_velocity")
    sample.attributes = [{"units": "m/s"}] * 2


def beside_wind_and_tide(sample: Sample) -> None:
    shape, numbers = ("lat", "lon"), np.full((16, 17), 9.0)
    for way, name in (("east", "u"), ("north", "v")):
        sample.extra[name] = (shape, {"units": "m s-1", "standard_name": f"{way}ward_wind"}, numbers)
        tide = f"{way}ward_sea_water_velocity_due_to_tides"
        sample.extra[name + "tide"] = (shape, {"units": "m s-1", "standard_name": tide}, numbers)


TRAITS = [
    flat, netcdf3, offset64, southwards, westwards, to_360, transposed, no_time, no_depth, heights, silent_heights,
    upside_down, axis_names_only, one_member, hycom, roms_regridded, globcurrent, beside_wind_and_tide,
]  # fmt: skip


@pytest.mark.parametrize("trait", TRAITS, ids=lambda trait: trait.__name__)
def test_a_file_is_read_whatever_its_form(tmp_path: Path, trait: Any) -> None:
    sample = Sample()
    trait(sample)
    field = read_current(sample.write(tmp_path / "sample.nc"), window=window(sample))
    assert field.names == sample.names
    assert field.title == "a sample"
    check(field, sample)


@pytest.mark.parametrize("longitude_deg", [179.98, -179.98, 180.0, 0.02, -0.02, 359.98])
@pytest.mark.parametrize("trait", [flat, to_360, westwards], ids=lambda trait: trait.__name__)
def test_longitudes_may_cross_their_end(tmp_path: Path, trait: Any, longitude_deg: float) -> None:
    sample = Sample(longitude_deg=longitude_deg)
    trait(sample)
    if trait is not to_360:
        sample.values["lon"] = (sample.values["lon"] + 180.0) % 360.0 - 180.0
    check(read_current(sample.write(tmp_path / "sample.nc"), window=window(sample)), sample)


@pytest.mark.parametrize("first", [0.0, -180.0, 20.0])
def test_a_whole_turn_of_longitudes_has_no_seam(tmp_path: Path, first: float) -> None:
    for longitude_deg in (0.0, 179.9, -180.0, 73.3):
        sample = Sample(longitude_deg=longitude_deg)
        flat(sample)
        sample.values["lon"] = first + np.arange(0.0, 360.1, 0.1)  # first and last are the same meridian
        check(read_current(sample.write(tmp_path / "sample.nc"), window=window(sample)), sample, tolerance=1e-11)


def test_packed_numbers_are_unpacked(tmp_path: Path) -> None:
    sample = Sample()
    sample.kind, sample.fill = "i2", np.int16(-30000)
    sample.pack = {"scale_factor": 1e-4, "add_offset": 0.05}
    sample.holes = [(0, 0)]
    path = sample.write(tmp_path / "sample.nc")
    field = read_current(path, window=window(sample))
    check(field, sample, tolerance=0.6e-4)
    with xarray.open_dataset(path) as oracle:
        whole = read_current(path)
        assert np.isnan(whole.velocity[:, :, 0, 0]).all()
        assert np.array_equal(whole.velocity[..., 1], oracle["uo"].values, equal_nan=True)
        assert np.array_equal(whole.velocity[..., 0], oracle["vo"].values, equal_nan=True)


@pytest.mark.parametrize(("unit", "factor"), [("cm/s", 0.01), ("cm s**-1", 0.01), ("knots", 1852.0 / 3600.0)])
def test_speeds_are_converted(tmp_path: Path, unit: str, factor: float) -> None:
    sample = Sample()
    for attributes in sample.attributes:
        attributes["units"] = unit
    check(read_current(sample.write(tmp_path / "sample.nc"), window=window(sample)), sample, scale=factor)


@pytest.mark.parametrize("fill", [None, -9999.0, 1e20])
def test_holes_are_nan_fill_or_out_of_range(tmp_path: Path, fill: float | None) -> None:
    sample = Sample()
    sample.fill, sample.hole, sample.holes = fill, fill or np.nan, [(6, 8), (2, 3)]
    field = read_current(sample.write(tmp_path / "sample.nc"))
    known = np.isfinite(field.velocity).all(axis=(0, 1, 4))
    assert {(int(r), int(c)) for r, c in np.argwhere(~known)} == {(6, 8), (2, 3)}


def test_named_variables_are_taken(tmp_path: Path) -> None:
    sample = Sample()
    sample.names = ("a", "b")
    sample.attributes = [{"units": "m/s", "standard_name": f"sea_water_{axis}_velocity"} for axis in "xy"]
    path = sample.write(tmp_path / "sample.nc")
    check(read_current(path, window=window(sample), east="a", north="b"), sample)
    swapped = read_current(path, window=window(sample), east="b", north="a")
    assert np.array_equal(
        swapped.velocity[..., ::-1], read_current(path, window=window(sample), east="a", north="b").velocity
    )


def test_only_what_is_near_is_read(tmp_path: Path) -> None:
    sample = Sample()
    field = read_current(
        sample.write(tmp_path / "sample.nc"),
        window=Window(sample.origin, radius=5e3, duration=1.2 * HOUR, deepest=3.0, start_time="2020-02-28T22:30"),
    )
    assert field.times == pytest.approx([-0.5 * HOUR, 0.5 * HOUR, 1.5 * HOUR])
    assert field.depths == pytest.approx([0.5, 1.5, 5.0])
    assert field.latitudes_deg == pytest.approx(36.8 + 0.04 * np.arange(-2, 3))
    assert field.longitudes_deg == pytest.approx(-7.24 + 0.05 * np.arange(-2, 3))
    assert field.velocity.shape == (3, 3, 5, 5, 2)


@pytest.mark.parametrize("start_time", ["2020-02-28T23:30", "2020-02-28T23:30:00Z", "2020-02-29T00:30+01:00"])
def test_a_mission_may_start_at_any_of_the_times(tmp_path: Path, start_time: str) -> None:
    sample = Sample()
    field = read_current(sample.write(tmp_path / "sample.nc"), window=window(sample, start_time=start_time))
    assert field.start is not None
    assert field.start.isoformat() == "2020-02-28T23:30:00+00:00"
    east, north = truth(1.5 + 0.25, 2.0, 0.0, 0.0)
    assert water_at(field.to_rows(sample.origin), 0.0, 0.0, 2.0, 0.25 * HOUR) == pytest.approx((north, east))


@pytest.mark.parametrize(("unit", "first"), [("days since 1950-01-01", 25_600.0), ("seconds since 2020-01-01", 3600.0)])
def test_times_have_the_unit_of_the_file(tmp_path: Path, unit: str, first: float) -> None:
    sample = Sample()
    factor = 86400.0 if unit.startswith("days") else 1.0
    path = sample.write(tmp_path / "sample.nc")
    with Dataset(path, "a") as file:
        file["time"].units = unit
        file["time"][:] = first + TIMES * HOUR / factor
    field = read_current(path)
    assert field.times == pytest.approx(TIMES * HOUR, abs=1e-4)
    assert str(field.start) == ("2020-02-03 00:00:00+00:00" if factor > 1.0 else "2020-01-01 01:00:00+00:00")


def test_a_calendar_of_its_own_has_no_dates(tmp_path: Path) -> None:
    sample = Sample()
    sample.coordinates["time"]["calendar"] = "360_day"
    path = sample.write(tmp_path / "sample.nc")
    assert read_current(path).start is None
    check(read_current(path, window=window(sample)), sample)
    with pytest.raises(DataError, match="calendar is 360_day: leave start_time out"):
        read_current(path, window=window(sample, start_time="2020-02-28T23:00"))


UNITS = {
    "m/s": 1.0, "m s-1": 1.0, "m.s-1": 1.0, "m s^-1": 1.0, "m s**-1": 1.0, "meter second-1": 1.0,
    "Metres / second": 1.0,
    "meters per second": 1.0, "cm s-1": 0.01, "mm/s": 0.001, "km/h": 1 / 3.6, "kn": 1852 / 3600, "m": None, "": None,
    "1": None, "m s-2": None, "ms-1": None, "degrees": None, "m s": None, "s/m": None, "Pa": None, "m/s/s": None,
}  # fmt: skip


@pytest.mark.parametrize(("unit", "factor"), UNITS.items())
def test_units_of_speed(unit: str, factor: float | None) -> None:
    assert speed_factor(unit) == pytest.approx(factor) if factor else speed_factor(unit) is None


def test_units_of_length() -> None:
    assert [length_factor(u) for u in ("m", "metres", "km", "cm", "dbar", "", "1", "m/s")] == [
        1.0, 1.0, 1000.0, 0.01, None, None, None, None,
    ]  # fmt: skip


# ---- files that are refused ------------------------------------------------------------------------------------------


def refuse(tmp_path: Path, sample: Sample, **more: Any) -> str:
    """The message with which a file is refused; it always names the file."""
    path = sample.write(tmp_path / "sample.nc")
    with pytest.raises(DataError) as caught:
        read_current(path, **{"window": window(sample), **more})
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    return message


def plain_names(s: Sample) -> None:
    s.names, s.attributes = ("a", "b"), [{"units": "m/s"}] * 2


def wind(s: Sample) -> None:
    s.names = ("u", "v")
    s.attributes = [{"units": "m/s", "standard_name": f"{way}ward_wind"} for way in ("east", "north")]


def along_grid(s: Sample) -> None:
    s.attributes = [{"units": "m/s", "standard_name": f"sea_water_{axis}_velocity"} for axis in "xy"]


def twice(s: Sample) -> None:
    s.extra["other"] = (("lat", "lon"), s.attributes[0], np.zeros((16, 17)))


def half(s: Sample) -> None:
    s.attributes[1] = {"units": "m/s"}


def no_unit(s: Sample) -> None:
    del s.attributes[0]["units"]


def wrong_unit(s: Sample) -> None:
    s.attributes[1]["units"] = "m s-2"


def curvilinear(s: Sample) -> None:
    s.dimensions, s.values["y"], s.values["x"] = ["y", "x"], np.arange(16.0), np.arange(17.0)
    s.extra["nav_lat"] = (("y", "x"), {"standard_name": "latitude"}, np.zeros((16, 17)))
    s.write = lambda path: write_bare(path, s)  # type: ignore[method-assign]


def bare(s: Sample) -> None:
    curvilinear(s)
    s.extra.clear()


def projected(s: Sample) -> None:
    s.coordinates["lat"]["standard_name"] = "projection_y_coordinate"


def rotated(s: Sample) -> None:
    s.coordinates["lon"]["standard_name"] = "grid_longitude"


def sigma(s: Sample) -> None:
    s.coordinates["depth"] = {"standard_name": "ocean_s_coordinate_g2", "positive": "up"}


def pressure(s: Sample) -> None:
    s.coordinates["depth"]["units"] = "dbar"


def unnamed_level(s: Sample) -> None:
    s.dimensions, s.values["layer"] = ["layer", "lat", "lon"], DEPTHS
    s.write = lambda path: write_bare(path, s)  # type: ignore[method-assign]


def two_times(s: Sample) -> None:
    s.coordinates["depth"] = {"standard_name": "time", "units": "hours since 2000-01-01"}


def no_longitude(s: Sample) -> None:
    s.dimensions = ["time", "lat"]
    s.write = lambda path: write_bare(path, s)  # type: ignore[method-assign]


def one_latitude(s: Sample) -> None:
    s.values["lat"] = np.array([36.8])


def uneven(s: Sample) -> None:
    s.values["lat"] = np.sort(np.append(s.latitudes[::3], s.latitudes[7]))


def gap(s: Sample) -> None:
    s.values["lon"] = np.where(s.longitudes > -7.2, s.longitudes + 0.3, s.longitudes)


def repeated(s: Sample) -> None:
    s.values["lat"] = np.repeat(s.latitudes, 2)


def backwards(s: Sample) -> None:
    s.values["time"] = TIMES[::-1]


def no_date(s: Sample) -> None:
    s.coordinates["time"]["units"] = "hours"


def bad_date(s: Sample) -> None:
    s.coordinates["time"]["units"] = "hours since the storm"


def levels_twice(s: Sample) -> None:
    s.values["depth"] = np.array([0.0, 1.0, 1.0, 2.0, 3.0])


def lost_coordinate(s: Sample) -> None:
    s.values["time"] = np.array([0.0, np.nan, 2.0, 3.0])


def beyond_the_pole(s: Sample) -> None:
    s.values["lat"] = s.latitudes + 60.0


def undeclared_fill(s: Sample) -> None:
    s.hole, s.holes = 9999.0, [(7, 9)]


def all_holes(s: Sample) -> None:
    s.holes = list(itertools.product(range(16), range(17)))


def elsewhere(s: Sample) -> None:
    s.origin = place(41.0, -7.24)


def far_east(s: Sample) -> None:
    s.origin = place(36.8, 10.0)


def write_bare(path: Path, s: Sample) -> Path:
    """As `Sample.write`, for dimensions that have no coordinate; the velocities are zeros."""
    with Dataset(path, "w") as file:
        for name in s.dimensions:
            file.createDimension(name, len(s.values[name]))
            if name in s.coordinates:
                file.createVariable(name, "f8", (name,)).setncatts(s.coordinates[name])
                file[name][:] = s.values[name]
        for name, attributes in zip(s.names, s.attributes, strict=True):
            file.createVariable(name, "f8", tuple(s.dimensions)).setncatts(attributes)
            file[name][:] = 0.0
        for name, (dimensions, attributes, _) in s.extra.items():
            file.createVariable(name, "f8", dimensions).setncatts(attributes)
    return path


REFUSED = [
    (plain_names, "name the variables with east: and north:", "a (time 4, depth 5, lat 16, lon 17) [m/s]"),
    (wind, "standard name of something else", "u (time 4, depth 5, lat 16, lon 17) [m/s] eastward_wind"),
    (along_grid, "uo, vo point along the grid (sea_water_x_velocity)", "interpolate them to a regular grid"),
    (twice, "uo, other with the standard name eastward_sea_water_velocity", "say which with east: and north:"),
    (half, "no variable with northward_sea_water_velocity", "say which"),
    (no_unit, "unit of uo is ''", "ncatted -a units,uo,o,c,'m s-1' FILE"),
    (wrong_unit, "unit of vo is 'm s-2'", "valid are m s-1"),
    (curvilinear, "uo is on a curvilinear grid: nav_lat has the two dimensions y, x", "cdo remapbil"),
    (bare, "dimension y (16) of uo has no coordinate", "add one"),
    (projected, "lat is an axis of a map projection", "cdo remapbil"),
    (rotated, "lon is an axis of a map projection", "cdo remapbil"),
    (sigma, "depth counts terrain-following levels", "depths in meters first"),
    (pressure, "depth: unit 'dbar' is no length", "depths in meters first"),
    (unnamed_level, "dimension layer (5) of uo has no coordinate", "take out one slice"),
    (two_times, "more than one axis of time: time, depth", ""),
    (no_longitude, "uo (time, lat) has no longitude", "cdo remapbil"),
    (one_latitude, "lat: there is only one latitude", "at least two"),
    (uneven, "lat: steps of latitude reach from 0.04 to 0.12 deg", "cdo remapbil"),
    (gap, "lon: steps of longitude reach from 0.05 to 0.35 deg", "cdo remapbil"),
    (repeated, "lat: steps of latitude reach from 0 to", ""),
    (backwards, "time: times do not increase", ""),
    (no_date, "time: unit 'hours'", "is no date"),
    (bad_date, "time: unit 'hours since the storm'", "is no date"),
    (levels_twice, "depth: a level occurs twice", ""),
    (lost_coordinate, "time: some of the coordinates are missing", ""),
    (beyond_the_pole, "lat: latitudes reach from 96.52 to 97.12 deg", ""),
    (undeclared_fill, "reach 9999 m/s, which no current does", "ncatted -a _FillValue,uo,o,f,9999 FILE"),
    (all_holes, "no water at all between latitude 36.7", "every cell is masked; move the origin"),
    (elsewhere, "lat: origin is at latitude 41.0000 deg; the file covers latitude 36.5200 to 37.1200 deg", "move"),
    (far_east, "lon: origin is at longitude 10.0000 deg; the file covers longitude -7.6900 to -6.8900 deg", "move"),
]


@pytest.mark.parametrize(("flaw", "says", "advises"), REFUSED, ids=[flaw.__name__ for flaw, _, _ in REFUSED])
def test_what_cannot_be_used_is_explained(tmp_path: Path, flaw: Any, says: str, advises: str) -> None:
    sample = Sample()
    flaw(sample)
    message = refuse(tmp_path, sample)
    assert says in message
    assert advises in message


@pytest.mark.parametrize(
    ("names", "says"),
    [
        ({"east": "uo"}, "east: names a variable, north: does not"),
        ({"north": "uo"}, "north: names a variable, east: does not"),
        ({"east": "uo", "north": "uo"}, "both name uo"),
        ({"east": "uo", "north": "v0"}, "north: v0 is not in the file"),
        ({"east": "uo", "north": "lat"}, "are not at the same points, as on a staggered C-grid"),
    ],
)
def test_wrong_names_are_explained(tmp_path: Path, names: dict[str, str], says: str) -> None:
    assert says in refuse(tmp_path, Sample(), **names)


@pytest.mark.parametrize(
    ("start_time", "says"),
    [
        ("2020-02-28T21:59", "is outside the file, 2020-02-28T22:00 to 2020-02-29T01:00"),
        ("2020-02-29T01:01", "is outside the file"),
        ("yesterday", "start_time 'yesterday' is no date; write it as 2013-10-31T22:00"),
    ],
)
def test_a_start_outside_the_file_is_explained(tmp_path: Path, start_time: str, says: str) -> None:
    sample = Sample()
    assert says in refuse(tmp_path, sample, window=window(sample, start_time=start_time))


def test_text_is_no_velocity(tmp_path: Path) -> None:
    path = Sample().write(tmp_path / "sample.nc")
    with Dataset(path, "a") as file:
        for name in "ab":
            file.createVariable(name, "S1", ("lat", "lon")).units = "m/s"
    with pytest.raises(DataError, match=r"holds .*, not numbers"):
        read_current(path, east="a", north="b")


def test_too_much_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.nc"
    with Dataset(path, "w") as file:
        for name, size in (("time", 3000), ("lat", 100), ("lon", 100)):
            file.createDimension(name, size)
            file.createVariable(name, "f8", (name,)).setncatts(COORDINATES[name])
            file[name][:] = 0.01 * np.arange(size)
        for name in ("uo", "vo"):
            file.createVariable(name, "f4", ("time", "lat", "lon"), zlib=True).units = "m/s"
    with pytest.raises(DataError, match=r"time 3000, lat 100, lon 100, has more than 20,000,000 numbers; give"):
        read_current(path)
    with pytest.raises(DataError, match="no water at all"):
        read_current(path, window=Window(place(0.5, 0.5), radius=5e3))


# ---- damaged files ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4"])
def test_a_file_cut_anywhere_is_refused(tmp_path: Path, kind: str) -> None:
    sample = Sample()
    no_depth(sample)
    sample.format = kind
    data = sample.write(tmp_path / "whole.nc").read_bytes()
    check(read_current(tmp_path / "whole.nc", window=window(sample)), sample)
    cut = tmp_path / "cut.nc"
    for size in [*range(0, 1200, 61), *np.linspace(1200, len(data) - 1, 25).astype(int), len(data) - 1]:
        cut.write_bytes(data[:size])
        with pytest.raises(DataError, match=r"cut\.nc: (is not NetCDF|cut short|damaged|cannot be read)"):
            read_current(cut)


def test_the_promised_size_is_the_size(tmp_path: Path) -> None:
    several = (("a", "i1", ("t", "x")), ("b", "f8", ("x",)), ("c", "i2", ("t",)))
    one = several[:2]  # the only variable with records is not padded
    kinds = ("NETCDF3_CLASSIC", "NETCDF3_64BIT_DATA")
    for kind, unlimited, variables in itertools.product(kinds, (False, True), (several, one)):
        path = tmp_path / "file.nc"
        with Dataset(path, "w", format=kind) as file:
            file.title = "odd"
            file.createDimension("t", None if unlimited else 3)
            file.createDimension("x", 5)
            for name, dtype, dimensions in variables:
                file.createVariable(name, dtype, dimensions)[:] = np.ones([{"t": 3, "x": 5}[d] for d in dimensions])
        size = promised_size(path)
        assert size is not None
        assert path.stat().st_size - 4 < size <= path.stat().st_size
    assert promised_size(Sample().write(tmp_path / "four.nc")) is None


@pytest.mark.parametrize("kind", ["NETCDF3_CLASSIC", "NETCDF4"])
def test_flipped_bytes_are_read_or_refused(tmp_path: Path, kind: str) -> None:
    sample = Sample()
    flat(sample)
    sample.format = kind
    data = np.frombuffer(sample.write(tmp_path / "whole.nc").read_bytes(), np.uint8)
    generator, broken = np.random.default_rng(13), tmp_path / "broken.nc"
    refused = 0
    for _ in range(150):
        flipped = data.copy()
        places = generator.integers(0, min(len(data), 3000), size=3)
        flipped[places] ^= generator.integers(1, 256, size=3).astype(np.uint8)
        broken.write_bytes(flipped.tobytes())
        try:
            read_current(broken, window=window(sample))
        except DataError:
            refused += 1
    assert refused > 10


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("text.nc", b"latitude,longitude,u,v\n", "is not NetCDF"),
        ("empty.nc", b"", "is not NetCDF"),
        ("half.nc", b"CDF\x01\x00\x00", "damaged: it ends within its header"),
        ("magic.nc", b"\x89HDF\r\n\x1a\n" + bytes(500), ""),
    ],
)
def test_other_files_are_refused(tmp_path: Path, name: str, content: bytes, says: str) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(DataError) as caught:
        read_current(path)
    assert str(path) in str(caught.value)
    assert says in str(caught.value)


@pytest.mark.parametrize("path", ["absent.nc", "http://localhost:9/thredds/dodsC/current.nc"])
def test_what_is_not_there_is_not_fetched(path: str) -> None:
    with pytest.raises(DataError, match="does not exist"):
        read_current(path)


def test_a_directory_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="is a directory"):
        read_current(tmp_path)


# ---- coverage --------------------------------------------------------------------------------------------------------


def holed_field(tmp_path: Path) -> tuple[Sample, CurrentField]:
    sample = Sample()
    sample.holes = [(r, c) for r, c in itertools.product(range(16), range(17)) if r >= 7 and c <= 9]
    return sample, read_current(sample.write(tmp_path / "sample.nc"), window=Window(sample.origin))


def test_a_mission_within_the_water_needs_no_words(tmp_path: Path) -> None:
    sample = Sample()
    field = read_current(sample.write(tmp_path / "sample.nc"), window=window(sample))
    assert explain_coverage(field, sample.origin, np.array([[0.0, 0.0], [300.0, -200.0]])) == ""


def test_a_mission_in_a_hole_is_told_where_water_is(tmp_path: Path) -> None:
    sample, field = holed_field(tmp_path)
    message = explain_coverage(field, sample.origin, np.array([[0.0, 0.0, 2.0], [300.0, 0.0, 2.0]]))
    assert "a hole (land, or not measured) at north 0 m, east 0 m (36.8000 N 7.2400 W), depth 2 m, 0 s after" in message
    assert "nearest cell with water is 4.4 km south, at 36.7600 N 7.2400 W: move the origin there" in message
    assert explain_coverage(field, place(36.76, -7.24), np.zeros((1, 2))) == ""


@given(st.floats(-9e3, 9e3), st.floats(-9e3, 9e3))
def test_the_coverage_is_what_the_law_finds(
    tmp_path_factory: pytest.TempPathFactory, north: float, east: float
) -> None:
    sample, field = COVERED.get("field") or COVERED.setdefault("field", holed_field(tmp_path_factory.mktemp("covered")))
    found = explain_coverage(field, sample.origin, np.array([[north, east]])) == ""
    water = water_at(field.to_rows(sample.origin), north, east, 0.0, 0.0)
    assert found == bool(np.isfinite(water).all())


COVERED: dict[str, Any] = {}


def test_a_mission_that_leaves_the_grid_is_told_where(tmp_path: Path) -> None:
    sample = Sample()
    field = read_current(sample.write(tmp_path / "sample.nc"), window=window(sample))
    message = explain_coverage(field, sample.origin, np.array([[0.0, 0.0], [0.0, 40e3]]))
    assert "leaves the grid at north 0 m, east 40000 m (36.7992 N 6.7918 W)" in message
    assert "latitude 36.7200 to 36.8800, longitude -7.3400 to -7.1400 deg" in message


def test_a_hole_that_comes_later_is_found(tmp_path: Path) -> None:
    sample = Sample()
    path = sample.write(tmp_path / "sample.nc")
    with Dataset(path, "a") as file:
        file["uo"][2:] = np.nan
    assert explain_coverage(read_current(path, window=window(sample, duration=0.9 * HOUR)), sample.origin, ORIGIN) == ""
    message = explain_coverage(read_current(path, window=window(sample)), sample.origin, ORIGIN)
    assert "7200 s after the start; this level has no water at all" in message


ORIGIN = np.zeros((1, 2))


# ---- the map from degrees to meters ----------------------------------------------------------------------------------


@pytest.mark.parametrize("latitude_deg", [-80.0, -36.8, 0.0, 36.8, 60.0, 85.0])
def test_a_degree_is_as_long_as_the_geodesic_says(latitude_deg: float) -> None:
    geod, step = Geod(ellps="WGS84"), 1e-4
    north, east = meters_per_degree(math.radians(latitude_deg))
    assert geod.inv(0.0, latitude_deg - step, 0.0, latitude_deg + step)[2] / (2 * step) == pytest.approx(
        north, rel=1e-8
    )
    assert geod.inv(-step, latitude_deg, step, latitude_deg)[2] / (2 * step) == pytest.approx(east, rel=1e-8)


def test_the_field_lies_within_meters_of_the_local_axes() -> None:
    origin = place(36.8, -7.24)
    for distance, error in ((1e3, 0.14), (5e3, 3.3), (10e3, 13.2)):
        latitude, longitude = to_geographic(distance, distance, origin)
        norths, easts = local_axes(np.degrees([latitude]), np.degrees([longitude]), origin)
        assert math.hypot(norths[0] - distance, easts[0] - distance) == pytest.approx(error, rel=0.07)


def test_a_pole_is_refused() -> None:
    with pytest.raises(DataError, match="up to 89 deg"):
        local_axes(np.array([89.0, 90.0]), np.array([0.0, 1.0]), place(89.5, 0.0))


# ---- the real field, and the one made up -----------------------------------------------------------------------------

CADIZ = place(36.80, -7.24)


def test_a_whole_earth_may_be_looked_up_anywhere(tmp_path: Path) -> None:
    sample = Sample(longitude_deg=0.0)
    flat(sample)
    sample.values["lon"] = np.arange(0.0, 360.0, 0.5)
    for attributes in sample.attributes:
        attributes["units"] = "mm/s"  # the truth grows to 100 of it
    field = read_current(sample.write(tmp_path / "sample.nc"))
    for longitude_deg in (0.1, 100.0, 179.9, -179.9, -60.0):
        east, north = np.multiply(truth(0.0, 0.0, 0.01, longitude_deg), 0.001)
        rows, north_scale = field.to_rows(place(36.8, longitude_deg)), meters_per_degree(math.radians(36.8))[0]
        if abs(longitude_deg) < 179.0:  # the truth jumps at 180
            assert water_at(rows, 0.01 * north_scale, 0.0, 0.0, 0.0) == pytest.approx((north, east), abs=1e-9)
        assert np.isfinite(water_at(rows, 0.0, 30e3, 0.0, 0.0)).all()
        assert np.isfinite(water_at(rows, 0.0, -30e3, 0.0, 0.0)).all()


@needs_real_file
def test_the_radar_file_reads_as_scipy_reads_it() -> None:
    field = read_current(REAL)
    with netcdf_file(REAL, mmap=False) as oracle:
        latitudes, longitudes = oracle.variables["lat"][:].copy(), oracle.variables["lon"][:].copy()
        east, north = (np.where(v == -9999.0, np.nan, v) for v in (oracle.variables[n][0].copy() for n in "uv"))
    assert np.array_equal(field.latitudes_deg, latitudes)
    assert field.longitudes_deg == pytest.approx(longitudes, abs=1e-12)
    assert np.array_equal(field.velocity[0, 0, :, :, 0], north, equal_nan=True)
    assert np.array_equal(field.velocity[0, 0, :, :, 1], east, equal_nan=True)
    rows, (north_scale, east_scale) = field.to_rows(CADIZ), meters_per_degree(CADIZ.latitude)
    lookup = RegularGridInterpolator((latitudes, longitudes), np.stack([north, east], axis=-1))
    places = np.random.default_rng(4).uniform(-6e3, 6e3, size=(200, 2))
    expected = np.array([lookup((36.80 + x / north_scale, -7.24 + y / east_scale)) for x, y in places])
    seen = np.array([water_at(rows, x, y, 0.0, 0.0) for x, y in places])
    beside_holes = np.isnan(expected)  # where SciPy knows nothing
    assert beside_holes.mean() < 0.2
    assert seen[~beside_holes] == pytest.approx(expected[~beside_holes], abs=1e-12)


@needs_real_file
def test_the_radar_sees_a_decimeter_a_second_at_the_place_of_the_mission() -> None:
    field = read_current(REAL, window=Window(CADIZ, duration=700.0, deepest=20.0))
    assert str(field.start) == "2013-10-31 22:00:00+00:00"
    water = water_at(field.to_rows(CADIZ), 0.0, 0.0, 10.0, 300.0)
    assert math.hypot(*water) == pytest.approx(0.1031, abs=1e-4)
    assert math.degrees(math.atan2(water.east, water.north)) == pytest.approx(164.75, abs=0.01)
    box = np.array([[n, e] for n in (-500.0, 0.0, 500.0) for e in (-500.0, 0.0, 500.0)])
    assert explain_coverage(field, CADIZ, box) == ""
    outside = explain_coverage(read_current(REAL, window=Window(place(37.1, -7.7))), place(37.1, -7.7), ORIGIN)
    assert "a hole" in outside


def test_the_made_up_field_says_so_and_is_like_the_real_one(tmp_path: Path) -> None:
    path = synthetic_cadiz(tmp_path / "cadiz.nc")
    assert os.listdir(tmp_path) == ["cadiz.nc"]
    field = read_current(path, window=Window(CADIZ))
    assert field.title.startswith("SYNTHETIC")
    whole = read_current(path)
    assert whole.velocity.shape == (1, 1, 61, 97, 2)
    speed = np.hypot(whole.velocity[..., 0], whole.velocity[..., 1])
    assert 0.5 < np.isnan(speed).mean() < 0.8
    assert 0.08 < np.nanmedian(speed) < 0.15
    assert np.nanmax(speed) < 0.45
    water = water_at(field.to_rows(CADIZ), 0.0, 0.0, 0.0, 0.0)
    assert math.hypot(*water) == pytest.approx(0.105, abs=0.005)
    assert math.degrees(math.atan2(water.east, water.north)) == pytest.approx(165.0, abs=3.0)
    box = np.array([[n, e] for n in (-3e3, 0.0, 3e3) for e in (-3e3, 0.0, 3e3)])
    assert explain_coverage(field, CADIZ, box) == ""
    with xarray.open_dataset(path) as oracle:
        assert whole.velocity[0, 0, :, :, 1] == pytest.approx(oracle["u"].values[0], nan_ok=True)
    assert synthetic_cadiz(tmp_path / "again.nc").read_bytes() == path.read_bytes()


def test_a_field_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="cannot be written"):
        synthetic_cadiz(tmp_path / "absent" / "cadiz.nc")
    target = tmp_path / "folder.nc"
    target.mkdir()
    with pytest.raises(DataError, match="cannot be written"):
        synthetic_cadiz(target)
    assert os.listdir(tmp_path) == ["folder.nc"]
