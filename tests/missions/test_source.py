import os
from pathlib import Path

import pytest

from cardume.errors import MissionError, Position, Problem
from cardume.missions import load_mission
from cardume.missions.source import MAX_BYTES, parse_yaml, read_text
from cardume.missions.tree import all_positions
from missions.fakes import CATALOG
from missions.helpers import SMALLEST


def problems(text: str) -> list[tuple[int, str, str]]:
    with pytest.raises(MissionError) as caught:
        parse_yaml(text, "m.yaml")
    return [(p.position.line, p.position.key, p.message) for p in caught.value.problems]


REFUSED = {
    "a: 1\nb: 2\na: 3": (3, "a", "given twice, on lines 1 and 3"),
    "v:\n  - {x: 1, x: 2}": (2, "v.0.x", "given twice, on lines 2 and 2"),
    "a: &x 1": (1, "a", "the anchor 'x' is not allowed"),
    "a: 1\nb: *x": (2, "b", "the alias 'x' is not allowed"),
    "&x a: 1": (1, "syntax", "the anchor 'x'"),
    "a: !!python/object/apply:os.system ['true']": (1, "a", "the tag"),
    "a: !!int 3": (1, "a", "the tag"),
    "!x a: 3": (1, "syntax", "the tag '!x'"),
    "a: ! 3": (1, "a", "the tag '!'"),
    "? [a, b]\n: 1": (1, "syntax", "a key must be one word"),
    "? {a: b}\n: 1": (1, "syntax", "a key must be one word"),
    "a: .nan": (1, "a", "finite"),
    "a: [1, -.INF]": (1, "a.1", "finite"),
    "a: 1e999": (1, "a", "too large"),
    "a: " + "9" * 400: (1, "a", "too large"),
    "a: 1\n---\nb: 2": (2, "syntax", "second document"),
    "a: 1\n...\nb: 2": (3, "syntax", "second document"),
    "": (1, "", "empty"),
    "# only a comment\n": (1, "", "empty"),
    "a: [1,\n": (2, "syntax", "not valid YAML"),
    "a: 1\n\tb: 2": (2, "syntax", "not valid YAML"),
    "a: b: c": (1, "syntax", "not valid YAML"),
    "a: 'open": (1, "syntax", "not valid YAML"),
    'a: "\\UFFFFFFFF"': (0, "", "not valid YAML"),
    "a: @b": (1, "syntax", "not valid YAML"),
    "a: |\n  x\n y": (3, "syntax", "not valid YAML"),
    "%YAML 9.9.9\n---\na: 1": (1, "syntax", "not valid YAML"),
    "[" * 100_000: (1, "0" + ".0" * 23, "nested deeper"),
    "- " * 5_000: (1, "0" + ".0" * 23, "nested deeper"),
    "{a: " * 5_000: (1, "a" + ".a" * 23, "nested deeper"),
    "a: \x1b[31m": (1, "syntax", "U+001B"),
    "a: 1\nb: \x00": (2, "syntax", "U+0000"),
}


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: repr(text[:30]))
def test_what_a_mission_may_not_use_is_refused_with_its_line(text: str) -> None:
    line, key, words = REFUSED[text]
    found = problems(text)
    assert [(at, where) for at, where, said in found if words in said] == [(line, key)], found


def test_several_slips_are_reported_together() -> None:
    found = problems("a: .nan\nb: &x 1\nc: *x\nc: !t 2\n")
    assert [(line, key) for line, key, _ in found] == [(1, "a"), (2, "b"), (3, "c"), (4, "c"), (4, "c")]


def test_plain_values_are_those_of_yaml_12() -> None:
    text = (
        "{a: yes, b: True, c: 010, d: 0x1F, e: 1_000, f: '5', g: ~, h: , i: 5., j: 1e3, k: -.5, l: 2001-01-01, <<: 1}"
    )
    value = {key: node.value for key, node in parse_yaml(text, "m").value.items()}
    assert value == {
        "a": "yes", "b": True, "c": 10, "d": "0x1F", "e": "1_000", "f": "5", "g": None, "h": None, "i": 5.0,
        "j": 1000.0, "k": -0.5, "l": "2001-01-01", "<<": 1,
    }  # fmt: skip


