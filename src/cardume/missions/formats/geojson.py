"""GeoJSON: lines on the Earth, WGS 84, longitude first.

Every LineString and MultiLineString is flown, one after the other; where the next does not begin at the end of
the last, a straight leg joins them.  A line's property `speed` [m/s] is that of its legs; a third coordinate
below zero is a depth.

Source: RFC 7946.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from cardume.missions.formats.document import Document, Path, described
from cardume.missions.formats.sampling import DIGITS, Course, Place
from cardume.missions.formats.waypoints import DEEPEST, Draft, Waypoint, check_place, geo
from cardume.missions.geodesy import GeoPoint
from cardume.units import printable

LINES = {"LineString", "MultiLineString"}
AREAS = {"Polygon", "MultiPolygon"}
GEOMETRIES = {*LINES, *AREAS, "Point", "MultiPoint", "GeometryCollection"}
WGS84 = ("CRS84", "EPSG::4326", "EPSG:4326", "OGC:CRS84", "WGS84", "WGS 84")
MOST_NESTED = 20
SAME = 1e-8  # [rad] 6 cm


def read_geojson(text: str, source: str) -> Draft:
    """Read a GeoJSON file.

    Args:
        text: its contents.
        source: what messages call it.

    Raises:
        MissionError: no GeoJSON, another datum, or positions that lie nowhere.
    """
    return _Reader(Document(text, source)).read()


def write_geojson(course: Course) -> bytes:
    """A FeatureCollection with a LineString for each run of legs of one speed, each beginning where the last ended.

    Args:
        course: what to write.
    """
    features, first = [], 0
    for last in range(1, len(course.points)):
        if last + 1 == len(course.points) or course.speeds[last + 1] != course.speeds[last]:
            features.append(_feature(course, course.points[first : last + 1], course.speeds[last]))
            first = last
    collection = {"type": "FeatureCollection", "features": features}
    return (json.dumps(collection, indent=2, allow_nan=False, ensure_ascii=False) + "\n").encode()


def _feature(course: Course, points: tuple[Place, ...], speed: float | None) -> dict[str, Any]:
    depth = [] if course.depth is None else [0.0 - course.depth]
    parts = [[[*point, *depth] for point in part] for part in _cut([_position(point) for point in points])]
    kind, coordinates = ("LineString", parts[0]) if len(parts) == 1 else ("MultiLineString", parts)
    properties = {"name": course.name, **({"speed": speed} if speed is not None else {})}
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": kind, "coordinates": coordinates},
    }


def _position(point: Place) -> tuple[float, float]:
    latitude, longitude = point.degrees
    return longitude, latitude


def _cut(line: Sequence[tuple[float, float]]) -> list[list[tuple[float, float]]]:
    """A line cut where it crosses the antimeridian, as the RFC wants it."""
    parts = [[line[0]]]
    for (longitude, latitude), after in pairwise(line):
        if abs(after[0] - longitude) > 180.0:
            side = math.copysign(180.0, longitude)
            beyond = after[0] + 2.0 * side  # as if longitudes went on
            share = (side - longitude) / (beyond - longitude) if beyond != longitude else 0.0
            at = round(latitude + share * (after[1] - latitude), DIGITS)
            parts[-1].append((side, at))
            parts.append([(-side, at)])
        parts[-1].append(after)
    return parts


def _is_gap(one: GeoPoint, other: GeoPoint) -> bool:
    turned = math.remainder(one.longitude - other.longitude, 2.0 * math.pi)
    return max(abs(one.latitude - other.latitude), abs(turned)) > SAME


class _Reader:
    """Walks through the objects of a file."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.lines: list[list[Waypoint]] = []
        self.points: list[Waypoint] = []
        self.names: list[str] = []
        self.areas = 0

    def read(self) -> Draft:
        """The whole file."""
        self._check_datum()
        self._object((), None)
        notes = list[str]()
        if self.areas:
            notes.append(f"areas, polygons ({self.areas}): not flown")
        if self.lines and self.points:
            notes.append(f"single points beside the lines ({len(self.points)}): not flown")
        elif self.points:
            notes.append("points without a line are flown in the order of the file")
            self.lines = [self.points]
        if not self.lines:
            found = "only areas (polygons)" if self.areas else "no lines"
            raise self.document.error((), f"holds {found}; a path is a LineString or MultiLineString")
        gaps = sum(_is_gap(before[-1].place, after[0].place) for before, after in pairwise(self.lines))
        if gaps:
            notes.append(f"gaps between lines ({gaps}): flown straight across")
        waypoints = [waypoint for line in self.lines for waypoint in line]
        name = self.names[0] if self.names else ""
        return Draft(
            source=self.document.source, name=name, waypoints=waypoints, notes=notes, locate=self.document.located
        )

    def _check_datum(self) -> None:
        """Before RFC 7946 a file could name another coordinate system."""
        crs = self.document.get(("crs",))
        name = self.document.get(("crs", "properties", "name"))
        if crs is not None and not (isinstance(name, str) and name.endswith(WGS84)):
            raise self.document.error(
                ("crs",), f"is {described(name)}; longitude and latitude in WGS 84 are read: reproject the file"
            )

    def _object(self, path: Path, properties: Any) -> None:
        document = self.document
        if len(path) > MOST_NESTED:
            raise document.error(path, "is nested too deeply for GeoJSON")
        kind = document.section(path).get("type")
        if kind == "FeatureCollection":
            self._each((*path, "features"), properties)
        elif kind == "Feature":
            inner = document.get((*path, "properties"))
            self._name(inner)
            if document.get((*path, "geometry")) is not None:
                self._object((*path, "geometry"), (inner, path))
        elif kind == "GeometryCollection":
            self._each((*path, "geometries"), properties)
        elif isinstance(kind, str) and kind in GEOMETRIES:
            self._geometry(kind, (*path, "coordinates"), properties)
        else:
            raise document.error(
                (*path, "type"),
                f"is {described(kind)}; it must be FeatureCollection, Feature, or a geometry such as LineString",
            )

    def _each(self, path: Path, properties: Any) -> None:
        for index in range(len(self.document.items(path))):
            self._object((*path, index), properties)

    def _name(self, properties: Any) -> None:
        name = properties.get("name") if isinstance(properties, dict) else None
        if isinstance(name, str) and name:
            self.names.append(printable(name[:200]))

    def _geometry(self, kind: str, path: Path, properties: Any) -> None:
        speed = self._speed(properties)
        if kind in AREAS:
            self.areas += 1
        elif kind == "Point":
            self.points.append(self._position(path, None))
        elif kind == "MultiPoint":
            self.points += self._line(path, None, least=0)
        elif kind == "LineString":
            self.lines.append(self._line(path, speed))
        else:
            for index in range(len(self.document.items(path))):
                self.lines.append(self._line((*path, index), speed))

    def _speed(self, properties: Any) -> float | None:
        if properties is None or not isinstance(properties[0], dict) or properties[0].get("speed") is None:
            return None
        path = (*properties[1], "properties", "speed")
        speed = self.document.number(path)
        if not speed > 0.0:
            raise self.document.error(path, f"is {speed:g} m/s; it must be > 0")
        return speed

    def _line(self, path: Path, speed: float | None, least: int = 2) -> list[Waypoint]:
        count = len(self.document.items(path))
        if count < least:
            raise self.document.error(path, f"has {count} positions; a line needs at least two")
        return [self._position((*path, index), speed) for index in range(count)]

    def _position(self, path: Path, speed: float | None) -> Waypoint:
        document = self.document
        values = document.items(path)
        if not 2 <= len(values) <= 10:
            raise document.error(path, f"has {len(values)} numbers; a position is longitude, latitude, maybe altitude")
        longitude, latitude = document.number((*path, 0)), document.number((*path, 1))
        if problem := check_place(latitude, longitude):
            raise document.error(path, f"{problem}; GeoJSON gives longitude first")
        depth = None
        if len(values) > 2:
            depth = max(0.0 - document.number((*path, 2), 0.0), 0.0)
            if depth > DEEPEST:
                raise document.error((*path, 2), f"is {-depth:g} m; no sea is deeper than {DEEPEST:g} m")
        label = f"position {path[-1]}" if path and isinstance(path[-1], int) else "point"
        return Waypoint(
            place=geo(latitude, longitude), speed=speed, depth=depth, label=label, position=document.position(path)
        )
