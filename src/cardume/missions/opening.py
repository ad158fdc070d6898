"""A mission by whatever name the user has for it: a file, a path file by itself, or a built-in one."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from cardume.errors import InputError, MissionError, Position, Problem
from cardume.missions import library
from cardume.missions.available import catalog
from cardume.missions.drafting import draft_mission, file_section
from cardume.missions.formats import read_plan
from cardume.missions.loading import load_mission, parse_mission
from cardume.missions.mission import Mission

MISSION_FILES = (".yaml", ".yml")


def open_mission(
    given: str | Path,
    overrides: Sequence[str] = (),
    seed: int | None = None,
    allow_code: Iterable[str | Path] = (),
) -> Mission:
    """Find and read a mission.

    Args:
        given: a mission file, a path file (MEDUSA text, .plan, WPL, GPX, GeoJSON), or the name of a built-in mission.
        overrides: what `--set` gives, as `current.speed=0.2 m/s`.
        seed: instead of the mission's own.
        allow_code: folders from which the mission's own laws may be imported.

    Raises:
        InputError: nothing of that name, or a mission that cannot be read.
    """
    known = catalog(allow_code)
    name = Path(given).as_posix()
    if name in library.names() and not Path(given).is_file():
        mission = load_mission(library.path(name), known, [*library.overrides(name), *overrides])
    elif Path(given).suffix.lower() in MISSION_FILES or Path(given).is_dir():
        mission = load_mission(given, known, overrides)
    elif Path(given).is_file():
        text = mission_of_path_file(Path(given))
        mission = parse_mission(text, known, overrides, source=f"made from {given}", directory=Path(given).parent)
    else:
        raise nothing_there(str(given))
    return mission if seed is None else replace(mission, seed=seed)


def nothing_there(given: str) -> InputError:
    """The error that a name is neither a file nor a built-in mission, to raise."""
    from cardume.missions.source import nearest_file
    from cardume.missions.wording import unknown

    built_in = unknown(f"no file and no built-in mission is called '{given}'", given, list(library.names()))
    return MissionError([Problem(Position(given, 0, ""), f"{built_in}{nearest_file(Path(given))}")])


def mission_of_path_file(file: Path) -> str:
    """The text of a mission that flies a path file with defaults: one MEDUSA per member of its formation.

    Args:
        file: the path file.

    Returns:
        YAML.

    Raises:
        MissionError: the path file cannot be read.
    """
    return draft_mission(read_plan(file), file_section(file.name), file.name.split(".")[0])
