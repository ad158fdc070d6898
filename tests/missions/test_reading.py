import json
import math
import pickle
from dataclasses import FrozenInstanceError, replace
from pathlib import Path

import pytest

from cardume.missions import LawChoice, load_mission
from cardume.missions.mission import Formation, Origin, Requirement, Transient
from cardume.missions.route import (
    ArcPath,
    ArcSegment,
    CirclePath,
    FilePath,
    LawnmowerPath,
    LinePath,
    LineSegment,
    PathStart,
    Point,
    SegmentsPath,
)
from cardume.missions.vehicle import AbsoluteStart, Offset, RelativeStart, Sensors
from missions.fakes import CATALOG
from missions.helpers import DESIGN, SMALLEST, mission, parse, refused, refused_mission, tree

DEG = math.pi / 180.0


def test_the_smallest_mission_gets_every_default() -> None:
    read = parse(SMALLEST)
    (alone,) = read.vehicles
    assert (read.cardume, read.name, read.seed, read.duration) == (1, "line", 0, 60.0)
    assert (read.tick, read.plant_step, read.log_period) == (0.1, 0.05, 1.0)
    assert read.path == LinePath(start=PathStart(course=30 * DEG), length=200.0)
    assert read.formation == Formation(speed=0.5)
    assert read.current == LawChoice(family="current", name="none")
    assert (read.origin, read.swath, read.require, read.transient) == (None, None, (), Transient())
    assert alone.model.name == "kinematic"
    assert alone.model.parameters == {"heading_time_constant": 0.0}
    assert alone.sensors == Sensors(ideal=True)
    assert alone.start == RelativeStart(cross_track=10.0)
    assert (alone.depth, alone.offset, alone.initial_estimate) == (0.0, Offset(), None)
    assert alone.guidance.law.parameters == {"lookahead": 5.0}
    assert alone.guidance.reference_point.name == "projection"
    names = (alone.compensation, alone.current_observer, alone.position, alone.neighbors, alone.autopilot)
    assert [law.name for law in names] == ["none", "none", "reset", "coordinated", "pid"]
    assert alone.coordination.law.name == "none"
    assert alone.messaging.name == "silent"
    assert alone.acoustics.name == "ideal"
    assert (alone.speed_reference, alone.end) == ("ground", "hold")
    assert read.is_fixed


def test_the_mission_of_the_design_page_is_read() -> None:
    read = parse(DESIGN)
    surface, port, starboard = read.vehicles
    start = PathStart(north=0.0, east=0.0, course=0.0)
    assert read.path == LawnmowerPath(start=start, leg=60.0, legs=4, spacing=24.0, turn="starboard")
    assert read.origin == Origin(latitude=36.8 * DEG, longitude=-7.24 * DEG)
    assert read.current.parameters == {"speed": 0.1, "towards": 60 * DEG}
    assert surface.start == AbsoluteStart(north=-5.0, east=3.0, heading=20 * DEG, speed=0.0)
    assert surface.sensors.gnss is not None
    assert surface.sensors.gnss.parameters == {"sigma": 0.5, "period": 0.2, "latency": 0.0}
    assert surface.sensors.depth is None  # the tests' catalog gives a surface vehicle none
    assert (port.depth, port.offset, port.initial_estimate) == (
        10.0,
        Offset(starboard=-3.0),
        Point(north=4.0, east=-6.0),
    )
    assert port.sensors.thruster_speed is not None
    assert port.sensors.thruster_speed.reader.parameters == {"scale": 1.1}
    assert port.sensors.gnss is None
    assert starboard.model.name == "medusa"
    for vehicle in read.vehicles:
        assert vehicle.compensation.name == "crab"
        assert vehicle.current_observer.parameters == {"k1": 0.2, "k2": 0.01}
        assert vehicle.coordination.law.parameters == {"gain": 0.15, "length_scale": 1.0}
        assert vehicle.messaging.parameters == {"period": 1.0}
        assert vehicle.acoustics.parameters == {"loss": 0.2, "delay": 0.3}
    assert read.require == (
        Requirement(metric="cross_track_rms", limit=0.5, unit="m"),
        Requirement(metric="coordination_error_max", limit=3.0, unit="m"),
    )


