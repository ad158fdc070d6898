"""Places on the Earth, against PROJ's own projections."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from pyproj import Transformer

from cardume.errors import InputError
from cardume.missions.geodesy import (
    GeoPoint,
    GridPoint,
    band_limits,
    geographic_to_utm,
    grid_scale,
    to_geographic,
    to_local,
    utm_to_geographic,
)

LISBON = GridPoint(491854.338, 4290819.848, 29, "S")
latitudes, longitudes = st.floats(-79.0, 83.0), st.floats(-179.0, 179.0)


def test_29s_is_a_band_of_the_northern_hemisphere() -> None:
    place = utm_to_geographic(LISBON)
    assert np.degrees(place) == pytest.approx((38.76605, -9.09376), abs=1e-5)


def test_the_same_as_the_published_coordinate_system() -> None:
    """EPSG 32629 is UTM zone 29 north, 32729 south."""
    for point, code in ((LISBON, 32629), (GridPoint(412345.0, 7654321.0, 29, "K"), 32729)):
        expected = Transformer.from_crs(code, 4326).transform(point.easting, point.northing)
        assert np.degrees(utm_to_geographic(point)) == pytest.approx(expected, abs=1e-11)


@given(latitudes, longitudes)
def test_there_and_back(latitude: float, longitude: float) -> None:
    place = GeoPoint(math.radians(latitude), math.radians(longitude))
    point = geographic_to_utm(place)
    low, high = band_limits(point.band)
    assert low - 1e-12 <= place.latitude < high
    assert utm_to_geographic(point) == pytest.approx(place, abs=1e-12)


def test_convergence_at_lisbon() -> None:
    """West of its central meridian grid north lies west of true north, by (lambda - lambda_0) sin(phi)."""
    convergence, scale = grid_scale(LISBON)
    place = utm_to_geographic(LISBON)
    assert math.degrees(convergence) == pytest.approx(-0.0587, abs=5e-5)
    assert convergence == pytest.approx((place.longitude - math.radians(-9.0)) * math.sin(place.latitude), rel=1e-5)
    assert scale == pytest.approx(0.9996 * (1.0 + (8145.662 / 6.38e6) ** 2 / 2.0), abs=1e-8)


@given(latitudes, st.floats(-2.9, 2.9))
def test_grid_axes_turned_and_scaled_are_local_axes(latitude: float, from_meridian: float) -> None:
    """A grid step (x, y) is the local step of bearing atan2(x, y) + convergence and length / scale."""
    place = GeoPoint(math.radians(latitude), math.radians(-9.0 + from_meridian))
    point = geographic_to_utm(place, 29)
    convergence, scale = grid_scale(point)
    for x, y in ((60.0, 0.0), (0.0, 60.0), (-30.0, 40.0)):
        there = utm_to_geographic(point._replace(easting=point.easting + x, northing=point.northing + y))
        bearing, length = math.atan2(x, y) + convergence, math.hypot(x, y) / scale
        # the grid is straight over 60 m to some micrometers
        assert to_local(*there, place) == pytest.approx(
            (length * math.cos(bearing), length * math.sin(bearing)), abs=2e-4
        )


@given(latitudes, longitudes, st.floats(-5e4, 5e4), st.floats(-5e4, 5e4))
def test_local_axes_there_and_back(latitude: float, longitude: float, north: float, east: float) -> None:
    origin = GeoPoint(math.radians(latitude), math.radians(longitude))
    assert to_local(*to_geographic(north, east, origin), origin) == pytest.approx((north, east), abs=1e-6)


def test_local_axes_are_azimuthal_equidistant() -> None:
    origin = GeoPoint(math.radians(36.8), math.radians(-7.24))
    projection = Transformer.from_crs(4326, "+proj=aeqd +lat_0=36.8 +lon_0=-7.24 +ellps=WGS84", always_xy=True)
    latitude, longitude = np.radians([36.85, 36.7, 36.8]), np.radians([-7.3, -7.0, -7.24])
    east, north = projection.transform(np.degrees(longitude), np.degrees(latitude))
    assert np.array(to_local(latitude, longitude, origin)) == pytest.approx(np.array([north, east]), abs=1e-4)


@pytest.mark.parametrize(("distance", "error"), [(1e3, 4.2e-9), (1e4, 4.2e-7), (1e5, 4.2e-5)])
def test_lengths_across_are_as_true_as_stated(distance: float, error: float) -> None:
    """Two points 1 m apart, both `distance` north of the origin, side by side."""
    from pyproj import Geod

    origin = GeoPoint(math.radians(36.8), math.radians(-7.24))
    latitude, longitude = to_geographic(np.array([distance, distance]), np.array([-0.5, 0.5]), origin)
    _, _, true = Geod(ellps="WGS84").inv(longitude[0], latitude[0], longitude[1], latitude[1], radians=True)
    assert abs(1.0 / true - 1.0) <= error + 3e-9


def test_the_antimeridian_is_no_border() -> None:
    origin = GeoPoint(math.radians(-17.0), math.radians(179.999))
    north, east = to_local(math.radians(-17.0), math.radians(-179.999), origin)
    assert (north, east) == pytest.approx((0.0, 213.0), abs=1.0)


@pytest.mark.parametrize(
    ("point", "said"),
    [
        (LISBON._replace(zone=61), "zone 61S does not exist"),
        (LISBON._replace(band="I"), "zone 29I does not exist"),
        (LISBON._replace(easting=4290819.848, northing=491854.338), "easting, which comes first"),
        (LISBON._replace(northing=7290819.0), "not a hemisphere: for south of the equator write 29J"),
        (LISBON._replace(band="N"), "not a hemisphere: for north of the equator write 29S"),
        (LISBON._replace(band="T"), "between 40 and 48 deg; check the northing"),
        (LISBON._replace(easting=math.nan), "easting nan m"),
    ],
)
def test_impossible_coordinates_are_refused(point: GridPoint, said: str) -> None:
    with pytest.raises(InputError) as refusal:
        utm_to_geographic(point)
    assert said in str(refusal.value)


def test_utm_does_not_reach_the_poles() -> None:
    with pytest.raises(InputError, match="80 deg south to 84 deg north"):
        geographic_to_utm(GeoPoint(math.radians(85.0), 0.0))
