"""What several commands take, and how a mission is found."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cardume.studies.constants import LARGEST_SEED

if TYPE_CHECKING:
    from cardume.missions.mission import Mission

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
LONGEST_NAME = 64

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
no_figures_option: Decorator = click.option("--no-figures", is_flag=True, help="Draw nothing.")
quiet_option: Decorator = click.option("-q", "--quiet", is_flag=True, help="Say nothing but errors.")
json_option: Decorator = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON, and nothing else, on stdout."
)


class Asked(NamedTuple):
    """What the user typed of what several commands take."""

    output: Path | None = None
    seed: int | None = None
    overrides: tuple[str, ...] = ()
    allow_code: tuple[Path, ...] = ()
    no_figures: bool = False
    quiet: bool = False
    as_json: bool = False

    @property
    def is_talkative(self) -> bool:
        """Whether a person reads along."""
        return not (self.quiet or self.as_json)

    @property
    def same(self) -> list[str]:
        """The options without which it would be another mission, or could not be read, as they are typed."""
        words = [word for change in self.overrides for word in ("--set", change)]
        words += [] if self.seed is None else ["--seed", str(self.seed)]
        return words + self.allowed

    @property
    def allowed(self) -> list[str]:
        """The options without which a mission could not be read, as they are typed."""
        return [word for folder in self.allow_code for word in ("--allow-code", str(folder))]


def take_asked(given: dict[str, Any]) -> Asked:
    """What several commands take out of what was given to one.

    Args:
        given: by name; what is taken leaves it.
    """
    return Asked(**{name: given.pop(name) for name in Asked._fields if name in given})


def output_option(numbered: str) -> Decorator:
    """Where results go.

    Args:
        numbered: where to if it is not given.
    """
    words = f"Where to; else {numbered}/001, 002, ..."
    return click.option("-o", "output", type=click.Path(path_type=Path), metavar="DIR", help=words)


def folder_name(mission: str, what: str) -> str:
    """The name of the folder for what is made of a mission.

    Args:
        mission: as the user names it.
        what: is made of it.
    """
    stem = re.sub(r"[^A-Za-z0-9_-]+", "-", Path(mission).name.split(".")[0]).strip("-")[:LONGEST_NAME]
    return f"{stem or 'mission'}-{what}"


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
