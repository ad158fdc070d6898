"""Controls say what the mission says, and setting one to what it says changes nothing."""

from pathlib import Path

import pytest

from cardume.errors import MissionError
from cardume.lab.controls import Control, as_groups
from cardume.lab.desk import Changes, Desk
from cardume.lab.folder import open_folder
from cardume.lab.ranges import slider_range
from cardume.missions import LawChoice, Mission, library
from cardume.missions.distributions import values_of
from cardume.missions.schema import NOT_NEGATIVE, POSITIVE, Bounds, Quantity

ALL = [name for name in library.names() if name != "cadiz"]  # which needs data that may not be here


def desk_with(folder: Path, name: str) -> tuple[Desk, list[Control]]:
    desk = Desk(open_folder(folder))
    desk.open_named(name)
    return desk, desk.controls(*desk.mission(Changes({}, {})))


def texts(control: Control) -> str:
    return f"{control.value:.12g} {control.unit}".strip() if isinstance(control.value, float) else control.value


@pytest.mark.parametrize("name", ALL)
def test_setting_every_control_to_what_it_says_changes_nothing(tmp_path: Path, name: str) -> None:
    desk, controls = desk_with(tmp_path, name)
    mission, _ = desk.mission(Changes({}, {}))
    plain = [control for control in controls if not control.given]
    laws = {key: texts(control) for control in plain if control.kind == "law" for key in control.keys}
    values = {
        key: str(int(float(control.value))) if control.kind == "whole" else texts(control)
        for control in plain
        if control.kind != "law"
        for key in control.keys
    }
    again, _ = desk.mission(Changes(laws, values))
    before, after = plain_values(mission), plain_values(again)
    assert before.keys() == after.keys()
    for key, value in before.items():
        assert after[key] == (pytest.approx(value, rel=1e-7) if isinstance(value, float) else value), key


def plain_values(mission: Mission) -> dict[str, object]:
    """Numbers and words by key; of laws their names."""
    found = {}
    for key, value in values_of(mission):
        if isinstance(value, LawChoice):
            found[f"{key} law {value.family}"] = value.name
        elif isinstance(value, float | int | str):
            found[key] = value
    return found


@pytest.mark.parametrize(
    "name",
    [
        "kinematic/spline",
        pytest.param("paper/figure-5", marks=pytest.mark.slow),
        pytest.param("survey-at-altitude", marks=pytest.mark.slow),
    ],
)
def test_both_ends_of_every_slider_are_allowed_by_themselves(tmp_path: Path, name: str) -> None:
    """What does not go with the rest of the mission may be refused, a number out of its own bounds may not."""
    desk, controls = desk_with(tmp_path, name)
    for control in controls:
        if control.kind not in ("number", "whole"):
            continue
        assert control.start < control.end, control.keys
        assert control.start <= float(control.value) <= control.end, control.keys
        for end in (control.start, control.end):
            text = f"{int(end)}" if control.kind == "whole" else f"{end:.9g} {control.unit}".strip()
            if end not in (control.low, control.high):
                assert "must be" not in complaint(desk, dict.fromkeys(control.keys, text)), control.keys


def complaint(desk: Desk, values: dict[str, str]) -> str:
    try:
        desk.mission(Changes({}, values))
    except MissionError as problem:
        return str(problem)
    return ""


