import json
import math
import statistics

import pytest

from cardume.errors import MissionError
from cardume.missions import (
    Choose,
    LawChoice,
    Mission,
    Normal,
    Sweep,
    Uniform,
    draw,
    refuse_sweeps,
    sweeps_of,
    with_options,
)
from missions.helpers import mission, parse, refused, refused_mission, tree

SPEED = {"uniform": ["0 m/s", "0.3 m/s"]}


def lookaheads(drawn: Mission) -> list[float]:
    return [vehicle.guidance.law.parameters["lookahead"] for vehicle in drawn.vehicles]


def test_a_distribution_is_kept_as_a_record_until_it_is_drawn() -> None:
    read = mission(
        current={"type": "uniform", "speed": SPEED, "towards": {"normal": ["10 deg", "1 deg"]}},
        messaging={"period": {"choose": ["1 s", "2 s"]}},
        sensors={"ahrs": {"sigma": {"sweep": ["1 deg", "2 deg"]}}},
        formation={"speed": {"linspace": ["0.1 m/s", 0.5, 5]}},
        path={"type": "lawnmower", "leg": 5, "legs": {"choose": [2, 4]}, "spacing": 4},
    )
    assert not read.is_fixed
    assert read.current.parameters["speed"] == Uniform(low=0.0, high=0.3, per="mission")
    towards = read.current.parameters["towards"]
    assert isinstance(towards, Normal)
    assert (towards.mean, towards.deviation) == (pytest.approx(math.radians(10)), pytest.approx(math.radians(1)))
    assert read.vehicles[0].messaging.parameters["period"] == Choose(options=(1.0, 2.0), per="mission")
    assert read.formation.speed == Sweep(options=(0.1, 0.2, pytest.approx(0.3), 0.4, 0.5), per="mission")
    assert read.path.legs == Choose(options=(2, 4), per="mission")
    assert set(sweeps_of(read)) == {"sensors.ahrs.sigma", "formation.speed"}


def test_what_the_fleet_shares_is_drawn_once_and_what_a_vehicle_owns_for_itself() -> None:
    law = {"lookahead": {"uniform": ["1 m", "9 m"]}}
    first, second = lookaheads(draw(mission(guidance=law), 5))
    assert first == second
    own = draw(mission(vehicles=[{"name": "a", "guidance": law}, {"name": "b", "guidance": law}]), 5)
    assert len(set(lookaheads(own))) == 2
    law["lookahead"]["per"] = "vehicle"
    first, second = lookaheads(draw(mission(guidance=law), 5))
    assert first != second
    law["lookahead"]["per"] = "mission"
    same = draw(mission(vehicles=[{"name": "a", "guidance": law}, {"name": "b", "guidance": law}]), 5)
    assert len(set(lookaheads(same))) == 1
    problem = refused_mission(current={"type": "uniform", "speed": {**SPEED, "per": "vehicle"}})
    assert "one for the whole mission" in problem.message


def test_a_draw_depends_on_the_seed_and_the_key_alone() -> None:
    law = {"lookahead": {"uniform": ["1 m", "9 m"]}}
    alone = mission(guidance=law)
    beside = mission(
        guidance=law,
        current={"type": "uniform", "speed": SPEED},
        vehicles=[{"name": "new", "depth": {"uniform": [1, 2]}}, {"name": "port"}, {"name": "starboard"}],
    )
    assert lookaheads(draw(alone, 5))[0] == lookaheads(draw(beside, 5))[0]
    assert draw(alone, 5) == draw(alone, 5)
    assert lookaheads(draw(alone, 5)) != lookaheads(draw(alone, 6))
    assert draw(alone, 5).seed == 5
    assert draw(alone) == draw(alone, 0)
    assert draw(alone, 5).is_fixed


def test_the_numbers_drawn_are_those_of_their_seed_for_ever() -> None:
    """A mission and its seed mean the same next year: change these only with the format's version."""
    drawn = draw(mission(current={"type": "uniform", "speed": SPEED, "towards": {"normal": [0, "1 deg"]}}), 7)
    assert drawn.current.parameters["speed"] == 0.0076783547946112805
    assert drawn.current.parameters["towards"] == pytest.approx(0.010751715290326463, rel=1e-13)


