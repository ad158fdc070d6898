"""MEDUSA / Farol mission text: what it says, and what is said of a bad one."""

import contextlib
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.errors import MissionError
from cardume.missions.formats import read_plan
from cardume.missions.formats.medusa import parse_medusa
from cardume.missions.formats.medusa_plan import to_plan
from cardume.missions.formats.plan import Plan
from cardume.missions.geodesy import GeoPoint, to_geographic, utm_to_geographic
from cardume.paths.offset import offset_path
from cardume.paths.segment import GeometryError, end_of, length_of

OURS = Path(__file__).parents[1] / "data" / "lawnmower_formation.medusa.txt"
REAL = Path(__file__).parents[3] / "shared" / "data" / "missions" / "lawnmower_3vehicles.medusa.txt"
HEAD = "3\n491854.338 4290819.848 29S\n"
PATH = "LINE 0 0 0 20 0.5\n"
ELSEWHERE = GeoPoint(math.radians(36.8), math.radians(-7.24))


def plan(text: str, origin: GeoPoint | None = ELSEWHERE) -> Plan:
    return to_plan(parse_medusa(text, "dock.txt"), origin)


def complaints(text: str) -> list[str]:
    with pytest.raises(MissionError) as refusal:
        plan(text)
    return [str(problem) for problem in refusal.value.problems]


# ---- our own file ----------------------------------------------------------------------------------------------------


def test_the_lawnmower_flies_north_turns_to_starboard_and_then_to_port() -> None:
    flown = read_plan(OURS, ELSEWHERE)
    kinds = [
        (round(math.degrees(s.course), 3) % 360.0, round(s.curvature, 6), round(s.length, 3)) for s in flown.segments
    ]
    assert kinds == [
        (0.0, 0.0, 30.0),
        (0.0, 0.1, 31.416),
        (180.0, 0.0, 30.0),
        (180.0, -0.1, 31.416),
        (0.0, 0.0, 30.0),
    ]
    # x is east and y north
    assert (flown.segments[0].north, flown.segments[0].east) == pytest.approx((-20.0, -30.0), abs=1e-6)
    assert end_of(flown.segments[-1])[:2] == pytest.approx((10.0, 10.0), abs=1e-6)


def test_speeds_depths_and_offsets() -> None:
    flown = read_plan(OURS)
    assert [s.speed for s in flown.segments] == [0.4, 0.3, 0.4, 0.3, 0.4]
    assert [(m.id, m.ahead, m.starboard, m.depth) for m in flown.members] == [
        (1, 0.0, 4.0, None),
        (2, -2.5, 0.0, 2.5),
        (3, 0.0, -4.0, 4.0),
    ]
    assert flown.notes == ()


def test_gamma_and_user_data_are_accepted_and_the_section_is_kept() -> None:
    mission = parse_medusa(OURS.read_text(), "x")
    assert [item.gamma for item in mission.items if item.is_path] == [None, None, 91.42, 122.83, None]
    assert [item.vehicle for item in mission.items] == [2, 3, -1, -1, -1, -1, -1]


def test_flown_where_it_says_every_point_lies_where_utm_puts_it() -> None:
    """Turned by the convergence of the grid and scaled: (north, east) = (y, x) would be centimeters off here."""
    mission, flown = parse_medusa(OURS.read_text(), "x"), read_plan(OURS)
    assert flown.origin == mission.place
    corners = [(-30.0, -20.0), (-30.0, 10.0), (-10.0, 10.0), (-10.0, -20.0), (10.0, -20.0), (10.0, 10.0)]
    ends = [(s.north, s.east) for s in flown.segments] + [end_of(flown.segments[-1])[:2]]
    for (x, y), (north, east) in zip(corners, ends, strict=True):
        grid = mission.reference._replace(
            easting=mission.reference.easting + x, northing=mission.reference.northing + y
        )
        there = to_geographic(north, east, flown.origin)
        assert np.array(there) == pytest.approx(np.array(utm_to_geographic(grid)), abs=1e-4 / 6.4e6)


