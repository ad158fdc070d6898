"""QGC WPL 110: the list of waypoints of ArduPilot and Mission Planner, one command a line.

    QGC WPL 110
    index current frame command p1 p2 p3 p4 latitude longitude altitude autocontinue

Row 0 is home, where it is a waypoint, in whatever frame: the vehicle is there already.

Source: mavlink.io/en/file_formats, plain-text file format.
"""

from __future__ import annotations

import math
import re

from cardume.errors import MissionError, Position, Problem
from cardume.missions.formats.commands import (
    CHANGE_SPEED,
    WAYPOINT,
    Command,
    speed_changes,
    to_waypoints,
    written_place,
)
from cardume.missions.formats.content import refused
from cardume.missions.formats.sampling import Course
from cardume.missions.formats.waypoints import Draft
from cardume.units import show_text

HEADER = "QGC WPL 110"
COLUMNS = ("index", "current", "frame", "command", "p1", "p2", "p3", "p4", "latitude", "longitude", "altitude", "auto")
WHOLE = ("index", "frame", "command")
NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
ABOVE_SEA, RELATIVE, NO_PLACE = 0, 3, 2  # MAV_FRAME


def read_wpl(text: str, source: str) -> Draft:
    """Read a list of waypoints.

    Args:
        text: its contents.
        source: what messages call it.

    Raises:
        MissionError: all that is wrong, by line.
    """
    lines = [(number, line.split()) for number, line in enumerate(text.lstrip("\ufeff").splitlines(), 1)]
    rows = [(number, words) for number, words in lines if words and not words[0].startswith("#")]
    if not rows or rows[0][1] != HEADER.split():
        given = show_text(" ".join(rows[0][1])) if rows else "nothing"
        raise refused(source, f"begins with {given}; lists that begin with {HEADER} are read", 1)
    problems: list[Problem] = []
    commands = [_command(words, Position(source, number, ""), problems) for number, words in rows[1:]]
    if problems:
        raise MissionError(problems)
    for before, after in zip(commands, commands[1:], strict=False):
        if after.number != before.number + 1:
            raise MissionError(
                [
                    Problem(
                        after.position._replace(key="index"),
                        f"is {after.number} after {before.number}; rows are numbered one by one: a row is missing,"
                        " given twice, or in another place",
                    )
                ]
            )
    notes: list[str] = []
    if commands and _is_home(commands[0]):
        home, *commands = commands
        if not commands or home.parameters[4:6] != commands[0].parameters[4:6]:
            notes.append("home (row 0): not flown, the path begins at row 1")
    waypoints, not_flown = to_waypoints(commands)
    return Draft(source=source, name="", waypoints=waypoints, notes=[*notes, *not_flown])


def write_wpl(course: Course) -> bytes:
    """A list that Mission Planner and QGroundControl open, its first point also home.

    Args:
        course: what to write.
    """
    altitude = 0.0 - (course.depth or 0.0)
    rows = [_row(0, ABOVE_SEA, WAYPOINT, (0.0, 0.0), course.points[0].degrees, 0.0)]
    for speed, point in zip(speed_changes(course.speeds), course.points, strict=True):
        if speed is not None:
            rows.append(_row(len(rows), NO_PLACE, CHANGE_SPEED, (1.0, speed, -1.0), (0.0, 0.0), 0.0))
        rows.append(_row(len(rows), RELATIVE, WAYPOINT, (), written_place(point.degrees), altitude))
    return ("\n".join([HEADER, *rows]) + "\n").encode()


def _row(
    index: int, frame: int, code: int, parameters: tuple[float, ...], place: tuple[float, float], altitude: float
) -> str:
    four = [*parameters, 0.0, 0.0, 0.0, 0.0][:4]
    numbers = [*(repr(value) for value in four), *(f"{degrees:.10f}" for degrees in place), f"{altitude:.12g}"]
    return "\t".join([str(index), str(int(index == 0)), str(frame), str(code), *numbers, "1"])


def _is_home(command: Command) -> bool:
    return command.number == 0 and command.code == WAYPOINT


def _command(words: list[str], position: Position, problems: list[Problem]) -> Command:
    """A row; what is wrong with it is noted."""
    values = dict.fromkeys(COLUMNS, math.nan)
    if len(words) != len(COLUMNS):
        problems.append(Problem(position, f"has {len(words)} columns; a row has {len(COLUMNS)}: {' '.join(COLUMNS)}"))
        words = []
    for name, word in zip(COLUMNS, words, strict=False):
        values[name], problem = _number(name, word)
        if problem:
            problems.append(Problem(position._replace(key=name), problem))
    index, _current, frame, code = (0 if values[k] != values[k] else int(values[k]) for k in COLUMNS[:4])
    p1, p2, p3, p4, latitude, longitude, altitude = (values[name] for name in COLUMNS[4:11])
    return Command(
        number=index,
        code=code,
        frame=frame,
        parameters=(p1, p2, p3, p4, latitude, longitude, altitude),
        label=f"row {index}",
        position=position,
    )


def _number(name: str, word: str) -> tuple[float, str]:
    """A number, and what is wrong with it."""
    if word.lower() == "nan" and name not in (*WHOLE, "current"):
        return math.nan, ""  # left open
    if not NUMBER.fullmatch(word) or not math.isfinite(float(word)):
        point = "; the decimal sign is a point" if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", word) else ""
        return math.nan, f"is {show_text(word)}; it must be a finite number{point}"
    value = float(word)
    if name in WHOLE and not (value == int(value) and 0 <= value < 2**31):
        return math.nan, f"is {show_text(word)}; it must be a whole number, 0 or more"
    return value, ""