def test_distributions_have_their_mean_spread_and_bounds() -> None:
    read = mission(
        current={"type": "uniform", "speed": SPEED, "towards": {"normal": [1, 0.2]}},
        acoustics={"channel": "bernoulli", "loss": {"normal": [0.1, 0.2]}, "delay": {"choose": [1, 2, 4]}},
    )
    drawn = [draw(read, seed) for seed in range(1000)]
    speeds = [one.current.parameters["speed"] for one in drawn]
    towards = [one.current.parameters["towards"] for one in drawn]
    losses = [one.vehicles[0].acoustics.parameters["loss"] for one in drawn]
    delays = [one.vehicles[0].acoustics.parameters["delay"] for one in drawn]
    assert 0.0 < min(speeds) < 0.005 < 0.295 < max(speeds) < 0.3
    assert statistics.fmean(speeds) == pytest.approx(0.15, abs=4 * 0.3 / math.sqrt(12 * 1000))
    assert statistics.fmean(towards) == pytest.approx(1.0, abs=4 * 0.2 / math.sqrt(1000))
    assert statistics.stdev(towards) == pytest.approx(0.2, rel=4 / math.sqrt(2 * 1000))
    assert 0.0 <= min(losses) < 0.01  # cut off at the bounds of a probability, not piled up there
    normal = statistics.NormalDist()
    inside = normal.cdf(4.5) - normal.cdf(-0.5)
    mean = 0.1 + 0.2 * (normal.pdf(-0.5) - normal.pdf(4.5)) / inside
    assert statistics.fmean(losses) == pytest.approx(mean, abs=4 * 0.2 / math.sqrt(1000))
    assert len(set(losses)) == 1000
    for delay in (1.0, 2.0, 4.0):
        assert delays.count(delay) == pytest.approx(1000 / 3, abs=4 * math.sqrt(1000 * 2 / 9))
    assert abs(statistics.correlation(speeds, towards)) < 4 / math.sqrt(1000)


def test_whole_sections_are_drawn_and_swept() -> None:
    laws = [{"law": "line_of_sight", "lookahead": {"uniform": [1, 9]}}, "arcsine", {"law": "along_path"}]
    names = {draw(mission(guidance={"choose": laws}), seed).vehicles[0].guidance.law.name for seed in range(40)}
    assert names == {"line_of_sight", "arcsine", "along_path"}
    swept = mission(guidance={"sweep": laws}, current={"sweep": ["none", {"type": "uniform", "speed": 0.1}]})
    assert set(sweeps_of(swept)) == {"guidance", "current"}
    one = with_options(
        swept, {"guidance": sweeps_of(swept)["guidance"].options[0], "current": sweeps_of(swept)["current"].options[1]}
    )
    assert {vehicle.guidance.law.name for vehicle in one.vehicles} == {"line_of_sight"}
    assert one.current.name == "uniform"
    assert draw(one, 3).is_fixed
    with pytest.raises(MissionError, match="is no sweep with the option"):
        with_options(swept, {"guidance": LawChoice(family="guidance", name="other")})
    graphs = mission(coordination={"topology": {"sweep": ["star", "ring"]}})
    assert [
        with_options(graphs, {"coordination.topology": name}).vehicles[1].coordination.topology
        for name in ("star", "ring")
    ] == ["star", "ring"]


def test_a_sweep_is_refused_where_a_single_mission_is_needed() -> None:
    text = json.dumps(
        {**tree(), "formation": {"speed": {"sweep": [0.1, 0.2]}}, "guidance": {"lookahead": {"sweep": [1]}}}, indent=1
    )
    swept = parse(text)
    for step in (refuse_sweeps, draw):
        with pytest.raises(MissionError) as caught:
            step(swept)
        found = [(problem.position.key, problem.position.line) for problem in caught.value.problems]
        assert found == [
            ("formation.speed", line_of(text, '"speed"')),
            ("guidance.lookahead", line_of(text, '"lookahead"')),
        ]
        assert "cardume compare" in str(caught.value)
    refuse_sweeps(parse(text, "formation.speed=0.3", "guidance.lookahead=2"))