def test_moved_elsewhere_the_drawing_stays_as_it_is() -> None:
    here, there = read_plan(OURS), read_plan(OURS, ELSEWHERE)
    assert there.origin == ELSEWHERE
    assert length_of(there.segments) == pytest.approx(90.0 + 20.0 * math.pi)
    assert length_of(here.segments) / length_of(there.segments) == pytest.approx(1.0 / 0.9996019, abs=1e-7)


# ---- the file of the Farol documentation -----------------------------------------------------------------------------


@pytest.mark.skipif(not REAL.exists(), reason="the mission file of the Farol documentation is not here")
def test_the_real_lawnmower_closes() -> None:
    """Written to the centimeter, its center 12.28 and 12.29 m from the ends of an arc: made smooth within 6 mm."""
    flown = read_plan(REAL, ELSEWHERE)
    written = [(-24.57, -24.57), (12.29, -24.57), (12.29, 0.0), (-12.29, 0.0), (-12.29, 24.57), (24.57, 24.57)]
    ends = [(s.north, s.east) for s in flown.segments] + [end_of(flown.segments[-1])[:2]]
    assert np.abs(np.array(ends) - written).max() < 6e-3
    for before, after in zip(flown.segments, flown.segments[1:], strict=False):
        assert end_of(before) == pytest.approx((after.north, after.east, after.course), abs=1e-9)
    assert [np.sign(s.curvature) for s in flown.segments] == [0.0, 1.0, 0.0, -1.0, 0.0]
    assert length_of(flown.segments) == pytest.approx(98.3 + 2.0 * math.pi * 12.285, abs=0.02)
    assert {s.speed for s in flown.segments} == {0.3}
    assert [(m.id, m.starboard) for m in flown.members] == [(1, 3.0), (2, 0.0), (3, -3.0)]
    assert np.degrees(read_plan(REAL).origin) == pytest.approx((38.76605, -9.09376), abs=1e-5)


@pytest.mark.skipif(not REAL.exists(), reason="the mission file of the Farol documentation is not here")
@pytest.mark.parametrize("offset", [-3.0, 0.0, 3.0, 11.0])
def test_the_real_lawnmower_has_room_for_its_formation(offset: float) -> None:
    path = offset_path(read_plan(REAL).segments, offset)
    assert path[0] == 5
    assert path[1] == pytest.approx(path[2], abs=0.01)  # one turn to each side: no path is longer


# ---- what the form allows --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        HEAD + PATH,
        (HEAD + PATH).replace("\n", "\r\n"),
        "\ufeff# fim\n\n\n" + HEAD + "\n   \n" + PATH + "\n",
        "3\n491854.338\t4290819.848   29 S\n\tLINE 0 0 0 2e1 5.e-1 # on we go",
        "  3  \n4.91854338e5 +4290819.848 29s\nLINE -0 .0 0 +20 0.5 -1 20 note",
    ],
)
def test_spaces_line_ends_comments_and_number_forms(text: str) -> None:
    (line,) = plan(text).segments
    assert (line.course, line.length, line.speed) == pytest.approx((0.0, 20.0, 0.5))


def test_a_latin_1_comment_is_no_obstacle(tmp_path: Path) -> None:
    file = tmp_path / "old.txt"
    file.write_bytes("# missão\n".encode("latin-1") + (HEAD + PATH).encode())
    assert len(read_plan(file).segments) == 1


@pytest.mark.parametrize(("direction", "curvature"), [("-1", 0.1), ("1", -0.1)])
def test_direction_minus_one_is_clockwise_on_the_map(direction: str, curvature: float) -> None:
    """From (-10, 0) about the origin: clockwise it goes north and arrives at (0, 10) after a quarter."""
    (arc,) = plan(HEAD + f"ARC -10 0 0 0 0 10 0.3 {direction} 10").segments
    assert arc.curvature == pytest.approx(curvature)
    assert arc.length == pytest.approx(10.0 * math.pi * (0.5 if direction == "-1" else 1.5))


