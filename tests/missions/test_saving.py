import json
import re
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from jsonschema import Draft202012Validator

from cardume.missions import draw, json_schema, load_mission, sweeps_of, with_options
from cardume.missions.mission import Mission
from cardume.missions.schema import fields_of
from cardume.missions.vehicle import SHARED
from missions.fakes import CATALOG
from missions.helpers import DESIGN, SMALLEST, mission, parse, tree
from missions.written import HERE, missions


def settled(read: Mission) -> Mission:
    """The first mission of a study."""
    return with_options(read, {key: sweep.options[0] for key, sweep in sweeps_of(read).items()})


@settings(max_examples=40)
@given(tree=missions())
def test_a_saved_mission_reads_back_equal(tree: dict[str, Any]) -> None:
    read = parse(json.dumps(tree, ensure_ascii=False), directory=HERE.parent)
    assert parse(read.to_yaml(), directory="/nowhere") == read
    drawn = draw(settled(read), 3)
    assert drawn.is_fixed
    again = parse(drawn.to_yaml(), directory="/nowhere")
    assert again == drawn
    assert again.to_yaml() == drawn.to_yaml()


def test_a_saved_mission_writes_every_default() -> None:
    saved = parse(SMALLEST).to_yaml()
    optional = ("origin", "swath", "faults", "require", "initial_estimate")
    for field in (*fields_of(Mission), *SHARED.values()):
        assert re.search(rf"^ *(- )?{field.key}:", saved, re.MULTILINE) or field.key in optional, field.key
    for text in ("cardume: 1", "plant_step: 0.05 s", "lookahead: 5 m", "heading_gain: 2 N m", "course: 30 deg"):
        assert text in saved
    assert "messaging: none" in saved


def test_what_the_fleet_shares_is_saved_once() -> None:
    saved = parse(DESIGN, "vehicles.port.guidance.lookahead=9 m").to_yaml()
    assert saved.count("compensation: crab") == 1
    assert saved.count("lookahead: 9 m") == 1
    assert saved.count("lookahead: 5 m") == 2
    assert max(len(line) for line in saved.splitlines()) < 120


def test_a_shared_distribution_stays_shared() -> None:
    law = {"lookahead": {"uniform": ["1 m", "9 m"]}}
    read = mission(
        vehicles=[{"name": "a"}, {"name": "b", "guidance": {"reference_point": "virtual_target"}}], guidance=law
    )
    saved = parse(read.to_yaml())
    assert saved == read
    first, second = (vehicle.guidance.law.parameters["lookahead"] for vehicle in draw(saved, 1).vehicles)
    assert first == second


def test_a_saved_file_name_is_relative_to_where_the_mission_lies(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "path, with: odd #name.txt").write_text("3\n")
    text = SMALLEST.replace("{type: line", "{type: file, file: 'path, with: odd #name.txt'} #")
    read = parse(text, directory=tmp_path / "in")
    (tmp_path / "out.yaml").write_text(read.to_yaml(tmp_path))
    assert '"in/path, with: odd #name.txt"' in read.to_yaml(tmp_path)
    assert load_mission(tmp_path / "out.yaml", CATALOG) == read


def test_users_laws_and_odd_texts_survive() -> None:
    read = mission(
        guidance={"law": "mine:pure_pursuit", "radius": 0.1}, require={"starboard": {"swath_coverage": "90 %"}}
    )
    assert parse(read.to_yaml()) == read


BAD: list[dict[str, Any]] = [
    {"nme": 1},
    {"path": {"type": "spiral"}},
    {"seed": -1},
    {"vehicles": []},
    {"guidance": {"lookahed": 1}},
    {"guidance": {"lookahead": 0}},
    {"duration": "5 m"},
    {"end": "stop"},
    {"current": {"type": "uniform", "x": 1}},
]


def test_the_json_schema_accepts_what_the_reader_accepts() -> None:
    schema = json_schema(CATALOG)
    Draft202012Validator.check_schema(schema)
    check = Draft202012Validator(schema)

    @settings(max_examples=40)
    @given(written=missions())
    def accepts(written: dict[str, Any]) -> None:
        check.validate(written)

    accepts()
    for bad in BAD:
        assert not check.is_valid({**tree(), **bad}), bad
    assert check.is_valid({**tree(), "guidance": {"law": "mine:law", "anything": 1}})


def test_the_json_schema_names_every_key_and_law() -> None:
    schema = json_schema(CATALOG)
    assert set(schema["properties"]) == {field.key for field in fields_of(Mission)} | set(SHARED)
    assert schema["required"] == ["cardume", "name", "duration", "path", "vehicles"]
    text = json.dumps(schema)
    for law in ("line_of_sight", "laplacian_tanh", "virtual_target", "target_gain", "lookahead", "scale", "lawnmower"):
        assert f'"{law}"' in text
    assert "where it believes it begins" in text
