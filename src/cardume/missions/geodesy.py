"""Places on the Earth: latitude and longitude, UTM grid coordinates, and the local north-east axes of a mission.

The local axes are azimuthal equidistant on the WGS84 ellipsoid: a point's distance and direction from the
origin are those of the geodesic.  Between two points d away from the origin lengths are true to d^2 / (6 R^2),
R = 6371 km: 4e-9 at 1 km, 4e-7 at 10 km, 4e-5 at 100 km.

UTM axes are not local axes.  Grid north is turned from true north by the convergence, up to some 3 degrees at
the edge of a zone, and a grid length is 0.9996 to 1.001 times the length on the ellipsoid.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import InputError

BANDS = "CDEFGHJKLMNPQRSTUVWX"  # 8 degrees of latitude each from 80 S on; X has 12
BAND_HEIGHT = np.radians(8.0)
SOUTHERNMOST, NORTHERNMOST = np.radians(-80.0), np.radians(84.0)
AT_EDGE = np.radians(0.5)  # a plan may reach over the edge of its band


class GeoPoint(NamedTuple):
    """A place on the WGS84 ellipsoid."""

    latitude: float  # [rad] north positive
    longitude: float  # [rad] east positive


class GridPoint(NamedTuple):
    """A place in a UTM zone."""

    easting: float  # [m]
    northing: float  # [m]
    zone: int  # 1 to 60
    band: str  # latitude band, C to X without I and O


class GridScale(NamedTuple):
    """How grid axes lie to true ones at a place."""

    convergence: float  # [rad] from true north to grid north, clockwise positive
    scale: float  # [-] grid length per true length


def utm_to_geographic(point: GridPoint) -> GeoPoint:
    """Latitude and longitude of a place given in UTM.

    The letter is a latitude band, not a hemisphere: 29S lies between 32 and 40 degrees north.

    Args:
        point: easting [m], northing [m], zone and band.

    Raises:
        InputError: a zone or band that does not exist, coordinates that no zone has, or a place outside its band.
    """
    if not 1 <= point.zone <= 60 or point.band not in BANDS:
        raise InputError(
            f"UTM zone {point.zone}{point.band} does not exist; zones are 1 to 60, followed by a latitude band"
            f" of {BANDS}"
        )
    if not (100e3 <= point.easting < 1000e3 and -60e3 <= point.northing <= 10060e3):
        raise InputError(
            f"UTM coordinates are easting {point.easting:.10g} m, northing {point.northing:.10g} m; easting, which"
            " comes first, lies between 100000 and 1000000 m, northing between 0 and 10000000 m"
        )
    longitude, latitude = _utm(point.zone, point.band < "N")(
        point.easting, point.northing, inverse=True, errcheck=True, radians=True
    )
    low, high = band_limits(point.band)
    if not low - AT_EDGE <= latitude <= high + AT_EDGE:
        raise InputError(_outside_band(point, latitude, low, high))
    return GeoPoint(float(latitude), float(longitude))


def geographic_to_utm(place: GeoPoint, zone: int | None = None) -> GridPoint:
    """UTM coordinates of a place.

    Args:
        place: latitude and longitude [rad].
        zone: UTM zone to express it in; None: the one it lies in (the exceptions around Norway are not made).

    Raises:
        InputError: a latitude that UTM does not cover.
    """
    if not SOUTHERNMOST <= place.latitude <= NORTHERNMOST:
        raise InputError(f"latitude is {np.degrees(place.latitude):.6g} deg; UTM covers 80 deg south to 84 deg north")
    longitude = np.degrees(place.longitude)
    zone = zone or int((longitude + 180.0) // 6.0) % 60 + 1
    band = BANDS[min(int((place.latitude - SOUTHERNMOST) / BAND_HEIGHT), len(BANDS) - 1)]
    easting, northing = _utm(zone, band < "N")(place.longitude, place.latitude, errcheck=True, radians=True)
    return GridPoint(float(easting), float(northing), zone, band)


def grid_scale(point: GridPoint) -> GridScale:
    """Convergence and scale of the UTM grid at a place."""
    place = utm_to_geographic(point)
    factors = _utm(point.zone, point.band < "N").get_factors(place.longitude, place.latitude, radians=True)
    return GridScale(float(np.radians(factors.meridian_convergence)), float(factors.meridional_scale))


def to_local(latitude: Any, longitude: Any, origin: GeoPoint) -> tuple[Any, Any]:
    """North and east [m] of places, from the origin.

    Args:
        latitude: [rad] a number or an array.
        longitude: [rad] the same shape.
        origin: of the local axes.
    """
    azimuth, _, distance = _ellipsoid().inv(
        np.full_like(longitude, origin.longitude, dtype=float),
        np.full_like(latitude, origin.latitude, dtype=float),
        longitude,
        latitude,
        radians=True,
    )
    return distance * np.cos(azimuth) + 0.0, distance * np.sin(azimuth) + 0.0  # no -0


def to_geographic(north: Any, east: Any, origin: GeoPoint) -> tuple[Any, Any]:
    """Latitude and longitude [rad] of places given in local axes.

    Args:
        north: [m] a number or an array.
        east: [m] the same shape.
        origin: of the local axes.
    """
    longitude, latitude, _ = _ellipsoid().fwd(
        np.full_like(east, origin.longitude, dtype=float),
        np.full_like(north, origin.latitude, dtype=float),
        np.arctan2(east, north),
        np.hypot(north, east),
        radians=True,
    )
    return latitude, longitude


def band_limits(band: str) -> tuple[float, float]:
    """Latitudes [rad] between which a band lies."""
    low = SOUTHERNMOST + BANDS.index(band) * BAND_HEIGHT
    return low, NORTHERNMOST if band == "X" else low + BAND_HEIGHT


def _outside_band(point: GridPoint, latitude: float, low: float, high: float) -> str:
    text = (
        f"northing {point.northing:.10g} m in zone {point.zone}{point.band} is latitude {np.degrees(latitude):.4f} deg,"
        f" but band {point.band} lies between {np.degrees(low):g} and {np.degrees(high):g} deg"
    )
    if point.band in "NS":
        return text + f"; the letter is a latitude band, not a hemisphere: {_likely(point)}"
    return text + "; check the northing and the letter"


def _likely(point: GridPoint) -> str:
    """The zone that was probably meant where N or S stands for a hemisphere."""
    southern = point.band == "S"
    _, latitude = _utm(point.zone, southern)(point.easting, point.northing, inverse=True, radians=True)
    if not SOUTHERNMOST <= latitude <= NORTHERNMOST:
        return "check the northing"
    band = BANDS[min(int((latitude - SOUTHERNMOST) / BAND_HEIGHT), len(BANDS) - 1)]
    half = "south" if southern else "north"
    return f"for {half} of the equator write {point.zone}{band}"


@cache
def _utm(zone: int, south: bool) -> Any:
    from pyproj import Proj  # loaded where a mission needs it: 0.1 s

    return Proj(proj="utm", zone=zone, ellps="WGS84", south=south)


@cache
def _ellipsoid() -> Any:
    from pyproj import Geod

    return Geod(ellps="WGS84")
