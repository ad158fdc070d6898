"""What we write is imported by MAVSDK, with a boat on the other end of the line, and uploaded to it."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from cardume.errors import InputError
from cardume.missions.formats import parse_plan, read_plan
from cardume.missions.formats.content import QGC, WPL
from cardume.missions.formats.plan import Plan
from cardume.missions.formats.sampling import to_course
from cardume.missions.formats.writing import with_speed, write_plan
from missions.formats.make_paths import FOLDER
from missions.formats.test_files import GOOD, real
from missions.formats.vehicle import PX4, Boat, free_port

mavsdk = pytest.importorskip("mavsdk", reason="mavsdk is not installed: pip install 'cardume[dev]'")
pytest.importorskip("pymavlink", reason="pymavlink is not installed: pip install 'cardume[dev]'")

FIND_IN = 20.0  # [s]
WAYPOINT, CHANGE_SPEED, RELATIVE = 16, 178, 3
UNIT = 1e-7  # [deg] of MAVLink


class Ground:
    """MAVSDK and the boat that it found."""

    def __init__(self, raw: Any, boat: Boat) -> None:
        self.raw, self.boat = raw, boat

    def imported(self, content: bytes, kind: str) -> list[Any]:
        """The mission items of a file."""
        read = (
            self.raw.import_qgroundcontrol_mission_from_string
            if kind == QGC
            else self.raw.import_mission_planner_mission_from_string
        )
        return list(read(content.decode()).mission_items)


@pytest.fixture(scope="module")
def ground() -> Iterator[Ground]:
    from mavsdk.plugins.mission_raw.mission_raw import MissionRaw

    port = free_port()
    configuration = mavsdk.Configuration.create_with_component_type(mavsdk.ComponentType.GROUND_STATION)
    sdk = mavsdk.Mavsdk(configuration)
    sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    with Boat(port, PX4) as boat:
        system = sdk.first_autopilot(FIND_IN)
        assert system is not None, "MAVSDK did not find the boat"
        raw = MissionRaw(system)
        yield Ground(raw, boat)
        raw.destroy()
        sdk.destroy()


def waypoints(items: list[Any]) -> np.ndarray:
    """Latitude and longitude [deg] of the items that lead somewhere, without a first one that is home."""
    found = [(item.x, item.y) for item in items if item.command == WAYPOINT and item.frame == RELATIVE]
    return np.array(found) * UNIT


def expected(plan: Plan) -> np.ndarray:
    return np.array([point.degrees for point in to_course(plan, "x").points])


def speeds(items: list[Any]) -> list[float]:
    """[m/s] of the leg that ends at each waypoint."""
    speed, found = math.nan, []
    for item in items:
        if item.command == CHANGE_SPEED:
            speed = math.nan if item.param2 == -2.0 else item.param2
        elif item.command == WAYPOINT and item.frame == RELATIVE:
            found.append(speed)
    return found


@pytest.mark.parametrize("kind", [QGC, WPL])
@pytest.mark.parametrize("name", [*GOOD, "lawnmower_formation.medusa.txt"])
def test_every_good_file_is_imported_with_equal_coordinates(ground: Ground, name: str, kind: str) -> None:
    folder = FOLDER if name in GOOD else FOLDER.parent
    plan = read_plan(folder / name)
    items = ground.imported(write_plan(plan, kind, "x").content, kind)
    found, wanted = waypoints(items), expected(plan)
    assert found.shape == wanted.shape
    assert np.abs(found - wanted).max() <= 0.5001 * UNIT
    course = to_course(plan, "x")
    wanted_speeds = [math.nan if speed is None else np.float32(speed) for speed in course.speeds]
    assert speeds(items) == pytest.approx(wanted_speeds, nan_ok=True)
    altitudes = {item.z for item in items if item.command == WAYPOINT and item.frame == RELATIVE}
    assert altitudes == {-np.float32(plan.members[0].depth or 0.0)}


@pytest.mark.parametrize("kind", [QGC, WPL])
def test_it_is_accepted_by_the_boat(ground: Ground, kind: str) -> None:
    plan = with_speed(read_plan(FOLDER / "speeds.geojson"), 0.5)
    items = ground.imported(write_plan(plan, kind, "x").content, kind)
    ground.boat.is_done.clear()
    ground.raw.upload_mission(items)
    assert ground.boat.is_done.wait(5.0)
    assert [(item.command, item.x, item.y) for item in ground.boat.mission] == [
        (item.command, item.x, item.y) for item in items
    ]


ELSE = ("three_laps.plan", "corridor.plan", "landing_pattern.plan")  # jumps, and complex items that it refuses


@pytest.mark.parametrize("name", [name for name in GOOD if name.endswith(".plan") and name not in ELSE])
def test_it_reads_the_plans_of_others_as_we_do(ground: Ground, name: str) -> None:
    items = ground.imported((FOLDER / name).read_bytes(), QGC)
    found = np.array([(i.x, i.y) for i in items if i.command in (16, 19, 21, 22, 82)]) * UNIT
    assert np.abs(found - expected(read_plan(FOLDER / name))).max() <= 0.5001 * UNIT


def test_a_real_survey_is_read_alike(ground: Ground) -> None:
    file = real("qgroundcontrol_sample_with_survey.plan")
    found = waypoints(ground.imported(file.read_bytes(), QGC))
    assert np.abs(found - expected(read_plan(file))).max() <= 0.5001 * UNIT


BOTH_REFUSE = [
    "bad_overall_version.plan",
    "bad_mission_version.plan",
    "bad_survey_version.plan",
    "bad_survey_without_items.plan",
    "bad_structure_scan.plan",
    "bad_without_mission.plan",
    "bad_cut_off.plan",
    "bad_old_mission.plan",
    "bad_header.waypoints",
    "bad_columns.waypoints",
]


@pytest.mark.parametrize("name", BOTH_REFUSE)
def test_what_it_refuses_we_refuse(ground: Ground, name: str) -> None:
    from mavsdk.plugins.mission_raw.mission_raw import MissionRawError

    content = (FOLDER / name).read_bytes()
    with pytest.raises(MissionRawError):
        ground.imported(content, QGC if name.endswith(".plan") else WPL)
    with pytest.raises(InputError):
        parse_plan(content.decode(), name)


def test_a_wrong_coordinate_would_be_seen(ground: Ground) -> None:
    """The comparison is not blind: 2e-7 degrees, two centimeters, are too much."""
    plan = read_plan(FOLDER / "estuary.waypoints")
    moved = replace(plan, origin=plan.origin._replace(latitude=plan.origin.latitude + math.radians(2e-7)))
    items = ground.imported(write_plan(moved, QGC, "x").content, QGC)
    assert np.abs(waypoints(items) - expected(plan)).max() > 1.4 * UNIT
