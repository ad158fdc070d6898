"""A run of a study flown again is the same mission: the same numbers, bit for bit."""

import numpy as np
import pytest

from cardume.errors import DataError
from cardume.missions.available import catalog
from cardume.missions.drawing import sweeps_of, with_options
from cardume.missions.loading import parse_mission
from cardume.studies.answers.again import fly_again, mission_of_run
from cardume.studies.answers.results import Results
from cardume.studies.flying import fly_seeds
from studies.datasets import make_dataset
from studies.missions import NOISY

DRAWN = NOISY.replace("speed: 0.1 m/s, towards", "speed: {uniform: [0 m/s, 0.3 m/s]}, towards").replace(
    "{law: line_of_sight, lookahead: 2 m}", "{sweep: [{law: line_of_sight, lookahead: 2 m}, {law: arcsine, gain: 0.2}]}"
)


def flown(with_chances: bool) -> Results:
    """Two laws with five seeds, and what was drawn and came out, as a study keeps it."""
    mission = parse_mission(DRAWN, catalog())
    (key,) = sweeps_of(mission)
    options = sweeps_of(mission)[key].options
    chances = {"current.speed": np.array([0.1, 0.9, 0.3, 0.5, 0.7])} if with_chances else {}
    tables = [fly_seeds(with_options(mission, {key: option}), range(3, 8), chances=chances) for option in options]
    values = {
        name[6:]: np.stack([table.metrics[name] for table in tables]) for name in tables[0].metrics if "fleet" in name
    }
    speeds = np.stack([table.drawn["current.speed"] for table in tables])
    swept = {key: (["line_of_sight", "arcsine"], "")}
    dataset = make_dataset(values, swept, {"current.speed": (speeds, "m/s")}, mission=mission.to_yaml())
    dataset = dataset.assign_coords(run=np.arange(3, 8))
    for name, chosen in chances.items():
        dataset[f"chance.{name}"] = ("run", chosen)
    return Results(dataset)


@pytest.mark.parametrize("with_chances", [False, True])
def test_the_same_numbers_bit_for_bit(with_chances: bool) -> None:
    results = flown(with_chances)
    assert len(np.unique(results.drawn["current.speed"])) == 5
    for at in ((0, 0), (1, 3)):
        mission = mission_of_run(results, at[:1], at[1])
        assert mission.current.parameters["speed"] == results.drawn["current.speed"][at]
        flight = fly_again(results, at[:1], at[1])
        assert len(flight.times) == 40
        for metric in results.metrics:
            np.testing.assert_array_equal(flight.metrics.worst(metric)[0], results.values(metric)[at])


def test_a_study_without_its_mission_says_so() -> None:
    with pytest.raises(DataError, match="does not hold the mission"):
        mission_of_run(Results(make_dataset({"energy": np.arange(3.0)})), (), 0)
