"""`cardume convert`, and path files where a mission may stand."""

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from cardume.missions.converting import VIEWERS
from cardume.missions.formats import read_plan
from cardume.missions.formats.content import FORMATS
from cli.stand_ins import Result
from missions.formats.make_paths import FOLDER

Cardume = Callable[..., Result]


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    return tmp_path


MISSION = """\
cardume: 1
name: pair
duration: 300 s
path: {type: lawnmower, leg: 40 m, legs: 2, spacing: 20 m, turn: starboard}
formation: {speed: 0.5 m/s}
vehicles:
  - {name: port, depth: 3 m, offset: {starboard: -2 m}}
  - {name: starboard, depth: 3 m, offset: {starboard: 4 m, ahead: -1 m}}
"""


def written(desk: Path, text: str = MISSION) -> Path:
    (desk / "pair.yaml").write_text(text)
    return desk / "pair.yaml"


@pytest.mark.parametrize("suffix", [known.suffixes[0] for known in FORMATS.values()])
def test_a_path_file_becomes_any_other(desk: Path, cardume: Cardume, suffix: str) -> None:
    source = str(FOLDER / "boat_speeds.plan")
    code, out, err = cardume("convert", source, f"out{suffix}")
    assert (code, err) == (0, "")
    assert f"Wrote out{suffix}" in out
    assert "NAV_RETURN_TO_LAUNCH (item 7): not flown" in out
    assert "cardume check out" in out
    again = read_plan(desk / f"out{suffix}")
    assert [s.speed for s in again.segments] == [1.2, 0.6, 0.6]
    assert [p.name for p in desk.iterdir()] == [f"out{suffix}"]  # nothing beside it


def test_a_mission_needs_an_origin_on_the_earth(desk: Path, cardume: Cardume) -> None:
    code, _, err = cardume("convert", str(written(desk)), "out.plan")
    assert code == 2
    assert "pair.yaml:1:origin: is not given" in err
    assert "--origin LATITUDE,LONGITUDE" in err
    assert not (desk / "out.plan").exists()


def test_a_mission_says_what_it_loses(desk: Path, cardume: Cardume) -> None:
    code, out, _ = cardume("convert", str(written(desk)), "out.plan", "--origin", "-16.7,179.9999")
    assert code == 0
    for words in ("1 arc became straight legs", "the formation: the file has one path", "the rest of the mission"):
        assert words in out
    plan = read_plan(desk / "out.plan")
    assert plan.members[0].depth == 3.0
    assert {s.speed for s in plan.segments} == {0.5}


def test_the_own_path_of_one_vehicle(desk: Path, cardume: Cardume) -> None:
    """The outer vehicle of the arc of 10 m flies one of 12 m, faster; the inner one of 6 m, slower."""
    for name, radius in (("port", 12.0), ("starboard", 6.0)):
        code, _, _ = cardume(
            "convert",
            "pair.yaml" if (desk / "pair.yaml").exists() else str(written(desk)),
            f"{name}.medusa.txt",
            "--origin",
            "38.7,-9.1",
            "--vehicle",
            name,
        )
        assert code == 0
        leg, arc, _ = read_plan(desk / f"{name}.medusa.txt").segments
        assert (leg.speed, arc.speed) == pytest.approx((0.5, 0.5 * radius / 10.0))
        assert 1.0 / arc.curvature == pytest.approx(radius, abs=1e-3)


def test_a_vehicle_that_is_not_there(desk: Path, cardume: Cardume) -> None:
    code, _, err = cardume("convert", str(written(desk)), "x.gpx", "--origin", "38.7,-9.1", "--vehicle", "prot")
    assert code == 2
    assert "Did you mean 'port'?" in err


def test_a_formation_keeps_its_offsets_in_medusa_text(desk: Path, cardume: Cardume) -> None:
    code, out, _ = cardume("convert", str(written(desk)), "out.medusa.txt", "--origin", "38.7,-9.1")
    assert code == 0
    assert "the names of the vehicles: port is 1, starboard is 2" in out
    assert "FORMATION 1 0.0000 2.0000 2 -1.0000 -4.0000" in (desk / "out.medusa.txt").read_text()
    found = [(m.ahead, m.starboard, m.depth) for m in read_plan(desk / "out.medusa.txt").members]
    assert found == [(0.0, -2.0, 3.0), (-1.0, 4.0, 3.0)]