def test_what_a_law_declares_is_what_the_slider_has(tmp_path: Path) -> None:
    _, controls = desk_with(tmp_path, "paper/figure-5")
    by_key = {control.keys[0]: control for control in controls}
    lookahead = by_key["vehicles.surface.guidance.lookahead"]
    assert (lookahead.value, lookahead.unit, lookahead.low) == (5.0, "m", 0.0)
    assert lookahead.meaning == "d > 0, how far ahead on the tangent it looks."
    assert lookahead.keys == tuple(f"vehicles.{name}.guidance.lookahead" for name in ("surface", "port", "starboard"))
    assert lookahead.is_log
    loss = by_key["vehicles.surface.acoustics.loss"]
    assert (loss.start, loss.end, loss.low, loss.high) == (0.0, 1.0, 0.0, 1.0)
    towards = by_key["current.towards"]
    assert (towards.value, towards.unit) == (60.0, "deg")
    assert by_key["vehicles.surface.sensors.gnss.sigma"].keys == ("vehicles.surface.sensors.gnss.sigma",)
    assert "gridded" not in by_key["current"].options  # cannot be chosen without a file
    assert {group["title"] for group in as_groups(controls)} >= {"Current", "Sensor: usbl", "Vehicle port", "Required"}


def test_what_is_drawn_says_so_and_can_be_set(tmp_path: Path) -> None:
    (tmp_path / "drawn.yaml").write_text(
        "cardume: 1\nname: drawn\nseed: 3\nduration: 20 s\npath: {type: line, length: 200 m}\n"
        "formation: {speed: {uniform: [0.4 m/s, 0.6 m/s]}}\nvehicles: [{name: a, model: kinematic, sensors: ideal}]\n",
        encoding="utf-8",
    )
    desk, controls = desk_with(tmp_path, "drawn.yaml")
    (speed,) = [control for control in controls if control.keys == ("formation.speed",)]
    assert speed.given == "uniform from 0.4 m/s to 0.6 m/s"
    assert 0.4 <= float(speed.value) <= 0.6
    mission, drawn = desk.mission(Changes({}, {"formation.speed": "0.7 m/s"}))
    assert mission.formation.speed == drawn.formation.speed == 0.7


def test_a_law_of_one_section_comes_before_its_parameters(tmp_path: Path) -> None:
    desk, _ = desk_with(tmp_path, "kinematic/line")  # which has no current
    mission, drawn = desk.mission(Changes({"current": "tidal"}, {"current.speed": "0.2 m/s"}))
    assert (mission.current.name, mission.current.parameters["speed"]) == ("tidal", 0.2)
    assert "current.across_speed" in {key for control in desk.controls(mission, drawn) for key in control.keys}


def test_a_swept_mission_opens_at_its_first_options(tmp_path: Path) -> None:
    text = library.path("kinematic/line").read_text(encoding="utf-8")
    (tmp_path / "swept.yaml").write_text(text.replace("lookahead: 5 m", "lookahead: {sweep: [3 m, 8 m]}"), "utf-8")
    desk = Desk(open_folder(tmp_path))
    opened = desk.open_named("swept.yaml")
    assert any("first option" in note for note in opened.notes)
    _, drawn = desk.mission(Changes({}, {}))
    assert drawn.vehicles[0].guidance.law.parameters["lookahead"] == 3.0


@pytest.mark.parametrize(
    ("kind", "value", "wanted"),
    [
        (Quantity("m", POSITIVE), 5.0, (0.5, 50.0, True)),
        (Quantity("m/s", NOT_NEGATIVE), 0.1, (0.0, 0.4, False)),
        (Quantity("m/s", NOT_NEGATIVE), 0.0, (0.0, 0.5, False)),
        (Quantity("", Bounds(0.0, 1.0)), 0.2, (0.0, 1.0, False)),
        (Quantity("m", Bounds(0.0, 12_000.0)), 10.0, (0.0, 40.0, False)),
        (Quantity("rad"), 1.0, (-180.0, 180.0, False)),
        (Quantity("rad"), 4.0, (0.0, 360.0, False)),
        (Quantity("m"), -3.0, (-20.0, 20.0, False)),
        (Quantity("s", POSITIVE, in_ticks=True), 0.1, (0.1, 1.0, True)),
    ],
)
def test_how_far_a_slider_goes(kind: Quantity, value: float, wanted: tuple[float, float, bool]) -> None:
    found = slider_range(kind, value, 0.1)
    assert (found.start, found.end, found.is_log) == wanted
