"""An ocean current as read from a file, and the flat table that compiled code takes of it."""

from dataclasses import dataclass
from datetime import datetime

import numpy as np

from cardume.errors import DataError
from cardume.missions.geodesy import GeoPoint
from cardume.world.currents import pack_grid

MAJOR_AXIS, FLATTENING = 6378137.0, 1.0 / 298.257223563  # [m], WGS84
NEAR_THE_POLE_DEG = 89.0


@dataclass(frozen=True, kw_only=True, eq=False)
class CurrentField:
    """A current on a grid of latitudes and longitudes; angles in degrees as files have them, all axes increasing."""

    source: str  # the file
    title: str  # what the file calls itself
    names: tuple[str, str]  # its variables for the velocity to the east and to the north
    start: datetime | None  # of the mission, UTC; None where the file has no time or a calendar of its own
    times: np.ndarray  # (num_times,) [s] since the start of the mission
    depths: np.ndarray  # (num_depths,) [m] below the surface
    latitudes_deg: np.ndarray  # (num_latitudes,) north positive
    longitudes_deg: np.ndarray  # (num_longitudes,) east positive; may go beyond 180 or below -180
    velocity: np.ndarray  # (num_times, num_depths, num_latitudes, num_longitudes, 2) [m/s] north, east; NaN: unknown

    def to_rows(self, origin: GeoPoint) -> np.ndarray:
        """The table that the law `gridded` reads.

        Latitude and longitude become north and east by the two radii of curvature at the origin.  Against the mission's
        own axes (azimuthal equidistant) this misplaces the field by E^2 tan(latitude) / (2 R) to the south and
        N E tan(latitude) / R to the east: at 36.8 N and 5 km north and 5 km east of the origin by 3.3 m, at 10 km and
        10 km by 13 m, where a cell of the grid has a thousand meters and more.

        Args:
            origin: of the mission's local axes.

        Returns:
            (n,) float64, read-only, in meters, seconds and m/s.

        Raises:
            DataError: an origin within a degree of a pole, where meridians are not parallel.
        """
        norths, easts = local_axes(self.latitudes_deg, self.longitudes_deg, origin)
        order = np.argsort(easts)  # a field around the whole Earth may begin elsewhere
        return pack_grid(self.times, self.depths, norths, easts[order], self.velocity[:, :, :, order])


def local_axes(
    latitudes_deg: np.ndarray, longitudes_deg: np.ndarray, origin: GeoPoint
) -> tuple[np.ndarray, np.ndarray]:
    """North [m] of parallels and east [m] of meridians, near an origin.

    Args:
        latitudes_deg: (n,)
        longitudes_deg: (m,)
        origin: where both are 0.

    Raises:
        DataError: an origin within a degree of a pole.
    """
    latitude_deg, longitude_deg = np.degrees(origin.latitude), np.degrees(origin.longitude)
    if abs(latitude_deg) > NEAR_THE_POLE_DEG:
        raise DataError(
            f"origin is at latitude {latitude_deg:.4f} deg; gridded currents work up to {NEAR_THE_POLE_DEG:g} deg"
        )
    north_scale, east_scale = meters_per_degree(origin.latitude)
    return (latitudes_deg - latitude_deg) * north_scale, around(longitudes_deg, longitude_deg) * east_scale


def meters_per_degree(latitude: float) -> tuple[float, float]:
    """Length [m] of a degree of latitude and of a degree of longitude on the WGS84 ellipsoid.

    M = a (1 - e^2) / (1 - e^2 sin^2)^(3/2),   N cos = a cos / (1 - e^2 sin^2)^(1/2)

    Args:
        latitude: [rad]
    """
    squared = FLATTENING * (2.0 - FLATTENING)
    bulge = 1.0 - squared * np.sin(latitude) ** 2
    meridian = MAJOR_AXIS * (1.0 - squared) / bulge**1.5
    parallel = MAJOR_AXIS * np.cos(latitude) / bulge**0.5
    return float(np.radians(meridian)), float(np.radians(parallel))


def around(longitudes_deg: np.ndarray, center_deg: float) -> np.ndarray:
    """Longitudes [deg] counted from a center, -180 to 180.

    Args:
        longitudes_deg: (n,)
        center_deg: where it is 0.
    """
    return (np.asarray(longitudes_deg, dtype=float) - center_deg + 180.0) % 360.0 - 180.0