def test_medusa_text_becomes_a_mission_that_opens(desk: Path, cardume: Cardume) -> None:
    source = str(FOLDER.parent / "lawnmower_formation.medusa.txt")
    assert cardume("convert", source, "out.yaml").code == 0
    assert cardume("convert", "out.yaml", "back.medusa.txt").code == 0
    one, other = read_plan(Path(source)), read_plan(desk / "back.medusa.txt")
    assert len(one.segments) == len(other.segments)
    for a, b in zip(one.segments, other.segments, strict=True):
        assert (a.north, a.east, a.length, a.speed) == pytest.approx((b.north, b.east, b.length, b.speed), abs=1e-3)
    assert [(m.ahead, m.starboard, m.depth or 0.0) for m in one.members] == [
        (m.ahead, m.starboard, m.depth) for m in other.members
    ]


@pytest.mark.parametrize("name", ["boat_speeds.plan", "estuary.waypoints", "yo_yo.plan", "line.geojson"])
def test_a_path_file_becomes_a_mission_to_be_edited(desk: Path, cardume: Cardume, name: str) -> None:
    (desk / "in").mkdir()
    (desk / "out").mkdir()
    (desk / "in" / name).write_bytes((FOLDER / name).read_bytes())
    code, out, _ = cardume("convert", f"in/{name}", "out/mission.yaml")
    assert (code, "to be edited" in out or "which stay in" in out) == (0, True)
    assert cardume("convert", "out/mission.yaml", "back.plan").code == 0
    one, other = read_plan(FOLDER / name), read_plan(desk / "back.plan")
    for a, b in zip(one.segments, other.segments, strict=True):
        assert (a.north, a.east, a.length) == pytest.approx((b.north, b.east, b.length), abs=1e-3)
        assert (a.speed or 0.5) == pytest.approx(b.speed)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing.plan", "x.gpx"], "no file and no built-in mission is called 'nothing.plan'"),
        (["kinematic/line", "x.txt"], "the name does not say what to write"),
        (["kinematic/line", "x.gpx", "--origin", "38.7"], "is not LATITUDE,LONGITUDE in degrees"),
        (["kinematic/line", "x.gpx", "--origin", "138.7,-9"], "latitude 138.7 deg"),
        (["kinematic/line", "x.gpx", "--origin", "38.7,-9", "--tolerance", "5 s"], "unit of time"),
        (["kinematic/line", "x.gpx", "--origin", "38.7,-9", "--tolerance", "-1"], "is not > 0"),
        (["kinematic/line", "x.gpx", "--origin", "38.7,-9", "--tolerance", "1e-9"], "it lies between 0.001 and 100 m"),
        (["kinematic/line", "x.gpx", "--to", "plam"], "Did you mean 'plan'?"),
        (["kinematic/line", "no/folder/x.gpx", "--origin", "38.7,-9"], "cannot be written"),
        ([str(FOLDER / "estuary.waypoints"), "x.medusa.txt"], "needs a speed on every line and arc"),
        ([str(FOLDER / "bad_cut_off.plan"), "x.gpx"], "bad_cut_off.plan:48: is not JSON"),
    ],
)
def test_what_cannot_be_done_is_said(desk: Path, cardume: Cardume, arguments: list[str], said: str) -> None:
    code, out, err = cardume("convert", *arguments)
    assert code == 2
    assert said in " ".join(err.split())
    assert out == ""
    assert not list(desk.iterdir())


def test_a_file_that_is_there_is_left_alone(desk: Path, cardume: Cardume) -> None:
    (desk / "out.gpx").write_text("mine")
    source = str(FOLDER / "line.geojson")
    code, _, err = cardume("convert", source, "out.gpx")
    assert code == 2
    assert "out.gpx exists already; give another name, or --force to replace it" in err
    assert (desk / "out.gpx").read_text() == "mine"
    assert cardume("convert", source, "out.gpx", "--force", "-q") == Result(0, "", "")
    assert "<gpx" in (desk / "out.gpx").read_text()


