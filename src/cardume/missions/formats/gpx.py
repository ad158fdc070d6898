"""GPX 1.0 and 1.1: routes, tracks and waypoints of satellite receivers and charting programs.

A file's first route is flown; without one its first track, whose parts are joined by straight legs; without
either its waypoints, in the order of the file.  An elevation below zero is a depth.

Source: topografix.com/GPX/1/1, the schema.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any
from xml.parsers import expat
from xml.sax.saxutils import escape

from cardume.errors import MissionError, Position, Problem
from cardume.missions.formats.content import refused
from cardume.missions.formats.sampling import Course
from cardume.missions.formats.waypoints import DEEPEST, Draft, Waypoint, check_place, geo
from cardume.units import printable, show_text

NAMESPACE = "urn:cardume:gpx:1"
POINTS = {"rtept": "rte", "trkpt": "trk", "wpt": "gpx"}
MOST_NESTED = 40
NUMBER = re.compile(r"\s*[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\s*")


@dataclass(slots=True)
class Line:
    """A route, a track, or the waypoints of a file."""

    kind: str
    name: str = ""
    parts: list[list[Waypoint]] = field(default_factory=lambda: [[]])

    @property
    def points(self) -> list[Waypoint]:
        """All of its points."""
        return [point for part in self.parts for point in part]


def read_gpx(text: str, source: str) -> Draft:
    """Read a GPX file.

    Args:
        text: its contents.
        source: what messages call it.

    Raises:
        MissionError: no XML, no GPX, entities, or points that lie nowhere.
    """
    lines = [line for line in _Reader(source).read(text) if line.points]
    order = {"rte": 0, "trk": 1, "gpx": 2}
    lines.sort(key=lambda line: order[line.kind])
    if not lines:
        raise refused(source, "holds no points: neither route, track nor waypoints")
    flown, notes = lines[0], list[str]()
    if flown.kind == "gpx":
        notes.append("waypoints without a route are flown in the order of the file")
    for line in lines[1:]:
        what = {"rte": "route", "trk": "track", "gpx": "waypoints"}[line.kind]
        notes.append(f"{what} {show_text(line.name) + ' ' if line.name else ''}({len(line.points)} points): not flown")
    parts = [part for part in flown.parts if part]
    if len(parts) > 1:
        notes.append(f"{len(parts)} parts of the track are joined by straight legs")
    return Draft(source=source, name=flown.name, waypoints=flown.points, notes=notes)


def write_gpx(course: Course) -> bytes:
    """GPX 1.1 with one route; depths as negative elevations, speeds in an extension of our own.

    Args:
        course: what to write.
    """
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<gpx version="1.1" creator="cardume" xmlns="http://www.topografix.com/GPX/1/1" xmlns:cardume="{NAMESPACE}">',
        "  <rte>",
        f"    <name>{escape(printable(course.name))}</name>",
    ]
    for speed, point in zip(course.speeds, course.points, strict=True):
        latitude, longitude = (f"{degrees:.10f}" for degrees in point.degrees)
        inner = "" if course.depth is None else f"<ele>{0.0 - course.depth:.12g}</ele>"
        if speed is not None:
            inner += f"<extensions><cardume:speed>{speed!r}</cardume:speed></extensions>"
        lines.append(f'    <rtept lat="{latitude}" lon="{longitude}">{inner}</rtept>')
    return ("\n".join([*lines, "  </rte>", "</gpx>"]) + "\n").encode()


class _Reader:
    """Takes the parser's events."""

    def __init__(self, source: str) -> None:
        self.source, self.problems = source, list[Problem]()
        self.stack: list[str] = []
        self.lines: list[Line] = [Line("gpx")]
        self.counts: dict[str, int] = {}
        self.point: dict[str, Any] = {}
        self.text: list[str] = []
        self.parser = expat.ParserCreate(encoding="UTF-8", namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self.text.append
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.EntityDeclHandler = self._refuse_doctype

    def read(self, text: str) -> list[Line]:
        """The lines of the file, in order."""
        try:
            self.parser.Parse(text.encode("utf-8", "surrogatepass"), True)
        except expat.ExpatError as problem:
            message = expat.errors.messages.get(problem.code, "not well formed")
            raise refused(self.source, f"is not XML: {message}; it may be cut off", problem.lineno) from None
        if self.problems:
            raise MissionError(self.problems)
        return self.lines

    def _refuse_doctype(self, *_: Any) -> None:
        raise refused(
            self.source,
            "declares a document type or entities, which GPX does not need and which can blow up: remove <!DOCTYPE",
            self.parser.CurrentLineNumber,
        )

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        space, _, name = tag.rpartition(" ")
        if not self.stack and name != "gpx":
            raise refused(self.source, f"is XML of the kind {show_text(name)}; GPX is read: convert it first", 1)
        if len(self.stack) > MOST_NESTED:
            raise refused(self.source, "is nested too deeply for GPX", self.parser.CurrentLineNumber)
        self.text.clear()
        parent = self.stack[-1] if self.stack else ""
        self.stack.append(f"{NAMESPACE} {name}" if space == NAMESPACE else name)
        if name in ("rte", "trk"):
            self.lines.append(Line(name))
        elif name == "trkseg" and self.lines[-1].kind == "trk":
            self.lines[-1].parts.append([])
        elif name in POINTS and parent in (POINTS[name], "trkseg"):
            self.counts[name] = self.counts.get(name, 0) + 1
            place = {"line": self.parser.CurrentLineNumber, "label": f"{name} {self.counts[name]}"}
            self.point = {key: attributes[key] for key in ("lat", "lon") if key in attributes} | place

    def _end(self, _tag: str) -> None:
        name, text = self.stack.pop(), "".join(self.text).strip()
        self.text.clear()
        parent = self.stack[-1] if self.stack else ""
        if name == "name" and parent in ("rte", "trk"):
            self.lines[-1].name = printable(text[:200])
        elif name == "ele" and parent in POINTS and self.point:
            self.point["ele"] = text
        elif name == f"{NAMESPACE} speed" and self.point:
            self.point["speed"] = text
        elif name in POINTS and self.point:
            line = self.lines[0] if name == "wpt" else self.lines[-1]
            if (waypoint := self._waypoint()) is not None:
                line.parts[-1].append(waypoint)
            self.point = {}

    def _waypoint(self) -> Waypoint | None:
        """The point that just ended; what is wrong with it is noted."""
        position = Position(self.source, self.point["line"], self.point["label"])
        before = len(self.problems)
        latitude, longitude = self._number("lat", position), self._number("lon", position)
        if len(self.problems) == before and (problem := check_place(latitude, longitude)):
            self.problems.append(Problem(position, problem))
        depth = 0.0 - self._number("ele", position) if "ele" in self.point else None
        if depth is not None and depth > DEEPEST:
            self.problems.append(Problem(position, f"elevation is {-depth:g} m; no sea is deeper than {DEEPEST:g} m"))
        speed = self._number("speed", position) if "speed" in self.point else None
        if speed is not None and not speed > 0.0:
            self.problems.append(Problem(position, f"speed is {speed:g} m/s; it must be > 0"))
        if len(self.problems) > before:
            return None
        return Waypoint(
            place=geo(latitude, longitude),
            speed=speed,
            depth=None if depth is None else max(depth, 0.0),
            label=self.point["label"],
            position=position,
        )

    def _number(self, name: str, position: Position) -> float:
        word = self.point.get(name)
        if word is None:
            self.problems.append(Problem(position, f"has no {name}"))
            return math.nan
        if not NUMBER.fullmatch(word) or not math.isfinite(float(word)):
            point = "; the decimal sign is a point" if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", word) else ""
            self.problems.append(Problem(position, f"{name} is {show_text(word)}; it must be a finite number{point}"))
            return math.nan
        return float(word)
