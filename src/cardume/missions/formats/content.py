"""The bytes of a path file as text, and which format they are in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from cardume.errors import MissionError, Position, Problem
from cardume.missions.source import nearest_file
from cardume.units import printable

MAX_BYTES = 20_000_000  # a day's track at one point a second has some ten million
MEDUSA, QGC, WPL, GPX, GEOJSON = "medusa", "plan", "wpl", "gpx", "geojson"
XML_ENCODING = re.compile(rb"""<\?xml[^>]{0,100}encoding\s*=\s*["']([A-Za-z0-9._-]{1,40})["']""")


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of path file.

    Attributes:
        title: what it is called.
        suffixes: endings of the names of such files, the usual one first.
        keeps: what of a mission such a file holds.
    """

    title: str
    suffixes: tuple[str, ...]
    keeps: str


FORMATS = {
    MEDUSA: Format(
        "MEDUSA / Farol mission text", (".medusa.txt", ".medusa"), "lines, arcs, speeds, offsets and depths of vehicles"
    ),
    QGC: Format("QGroundControl plan", (".plan",), "straight legs, speeds, one depth, geofence"),
    WPL: Format("ArduPilot waypoints, QGC WPL 110", (".waypoints", ".wpl"), "straight legs, speeds, one depth"),
    GPX: Format("GPX route", (".gpx",), "straight legs, one depth; speeds in an extension"),
    GEOJSON: Format("GeoJSON lines", (".geojson", ".json"), "straight legs, one depth; speeds as a property"),
}


def refused(source: str, message: str, line: int = 0, key: str = "") -> MissionError:
    """An error about a path file, to raise.

    Args:
        source: the file.
        message: what was given, what is valid, what to do.
        line: where; 0: nowhere in particular.
        key: of the value, or its line's keyword.
    """
    return MissionError([Problem(Position(source, line, printable(key)), message)])


def read_text(file: Path) -> str:
    """The text of a path file.

    Raises:
        MissionError: missing, a directory, unreadable, too large, empty or binary.
    """
    source = printable(str(file))
    try:
        if file.exists() and not file.is_file():
            raise refused(source, "is not a regular file; give a path file")
        with open(file, "rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise refused(source, f"no such file{nearest_file(file)}") from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise refused(source, f"cannot be read: {reason}; check the path and its permissions") from None
    if len(content) > MAX_BYTES:
        raise refused(source, f"larger than {MAX_BYTES:,} bytes; split it, or thin its points out")
    return decode(content, source)


def decode(content: bytes, source: str) -> str:
    """The text that bytes hold; what is not UTF-8 is read as Latin-1, for the sake of old comments.

    Args:
        content: of a path file.
        source: what messages call it.

    Raises:
        MissionError: nothing, or no text.
    """
    if not content.strip():
        raise refused(source, "is empty; a path file holds at least two points")
    if b"\0" in content:
        raise refused(source, "is a binary file or UTF-16 text; save it as UTF-8 text")
    declared = XML_ENCODING.match(content.removeprefix(b"\xef\xbb\xbf").lstrip()[:200])
    for encoding in ("utf-8-sig", declared[1].decode("ascii") if declared else "utf-8"):
        try:
            return content.decode(encoding)
        except (UnicodeError, LookupError):
            continue
    return content.decode("latin-1")


def format_of(text: str, file: str = "") -> str:
    """Which of our formats a text is in, from what it begins with; MEDUSA text if nothing speaks for another.

    Args:
        text: of the file.
        file: its name, whose ending decides what the text leaves open.
    """
    head = text.lstrip()
    if head.startswith("QGC WPL"):
        return WPL
    if head.startswith("<"):
        return GPX
    suffix = suffix_format(file)
    if head.startswith(("{", "[")):
        return QGC if '"fileType"' in head or suffix == QGC else GEOJSON
    return suffix or MEDUSA


def suffix_format(file: str) -> str:
    """The format that a file's name speaks of; empty where it speaks of none."""
    lowered = file.lower()
    return next((name for name, known in FORMATS.items() if lowered.endswith(known.suffixes)), "")