PATHS = {
    "line": ({"length": 5}, LinePath(length=5.0)),
    "arc": ({"radius": 5, "angle": "90 deg", "turn": "port"}, ArcPath(radius=5.0, turn="port", angle=90 * DEG)),
    "circle": (
        {"centre": {"north": 1, "east": 2}, "radius": 5, "start_bearing": "9 deg"},
        CirclePath(centre=Point(north=1.0, east=2.0), radius=5.0, turn="starboard", start_bearing=9 * DEG),
    ),
    "lawnmower": ({"leg": 5, "legs": 2, "spacing": 4}, LawnmowerPath(leg=5.0, legs=2, spacing=4.0, turn="starboard")),
    "segments": (
        {"segments": [{"line": 3}, {"arc": 12, "turn": "port", "angle": "180 deg", "speed": "1 kn"}]},
        SegmentsPath(
            segments=(LineSegment(line=3.0), ArcSegment(arc=12.0, turn="port", angle=math.pi, speed=1852 / 3600))
        ),
    ),
}


@pytest.mark.parametrize("name", PATHS)
def test_each_form_of_path_is_read(name: str) -> None:
    keys, record = PATHS[name]
    assert mission(path={"type": name, **keys}).path == record


def test_a_path_file_is_found_beside_the_mission_file(tmp_path: Path) -> None:
    (tmp_path / "lawn.medusa.txt").write_text("3\n")
    (tmp_path / "m.yaml").write_text(SMALLEST.replace("{type: line", "{type: file, file: lawn.medusa.txt} #"))
    read = load_mission(tmp_path / "m.yaml", CATALOG)
    assert read.path == FilePath(file=str(tmp_path / "lawn.medusa.txt"))
    (problem,) = refused(SMALLEST.replace("{type: line", "{type: file, file: lawn.medusa.tx} #"), directory=tmp_path)
    assert "Did you mean" in problem.message
    (problem,) = refused(SMALLEST.replace("{type: line", "{type: file, file: .} #"), directory=tmp_path)
    assert "not a regular file" in problem.message


def test_the_formation_speed_may_be_left_to_the_segments() -> None:
    with_speed = {"type": "segments", "segments": [{"line": 3, "speed": 0.4}]}
    assert mission(path=with_speed, formation={}).formation.speed is None
    problem = refused_mission(path={"type": "segments", "segments": [{"line": 3}]}, formation={})
    assert problem.position.key == "formation.speed"


def test_parameters_of_two_families_share_a_section() -> None:
    read = mission(guidance={"law": "arcsine", "gain": 0.3, "reference_point": "virtual_target", "target_gain": "2 Hz"})
    guidance = read.vehicles[0].guidance
    assert guidance.law.parameters == {"gain": 0.3, "saturation": 0.99}
    assert guidance.reference_point.parameters == {"target_gain": 2.0}


def test_a_parameter_that_two_laws_of_a_section_have_is_the_later_ones_alone() -> None:
    """Otherwise a scale would be applied by the sensor and once more by who reads it."""
    read = mission(sensors={"thruster_speed": {"scale": 1.1}})
    thruster_speed = read.vehicles[0].sensors.thruster_speed
    assert thruster_speed is not None
    assert thruster_speed.law.parameters["scale"] == 1.0
    assert thruster_speed.reader.parameters["scale"] == 1.1
    assert parse(read.to_yaml()) == read


def test_a_word_alone_names_a_law() -> None:
    read = mission(guidance="arcsine", coordination="none", messaging="none", model={"law": "kinematic"})
    vehicle = read.vehicles[0]
    assert (vehicle.guidance.law.name, vehicle.guidance.reference_point.name) == ("arcsine", "projection")
    assert (vehicle.coordination.law.name, vehicle.messaging.name) == ("none", "silent")
    assert vehicle.model == LawChoice(
        family="model", name="kinematic", parameters=read.vehicles[1].model.parameters, units=vehicle.model.units
    )


