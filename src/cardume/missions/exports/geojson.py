"""GeoJSON tracks, for QGIS and the web: one feature per vehicle, true and believed.

Source: RFC 7946; `times` beside the coordinates as in no standard.
"""

import json

from cardume.missions.exports.tracks import Track


def geojson_of(tracks: list[Track], name: str) -> bytes:
    """The tracks as a FeatureCollection; heights below zero are depths.

    Args:
        tracks: any number.
        name: of the mission.
    """
    features = [_feature(track) for track in tracks]
    collection = {"type": "FeatureCollection", "name": name, "features": features}
    return json.dumps(collection, allow_nan=False, separators=(",", ":")).encode("ascii") + b"\n"


def _feature(track: Track) -> dict[str, object]:
    rows = zip(track.longitude_deg, track.latitude_deg, track.depth, strict=True)
    points = [[round(float(x), 9), round(float(y), 9), round(-float(z) + 0.0, 3)] for x, y, z in rows]
    is_line = len(points) > 1  # a line of one point is none
    return {
        "type": "Feature",
        "properties": {
            "vehicle": track.vehicle,
            "kind": track.kind,
            "times": [round(float(time), 6) for time in track.times],
        },
        "geometry": {
            "type": "LineString" if is_line else "Point",
            "coordinates": points if is_line else points[0],
        },
    }