def test_without_formation_one_vehicle_flies_the_path() -> None:
    assert [(m.id, m.ahead, m.starboard) for m in plan(HEAD + PATH).members] == [(1, 0.0, 0.0)]
    assert [m.id for m in plan(HEAD + "LINE 0 0 0 20 0.5 7").members] == [7]


def test_bias_moves_vehicles_along_the_path_only() -> None:
    flown = plan(HEAD + "BIAS 1 -5 3 2 0 0\n" + PATH)
    assert [(m.id, m.ahead, m.starboard) for m in flown.members] == [(1, -5.0, 0.0), (2, 0.0, 0.0)]
    assert any("BIAS leaves the paths where they are" in note for note in flown.notes)


def test_a_section_for_one_vehicle_is_flown_as_written() -> None:
    flown = plan(HEAD + "FORMATION 2 1 3\nLINE 0 0 0 20 0.5 2")
    assert [(m.id, m.ahead, m.starboard) for m in flown.members] == [(2, 0.0, 0.0)]
    assert "without the offset" in flown.notes[0]


def test_what_is_not_flown_is_noted_by_line() -> None:
    flown = plan(
        HEAD
        + "POINT 0 0 2 0.5 0 10\nDEPTH 3 -1\nDEPTH 1 30 -1\n"
        + PATH
        + "ALT 2 -1 -1\nDEPTH 5 -1 -1\nLINE 0 20 0 40 0.5 9\nFORMATION 1 0 0 2 0 3\n"
    )
    assert [note.split(";")[0].split(":")[0] for note in flown.notes] == [f"line {n}" for n in (3, 5, 7, 8, 9)]
    assert [m.depth for m in flown.members] == [3.0, 3.0]
    assert len(flown.segments) == 1


# ---- what it does not ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "dock.txt: holds no mission"),
        ("# only comments\n", "holds no mission"),
        ("2\n491854.338 4290819.848 29S\n" + PATH, "dock.txt:1:version: is '2'; the version that is read is 3"),
        ("3\n491854.338 4290819.848\n" + PATH, "dock.txt:2:reference: is '491854.338 4290819.848'; give UTM easting"),
        ("3\n491854.338 4290819.848 29Q\n" + PATH, "band Q lies between 16 and 24 deg"),
        ("3\n4290819.848 491854.338 29S\n" + PATH, "easting, which comes first"),
        ("3\n491854.338 north 29S\n" + PATH, "northing is 'north'; it must be a finite number"),
        (HEAD, "holds no LINE and no ARC"),
        (HEAD + "DEPTH 3 -1 -1", "holds no LINE and no ARC"),
        (HEAD + "LINES 0 0 0 20 0.5", "dock.txt:3:LINES: 'LINES' is no keyword; valid are LINE, ARC"),
        (HEAD + "line 0 0 0 20 0.5", "Did you mean 'LINE'?"),
        (HEAD + "LINE 0 0 0 20", "dock.txt:3:LINE: has 4 of its 5 values: xInit yInit xEnd yEnd speed"),
        (HEAD + "ARC -10 0 0 0 10 0 0.3 -1", "has 8 of its 9 values"),
        (HEAD + "LINE 0 0 0 20,5 0.5", "yEnd is '20,5'; it must be a finite number, such as -24.57; the decimal sign"),
        (HEAD + "LINE 0 0 0 nan 0.5", "yEnd is 'nan'"),
        (HEAD + "LINE 0 0 0 1e999 0.5", "yEnd is '1e999'"),
        (HEAD + "LINE 0 0 0 2e6 0.5", "yEnd is 2e+06; no number of a mission is beyond 1e+06"),
        (HEAD + "LINE 0 0 0 20 0.5 all", "vehicle is 'all'; it must be a whole number, an id or -1"),
        (HEAD + "LINE 0 0 0 20 0.5 -1 x", "gamma is 'x'"),
        (HEAD + "LINE 0 0 0 20 0", "speed is 0; it must be > 0"),
        (HEAD + "LINE 0 0 0 20 -0.5", "speed is -0.5"),
        (HEAD + "LINE 0 0 0 0.01 0.5", "dock.txt:3: line 3 is a line of 0.01 m"),
        (HEAD + "ARC -10 0 0 0 10 0 0.3 0 10", "direction is 0; it is -1 (clockwise on the map) or 1"),
        (HEAD + "ARC -10 0 0 0 10 0 0.3 -1 12", "radius is 12 m, but the arc starts 10 m from its center"),
        (HEAD + "ARC -10 0 0 0 11 0 0.3 -1 10", "ends 11 m from it"),
        (HEAD + "ARC -10 0 0 0 -10 0 0.3 -1 10", "ends where it starts"),
        (HEAD + PATH + "LINE 0 21 0 40 0.5", "dock.txt:4: line 4 starts 1 m from where line 3 ends"),
        (HEAD + "DEPTH -3 -1\n" + PATH, "depth is -3 m; it must be 0 or more"),
        (HEAD + "FORMATION 1 0\n" + PATH, "has 2 values; give id, x (along the path) and y (to its left)"),
        (HEAD + "FORMATION 1 0 0 1 0 3\n" + PATH, "names the vehicles 1, 1; each needs an id of its own"),
        (HEAD + "FORMATION 1 0 0\nBIAS 1 0 0\n" + PATH, "dock.txt:4:BIAS: is a second formation"),
        (HEAD + "FORMATION 1 0 0 2 0 3\nLINE 0 0 0 20 0.5 2", "is for vehicle 2 alone, but vehicles 1, 2 share one"),
    ],
)
def test_bad_text_is_refused_by_line(text: str, said: str) -> None:
    found = complaints(text)
    assert len(found) == 1
    assert said in found[0]


