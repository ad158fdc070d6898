"""Where vehicles were and believed to be, as tracks on the Earth."""

from typing import NamedTuple

import numpy as np

from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.simulation.flight import Flight

TRUE, BELIEVED = "true", "believed"
KINDS = {TRUE: "", BELIEVED: "_estimate"}  # endings of the log's channels
EPOCH = np.datetime64("1970-01-01T00:00:00.000")  # when a mission begins, for formats that want a date


class Track(NamedTuple):
    """One vehicle's way; points where a place is not known are left out."""

    vehicle: str
    kind: str  # one of KINDS
    times: np.ndarray  # (n,) [s]
    latitude_deg: np.ndarray  # (n,)
    longitude_deg: np.ndarray  # (n,)
    depth: np.ndarray  # (n,) [m] true, also of a believed track; 0 where it is not known


def tracks_of(flight: Flight, origin: GeoPoint) -> list[Track]:
    """Two tracks per vehicle, the true and the believed one; a track without points is left out.

    Args:
        flight: what was flown.
        origin: where its north = east = 0 lies.
    """
    tracks = []
    for k, name in enumerate(flight.vehicle_names):
        for kind, ending in KINDS.items():
            north, east = (flight.channels[f"{axis}{ending}"][:, k] for axis in ("north", "east"))
            depth = flight.channels["depth"][:, k]
            known = np.isfinite(north) & np.isfinite(east)
            if known.any():
                latitude, longitude = degrees_of(north[known], east[known], origin)
                tracks.append(Track(name, kind, flight.times[known], latitude, longitude, np.nan_to_num(depth[known])))
    return tracks


def degrees_of(north: np.ndarray, east: np.ndarray, origin: GeoPoint) -> tuple[np.ndarray, np.ndarray]:
    """Latitudes and longitudes [deg] of places, NaN where a place is not known.

    Args:
        north: (n,) [m]
        east: (n,) [m]
        origin: where both are 0.
    """
    latitude, longitude = to_geographic(np.nan_to_num(north), np.nan_to_num(east), origin)
    unknown = ~(np.isfinite(north) & np.isfinite(east))
    return (
        np.where(unknown, np.nan, np.degrees(latitude)),
        np.where(unknown, np.nan, np.degrees(longitude)),
    )


def moments(times: np.ndarray) -> list[str]:
    """Times as ISO 8601, in UTC, of a mission that begins at the EPOCH.

    Args:
        times: (n,) [s]
    """
    stamps = EPOCH + np.round(times * 1000.0).astype("timedelta64[ms]")
    return [f"{text}Z" for text in np.datetime_as_string(stamps, unit="ms")]
