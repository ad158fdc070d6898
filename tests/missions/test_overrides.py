import pytest

from cardume.missions.vehicle import AbsoluteStart
from missions.helpers import DESIGN, SMALLEST, mission, parse, refused, refused_mission


def port(*overrides: str, **sections: object) -> object:
    return mission(*overrides, **sections).vehicles[0]


def fleet(**port_sections: object) -> list[dict[str, object]]:
    return [{"name": "port", **port_sections}, {"name": "starboard"}]


def test_a_vehicles_section_merges_with_the_fleets() -> None:
    read = mission(
        vehicles=fleet(coordination={"gain": "0.3 m/s"}, end="surface", sensors={"ahrs": {"sigma": 0}, "gnss": "none"}),
        coordination={"length_scale": "2 m", "topology": "star"},
        sensors={"ahrs": {"period": "0.5 s"}, "gnss": {}, "depth": {}},
    )
    first, second = read.vehicles
    assert first.coordination.law.parameters == {"gain": 0.3, "length_scale": 2.0}
    assert second.coordination.law.parameters == {"gain": 0.2, "length_scale": 2.0}
    assert first.coordination.topology == second.coordination.topology == "star"
    assert (first.end, second.end) == ("surface", "hold")
    assert first.sensors.ahrs.parameters == {"sigma": 0.0, "period": 0.5, "latency": 0.0}
    assert second.sensors.ahrs.parameters == {"sigma": 0.01, "period": 0.5, "latency": 0.0}
    assert (first.sensors.gnss, first.sensors.depth) == (None, second.sensors.depth)
    assert second.sensors.gnss is not None


def test_another_law_brings_its_own_parameters_and_leaves_what_is_not_the_laws() -> None:
    shared = {"law": "line_of_sight", "lookahead": "3 m", "reference_point": "virtual_target", "target_gain": 0.7}
    for override, law, parameters in (
        ("along_path", "along_path", {"lookahead": 5.0}),
        ({"law": "along_path"}, "along_path", {"lookahead": 5.0}),
        ({"law": "arcsine", "gain": 0.2}, "arcsine", {"gain": 0.2, "saturation": 0.99}),
        ({"law": "line_of_sight"}, "line_of_sight", {"lookahead": 3.0}),
        ({"lookahead": "9 m"}, "line_of_sight", {"lookahead": 9.0}),
    ):
        guidance = mission(vehicles=fleet(guidance=override), guidance=shared).vehicles[0].guidance
        assert (guidance.law.name, guidance.law.parameters) == (law, parameters)
        assert guidance.reference_point.parameters == {"target_gain": 0.7}
    projected = (
        mission(vehicles=fleet(guidance={"reference_point": "projection"}), guidance=shared).vehicles[0].guidance
    )
    assert (projected.law.parameters, projected.reference_point.parameters) == ({"lookahead": 3.0}, {})


def test_ideal_sensors_and_words_replace_a_whole_section() -> None:
    assert mission(vehicles=fleet(sensors="ideal"), sensors={"ahrs": {}}).vehicles[0].sensors.ideal
    given = mission(vehicles=fleet(sensors={"ahrs": {}}), sensors="ideal").vehicles[0].sensors
    assert not given.ideal
    assert given.ahrs is not None
    assert mission(vehicles=fleet(messaging="none"), messaging={"period": "2 s"}).vehicles[0].messaging.name == "silent"


def test_a_wrong_section_of_the_fleet_is_refused_once_even_where_no_vehicle_uses_it() -> None:
    problem = refused_mission(vehicles=fleet(guidance="arcsine")[:1], guidance={"lookahed": 3})
    assert problem.position.key == "guidance.lookahed"
    assert "Did you mean 'lookahead'?" in problem.message