def test_every_value_knows_its_line_and_key() -> None:
    text = "a:\n  b: 1\nvehicles:\n  - name: port\n    depth: 2\n  - 5\n"
    at = {key: position.line for key, position in all_positions(parse_yaml(text, "m")).items()}
    assert at == {"": 1, "a": 1, "a.b": 2, "vehicles": 3, "vehicles.port": 4, "vehicles.port.name": 4,
                  "vehicles.port.depth": 5, "vehicles.1": 6}  # fmt: skip


def test_a_message_is_printable_whatever_the_file_holds() -> None:
    for text in ('"\\ud800": 1', 'name: "\\e[31m\\n"', '"a\\nb": 1', '"\\u202e": &x 1'):
        with pytest.raises(MissionError) as caught:
            load_text(text)
        said = str(caught.value)
        said.encode("utf-8")
        assert all(char.isprintable() or char == "\n" for char in said)


def load_text(text: str) -> None:
    from missions.helpers import parse

    parse(text)


FILES = {
    "empty": (b"", "empty"),
    "binary": (b"\x89PNG\r\n\x1a\n\x00\x00", "is a binary file"),
    "latin": ("name: mar\xe9\n".encode("latin-1"), "not UTF-8"),
    "utf16": ("cardume: 1\n".encode("utf-16"), "UTF-16"),
    "utf16-no-mark": ("cardume: 1\n".encode("utf-16-le"), "U+0000"),
    "gzip": (b"\x1f\x8b\x08\x00\x00\x00", "is a binary file"),
    "huge": (b"#" * (MAX_BYTES + 1), "larger than"),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_is_no_text_is_named(tmp_path: Path, name: str) -> None:
    content, words = FILES[name]
    path = tmp_path / "m.yaml"
    path.write_bytes(content)
    with pytest.raises(MissionError) as caught:
        load_mission(path, CATALOG)
    assert words in str(caught.value)
    assert str(caught.value).startswith(str(path))
    assert list(tmp_path.iterdir()) == [path], "nothing may be left behind"


def test_a_path_that_is_no_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "mission.yaml").write_text(SMALLEST)
    os.mkfifo(tmp_path / "pipe")
    for path, words in {
        tmp_path / "mssion.yaml": f"Did you mean '{tmp_path}/mission.yaml'?",
        tmp_path / "nowhere" / "m.yaml": "its folder",
        tmp_path: "is a directory",
        tmp_path / "pipe": "not a regular file",
        tmp_path / "mission.yaml" / "x": "cannot be read",
        tmp_path / ("x" * 5000): "cannot be read",
        Path("nul\0byte"): "cannot be read",
    }.items():
        with pytest.raises(MissionError) as caught:
            read_text(path)
        assert words in str(caught.value)


def test_a_file_without_permission_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    path = tmp_path / "m.yaml"
    path.write_text(SMALLEST)
    monkeypatch.setattr("builtins.open", refuse)  # a chmod would not stop the superuser
    with pytest.raises(MissionError, match="cannot be read: Permission denied"):
        load_mission(path, CATALOG)


def test_a_byte_order_mark_and_windows_lines_are_fine(tmp_path: Path) -> None:
    path = tmp_path / "m.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + SMALLEST.replace("\n", "\r\n").encode())
    mission = load_mission(path, CATALOG)
    assert mission.where("guidance.lookahead") == Position(str(path), 8, "guidance.lookahead")


def test_a_problem_reads_file_line_key_message() -> None:
    assert str(Problem(Position("m.yaml", 3, "a.b"), "wrong")) == "m.yaml:3:a.b: wrong"
    assert str(Problem(Position("m.yaml", 0, ""), "wrong")) == "m.yaml: wrong"
    assert str(Problem(Position("--set a.b=1", 0, "a.b"), "wrong")) == "--set a.b=1: wrong"
    assert str(Problem(Position("--set a={b: 1}", 0, "a.b"), "wrong")) == "--set a={b: 1}:a.b: wrong"


def test_at_most_twenty_problems_are_shown() -> None:
    error = MissionError(Problem(Position("m", n, "k"), "wrong") for n in range(30))
    assert len(str(error).splitlines()) == 21
    assert str(error).endswith("... and 10 more problems")
