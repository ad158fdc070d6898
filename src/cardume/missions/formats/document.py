"""JSON with errors that name line and key: what QGroundControl plans and GeoJSON are written in."""

from __future__ import annotations

import json
import math
from typing import Any

from cardume.errors import MissionError, Position, Problem
from cardume.missions.formats.content import refused
from cardume.units import printable, show_text

Path = tuple[str | int, ...]
WORDS = {dict: "an object", list: "a list", bool: "true or false"}


class NotFiniteError(ValueError):
    """NaN or infinity, which JSON does not have."""


class Document:
    """A JSON text; every value is asked for by its path, and what is wrong with it is told with line and key."""

    def __init__(self, text: str, source: str) -> None:
        self.text, self.source = text, source
        try:
            self.root = json.loads(text, parse_constant=_refuse_constant)
        except json.JSONDecodeError as problem:
            raise refused(source, f"is not JSON: {problem.msg}; it may be cut off", problem.lineno) from None
        except NotFiniteError as problem:
            line = text.count("\n", 0, text.find(str(problem))) + 1
            raise refused(source, f"holds {problem}; JSON has no such number, give a finite one", line) from None
        except (ValueError, RecursionError) as problem:
            reason = "nested too deeply" if isinstance(problem, RecursionError) else "a number has too many digits"
            raise refused(source, f"is not JSON that can be read: {reason}") from None
        if not isinstance(self.root, dict):
            raise self.error((), f"is {described(self.root)}; it must be an object, {{...}}")

    def error(self, path: Path, message: str) -> MissionError:
        """An error about a value, or about one that is missing, to raise.

        Args:
            path: keys and indices that lead to it.
            message: what was given, what is valid, what to do.
        """
        return MissionError([Problem(self.located(self.position(path)), message)])

    def position(self, path: Path) -> Position:
        """Where in the file a value stands; its line is looked for only where it is needed, see `located`.

        Args:
            path: keys and indices that lead to it.
        """
        return Position(self.source, 0, printable(".".join(map(str, path))))

    def located(self, position: Position) -> Position:
        """The same with its line.

        Args:
            position: as `position` gave it.
        """
        path = (int(word) if word.isdecimal() else word for word in position.key.split(".") if word)
        return position._replace(line=self.line_of(tuple(path)))

    def get(self, path: Path, default: Any = None) -> Any:
        """The value at a path, or the default where there is none."""
        value: Any = self.root
        for step in path:
            is_there = step in value if isinstance(value, dict) else isinstance(step, int) and _has(value, step)
            if not is_there:
                return default
            value = value[step]
        return value

    def section(self, path: Path) -> dict[str, Any]:
        """The object at a path.

        Raises:
            MissionError: it is none.
        """
        value = self.get(path)
        if not isinstance(value, dict):
            raise self.error(path, f"is {described(value)}; it must be an object, {{...}}")
        return value

    def items(self, path: Path) -> list[Any]:
        """The list at a path.

        Raises:
            MissionError: it is none.
        """
        value = self.get(path)
        if not isinstance(value, list):
            raise self.error(path, f"is {described(value)}; it must be a list, [...]")
        return value

    def number(self, path: Path, default: float | None = None) -> float:
        """The finite number at a path; where it is null or missing, the default.

        Raises:
            MissionError: it is no finite number, or there is none and no default.
        """
        value = self.get(path)
        if value is None and default is not None:
            return default
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.error(path, f"is {described(value)}; it must be a number")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.error(path, "is too large for a number; give a finite one")
        return number

    def line_of(self, path: Path) -> int:
        """The line of the value at a path; of the innermost one around it where it is missing."""
        at = _skip_blank(self.text.lstrip("\ufeff"), 0)
        for step in path:
            found = self._find(at, step)
            if found is None:
                break
            at = found
        return self.text.count("\n", 0, at) + 1

    def _find(self, at: int, step: str | int) -> int | None:
        """Where in the text a value of the object or list at `at` begins."""
        text, decoder = self.text, json.JSONDecoder()
        wanted = text[at : at + 1] == ("[" if isinstance(step, int) else "{")
        at, index = _skip_blank(text, at + 1), 0
        while wanted and text[at] not in "]}":
            name: str | int = index
            if isinstance(step, str):
                name, at = decoder.raw_decode(text, at)
                at = _skip_blank(text, _skip_blank(text, at) + 1)
            if name == step:
                return at
            at = _skip_blank(text, decoder.raw_decode(text, at)[1])
            at, index = _skip_blank(text, at + 1) if text[at] == "," else at, index + 1
        return None


def described(value: Any) -> str:
    """A JSON value in words, for a message."""
    if value is None:
        return "missing or null"
    if isinstance(value, str):
        return show_text(value)
    return WORDS.get(type(value)) or show_text(json.dumps(value))[1:-1]


def _has(value: Any, index: int) -> bool:
    return isinstance(value, list) and index < len(value)


def _refuse_constant(name: str) -> float:
    raise NotFiniteError(name)


def _skip_blank(text: str, at: int) -> int:
    while at < len(text) and text[at] in " \t\r\n":
        at += 1
    return at
