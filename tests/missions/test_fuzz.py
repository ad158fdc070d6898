"""Whatever a file holds, the reader gives a mission or a MissionError, never anything else."""

import json
from contextlib import suppress
from typing import Any

from hypothesis import example, given, settings, strategies as st

from cardume.errors import MissionError
from cardume.missions import Mission, draw, load_mission, parse_mission
from missions.fakes import CATALOG
from missions.helpers import DESIGN
from missions.written import HERE, missions

WORDS = [
    *{word.strip("{},:") for word in DESIGN.split()},
    "none",
    "ideal",
    "sweep",
    "choose",
    "uniform",
    "per",
    "mine:broken",
]
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**30), 10**30),
    st.floats(),
    st.text(max_size=20),
    st.sampled_from(WORDS),
    st.builds("{} {}".format, st.floats(-1e3, 1e3), st.sampled_from(["m", "deg", "s", "m/s", "%", "furlong"])),
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.sampled_from(WORDS), inner, max_size=4)),
    max_leaves=12,
)
INSERTS = st.one_of(
    st.sampled_from(
        [
            ":",
            "- ",
            "\n",
            "  ",
            "{",
            "}",
            "[",
            "]",
            "&x ",
            "*x",
            "!t ",
            "? ",
            "|",
            ">",
            '"',
            "'",
            "#",
            "---\n",
            "\t",
            "%",
        ]
    ),
    st.characters(),
)


def survives(text: str, *overrides: str) -> None:
    """A mission, then it can be saved, read again and drawn; or a refusal that can be printed."""
    try:
        read = parse_mission(text, CATALOG, overrides, directory=HERE.parent)
        assert isinstance(read, Mission)
        assert parse_mission(read.to_yaml(), CATALOG, directory=HERE.parent) == read
        draw(read, 1)
    except MissionError as error:
        problems = error.problems
    else:
        return
    assert problems
    assert all(str(problem).isprintable() and problem.message for problem in problems)


@settings(max_examples=150)
@given(data=st.binary(max_size=300))
def test_any_bytes(data: bytes, tmp_path_factory: Any) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzz.yaml"
    path.write_bytes(data)
    with suppress(MissionError):
        load_mission(path, CATALOG)


@settings(max_examples=150)
@given(text=st.text(max_size=200))
@example('"\\UFFFFFFFF": 1')
@example("a: " + "9" * 5000)
def test_any_text(text: str) -> None:
    survives(text)


@settings(max_examples=200)
@given(at=st.integers(0, len(DESIGN)), length=st.integers(0, 12), insert=st.lists(INSERTS, max_size=4).map("".join))
def test_a_mission_with_some_characters_changed(at: int, length: int, insert: str) -> None:
    survives(DESIGN[:at] + insert + DESIGN[at + length :])


@settings(max_examples=150)
@given(tree=st.dictionaries(st.sampled_from(WORDS), ANYTHING, max_size=6))
def test_any_tree_under_known_words(tree: dict[str, Any]) -> None:
    survives(json.dumps(tree))


@settings(max_examples=100)
@given(tree=missions(), data=st.data())
def test_a_valid_tree_with_one_value_replaced(tree: dict[str, Any], data: st.DataObject) -> None:
    parent: Any = tree
    for _ in range(data.draw(st.integers(0, 4))):
        inner = [
            item
            for item in (parent.values() if isinstance(parent, dict) else parent)
            if item and isinstance(item, (dict, list))
        ]
        parent = data.draw(st.sampled_from(inner)) if inner else parent
    key = data.draw(st.sampled_from(sorted(parent) if isinstance(parent, dict) else range(len(parent))))
    parent[key] = data.draw(ANYTHING)
    survives(json.dumps(tree, ensure_ascii=False))


@settings(max_examples=150)
@given(
    key=st.lists(st.sampled_from(WORDS), max_size=4).map(".".join),
    value=st.one_of(st.text(max_size=20), ANYTHING.map(json.dumps)),
)
def test_any_override(key: str, value: str) -> None:
    survives(DESIGN, f"{key}={value}")