def test_a_fleet_coordinates_and_speaks_unless_told_otherwise() -> None:
    vehicle = mission().vehicles[0]
    assert (vehicle.coordination.law.name, vehicle.coordination.topology) == ("laplacian_tanh", "complete")
    assert (vehicle.messaging.name, vehicle.messaging.parameters) == ("periodic", {"period": 1.0})


def test_default_sensors_are_those_of_the_model_and_the_depth() -> None:
    read = mission(
        vehicles=[{"name": "up"}, {"name": "down", "depth": 5}, {"name": "few", "sensors": {"gnss": "none"}}]
    )
    carried = [[kind for kind in ("gnss", "ahrs", "depth", "usbl") if getattr(v.sensors, kind)] for v in read.vehicles]
    assert carried == [["gnss", "ahrs", "usbl"], ["ahrs", "depth"], ["ahrs", "usbl"]]
    ideal = replace(CATALOG, default_sensors=lambda model, submerged: "ideal")
    assert parse(json.dumps(tree()), catalog=ideal).vehicles[0].sensors.ideal


def test_users_laws_bring_their_own_parameters() -> None:
    read = mission(guidance={"law": "mine:pure_pursuit", "radius": "9 m"})
    assert read.vehicles[0].guidance.law.name == "mine:pure_pursuit"
    assert read.vehicles[0].guidance.law.parameters == {"radius": 9.0}
    for law, words in {
        "mine:absent": "there is no absent in mine.py",
        "mine:broken": "cannot be imported: SyntaxError: invalid syntax",
    }.items():
        assert words in refused_mission(guidance={"law": law}).message
    assert (
        "is a guidance law; a compensation law is needed" in refused_mission(compensation="mine:pure_pursuit").message
    )
    without = replace(CATALOG, resolve_law=type(CATALOG)(laws_of=CATALOG.laws_of).resolve_law)
    (problem,) = refused(SMALLEST, "guidance.law=mine:pure_pursuit", catalog=without)
    assert "--allow-code" in problem.message


GRAPHS = {
    "complete": ((0, 1, 1, 1), (1, 0, 1, 1), (1, 1, 0, 1), (1, 1, 1, 0)),
    "star": ((0, 1, 1, 1), (1, 0, 0, 0), (1, 0, 0, 0), (1, 0, 0, 0)),
    "path": ((0, 1, 0, 0), (1, 0, 1, 0), (0, 1, 0, 1), (0, 0, 1, 0)),
    "ring": ((0, 1, 0, 1), (1, 0, 1, 0), (0, 1, 0, 1), (1, 0, 1, 0)),
}


@pytest.mark.parametrize("name", GRAPHS)
def test_named_graphs_become_matrices(name: str) -> None:
    vehicles = [{"name": f"v{i}"} for i in range(4)]
    assert mission(vehicles=vehicles, coordination={"topology": name}).adjacency == GRAPHS[name]


def test_a_matrix_says_who_listens_to_whom() -> None:
    assert mission(coordination={"topology": [[0, 0.5], [0, 0]]}).adjacency == ((0.0, 0.5), (0.0, 0.0))
    for bad, words in {
        ((0, 1),): "here 2 x 2",
        ((0, 1), (1,)): "here 2 x 2",
        ((0, 1, 0), (1, 0, 0), (0, 0, 0)): "here 2 x 2",
        ((1, 1), (1, 0)): "the diagonal must be 0",
        ((0, -1), (1, 0)): "at least 0",
        ((0, "much"), (1, 0)): "not a number",
    }.items():
        assert words in refused_mission(coordination={"topology": bad}).message
    assert "Did you mean 'star'?" in refused_mission(coordination={"topology": "stars"}).message