def test_a_full_disk_leaves_the_old_file(desk: Path, cardume: Cardume, monkeypatch: pytest.MonkeyPatch) -> None:
    (desk / "out.gpx").write_text("mine")

    def full(_path: Path, _content: bytes) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    code, _, err = cardume("convert", str(FOLDER / "line.geojson"), "out.gpx", "--force")
    monkeypatch.undo()
    assert code == 3  # the input was good
    assert "the disk of out.gpx is full (No space left on device)" in " ".join(err.split())
    assert {path.name: path.read_text() for path in desk.iterdir()} == {"out.gpx": "mine"}


def test_a_link_laid_where_the_partial_file_will_be_is_not_followed(desk: Path, cardume: Cardume) -> None:
    (desk / "theirs").write_text("precious")
    (desk / f".out.gpx.{os.getpid()}.partial").symlink_to("theirs")
    assert cardume("convert", str(FOLDER / "line.geojson"), "out.gpx", "-q").code == 0
    assert (desk / "theirs").read_text() == "precious"
    assert not (desk / "out.gpx").is_symlink()


def test_a_name_that_no_disk_takes_is_bad_input(desk: Path, cardume: Cardume) -> None:
    long = "a" * 300
    for arguments in (
        ["convert", str(FOLDER / "line.geojson"), f"{long}.gpx"],
        ["report", long],
        ["run", "kinematic/line", "--no-figures", "-o", long],
    ):
        code, out, err = cardume(*arguments)
        assert (code, out) == (2, "")
        assert f"{long[:250]}" in err
        assert "File name too long" in err
    assert not list(desk.iterdir())


def test_formats_may_be_named(desk: Path, cardume: Cardume) -> None:
    (desk / "in.txt").write_bytes((FOLDER / "estuary.waypoints").read_bytes())
    assert cardume("convert", "in.txt", "out.txt", "--from", "wpl", "--to", "medusa", "--speed", "1 kn").code == 0
    assert {s.speed for s in read_plan(desk / "out.txt").segments} == {1852.0 / 3600.0}
    code, _, err = cardume("convert", "in.txt", "x.gpx", "--from", "gpx")
    assert code == 2
    assert "in.txt:1: is not XML" in err


def test_json_for_programs(desk: Path, cardume: Cardume) -> None:
    code, out, _ = cardume("convert", str(FOLDER / "boat_speeds.plan"), "out.gpx", "--json")
    assert code == 0
    said = json.loads(out)
    assert said["file"] == "out.gpx"
    assert said["holds"].startswith("GPX route: 4 points")
    assert said["not_flown"] == ["NAV_RETURN_TO_LAUNCH (item 7): not flown"]


def test_formats_are_listed(cardume: Cardume) -> None:
    code, out, _ = cardume("list", "formats", "--json")
    assert code == 0
    assert [entry["name"] for entry in json.loads(out)] == [*FORMATS, *VIEWERS]
    assert ".geojson" in cardume("list", "formats").out


def test_path_files_are_checked_as_they_are(desk: Path, cardume: Cardume) -> None:
    code, out, _ = cardume("check", str(FOLDER / "boat_speeds.plan"), "--set", "model=kinematic")
    assert code == 0
    assert "of the file is not flown: NAV_RETURN_TO_LAUNCH (item 7): not flown" in " ".join(out.split())


def test_a_plan_with_depths_and_a_fence_becomes_a_mission_with_them(desk: Path, cardume: Cardume) -> None:
    import cardume as library

    mission = library.load(FOLDER / "fence_and_rally.plan")
    fence = mission.vehicles[0].limits.geofence
    assert fence.radius == 400.0
    assert (fence.centre.north, fence.centre.east) == pytest.approx((0.0, 0.0), abs=1e-3)
    assert cardume("convert", str(FOLDER / "boat_speeds.plan"), "x.json", "--to", "geojson").code == 0
    deep = library.load(FOLDER / "yo_yo.plan").vehicles[0].depth
    assert [depth for _, depth in deep.points] == [2.0, 8.0, 2.0, 8.0, 2.0]


def test_names_that_yaml_would_misread(desk: Path) -> None:
    import cardume as library

    for name in ("it's.gpx", "a: b.gpx", "007.gpx", "#1.gpx", "São Jacinto.gpx", "null.gpx"):
        (desk / name).write_bytes((FOLDER / "opencpn_route.gpx").read_bytes())
        assert library.load(name).path.file == str(desk / name)