ODD_WORDS = [
    "",
    "0",
    "-1",
    "1",
    "nan",
    "1e308",
    "-1e-308",
    "1e7",
    "x",
    "\0",
    "29S",
    "ARC",
    "LINE",
    "\n",
    "#",
    "12,5",
    "é",
    "0.3",
]


@given(
    st.lists(
        st.tuples(st.integers(0, 60), st.sampled_from(ODD_WORDS) | st.floats(-50, 50).map(str)), min_size=1, max_size=4
    )
)
def test_whatever_is_written_it_is_flown_or_refused(changes: list[tuple[int, str]]) -> None:
    words = [line.split() for line in OURS.read_text().splitlines() if line and line[0] != "#"]
    flat = [(row, column) for row, line in enumerate(words) for column in range(len(line))]
    for place, word in changes:
        row, column = flat[place % len(flat)]
        words[row][column] = word
    with contextlib.suppress(MissionError, GeometryError):
        flown = plan("\n".join(" ".join(line) for line in words), None)
        for member in flown.members:
            assert np.isfinite(offset_path(flown.segments, member.starboard, member.ahead)).all()


def test_all_that_is_wrong_is_said_at_once() -> None:
    found = complaints(HEAD + "LINE 0 0 0 x 0.5\nARCO 1\nDEPTH y 0\n")
    assert [problem.split(":")[1] for problem in found] == ["3", "4", "5"]


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.txt", b"3\n\0\0", "binary file"),
        ("b.txt", b'{"fileType": "Plan"}', "version: is missing or null; plans of version 1"),
        ("c.txt", b"QGC WPL 110\n0\t1", "has 2 columns"),
        ("d.txt", b"<?xml version='1.0'?><gpx/>", "holds no points"),
        ("e.txt", b"\xff\xfe3\x00", "UTF-16"),
        ("f.txt", b"x" * 20_000_001, "larger than 20,000,000 bytes"),
        ("g.txt", b" \r\n", "is empty"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, name: str, content: bytes, said: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MissionError, match=said):
        read_plan(tmp_path / name)


def test_missing_files_and_folders_are_refused(tmp_path: Path) -> None:
    (tmp_path / "dock.txt").write_text(HEAD + PATH)
    with pytest.raises(MissionError, match=r"no such file\. Did you mean"):
        read_plan(tmp_path / "dok.txt")
    with pytest.raises(MissionError, match="not a regular file"):
        read_plan(tmp_path)
