"""What one open page works on: a mission as it was opened, and everything that was changed since."""

import math
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from cardume.errors import InputError
from cardume.lab.controls import Control, Panel
from cardume.lab.folder import Folder, readable
from cardume.missions import library
from cardume.missions.available import catalog
from cardume.missions.catalog import Catalog, Context
from cardume.missions.distributions import varying_values
from cardume.missions.drawing import draw, sweeps_of, with_options
from cardume.missions.flying import flight_of
from cardume.missions.formats.notes import notes_of
from cardume.missions.loading import mission_of_tree
from cardume.missions.mission import Mission
from cardume.missions.opening import MISSION_FILES, mission_of_path_file
from cardume.missions.overrides import apply_overrides
from cardume.missions.planning import make_plan
from cardume.missions.source import parse_yaml, read_text
from cardume.missions.tree import Node, label
from cardume.simulation.flight import Flight
from cardume.simulation.fly import fly
from cardume.simulation.warming import warm_up

LONGEST = 4_000_000  # vehicle-ticks that are flown at a move; some five seconds
MOST_RECORDS = 2_000_000  # of the log, times vehicles: what fits into memory several times over


@dataclass(frozen=True, slots=True)
class Opened:
    """A mission as it was opened.

    Attributes:
        name: what the page calls it.
        tree: its text as values, sweeps already decided.
        directory: that its file names are relative to.
        notes: what a person should know of it.
    """

    name: str
    tree: Node
    directory: Path
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Changes:
    """What was changed on the page.

    Attributes:
        laws: keys of laws, or of whole sections, to their names or texts; they come first.
        values: keys to texts, as `--set` takes them.
        seed: instead of the mission's own.
    """

    laws: Mapping[str, str]
    values: Mapping[str, str]
    seed: int | None = None


class Desk:
    """Opens, changes and flies missions for one page.

    Args:
        folder: that may be read and written.
        allow_code: folders from which laws may be imported.
    """

    def __init__(self, folder: Folder, allow_code: Iterable[Path] = ()) -> None:
        self.folder = folder
        self.catalog: Catalog = catalog(allow_code, readable(folder))
        self.allow_code = tuple(allow_code)
        self.opened: Opened | None = None
        self.panel = Panel(self.catalog)

    def open_named(self, name: str) -> Opened:
        """Open a built-in mission, or a mission or path file of the folder.

        Args:
            name: of either.

        Raises:
            InputError: there is none, it lies elsewhere, or cannot be read.
        """
        if name in library.names():
            text, directory, overrides = read_text(library.path(name)), library.HERE, library.overrides(name)
            return self._open(name, text, directory, overrides)
        file = self.folder.file(name)
        text = read_text(file) if file.name.lower().endswith(MISSION_FILES) else mission_of_path_file(file)
        return self._open(name, text, file.parent)

    def open_text(self, name: str, text: str) -> Opened:
        """Open a mission that the person brought along.

        Args:
            name: of the file that it was.
            text: of the mission file.

        Raises:
            InputError: it cannot be read.
        """
        return self._open(name, text, self.folder.root)

    def _open(self, name: str, text: str, directory: Path, overrides: Iterable[str] = ()) -> Opened:
        context = Context(catalog=self.catalog, directory=directory)
        tree = label(apply_overrides(parse_yaml(text, name), overrides, context))
        mission = mission_of_tree(tree, self.catalog, directory=directory)
        sweeps = sweeps_of(mission)
        if sweeps:
            mission = with_options(mission, {key: sweep.options[0] for key, sweep in sweeps.items()})
            tree = parse_yaml(mission.to_yaml(directory), name)
        notes = [f"{key} is swept in this file; its first option is flown" for key in sweeps]
        notes += notes_of(mission if mission.is_fixed else draw(mission))
        self.panel = Panel(self.catalog)
        self.opened = Opened(name, tree, directory, tuple(notes))
        return self.opened

    def mission(self, changes: Changes) -> tuple[Mission, Mission]:
        """The mission as changed: as written, and with everything drawn.

        Args:
            changes: of the page.

        Raises:
            InputError: nothing is open, or what was changed cannot be.
        """
        if self.opened is None:
            raise InputError("no mission is open; choose one")
        tree, directory = self.opened.tree, self.opened.directory
        for key, value in changes.laws.items():  # one by one: a law may be one that another section announced
            tree = apply_overrides(tree, [f"{key}={value}"], Context(catalog=self.catalog, directory=directory))
        values = [f"{key}={value}" for key, value in changes.values.items()]
        mission = mission_of_tree(label(tree), self.catalog, values, directory=directory)
        mission = mission if changes.seed is None else replace(mission, seed=changes.seed)
        drawn = draw(mission) if varying_values(mission) else mission
        self.panel.tick = drawn.tick
        return mission, drawn

    def controls(self, mission: Mission, drawn: Mission) -> list[Control]:
        """The controls for a mission.

        Args:
            mission: as written.
            drawn: with everything drawn.
        """
        return self.panel.controls(mission, drawn)

    def fly(
        self,
        drawn: Mission,
        should_stop: Callable[[], bool] = lambda: False,
        progress: Callable[[str, int, int], None] = lambda stage, done, total: None,
    ) -> Flight:
        """Fly a mission with a log.

        Args:
            drawn: with everything drawn.
            should_stop: asked every few milliseconds.
            progress: called with "compile" or "fly", how much is done, and how much there is.

        Raises:
            InputError: it cannot be flown, or is too long to be flown at every move.
        """
        self._refuse_long(drawn)
        planned = make_plan(drawn, self.catalog)
        warm_up(planned.plan, lambda done, total: progress("compile", done, total))
        begin = time.perf_counter()
        flown = fly(planned.plan, lambda done, total: progress("fly", done, total), should_stop)
        return flight_of(drawn.name, planned, flown, time.perf_counter() - begin)

    def _refuse_long(self, drawn: Mission) -> None:
        size = len(drawn.vehicles)
        steps, records = size * drawn.duration / drawn.tick, size * drawn.duration / drawn.log_period
        if steps > LONGEST or records > MOST_RECORDS:
            key = "duration" if steps > LONGEST else "log_period"
            limit = LONGEST * drawn.tick / size if steps > LONGEST else MOST_RECORDS * drawn.log_period / size
            raise drawn.error(
                key,
                f"{drawn.duration:g} s of {size} vehicles are too much to be flown at every move; here at most"
                f" {math.floor(limit):g} s; 'cardume run' flies it",
            )

    def save(self, mission: Mission, name: str, may_replace: bool) -> Path:
        """Save a mission into the folder, every default written.

        Args:
            mission: as written.
            name: of the file.
            may_replace: whether a file of that name may give way.

        Raises:
            InputError: it cannot be written there.
            NameTaken: there is a file of that name.
        """
        stem = Path(name).name.removesuffix(".yaml").removesuffix(".yml")
        return self.folder.save(name, replace(mission, name=stem).to_yaml(self.folder.root), may_replace)
