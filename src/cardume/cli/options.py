"""What several commands take, and how a mission is found."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from cardume.missions.mission import Mission

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
LARGEST_SEED = 2**63 - 1

mission_argument: Decorator = click.argument("mission")
seed_option: Decorator = click.option(
    "--seed",
    type=click.IntRange(0, LARGEST_SEED),
    metavar="N",
    help="Seed of all that is random, instead of the file's.",
)
set_option: Decorator = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    help="Change a value, as current.speed=0.2; may be repeated.",
)
allow_code_option: Decorator = click.option(
    "--allow-code",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="DIR",
    help="Folder from which the mission may import laws of yours.",
)
quiet_option: Decorator = click.option("-q", "--quiet", is_flag=True, help="Say nothing but errors.")
json_option: Decorator = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON, and nothing else, on stdout."
)


def find_mission(
    given: str, overrides: Sequence[str] = (), seed: int | None = None, allow_code: Sequence[Path] = ()
) -> "Mission":
    """The mission that a user names, every number that it leaves to chance drawn.

    Args:
        given: a mission file, a path file, or the name of a built-in mission.
        overrides: `KEY=VALUE`, each of which replaces a value of the file.
        seed: instead of the file's.
        allow_code: folders from which laws may be imported.

    Raises:
        InputError: it cannot be found, or says something that cannot be flown.
    """
    from cardume.missions.drawing import draw
    from cardume.missions.opening import open_mission

    mission = open_mission(given, overrides=list(overrides), seed=seed, allow_code=list(allow_code))
    return mission if mission.is_fixed else draw(mission, mission.seed)


def warn_of_path_file(mission: "Mission") -> None:
    """Say on stderr what of a mission's path file is not flown.

    Args:
        mission: every value of it fixed.
    """
    from cardume.missions.formats.notes import notes_of

    for note in notes_of(mission):
        click.secho("warning: ", fg="yellow", bold=True, nl=False, err=True)
        click.echo(note, err=True)
