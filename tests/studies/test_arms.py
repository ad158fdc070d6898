"""What becomes an arm of a comparison, what it is called, and what is refused."""

from pathlib import Path

import pytest

from cardume.errors import InputError, MissionError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.studies.arms import MOST_ARMS, as_text, check_metrics, make_arms, parse_vary, split_values
from studies.missions import LINE


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "line.yaml"
    path.write_text(LINE, encoding="utf-8")
    return str(path)


def laws(arms: object) -> list[str]:
    return [arm.mission.vehicles[0].guidance.law.name for arm in arms]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a,b", ["a", "b"]),
        ("{law: arcsine, gain: 0.1},b", ["{law: arcsine, gain: 0.1}", "b"]),
        ("[[0, 1], [1, 0]],star", ["[[0, 1], [1, 0]]", "star"]),
        ("'a,b',c", ["'a,b'", "c"]),
        ("a", ["a"]),
        ("a,,b", ["a", "", "b"]),
    ],
)
def test_commas_part_values_but_not_inside_brackets_or_quotes(text: str, values: list[str]) -> None:
    assert split_values(text) == values


@pytest.mark.parametrize(
    ("texts", "complaint"),
    [
        (["guidance.law"], "--vary guidance.law: write key=value,value"),
        (["=a,b"], "write key=value,value"),
        (["guidance.law="], "write key=value,value"),
        (["guidance.law=a,,b"], "write key=value,value"),
        (["guidance.law=a,a"], "the value 'a' stands there twice"),
        (["a.b=1,2", "a.b=3"], "a.b is varied already"),
    ],
)
def test_what_cannot_be_varied_is_told(texts: list[str], complaint: str) -> None:
    with pytest.raises(InputError) as error:
        parse_vary(texts)
    assert complaint in str(error.value)


def test_every_combination_is_an_arm_and_keeps_what_it_does_not_change(file: str) -> None:
    arms = make_arms([file], {"guidance.law": ["line_of_sight", "arcsine"], "current.speed": ["0 m/s", "0.2 m/s"]})
    assert [arm.label for arm in arms] == [
        "line_of_sight, speed 0 m/s",
        "line_of_sight, speed 0.2 m/s",
        "arcsine, speed 0 m/s",
        "arcsine, speed 0.2 m/s",
    ]
    assert laws(arms) == ["line_of_sight", "line_of_sight", "arcsine", "arcsine"]
    assert arms[0].mission.vehicles[0].guidance.law.parameters["lookahead"] == 2.0  # the file's, not the default
    assert arms[3].mission.current.parameters["speed"] == 0.2
    assert arms[3].changes == ("guidance.law=arcsine", "current.speed=0.2 m/s")


def test_a_sweep_in_a_file_makes_arms_with_its_parameters(file: str) -> None:
    sweep = (
        "guidance={sweep: [{law: line_of_sight, lookahead: 3 m}, {law: line_of_sight, lookahead: 5 m}, {law: arcsine}]}"
    )
    arms = make_arms([file], {}, [sweep, "current.speed={linspace: [0, 0.1, 2]}"])
    assert [arm.label for arm in arms] == [
        "speed 0, line_of_sight lookahead 3",
        "speed 0, line_of_sight lookahead 5",
        "speed 0, arcsine",
        "speed 0.1, line_of_sight lookahead 3",
        "speed 0.1, line_of_sight lookahead 5",
        "speed 0.1, arcsine",
    ]
    assert [arm.mission.vehicles[0].guidance.law.parameters.get("lookahead") for arm in arms[:3]] == [3.0, 5.0, None]
    assert not any(arm.is_runnable for arm in arms)
    assert all(arm.mission.is_fixed for arm in arms)


def test_missions_side_by_side_are_called_by_what_tells_them_apart(file: str, tmp_path: Path) -> None:
    assert [arm.label for arm in make_arms(["kinematic/line", "kinematic/circle"], {})] == ["line", "circle"]
    labels = [arm.label for arm in make_arms(["kinematic/line", "kinematic/line"], {})]
    assert labels == ["line (1)", "line (2)"]
    (tmp_path / "b.yaml").write_text(LINE)
    arms = make_arms([file, tmp_path / "b.yaml"], {"guidance.lookahead": ["2 m"]})
    assert [arm.label for arm in arms] == ["line, lookahead 2 m", "b, lookahead 2 m"]


def test_a_mission_that_was_read_already_can_be_varied(file: str) -> None:
    mission = parse_mission(LINE, catalog())
    arms = make_arms([mission], {"guidance.law": ["line_of_sight", "arcsine"]}, ["current.speed=0.3 m/s"])
    assert laws(arms) == ["line_of_sight", "arcsine"]
    assert {arm.mission.current.parameters["speed"] for arm in arms} == {0.3}
    assert make_arms([mission, mission], {})[0].mission is mission


@pytest.mark.parametrize(
    ("vary", "complaint"),
    [
        ({"guidance.lw": ["a", "b"]}, "--vary guidance.lw=a: there is no key 'lw' in guidance. Did you mean 'law'?"),
        (
            {"guidance.law": ["line_of_sight", "arcsin"]},
            "--vary guidance.law=arcsin: there is no guidance law 'arcsin'",
        ),
        ({"guidance.lookahead": ["2", "-1"]}, "--vary guidance.lookahead=-1: given -1"),
        ({"guidance.lookahead": ["2", "3 s"]}, "--vary guidance.lookahead=3 s: "),
        ({"vehicles.b.depth": ["1", "2"]}, "--vary vehicles.b.depth=1"),
        ({}, "there is one arm only"),
        ({"guidance.lookahead": ["2"]}, "there is one arm only"),
        ({"guidance.lookahead": [str(k + 1) for k in range(MOST_ARMS + 1)]}, "compare at most"),
        ({"guidance.lookahead": ["{linspace: [1, 2, 500]}"]}, "compare at most"),
    ],
)
def test_arms_that_cannot_be_are_refused_where_the_user_wrote_them(
    file: str, vary: dict[str, list[str]], complaint: str
) -> None:
    with pytest.raises(InputError) as error:
        make_arms([file], vary)
    assert complaint in str(error.value)
    assert "--set" not in str(error.value)


def test_what_is_wrong_in_an_override_of_all_stays_with_set(file: str) -> None:
    with pytest.raises(MissionError, match=r"--set guidance\.lw=3"):
        make_arms([file], {"guidance.lookahead": ["1", "2"]}, ["guidance.lw=3"])


def test_values_of_python_are_written_as_a_mission_file_would() -> None:
    assert [as_text(value) for value in (0.5, True, "5 m", {"law": "arcsine"}, [1, 2])] == [
        "0.5",
        "true",
        "5 m",
        '{"law": "arcsine"}',
        "[1, 2]",
    ]


@pytest.mark.parametrize(
    ("metric", "complaint"),
    [
        ("cross_trck_rms", "Did you mean 'cross_track_rms'?"),
        ("cross", "like it are cross_track_rms, "),
        ("nonsense", "All of them: cardume list metrics"),
        ("b.cross_track_rms", "no vehicle is called 'b'; there are a"),
    ],
)
def test_a_metric_that_is_none_is_refused(file: str, metric: str, complaint: str) -> None:
    arms = make_arms([file, file], {})
    known = ("cross_track_rms", "cross_track_max", "energy")
    assert check_metrics(["energy", "a.energy", "energy"], arms, known) == ("energy", "a.energy")
    with pytest.raises(InputError) as error:
        check_metrics([metric], arms, known)
    assert complaint in str(error.value)