def line_of(text: str, word: str) -> int:
    return next(n for n, line in enumerate(text.splitlines(), 1) if word in line)


REFUSED = {
    "order": ({"uniform": [2, 1]}, "the higher end first"),
    "length": ({"uniform": [1]}, "uniform needs [low, high]"),
    "normal-length": ({"normal": [1, 2, 3]}, "normal needs [mean, standard deviation]"),
    "deviation": ({"normal": [1, -1]}, "at least 0 m"),
    "bounds": ({"uniform": [0, 5]}, "above 0 m"),
    "mean": ({"normal": [-1, 5]}, "above 0 m"),
    "option": ({"choose": [1, -5]}, "above 0 m"),
    "unit": ({"sweep": ["1 m", "1 s"]}, "a unit of time, but one of length"),
    "scalar": ({"uniform": 3}, "needs a list"),
    "empty": ({"choose": []}, "needs a list"),
    "count": ({"linspace": [1, 2, 1]}, "a whole number from 2"),
    "real-count": ({"linspace": [1, 2, 2.5]}, "a whole number from 2"),
    "huge-count": ({"linspace": [1, 2, 10**9]}, "a whole number from 2"),
    "two": ({"uniform": [1, 2], "normal": [1, 2]}, "does not belong beside uniform"),
    "key": ({"uniform": [1, 2], "pre": "vehicle"}, "does not belong beside uniform"),
    "per": ({"uniform": [1, 2], "per": "fleet"}, "must be one of mission, vehicle"),
    "nested": ({"choose": [{"uniform": [1, 2]}, 3]}, "stands inside one that varies"),
    "nothing": ({"choose": [1, None]}, "no value is given"),
    "misspelt": ({"unifrm": [1, 2]}, "must be a number"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_wrong_distribution_is_refused(name: str) -> None:
    lookahead, words = REFUSED[name]
    problem = refused_mission(guidance={"lookahead": lookahead})
    assert problem.position.key.startswith("guidance.lookahead")
    assert words in problem.message


@pytest.mark.parametrize(
    ("sections", "words"),
    [
        ({"seed": {"choose": [1, 2]}}, "may not vary"),
        ({"name": {"sweep": ["a", "b"]}}, "may not vary"),
        ({"vehicles": {"choose": [[{"name": "a"}]]}}, "may not vary"),
        ({"require": {"cross_track_rms": SPEED}}, "no such vehicle"),
        ({"messaging": {"period": {"uniform": ["1 s", "2 s"]}}}, "list the values with choose or sweep"),
        ({"messaging": {"period": {"choose": ["1 s", "0.25 s"]}}}, "the nearest are 0.2 s and 0.3 s"),
        ({"tick": {"sweep": [0.1, 0.3]}}, "the nearest are 0.9 s and 1.2 s"),
        ({"end": {"uniform": [1, 2]}}, "what is not a quantity"),
        ({"end": {"choose": ["hold", "stop"]}}, "given 'stop'"),
        ({"guidance": {"law": {"sweep": ["arcsine", "along_path"]}}}, "carries its parameters"),
        ({"guidance": {"sweep": ["arcsine", {"lookahead": {"sweep": [1, 2]}}]}}, "a sweep stands inside"),
        ({"path": {"type": {"choose": ["line", "arc"]}}}, "carries its keys"),
        ({"formation": {"sweep": [{"speed": 1}, {}]}}, "missing"),
    ],
)
def test_what_may_not_vary_so_is_refused(sections: dict[str, object], words: str) -> None:
    problems = refused(json.dumps({**tree(), **sections}))
    assert any(words in problem.message for problem in problems), problems


def test_swept_ticks_get_a_plant_step_that_fits_the_shortest() -> None:
    swept = mission(tick={"sweep": [0.1, 0.05, 0.02, 0.01]}, sensors="ideal")
    assert swept.plant_step == 0.01
    assert [with_options(swept, {"tick": tick}).tick for tick in sweeps_of(swept)["tick"].options] == [
        0.1,
        0.05,
        0.02,
        0.01,
    ]