def test_set_reaches_every_value() -> None:
    for override, get, value in (
        ("seed=9", lambda m: m.seed, 9),
        ("vehicles.port.depth=5 m", lambda m: m.vehicles[1].depth, 5.0),
        ("vehicles.1.depth=5 m", lambda m: m.vehicles[1].depth, 5.0),
        ("vehicles.port.sensors.thruster_speed.scale=1.2",
         lambda m: m.vehicles[1].sensors.thruster_speed.reader.parameters["scale"], 1.2),
        ("vehicles.port.guidance.lookahead=9", lambda m: m.vehicles[1].guidance.law.parameters["lookahead"], 9.0),
        ("guidance.lookahead = 9 m", lambda m: m.vehicles[2].guidance.law.parameters["lookahead"], 9.0),
        ("guidance.law=arcsine", lambda m: m.vehicles[0].guidance.law.parameters, {"gain": 0.1, "saturation": 0.99}),
        ("guidance={law: arcsine, gain: 0.4}", lambda m: m.vehicles[0].guidance.law.parameters["gain"], 0.4),
        ("current.speed=0.2 m/s", lambda m: m.current.parameters["speed"], 0.2),
        ("current.type=none", lambda m: (m.current.name, len(m.current.parameters)), ("none", 0)),
        ("current=none", lambda m: m.current.name, "none"),
        ("path={type: line, length: 7}", lambda m: m.path.length, 7.0),
        ("path.start.course=90 deg", lambda m: round(m.path.start.course, 3), 1.571),
        ("vehicles.surface.start.north=7", lambda m: m.vehicles[0].start, AbsoluteStart(
            north=7.0, east=3.0, heading=m0().vehicles[0].start.heading)),
        ("sensors=ideal", lambda m: [v.sensors.ideal for v in m.vehicles], [False, False, True]),
        ("require.cross_track_rms=9 m", lambda m: m.require[0].limit, 9.0),
        ("swath=10 m", lambda m: m.swath, 10.0),
    ):  # fmt: skip
        assert get(parse(DESIGN, override)) == value, override


def m0() -> object:
    return parse(DESIGN)


def test_several_sets_come_in_any_order() -> None:
    for overrides in (["guidance.law=arcsine", "guidance.gain=0.4"], ["guidance.gain=0.4", "guidance.law=arcsine"]):
        assert parse(DESIGN, *overrides).vehicles[0].guidance.law.parameters["gain"] == 0.4
    for overrides in (
        ["guidance.law=along_path", "guidance.lookahead=4"],
        ["guidance.lookahead=4", "guidance.law=along_path"],
    ):
        assert parse(DESIGN, *overrides).vehicles[0].guidance.law.parameters == {"lookahead": 4.0}
    assert parse(DESIGN, "seed=1", "seed=2").seed == 2
    segments = {"type": "segments", "segments": [{"line": 3}, {"arc": 4, "angle": 1}]}
    assert mission("path.segments.1.arc=9 m", "path.segments.0.line=2", path=segments).path.segments[1].arc == 9.0


REFUSED = {
    "guidnce.lookahead=3": ("guidnce", "Did you mean 'guidance'?"),
    "vehicles.prt.depth=3": ("vehicles.prt", "Did you mean 'port'?"),
    "vehicles.7.depth=3": ("vehicles.7", "Valid here: surface, port, starboard"),
    "vehicles.port.dept=3": ("vehicles.port.dept", "Did you mean 'depth'?"),
    "vehicles.port.depth=-3 m": ("vehicles.port.depth", "at least 0 m"),
    "vehicles.port.depth=3 deg": ("vehicles.port.depth", "angle"),
    "guidance.lookahead.x=3": ("guidance.lookahead", "a mapping"),
    "current.sped=3": ("current.sped", "Did you mean 'speed'?"),
    "path.type=spiral": ("path.type", "Valid here: line, arc, circle"),
    "seed=.nan": ("", "finite"),
    "seed=*x": ("", "alias"),
    "seed=[1": ("", "not valid YAML"),
    "seed=": ("", "write key.path=value"),
    "seed": ("", "write key.path=value"),
    "=3": ("", "write key.path=value"),
    "a..b=3": ("", "write key.path=value"),
    "duration=\x00": ("", "U+0000"),
    "sensors.ahrs.sigma=\ud800": ("", "U+D800"),
}


@pytest.mark.parametrize("override", REFUSED, ids=repr)
def test_a_wrong_set_is_refused_by_name(override: str) -> None:
    key, words = REFUSED[override]
    problem = refused(DESIGN, override)[0]
    assert problem.position.source.startswith("--set ")
    assert problem.position.line == 0
    assert words in problem.message
    assert not key or problem.position.key == key
    str(problem).encode("utf-8")


def test_a_single_word_cannot_be_set_in_part() -> None:
    (problem,) = refused(SMALLEST, "vehicles.alone.sensors.ahrs.sigma=0.1")
    assert "the section is 'ideal' as a whole" in problem.message
    (problem,) = refused(DESIGN.replace("{law: crab}", "{choose: [crab, none]}"), "compensation.x=1")
    assert "cannot be set; give all of it" in problem.message


def test_a_set_is_where_its_value_is() -> None:
    read = parse(DESIGN, "vehicles.port.depth=5 m")
    assert str(read.where("vehicles.port.depth")) == "--set vehicles.port.depth=5 m"
    assert read.where("vehicles.port.offset").source == "m.yaml"