def test_requirements_are_of_the_fleet_or_of_a_vehicle() -> None:
    read = mission(require={"swath_coverage": "90 %", "port": {"cross_track_rms": "30 ft"}})
    assert read.require == (
        Requirement(metric="swath_coverage", limit=0.9, unit=""),
        Requirement(metric="cross_track_rms", limit=pytest.approx(9.144), unit="m", vehicle="port"),
    )
    for bad, words in {
        "cross_track_rm": "Did you mean 'cross_track_rms'?",
        "prt": "Did you mean 'port'?",
    }.items():
        value = 1 if "cross" in bad else {"cross_track_rms": 1}
        problem = refused_mission(require={bad: value})
        assert problem.position.key == f"require.{bad}"
        assert words in problem.message


def test_steps_that_are_left_out_fit_the_tick() -> None:
    for tick, step, period in ((0.1, 0.05, 1.0), (0.02, 0.02, 1.0), (0.12, 0.04, 0.96), (3.0, 0.05, 3.0)):
        read = mission(tick=tick, messaging="none", vehicles=[{"name": "a", "sensors": "ideal"}])
        assert (read.plant_step, read.log_period) == (pytest.approx(step), pytest.approx(period))


def test_what_recurs_does_so_every_so_many_ticks() -> None:
    for sections, key, words in (
        ({"plant_step": 0.2}, "plant_step", "the nearest are 0.05 s and 0.1 s"),
        ({"plant_step": 0.03}, "plant_step", "the nearest are 0.025 s and 0.0333333333333 s"),
        ({"log_period": 0.25}, "log_period", "the nearest are 0.2 s and 0.3 s"),
        ({"log_period": 0.02}, "log_period", "the nearest are 0.1 s"),
        ({"messaging": {"period": 0.55}}, "messaging.period", "the nearest are 0.5 s and 0.6 s"),
        ({"log_period": 0.1, "duration": "480 h"}, "log_period", "rows"),
    ):
        found = refused(json.dumps({**tree(), **sections}))
        assert found[0].position.key == key
        assert words in found[0].message


def test_the_fleet_has_one_graph_and_one_channel() -> None:
    fleet = [{"name": "a"}, {"name": "b", "coordination": {"topology": "star"}}]
    assert refused_mission(vehicles=fleet).position.key == "vehicles.b.coordination.topology"
    fleet = [{"name": "a"}, {"name": "b", "acoustics": "bernoulli"}]
    assert refused_mission(vehicles=fleet).position.key == "vehicles.b.acoustics.channel"


def test_where_names_the_line_of_a_value_or_of_what_holds_it() -> None:
    read = parse(DESIGN)
    for key, begins in {
        "vehicles.port.offset.starboard": "    offset: {starboard",
        "vehicles.port.offset.ahead": "    offset: {starboard",
        "vehicles.port.sensors.thruster_speed.scale": "    sensors: {ahrs",
        "vehicles.starboard.depth": "  - name: starboard",
        "vehicles.port": "  - name: port",
        "path.leg": "  leg:",
        "path": "path:",
        "plant_step": "cardume",
    }.items():
        assert str(read.where(key)) == f"m.yaml:{line_of(begins)}:{key}"
    for rest in ("guidance.lookahead", "guidance.gain"):  # given for the whole fleet
        assert str(read.where(f"vehicles.port.{rest}")) == f"m.yaml:{line_of('guidance')}:{rest}"
    error = read.error("vehicles.port.offset.starboard", "inner arc vanishes")
    assert (
        str(error) == f"m.yaml:{line_of('    offset: {starboard')}:vehicles.port.offset.starboard: inner arc vanishes"
    )


def line_of(begins: str) -> int:
    return next(n for n, line in enumerate(DESIGN.splitlines(), 1) if line.startswith(begins))


def test_a_mission_is_frozen_and_travels() -> None:
    read = parse(DESIGN)
    assert pickle.loads(pickle.dumps(read)) == read
    assert hash(read) == hash(parse(DESIGN))
    with pytest.raises(FrozenInstanceError):
        read.seed = 3  # type: ignore[misc]
    with pytest.raises(TypeError):
        read.current.parameters["speed"] = 3.0  # type: ignore[index]
