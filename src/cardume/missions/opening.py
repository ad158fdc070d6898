"""A mission by whatever name the user has for it: a file, a path file by itself, or a built-in one."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from cardume.errors import InputError, MissionError, Position, Problem
from cardume.missions import library
from cardume.missions.available import catalog
from cardume.missions.formats import read_plan
from cardume.missions.loading import load_mission, parse_mission
from cardume.missions.mission import Mission

MISSION_FILES = (".yaml", ".yml")
SLOWEST = 0.5  # [-] of its planned speed, for the time that a path file by itself is given


def open_mission(
    given: str | Path,
    overrides: Sequence[str] = (),
    seed: int | None = None,
    allow_code: Iterable[str | Path] = (),
) -> Mission:
    """Find and read a mission.

    Args:
        given: a mission file, a path file (MEDUSA text), or the name of a built-in mission.
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
        raise _nothing_there(str(given))
    return mission if seed is None else replace(mission, seed=seed)


def _nothing_there(given: str) -> InputError:
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
    plan = read_plan(file)
    speeds = [segment.speed for segment in plan.segments if segment.speed]
    length = sum(segment.length for segment in plan.segments)
    seconds = 60.0 + length / (SLOWEST * min(speeds, default=0.5))
    lines = [
        "cardume: 1",
        f"name: {_safe(file.name.split('.')[0])}",
        f"duration: {round(seconds)} s",
        f"path: {{type: file, file: '{file.name}'}}",
        "vehicles:",
    ]
    for number, member in enumerate(plan.members):
        sensors = "gnss: {}, ahrs: {}, depth: {}, thruster_speed: {}"
        carried = f"{sensors}, usbl: {{}}" if number == 0 and len(plan.members) > 1 else sensors
        lines += [
            f"  - name: vehicle-{member.id}",
            f"    depth: {member.depth or 0.0:g} m",
            f"    offset: {{ahead: {member.ahead:g} m, starboard: {member.starboard:g} m}}",
            f"    sensors: {{{carried}}}",
        ]
    lines += ["compensation: {law: crab}", "current_observer: {law: complementary}"]
    if not speeds:
        lines.append("formation: {speed: 0.5 m/s}")
    return "\n".join(lines) + "\n"


def _safe(name: str) -> str:
    kept = "".join(c if c.isalnum() or c in "-_" else "-" for c in name)
    return kept.strip("-")[:64] or "mission"
