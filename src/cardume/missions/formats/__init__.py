"""Path files that other programs wrote: MEDUSA / Farol text."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from cardume.errors import MissionError, Position, Problem
from cardume.missions.source import nearest_file
from cardume.units import printable

if TYPE_CHECKING:
    from cardume.missions.formats.plan import Plan
    from cardume.missions.geodesy import GeoPoint

MAX_BYTES = 1_000_000
READ = "MEDUSA / Farol text is read: a line with the version, 3, then one such as '491854.338 4290819.848 29S'"


def read_plan(file: Path, origin: GeoPoint | None = None) -> Plan:
    """Read a path file in whatever format it is.

    Args:
        file: where it is.
        origin: place it there instead of where it says.

    Raises:
        MissionError: no such file, a format that is not read, or contents that cannot be flown.
    """
    from cardume.missions.formats.medusa import parse_medusa
    from cardume.missions.formats.medusa_plan import to_plan

    text, source = read_text(file), printable(str(file))
    known = _other_format(text)
    if known:
        raise MissionError([Problem(Position(source, 1, ""), f"looks like {known}; {READ}")])
    return to_plan(parse_medusa(text, source), origin)


def read_text(file: Path) -> str:
    """The text of a path file; bytes that are not UTF-8 are read as Latin-1, for the sake of old comments.

    Raises:
        MissionError: missing, a directory, unreadable, too large or binary.
    """

    def error(message: str) -> MissionError:
        return MissionError([Problem(Position(printable(str(file)), 0, ""), message)])

    try:
        if file.exists() and not file.is_file():
            raise error("is not a regular file; give a path file")
        with open(file, "rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise error(f"no such file{nearest_file(file)}") from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise error(f"cannot be read: {reason}; check the path and its permissions") from None
    if len(content) > MAX_BYTES:
        raise error(f"larger than {MAX_BYTES:,} bytes; a path file holds a few hundred lines of text")
    if b"\0" in content:
        raise error(f"is a binary file or UTF-16 text; {READ}")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _other_format(text: str) -> str:
    head = text.lstrip()[:2000]
    if head.startswith("QGC WPL"):
        return "a list of waypoints (QGC WPL)"
    if head.startswith("{"):
        return "a QGroundControl plan" if '"fileType"' in head else "JSON"
    if head.startswith("<"):
        return "XML, such as GPX or KML"
    return ""
