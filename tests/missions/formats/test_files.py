"""Path files as people have them: what is flown of each, by the eyes of other programs, or why it is refused."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pyproj import Geod

from cardume.errors import MissionError
from cardume.missions.formats import read_plan
from cardume.missions.formats.content import decode
from cardume.missions.formats.plan import Plan
from cardume.missions.geodesy import to_geographic
from cardume.missions.library import data_file
from cardume.paths.offset import offset_path
from cardume.paths.segment import end_of
from missions.formats import make_paths

FOLDER = make_paths.FOLDER
LOOP, EARTH = 3, Geod(ellps="WGS84")


def flown(name: str) -> Plan:
    return read_plan(FOLDER / name)


def places(plan: Plan) -> np.ndarray:
    """The corners of a plan, latitude and longitude in degrees: (n, 2)."""
    ends = [(s.north, s.east) for s in plan.segments] + [end_of(plan.segments[-1])[:2]]
    north, east = np.array(ends).T
    return np.degrees(np.column_stack(to_geographic(north, east, plan.origin)))


# ---- readers of other people -----------------------------------------------------------------------------------------


def by_json(name: str) -> list[list[float]]:
    """The waypoints of a plan without jumps, in the order of the file."""
    found = []

    def look(items: list[Any]) -> None:
        for item in items:
            if item["type"] == "ComplexItem":
                look(item.get("TransectStyleComplexItem", {}).get("Items", []))
            elif item["command"] in (16, 17, 18, 19, 21, 22, 82):
                found.append(item["params"][4:6])

    look(json.loads((FOLDER / name).read_text())["mission"]["items"])
    return found


def by_pymavlink(name: str) -> list[list[float]]:
    from pymavlink.mavwp import MAVWPLoader

    loader = MAVWPLoader()
    loader.load(str(FOLDER / name))
    rows = [loader.wp(k) for k in range(loader.count())]
    return [[row.x, row.y] for row in rows if row.seq and row.command in (16, 17, 18, 19) and (row.x or row.y)]


def by_gpxpy(name: str) -> list[list[float]]:
    import gpxpy

    gpx = gpxpy.parse(decode((FOLDER / name).read_bytes(), name))  # given bytes it knows only UTF-8
    if gpx.routes:
        points: list[Any] = gpx.routes[0].points
    elif gpx.tracks:
        points = [point for segment in gpx.tracks[0].segments for point in segment.points]
    else:
        points = gpx.waypoints
    return [[point.latitude, point.longitude] for point in points]


def by_shapely(name: str) -> list[list[float]]:
    import shapely

    shape = shapely.from_geojson((FOLDER / name).read_text())
    geometries = [g for g in shapely.get_parts(shape).tolist() if "Polygon" not in g.geom_type]
    return [[y, x] for g in geometries for x, y in shapely.get_coordinates(g)]


OTHERS = {".plan": by_json, ".waypoints": by_pymavlink, ".gpx": by_gpxpy, ".geojson": by_shapely}


GOOD = {
    # name: legs, speeds, depth, what is said of the rest
    "boat_speeds.plan": (3, [1.2, 0.6, 0.6], None, ["NAV_RETURN_TO_LAUNCH (item 7): not flown"]),
    "harbor_survey.plan": (9, [0.8] * 9, None, ["DO_SET_CAM_TRIGG_DIST (item 3, 5, 7, 9 and 6 more): not flown"]),
    "corridor.plan": (5, None, None, ["DO_SET_CAM_TRIGG_DIST (item 2, 4, 6, 8 and 2 more): not flown"]),
    "submarine.plan": (3, None, 5.0, []),
    "yo_yo.plan": (4, None, 2.0, []),
    "fence_and_rally.plan": (
        LOOP, None, None, ["areas of the geofence to keep out of", "rally points (1): not used"]
    ),
    "copter_habits.plan": (
        3,
        None,
        None,
        [
            "NAV_TAKEOFF (item 1): flown to, without taking off",
            "altitudes above the surface are not flown",
            "SET_CAMERA_MODE (item 2): not flown",
            "NAV_LOITER_TIME (item 4): flown through, without staying there",
            "CONDITION_YAW (item 5): not flown",
            "command 31010 (item 6): not flown",
            "NAV_LAND (item 7): flown to, without landing",
        ],
    ),
    "landing_pattern.plan": (LOOP, None, None, ["item 5: the landing pattern is not flown"]),
    "terrain_frame.plan": (LOOP, None, None, ["altitudes above the seabed are not flown"]),
    "spline.plan": (LOOP, None, None, ["NAV_SPLINE_WAYPOINT (item 2, 3, 4): flown to on a straight leg"]),
    "three_laps.plan": (4 * 3 - 1, None, None, []),
    "estuary.waypoints": (4, None, None, ["home (row 0): not flown"]),
    "windows.waypoints": (4, None, None, ["home (row 0): not flown"]),
    "spaces.wpl": (4, None, None, ["home (row 0): not flown"]),
    "across_the_antimeridian.waypoints": (
        9, None, None, ["home", "above the seabed", "DO_JUMP (row 6): repeats without end: taken once"]
    ),
    "rover_speeds.waypoints": (
        3,
        [1.5, 0.5, None],
        None,
        ["home", "NAV_LOITER_TURNS (row 7): flown through", "NAV_RETURN_TO_LAUNCH (row 8): not flown"],
    ),
    "dive.waypoints": (4, None, 3.5, ["home"]),
    "home_in_another_frame.waypoints": (4, None, None, ["home (row 0): not flown"]),
    "counted_from_one.waypoints": (4, None, None, []),
    "here.waypoints": (4, None, None, ["home", "NAV_LOITER_TIME (row 3): names no place: not flown"]),
    "opencpn_route.gpx": (3, None, None, []),
    "recorded_track.gpx": (439, None, None, ["2 parts of the track are joined by straight legs"]),
    "marks_only.gpx": (3, None, None, ["waypoints without a route are flown in the order of the file"]),
    "gpx_1_0.gpx": (3, None, None, []),
    "latin_1.gpx": (3, None, None, []),
    "two_routes.gpx": (
        3,
        None,
        None,
        ["route 'back' (4 points): not flown", "track 'morning' (440 points): not flown"],
    ),
    "dive_route.gpx": (3, None, 12.5, []),
    "line.geojson": (5, None, None, []),
    "speeds.geojson": (5, [0.4, 0.4, 0.7, 0.7, 0.7], None, []),
    "survey_lines.geojson": (5, None, None, ["gaps between lines (2): flown straight across"]),
    "antimeridian.geojson": (4, None, None, []),
    "points.geojson": (5, None, None, ["points without a line are flown in the order of the file"]),
    "with_area.geojson": (5, None, None, ["areas, polygons (1): not flown"]),
    "dive.geojson": (5, None, 8.0, []),
    "collected.geojson": (5, None, None, []),
}  # fmt: skip

BAD = {
    "bad_overall_version.plan": "104:version: is 2; plans of version 1 are read",
    "bad_mission_version.plan": "98:mission.version: is 1; missions of version 2 are read",
    "bad_survey_version.plan": "mission.items.0.version: is 3; a survey of version 4 and 5 is read",
    "bad_survey_without_items.plan": "mission.items.0.TransectStyleComplexItem.Items: is missing or empty",
    "bad_structure_scan.plan": "16:mission.items.0.complexItemType: is 'StructureScan', which does not hold the items",
    "bad_without_mission.plan": "mission: is missing; the plan holds no mission",
    "bad_no_items.plan": "14:mission.items: is empty",
    "bad_only_camera.plan": "holds no waypoint, only IMAGE_START_CAPTURE (item 1): not flown; SET_CAMERA_MODE (item 2)",
    "bad_one_waypoint.plan": "15:mission.items.0: is the only place of the file",
    "bad_local_frame.plan": "15:mission.items.0: NAV_WAYPOINT is in frame 1, local NED; a place on the Earth is needed",
    "bad_exchanged.plan": "34:mission.items.1: latitude -120.31 deg, longitude 38.7 deg lies nowhere",
    "bad_six_params.plan": "20:mission.items.0.params: has 6 values; a command has 7",
    "bad_jump_nowhere.plan": "91:mission.items.4: DO_JUMP leads to 9; the list has the numbers 1 to 5",
    "bad_million_laps.plan": "91:mission.items.4: DO_JUMP repeats 1e+06 times",
    "bad_two_oceans.plan": "34:mission.items.1: item 2 lies 1,670 km from the first waypoint",
    "bad_old_mission.plan": "2:fileType: is 'Mission'; it must be 'Plan'; a file of an older QGroundControl",
    "bad_text_for_number.plan": "25:mission.items.0.params.4: is '38.69'; it must be a number",
    "bad_cut_off.plan": "48: is not JSON: ",
    "bad_header.waypoints": "1: begins with 'QGC WPL 120'; lists that begin with QGC WPL 110 are read",
    "bad_comma.waypoints": "2:latitude: is '38,73473051'; it must be a finite number; the decimal sign is a point",
    "bad_columns.waypoints": "5: has 11 columns; a row has 12: index current frame command",
    "bad_only_home.waypoints": "holds no waypoint, only home (row 0): not flown",
    "bad_fence.waypoints": "only home (row 0): not flown, the path begins at row 1; NAV_FENCE_POLYGON_VERTEX_INCLUSION",
    "bad_missing_row.waypoints": "5:index: is 4 after 2; rows are numbered one by one",
    "bad_scaled.waypoints": "3: latitude 387350000 deg, longitude -90400000 deg lies nowhere; these look like degrees",
    "bad_nan.waypoints": "5: latitude nan, longitude -9.04: both must be finite",
    "bad_frame.waypoints": "3: NAV_WAYPOINT is in frame 4, local ENU",
    "bad_jump.waypoints": "8: DO_JUMP leads to 12; the list has the numbers 1 to 6",
    "bad_deep.waypoints": "3: altitude is -20000 m; no sea is deeper than 12000 m",
    "bad_entities.gpx": "2: declares a document type or entities",
    "bad_kml.gpx": "1: is XML of the kind 'kml'; GPX is read",
    "bad_latitude.gpx": "9:rtept 5: latitude 95 deg, longitude 18.99 deg lies nowhere",
    "bad_no_points.gpx": "holds no points: neither route, track nor waypoints",
    "bad_no_longitude.gpx": "8:rtept 5: has no lon",
    "bad_elevation.gpx": "5:rtept 1: ele is 'deep'; it must be a finite number",
    "bad_cut_off.gpx": "8: is not XML: unclosed token",
    "bad_area_only.geojson": "holds only areas (polygons); a path is a LineString or MultiLineString",
    "bad_datum.geojson": "crs: is 'urn:ogc:def:crs:EPSG::3857'; longitude and latitude in WGS 84 are read",
    "bad_exchanged.geojson": "7:geometry.coordinates.0: latitude -118.2 deg, longitude 38.7 deg lies nowhere",
    "bad_empty.geojson": "holds no lines",
    "bad_one_position.geojson": "6:geometry.coordinates: has 1 positions; a line needs at least two",
    "bad_type.geojson": "2:type: is 'Topology'; it must be FeatureCollection, Feature",
    "bad_position.geojson": "11:geometry.coordinates.1: has 1 numbers; a position is longitude, latitude",
    "bad_speed.geojson": "4:properties.speed: is -1 m/s; it must be > 0",
    "bad_nan.geojson": "3: holds NaN; JSON has no such number",
}


def test_every_file_is_tried() -> None:
    assert {file.name for file in FOLDER.iterdir()} == GOOD.keys() | BAD.keys()
    assert len(GOOD) >= 30


def test_the_files_are_those_of_their_generator() -> None:
    for name, text in make_paths.everything().items():
        assert (FOLDER / name).read_bytes() == make_paths.encoded(name, text), name


@pytest.mark.parametrize("name", GOOD)
def test_what_is_flown_and_what_is_not(name: str) -> None:
    legs, speeds, depth, said = GOOD[name]
    plan = flown(name)
    assert len(plan.segments) == legs
    assert [segment.speed for segment in plan.segments] == (speeds or [None] * legs)
    assert [member.depth for member in plan.members] == [depth]
    for words in said:
        assert any(words in note for note in plan.notes), f"{words!r} is not among {plan.notes}"
    extra = [note for note in plan.notes if not any(words in note for words in said)]
    assert not extra
    assert np.isfinite(offset_path(plan.segments, 0.0, 0.0, 0.5)).all()


LIKE_ESTUARY = ("windows.waypoints", "counted_from_one.waypoints")
WITH_JUMPS = {"three_laps.plan": 3, "across_the_antimeridian.waypoints": 2}


@pytest.mark.parametrize("name", [name for name in GOOD if Path(name).suffix in OTHERS and name not in LIKE_ESTUARY])
def test_another_program_reads_the_same_places(name: str) -> None:
    expected = np.array(OTHERS[Path(name).suffix](name) * WITH_JUMPS.get(name, 1))
    steps = np.abs(np.diff(expected, axis=0)) % 360.0  # a point twice is one
    expected = expected[np.append(True, steps.max(axis=1) > 1e-7)]
    found = places(flown(name))
    assert found.shape == expected.shape
    assert np.abs((found - expected + 180.0) % 360.0 - 180.0).max() < 1e-9  # [deg] a tenth of a millimeter
    _, _, lengths = EARTH.inv(expected[:-1, 1], expected[:-1, 0], expected[1:, 1], expected[1:, 0])
    assert [s.length for s in flown(name).segments] == pytest.approx(lengths, rel=3e-6)


@pytest.mark.parametrize("name", LIKE_ESTUARY)
def test_what_pymavlink_does_not_read_as_it_stands_is_the_same(name: str) -> None:
    """It stops at a byte order mark, and numbers rows from 0 whatever they say."""
    assert (places(flown(name)) == places(flown("estuary.waypoints"))).all()


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_is_told_with_its_place(name: str) -> None:
    with pytest.raises(MissionError) as refusal:
        flown(name)
    first = str(refusal.value.problems[0])
    assert BAD[name] in first
    assert first.startswith(str(FOLDER / name))
    assert "Error" not in first
    assert len(first) < 500


def test_the_fence_is_kept_for_information() -> None:
    polygon, circle = flown("fence_and_rally.plan").fences
    assert (len(polygon.corners), polygon.radius, polygon.is_inclusion) == (3, 0.0, False)
    assert np.degrees(circle.corners[0]) == pytest.approx([38.6925, -9.418])
    assert circle.radius == 400.0


def test_depths_that_change_become_a_profile_along_the_path() -> None:
    (member,) = flown("yo_yo.plan").members
    lengths, depths = np.array(member.depths).T
    assert depths.tolist() == [2.0, 8.0, 2.0, 8.0, 2.0]
    assert lengths == pytest.approx([0.0, 50.0, 100.0, 150.0, 200.0], rel=4e-3)


def test_the_antimeridian_is_no_border() -> None:
    plan = flown("across_the_antimeridian.waypoints")
    assert max(abs(s.east) for s in plan.segments) == pytest.approx(12_000.0, rel=1e-2)
    longitudes = places(plan)[:, 1]
    assert longitudes.min() < -179.8
    assert longitudes.max() > 179.9


def test_places_stay_where_they_are_whatever_the_origin() -> None:
    here = flown("estuary.waypoints")
    origin = here.origin._replace(latitude=here.origin.latitude + 1e-3, longitude=here.origin.longitude - 2e-3)
    there = read_plan(FOLDER / "estuary.waypoints", origin)
    assert there.origin == origin
    assert np.abs(places(there) - places(here)).max() < 1e-9
    assert abs(there.segments[0].north) > 1_000.0


def test_an_origin_far_away_is_refused() -> None:
    with pytest.raises(MissionError, match=r"from the origin that the mission gives; .*leave origin out"):
        read_plan(FOLDER / "estuary.waypoints", flown("across_the_antimeridian.waypoints").origin)


def test_names_of_commands_are_those_of_mavlink() -> None:
    from pymavlink.dialects.v20 import ardupilotmega

    from cardume.missions.formats.commands import NAMES, OTHER_FRAMES, PLACES, SEA_FRAMES, TERRAIN_FRAMES

    enums = ardupilotmega.enums
    assert {code: f"MAV_CMD_{name}" for code, name in NAMES.items()} == {
        code: enums["MAV_CMD"][code].name for code in NAMES
    }
    frames = {code: entry.name for code, entry in enums["MAV_FRAME"].items()}
    assert all(re.match(r"MAV_FRAME_GLOBAL(_INT|_RELATIVE_ALT(_INT)?)?$", frames[code]) for code in SEA_FRAMES)
    assert all("GLOBAL_TERRAIN" in frames[code] for code in TERRAIN_FRAMES)
    assert not any("GLOBAL" in frames[code] for code in OTHER_FRAMES)
    assert PLACES.keys() <= NAMES.keys()


# ---- real ones -------------------------------------------------------------------------------------------------------


def real(name: str) -> Path:
    file = data_file(Path("missions") / name)
    if file is None:
        pytest.skip(f"{name} is not here; set CARDUME_DATA to the folder that has missions/{name}")
    return file


def test_a_real_survey() -> None:
    plan = read_plan(real("qgroundcontrol_sample_with_survey.plan"))
    items = json.loads(real("qgroundcontrol_sample_with_survey.plan").read_text())["mission"]["items"]
    inner = next(i for i in items if i["type"] == "ComplexItem")["TransectStyleComplexItem"]["Items"]
    expected = np.array([item["params"][4:6] for item in inner if item["command"] == 16])
    assert np.abs(places(plan) - expected).max() < 1e-9
    assert any("DO_SET_CAM_TRIGG_DIST" in note for note in plan.notes)


def test_a_real_list_of_waypoints() -> None:
    plan = read_plan(real("mission_planner_sample.txt"))
    expected = [[47.3978101, 8.5455380], [47.3977992, 8.5454669], [47.3977883, 8.5453958]]
    assert np.abs(places(plan) - expected).max() < 1e-9
    assert any("NAV_RETURN_TO_LAUNCH (row 3): not flown" in note for note in plan.notes)


def test_a_real_plan_of_another_version() -> None:
    with pytest.raises(MissionError, match="version: is 42; plans of version 1 are read"):
        read_plan(real("qgroundcontrol_sample_wrong_overall_version.plan"))


def test_half_a_turn_of_longitude_is_written_either_way(tmp_path: Path) -> None:
    """Some programs count longitudes to 360."""
    (tmp_path / "east.geojson").write_text(json.dumps(_turned(json.loads((FOLDER / "line.geojson").read_text()))))
    west, east = flown("line.geojson"), read_plan(tmp_path / "east.geojson")
    assert [s.length for s in east.segments] == pytest.approx([s.length for s in west.segments], abs=1e-6)
    assert math.degrees(east.origin.longitude) == pytest.approx(math.degrees(west.origin.longitude) + 360.0)


def _turned(line: dict[str, Any]) -> dict[str, Any]:
    return line | {"coordinates": [[x + 360.0, y] for x, y in line["coordinates"]]}
