"""Whether a mission stays where a current field has water, and if not, where it would."""

import numpy as np

from cardume.missions.currents.field import CurrentField, local_axes
from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.world.currents import water_at

WINDS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
FINENESS = 20.0  # places looked at per cell of the grid


def explain_coverage(field: CurrentField, origin: GeoPoint, points: np.ndarray) -> str:
    """Why a mission cannot be flown in a field; "" where it can.

    Looks up the current at the points, in the middle of cells as the law does, at every time that was read.

    Args:
        field: of the current.
        origin: of the mission's local axes.
        points: [m] (n, 2) north and east, or (n, 3) with depth, of the paths and the vehicles' starts.
    """
    rows = field.to_rows(origin)
    for point in _thinned(field, origin, points):
        north, east, depth = point
        for time in np.unique(np.clip(field.times, 0.0, None)):
            if np.isnan(water_at(rows, north, east, depth, time).north):
                return _explain(field, origin, point, time)
    return ""


def _thinned(field: CurrentField, origin: GeoPoint, points: np.ndarray) -> np.ndarray:
    """The first of the points in each small part of a cell, (m, 3), in their order."""
    norths, easts = local_axes(field.latitudes_deg, field.longitudes_deg, origin)
    places = np.zeros((len(points), 3))
    places[:, : np.shape(points)[1]] = points
    sides = [np.diff(norths).min() / FINENESS, np.abs(np.diff(easts)).min() / FINENESS, 1.0]
    _, first = np.unique(np.round(places / sides), axis=0, return_index=True)
    return places[np.sort(first)]


def _explain(field: CurrentField, origin: GeoPoint, point: np.ndarray, time: float) -> str:
    north, east, depth = point
    latitude, longitude = np.degrees(to_geographic(north, east, origin))
    norths, easts = local_axes(field.latitudes_deg, field.longitudes_deg, origin)
    here = f"north {north:.0f} m, east {east:.0f} m ({show_place(latitude, longitude)})"
    if not (norths[0] <= north <= norths[-1] and easts.min() <= east <= easts.max()):
        covered = (
            f"latitude {field.latitudes_deg[0]:.4f} to {field.latitudes_deg[-1]:.4f}, longitude"
            f" {field.longitudes_deg[0]:.4f} to {field.longitudes_deg[-1]:.4f} deg"
        )
        return f"{field.source}: the mission leaves the grid at {here}; what was read covers {covered}"
    when = f", {time:.0f} s after the start" if len(field.times) > 1 else ""
    text = f"{field.source}: a hole (land, or not measured) at {here}, depth {depth:.0f} m{when}"
    return f"{text}; {_nearest(field, norths, easts, point, time)}"


def _nearest(field: CurrentField, norths: np.ndarray, easts: np.ndarray, point: np.ndarray, time: float) -> str:
    """Where the nearest cell is that holds water at the level and the time nearest to a point's."""
    level = int(np.abs(field.depths - point[2]).argmin())
    moment = int(np.abs(field.times - time).argmin())
    known = np.isfinite(field.velocity[moment, level]).all(axis=-1)
    if not known.any():
        return "this level has no water at all: choose shallower vehicles, another time or another file"
    distance = np.hypot(norths[:, None] - point[0], easts[None, :] - point[1])
    row, column = np.unravel_index(np.where(known, distance, np.inf).argmin(), distance.shape)
    bearing = np.arctan2(easts[column] - point[1], norths[row] - point[0])
    wind = WINDS[round(bearing / (np.pi / 4.0)) % 8]
    place = show_place(field.latitudes_deg[row], field.longitudes_deg[column])
    return (
        f"the nearest cell with water is {distance[row, column] / 1000.0:.1f} km {wind}, at {place}: move the origin"
        " there or use another file"
    )


def show_place(latitude_deg: float, longitude_deg: float) -> str:
    """A place for a message, as 36.8000 N 7.2400 W.

    Args:
        latitude_deg: north positive.
        longitude_deg: east positive.
    """
    longitude = (longitude_deg + 180.0) % 360.0 - 180.0
    return (
        f"{abs(latitude_deg):.4f} {'N' if latitude_deg >= 0.0 else 'S'}"
        f" {abs(longitude):.4f} {'E' if longitude >= 0.0 else 'W'}"
    )
