"""One run of a study as a mission by itself, and flown again with its whole log."""

from collections.abc import Iterable
from pathlib import Path

from cardume.errors import DataError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw, sweeps_of, with_options
from cardume.missions.flying import fly_mission
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.simulation.flight import Flight
from cardume.studies.answers.results import Results


def mission_of_run(results: Results, case: tuple[int, ...], run: int, allow_code: Iterable[str | Path] = ()) -> Mission:
    """The mission that a run of a study flew: the options of its case, its seed, and the values that were drawn for it.

    Args:
        results: of the study.
        case: the place of the option of each swept key.
        run: its place among the runs.
        allow_code: folders from which the mission's own laws may be imported.

    Raises:
        DataError: the study does not hold its mission.
        InputError: the mission names something that is not here.
    """
    text = results.dataset.attrs.get("mission")
    if not isinstance(text, str):
        raise DataError("the study does not hold the mission that it flew, so no run of it can be flown again")
    mission = parse_mission(text, catalog(allow_code), source="the mission of the study")
    sweeps = sweeps_of(mission)
    options = {key: sweeps[key].options[place] for key, place in zip(results.swept, case, strict=True)}
    chosen = with_options(mission, options) if options else mission
    chances = {key: float(values[run]) for key, values in results.chances.items()}
    return draw(chosen, int(results.seeds[run]), chances)


def fly_again(results: Results, case: tuple[int, ...], run: int, allow_code: Iterable[str | Path] = ()) -> Flight:
    """A run of a study with its whole log: the same mission and seed, so the same numbers, bit for bit.

    Args:
        results: of the study.
        case: the place of the option of each swept key.
        run: its place among the runs.
        allow_code: folders from which the mission's own laws may be imported.

    Raises:
        DataError: the study does not hold its mission.
        InputError: the mission names something that is not here.
    """
    folders = tuple(allow_code)
    return fly_mission(mission_of_run(results, case, run, folders), allow_code=folders)
