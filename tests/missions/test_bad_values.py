"""Each key of a mission missing, misspelt, given twice, of another type, dimension, sign, range, or not finite.

The keys come from the schema: a saved mission writes every one of them.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from cardume.errors import MissionError
from cardume.missions.mission import Mission
from cardume.missions.schema import Forms, Group, Quantity, fields_of, records_of
from cardume.missions.source import parse_yaml
from cardume.missions.tree import Node
from cardume.missions.vehicle import SHARED
from missions.helpers import DESIGN, SMALLEST, parse

HERE = Path(__file__)
MISSIONS = {
    "design": (DESIGN.replace("  - name: starboard\n", ""), "swath=10 m", "vehicles.surface.sensors.dvl={}"),
    "line": (SMALLEST,),
    "arc": (SMALLEST, "path={type: arc, radius: 9 m, angle: 90 deg}", "current={type: gridded, file: helpers.py}"),
    "circle": (SMALLEST, "path={type: circle, centre: {north: 1, east: 2}, radius: 9}", "guidance.law=arcsine"),
    "segments": (
        SMALLEST,
        "path={type: segments, segments: [{line: 3, speed: 1}, {arc: 9, angle: 1, speed: 1}]}",
        "guidance.reference_point=virtual_target",
    ),
    "clothoids": (
        SMALLEST,
        "path={type: segments, segments: [{line: 3}, {clothoid: 9, radius: 12, speed: 1}, {clothoid: 4, radius: 9}]}",
    ),
    "waypoints": (
        SMALLEST,
        "path={type: waypoints, points: [{north: 0, east: 0}, {north: 9, east: 0}], turn_radius: 2}",
    ),
    "spline": (
        SMALLEST,
        "path={type: spline, points: [{north: 0, east: 0}, {north: 9, east: 0}, {north: 9, east: 9}], shape: closed}",
    ),
    "lemniscate": (
        SMALLEST,
        "path={type: lemniscate, centre: {north: 1, east: 2}, half_width: 9, parameter_rate: 0.1, laps: 2}",
    ),
    "file": (SMALLEST, "path={type: file, file: helpers.py}"),
    "orders": (
        SMALLEST,
        "phases={dive: {timeout: 9}, gather: {timeout: 9}, hold: 3, circle: 4}",
        "limits={depth: 9, altitude: 1, geofence: {radius: 9}}",
        "abort={silence: 3, time: 9}",
        "bathymetry={type: flat}",
        "vehicles.alone.altitude=3",
        "vehicles.alone.start.depth=1",
    ),
    "faults": (
        SMALLEST,
        "coordination={silence: {after: 9, do: slow_down}}",
        "faults=["
        "{kind: modem_silent, vehicle: alone, from: 3, to: 9}, {kind: gnss_lost, vehicle: alone, from: 3, lasts: 9},"
        "{kind: usbl_outlier, vehicle: alone, from: 3}, {kind: sensor_frozen, vehicle: alone, from: 3, sensor: ahrs},"
        "{kind: sensor_biased, vehicle: alone, from: 3, sensor: ahrs, heading: 0.1},"
        "{kind: sensor_nan, vehicle: alone, from: 3, sensor: ahrs}, {kind: thruster_weak, vehicle: alone, from: 3},"
        "{kind: vehicle_lost, vehicle: alone, from: 3}, {kind: clock_offset, vehicle: alone, from: 3, offset: 2},"
        "{kind: clock_drift, vehicle: alone, from: 3, drift: 0.01}, {kind: current_step, from: 3, speed: 0.1},"
        "{kind: forged_packets, vehicle: alone, from: 3}, {kind: replayed_packets, vehicle: alone, from: 3}]",
    ),
}
REPEATED = {
    "line": ("path",),
    "circle": ("path", "guidance"),
    "segments": ("path", "guidance"),
    "arc": ("path", "current"),
    "file": ("path",),
    "faults": ("faults", "coordination"),
    "orders": ("phases", "limits", "abort", "bathymetry"),
    "clothoids": ("path",),
    "waypoints": ("path",),
    "spline": ("path",),
    "lemniscate": ("path",),
}


class Key(NamedTuple):
    """One key of a saved mission: where it is, and what stands there."""

    mission: str
    words: tuple[str | int, ...]
    value: Any

    def __str__(self) -> str:
        return f"{self.mission}:{'.'.join(map(str, self.words))}"


def saved(name: str) -> Any:
    """A mission with every default written, as plain data."""
    text, *overrides = MISSIONS[name]
    return plain(parse_yaml(parse(text, *overrides, directory=HERE.parent).to_yaml(), "saved"))


def plain(node: Node) -> Any:
    if isinstance(node.value, dict):
        return {key: plain(item) for key, item in node.value.items()}
    return [plain(item) for item in node.value] if isinstance(node.value, list) else node.value


def keys_below(name: str, value: Any, words: tuple[str | int, ...] = ()) -> Iterator[Key]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for word, item in items:
        yield Key(name, (*words, word), item)
        yield from keys_below(name, item, (*words, word))


TREES = {name: saved(name) for name in MISSIONS}
KEYS = [
    key for name, tree in TREES.items() for key in keys_below(name, tree) if key.words[0] in REPEATED.get(name, tree)
]


def written(key: Key, change: Any) -> tuple[str, str]:
    """The mission as text with one key changed, one line a value, and that key as messages name it."""
    tree = json.loads(json.dumps(TREES[key.mission]))
    parent = tree
    for word in key.words[:-1]:
        parent = parent[word]
    change(parent, key.words[-1])
    return json.dumps(tree, indent=1).replace("@twice", ""), dotted(key)


def dotted(key: Key) -> str:
    words = list(key.words)
    if words[0] == "vehicles" and len(words) > 2 and words[2] != "name":
        words[1] = TREES[key.mission]["vehicles"][words[1]]["name"]
    return ".".join(map(str, words))


def refused_at(text: str, key: str) -> list[str]:
    """The messages about a key, or about what holds it or is in it."""
    with pytest.raises(MissionError) as caught:
        parse(text, directory=HERE.parent)
    for problem in caught.value.problems:
        assert problem.position.line > 0
        assert str(problem).isprintable()
    return [p.message for p in caught.value.problems if p.position.key == key or p.position.key.startswith(key + ".")]


def replaced(value: Any) -> Any:
    def change(parent: Any, word: Any) -> None:
        parent[word] = value

    return change


NAMED = [key for key in KEYS if isinstance(key.words[-1], str)]
QUANTITIES = [
    key
    for key in KEYS
    if isinstance(key.value, (int, float)) or (isinstance(key.value, str) and key.value[0] in "-.0123456789")
]


@pytest.mark.parametrize("key", NAMED, ids=str)
def test_a_missing_key_has_a_default_or_is_named(key: Key) -> None:
    text, name = written(key, lambda parent, word: parent.pop(word))
    try:
        read = parse(text, directory=HERE.parent)
    except MissionError as error:
        problems = error.problems
    else:
        assert parse(read.to_yaml(), directory=HERE.parent) == read
        return
    is_named = any(p.position.key.startswith(name) and "missing" in p.message for p in problems)
    # Without its law a section's other keys may be unknown instead.
    is_selector = key.words[-1] in ("law", "type", "schedule", "channel", "reader", "reference_point")
    assert is_named or (is_selector and all("there is no key" in p.message for p in problems)), problems


@pytest.mark.parametrize("key", NAMED, ids=str)
def test_a_misspelt_key_is_named_with_the_nearest(key: Key) -> None:
    word = str(key.words[-1])

    def change(parent: Any, _: Any) -> None:
        parent[word + "q"] = parent.pop(word)

    text, name = written(key, change)
    messages = refused_at(text, name + "q")
    of_vehicle = key.words[0] == "require" or name.startswith("require.")
    if of_vehicle and key.words[0] == "require" and len(key.words) > 1:
        assert any("no such metric" in message for message in messages)
    else:
        assert any(
            f"there is no key '{word}q'" in message and f"Did you mean '{word}'?" in message for message in messages
        )


@pytest.mark.parametrize("key", NAMED, ids=str)
def test_a_key_given_twice_is_named_with_both_lines(key: Key) -> None:
    word = str(key.words[-1])

    def change(parent: Any, _: Any) -> None:
        parent[word + "@twice"] = parent[word]

    text, _ = written(key, change)
    lines = [n for n, line in enumerate(text.splitlines(), 1) if f'"{word}"' in line]
    with pytest.raises(MissionError) as caught:
        parse(text, directory=HERE.parent)
    (problem,) = caught.value.problems
    assert "given twice, on lines" in problem.message
    assert problem.position.line in lines


WRONG = {
    "nothing": None,
    "true": True,
    "a list": [[], [1]],
    "a mapping": {"x": {}},
    "odd text": "\x00\u202e{{no such thing",
}


@pytest.mark.parametrize("key", KEYS, ids=str)
def test_a_value_of_another_type_is_named(key: Key) -> None:
    for name, value in WRONG.items():
        text, at = written(key, replaced(value))
        messages = refused_at(text, at)
        assert messages, f"{name} was taken for {key}, or blamed on another key"


NOT_NUMBERS = {
    "not a number": ".nan",
    "infinite": "-.inf",
    "huge": "1e300",
    "too large to store": "1e999",
    "another dimension": '"5 kg"',
    "an unknown unit": '"5 parsec"',
}


@pytest.mark.parametrize("key", QUANTITIES, ids=str)
def test_a_number_that_is_none_is_named(key: Key) -> None:
    for name, value in NOT_NUMBERS.items():
        text, at = written(key, replaced("@here"))
        messages = refused_at(text.replace('"@here"', value), at)
        assert messages, f"{name} was taken for {key}, or blamed on another key"


def quantity_keys(record: type, prefix: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Quantity]]:
    for field in fields_of(record):
        if isinstance(field.kind, Quantity):
            yield (*prefix, field.key), field.kind
        if isinstance(field.kind, (Group, Forms)):
            for inner in records_of(field.kind):
                yield from quantity_keys(inner, (*prefix, field.key))


BOUNDED = [(".".join(words), kind) for words, kind in quantity_keys(Mission) if "vehicles" not in words]


@pytest.mark.parametrize(("key", "kind"), BOUNDED, ids=lambda value: value if isinstance(value, str) else "")
def test_a_number_just_out_of_range_is_named(key: str, kind: Quantity) -> None:
    bounds = kind.bounds
    below = bounds.low if bounds.low_open else bounds.low - abs(bounds.low) * 1e-9 - 1e-9
    for value in (below, bounds.high * (1 + 1e-9)):
        with pytest.raises(MissionError) as caught:
            parse(DESIGN, f"{key}={value!r} {kind.unit}", directory=HERE.parent)
        assert any(p.position.key == key and "must be a number" in p.message for p in caught.value.problems)


def test_the_keys_of_the_schema_are_all_tried() -> None:
    tried = {key.words[-1] for key in KEYS}
    for record in (Mission, *(inner for field in fields_of(Mission) for inner in records_of(field.kind))):
        assert {field.key for field in fields_of(record)} <= tried | {"reference_point"}
    assert set(SHARED) <= tried
    assert len(KEYS) > 120
