"""Text to a tree of values.

YAML 1.2 without its traps: UTF-8 only, one document, no aliases, anchors or tags, no key twice, no
NaN or infinity, bounded in size and depth. Whatever is wrong becomes a `MissionError`.
"""

from __future__ import annotations

import difflib
import math
import os
import re
import stat
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from cardume.errors import MissionError, Position, Problem
from cardume.missions.tree import Node, item_name, join, label
from cardume.units import printable, show_text

MAX_BYTES = 500_000  # some ten seconds of reading; a mission has a few thousand
MAX_DEPTH = 24
NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
CONSTANTS = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False} | dict.fromkeys(
    ("null", "Null", "NULL", "~", "")
)
EMPTY = "is empty; the smallest mission has the keys cardume, name, duration, path, formation and vehicles"
ALLOWED_CONTROLS = "\t\n\r\x85"


def read_text(path: Path) -> str:
    """The text of a mission file.

    Raises:
        MissionError: missing, a directory, unreadable, too large, empty, binary, or not UTF-8.
    """

    def error(message: str, line: int = 0) -> MissionError:
        return MissionError([Problem(Position(printable(str(path)), line, ""), message)])

    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise error("is a directory; give a mission file inside it")
        if not stat.S_ISREG(mode):
            raise error("is not a regular file; give a mission file")
        with open(path, "rb") as file:
            content = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        advice = nearest_file(path)
        if not advice and path.suffix.lower() in (".yaml", ".yml"):
            advice = "; 'cardume new' writes one to begin with, 'cardume list missions' has built-in ones"
        raise error(f"no such file{advice}") from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise error(f"cannot be read: {reason}; check the path and its permissions") from None
    if len(content) > MAX_BYTES:
        raise error(f"larger than {MAX_BYTES:,} bytes; a mission file holds a few hundred lines of text")
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise error("is UTF-16 text; save it as UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        what = "a binary file" if b"\0" in content[:4096] else f"not UTF-8 text (byte {problem.start})"
        raise error(f"is {what}; a mission file is YAML text saved as UTF-8", line) from None


def nearest_file(path: Path) -> str:
    """`. Did you mean 'x'?` for a file of the same folder with a similar name, or nothing."""
    try:
        names = sorted(os.listdir(path.parent))[:10_000] if path.parent.is_dir() else None
    except (OSError, ValueError):
        return ""
    if names is None:
        return f"; its folder {show_text(str(path.parent), 500)} does not exist"
    close = difflib.get_close_matches(path.name, names, n=1)
    return f". Did you mean {show_text(str(path.parent / close[0]), 500)}?" if close else ""


def parse_yaml(text: str, source: str) -> Node:
    """The tree of a YAML text; positions carry `source`, the line, and the dotted key.

    Raises:
        MissionError: not the YAML that a mission may use.
    """
    bad = next((at for at, char in enumerate(text) if not char.isprintable() and not _is_layout(char)), None)
    if bad is not None:
        where = Position(source, text.count("\n", 0, bad) + 1, "syntax")
        code = f"U+{ord(text[bad]):04X}"
        raise MissionError([Problem(where, f"holds the control character {code}; a mission file is plain text")])
    try:
        builder = _Builder(source, YAML(typ="safe", pure=True).parse(text))
        node = builder.document()
    except MissionError:
        raise
    except MarkedYAMLError as problem:
        mark = problem.problem_mark or problem.context_mark
        line = mark.line + 1 if mark else 0
        raise MissionError([Problem(Position(source, line, "syntax"), _syntax_message(problem))]) from None
    except Exception as problem:  # the parser's own slips on odd input, e.g. an escape beyond Unicode
        raise MissionError(
            [Problem(Position(source, 0, ""), f"is not valid YAML: {show_text(str(problem))}")]
        ) from None
    return label(node)


def _is_layout(char: str) -> bool:
    return char in ALLOWED_CONTROLS or not (ord(char) < 32 or 127 <= ord(char) < 160 or 0xD800 <= ord(char) < 0xE000)


def _syntax_message(problem: MarkedYAMLError) -> str:
    parts = [part for part in (problem.context, problem.problem) if part]
    advice = "indent with spaces and write 'key: value'; quote a text that holds : # [ or {"
    return f"is not valid YAML, {printable(', '.join(parts))}; {advice}"


class _Builder:
    """Turns the parser's events into nodes and notes what a mission may not use."""

    def __init__(self, source: str, events: Iterator[Any]) -> None:
        self.source, self.events, self.problems = source, events, list[Problem]()

    def document(self) -> Node:
        event = next((e for e in self.events if isinstance(e, DocumentStartEvent)), None)
        if event is None:
            raise MissionError([Problem(Position(self.source, 1, ""), EMPTY)])
        node = self._node(next(self.events), 0, "")
        for event in self.events:
            if isinstance(event, DocumentStartEvent):
                self._note(event, "", "a second document begins here; one file holds one mission, remove '---'")
                break
        if self.problems:
            raise MissionError(self._by_name(problem, node) for problem in self.problems)
        return node

    def _by_name(self, problem: Problem, document: Node) -> Problem:
        """While a file is read a vehicle has no name yet, only its index."""
        root, *words = problem.position.key.split(".")
        vehicles = document.value.get(root) if isinstance(document.value, dict) and root == "vehicles" else None
        if vehicles is None or not words or not isinstance(vehicles.value, list):
            return problem
        name = item_name(vehicles.value[int(words[0])], int(words[0]), root)
        return problem._replace(position=problem.position._replace(key=join(root, name, *words[1:])))

    def _note(self, event: Any, key: str, message: str) -> None:
        position = Position(self.source, event.start_mark.line + 1, printable(key[:200]) or "syntax")
        self.problems.append(Problem(position, message))

    def _node(self, event: Any, depth: int, key: str) -> Node:
        self._note_unsafe(event, key)
        value: Any = None
        if isinstance(event, (MappingStartEvent, SequenceStartEvent)) and depth >= MAX_DEPTH:
            self._note(event, key, f"nested deeper than {MAX_DEPTH} levels; a mission needs at most eight")
            raise MissionError(self.problems)
        if isinstance(event, ScalarEvent):
            value = self._scalar(event, key)
        elif isinstance(event, SequenceStartEvent):
            value = self._sequence(depth, key)
        elif isinstance(event, MappingStartEvent):
            value = self._mapping(depth, key)
        return Node(value, Position(self.source, event.start_mark.line + 1, ""))

    def _sequence(self, depth: int, key: str) -> list[Node]:
        items: list[Node] = []
        while not isinstance(event := next(self.events), SequenceEndEvent):
            items.append(self._node(event, depth + 1, join(key, str(len(items)))))
        return items

    def _mapping(self, depth: int, key: str) -> dict[str, Node]:
        entries: dict[str, Node] = {}
        while not isinstance(event := next(self.events), MappingEndEvent):
            self._note_unsafe(event, key)
            if not isinstance(event, ScalarEvent):
                if not isinstance(event, AliasEvent):
                    self._note(event, key, "a key must be one word, but a list or mapping stands here")
                raise MissionError(self.problems)
            inner, line = join(key, event.value), event.start_mark.line + 1
            if event.value in entries:
                first = entries[event.value].position.line
                self._note(event, inner, f"given twice, on lines {first} and {line}; keep one")
            node = self._node(next(self.events), depth + 1, inner)
            # An error should point at the key: its value may begin on a later line.
            entries[event.value] = replace(node, position=node.position._replace(line=line))
        return entries

    def _note_unsafe(self, event: Any, key: str) -> None:
        anchor = show_text(getattr(event, "anchor", None) or "")
        tag = getattr(event, "tag", None) or getattr(event, "ctag", None)
        if isinstance(event, AliasEvent):
            self._note(event, key, f"the alias {anchor} is not allowed; write the value out")
        elif getattr(event, "anchor", None):
            self._note(event, key, f"the anchor {anchor} is not allowed; write the value out wherever it is needed")
        elif tag:
            self._note(event, key, f"the tag {show_text(str(tag))} is not allowed; write the plain value")

    def _scalar(self, event: ScalarEvent, key: str) -> Any:
        text = event.value
        if not event.implicit[0]:  # quoted: always text
            return text
        if text in CONSTANTS:
            return CONSTANTS[text]
        if NOT_FINITE.fullmatch(text):
            self._note(event, key, f"{text} is not allowed; give a finite number")
        if not NUMBER.fullmatch(text):
            return text
        is_whole = text.lstrip("+-").isdigit() and len(text) < 20
        number = int(text) if is_whole else float(text)
        if math.isinf(number):
            self._note(event, key, f"{show_text(text)} is too large; give a finite number")
        return number
