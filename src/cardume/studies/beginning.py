"""How a study begins: what it will hold, whether anything varies, whether it fits on the disk."""

import hashlib
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import numpy as np

from cardume.errors import InputError
from cardume.missions.atomic import new_directory
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.results import refuse_unwritable
from cardume.studies.cases import Cases, cases_of
from cardume.studies.constants import LARGEST_SEED
from cardume.studies.distributing import Task, stamp
from cardume.studies.files import digests_of, named_files, refuse_stale
from cardume.studies.flying import Progress
from cardume.studies.forecast import Forecast, Trial, check_that_something_varies
from cardume.studies.layout import Layout, Portion, chunk_shape, make_variables
from cardume.studies.ledger import Ledger, digest_of
from cardume.studies.required import wanted_of
from cardume.studies.sampling import needed, sample_chances, sampling_note
from cardume.studies.store import (
    STORE_NAME,
    bytes_free,
    bytes_needed,
    create_study,
    files_of,
    remove_partial_files,
    write_block,
)
from cardume.studies.work import expected_steps, expected_ticks, wants_lanes
from cardume.units import printable

MOST_MISSIONS = 100_000_000
SPARE = 1000  # seeds above those of the runs, for flights that are only tried


@dataclass
class Begun:
    """A study that can be flown.

    Attributes:
        directory: where it is kept.
        text: its mission, resolved.
        cases: of it.
        layout: of its data set.
        left: portions to be flown, by number.
        seconds: [s] that one processor takes for one mission.
        allow_code: folders from which laws may be imported.
        notes: worth knowing.
        ledger: held by this process, once it is there.
    """

    directory: Path
    text: str
    cases: Cases
    layout: Layout
    left: Mapping[int, Portion]
    seconds: float
    allow_code: tuple[str, ...]
    notes: tuple[str, ...]
    ledger: Ledger | None = None

    def create(self, stack: ExitStack) -> None:
        """Make its place, with nothing flown in it yet.

        Args:
            stack: that will let go of it.
        """
        with new_directory(self.directory) as folder:
            create_study(folder, self.layout, self.cases.mission.to_yaml(self.directory))
        self.ledger = stack.enter_context(Ledger(self.directory))
        remove_partial_files(self.directory)

    def keep(self, number: int, block: Mapping[str, np.ndarray]) -> None:
        """Write a portion, and note that it is there.

        Args:
            number: of it.
            block: of each variable.

        Raises:
            OSError: the disk is full, or refused otherwise.
        """
        assert self.ledger is not None
        portion = self.left[number]
        write_block(self.directory, self.layout, portion, block)
        self.ledger.note(number, digest_of(files_of(self.directory, self.layout, portion).values()))

    def tasks(self) -> list[Task]:
        """What is left, as it is flown."""
        missions = self.cases.size * len(self.layout.seeds)
        lanes = wants_lanes(expected_ticks(self.cases.mission) * missions)
        return [
            Task(
                number=number,
                text=self.text,
                places=tuple(portion.places),
                seeds=self.layout.seeds[portion.runs],
                chances={key: values[portion.runs] for key, values in self.layout.chances.items()},
                allow_code=self.allow_code,
                engine=stamp(),
                files=self.layout.attrs["files"],
                lanes=lanes,
            )
            for number, portion in self.left.items()
        ]

    def forecast(self, slots: int) -> Forecast:
        """How long it will take, and how much disk.

        Args:
            slots: missions that are flown at once.
        """
        missions = sum(portion.size for portion in self.left.values())
        return Forecast(
            missions=missions,
            complete=self.cases.size * len(self.layout.seeds) - missions,
            seconds=missions * self.seconds / max(slots, 1),
            slots=slots,
            bytes=bytes_needed(self.layout),
            free=bytes_free(self.directory),
            directory=self.directory,
            notes=self.notes,
        )


def begin(
    directory: Path,
    mission: Mission,
    runs: int | None,
    sampling: str,
    command: str,
    allow_code: tuple[str, ...],
    progress: Progress,
) -> Begun:
    """A new study, of which nothing exists yet.

    Args:
        directory: to keep it in.
        mission: with what varies in it.
        runs: of each case.
        sampling: monte_carlo, latin_hypercube or sobol.
        command: that was typed.
        allow_code: folders from which laws may be imported.
        progress: called with "compile", how much is done, and how much there is.

    Raises:
        InputError: it cannot be flown, or does not fit.
    """
    needed("zarr", "zarr")
    needed("xarray", "xarray")
    refuse_taken(directory)
    text = mission.to_yaml()
    cases = cases_of(parse_mission(text, catalog(allow_code), source="the mission"))
    count = _checked(runs, cases)
    seeds = cases.mission.seed + np.arange(count, dtype=np.int64)
    chances = sample_chances([one.key for one in cases.drawn], count, sampling, cases.mission.seed)
    wanted, named = wanted_of(cases.mission), named_files(cases.mission, allow_code)
    refuse_stale(named)
    trial = Trial(cases, seeds, chances, allow_code, progress)
    layout = Layout(
        axes=cases.axes,
        seeds=seeds,
        vehicles=tuple(vehicle.name for vehicle in cases.mission.vehicles),
        requirements=wanted,
        variables=make_variables(cases.drawn, trial.glimpses(), wanted),
        chunk=chunk_shape((*cases.shape, count), expected_steps(cases.mission)),
        chances=chances,
        attrs={
            "title": f"study of {cases.mission.name}",
            "version": installed_version(),
            "engine": stamp(),
            "mission": text,
            "mission_hash": hashlib.sha256(text.encode()).hexdigest(),
            "swept": [axis.key for axis in cases.axes],
            "sampling": sampling,
            "seed": cases.mission.seed,
            "runs": count,
            "command": command,
            "files": digests_of(named),
        },
    )
    _refuse_too_large(directory, layout)
    notes = check_that_something_varies(cases, count, trial.is_random)
    notes += tuple(note for note in (sampling_note(sampling, count, [one.key for one in cases.drawn]),) if note)
    left = dict(enumerate(layout.portions()))
    return Begun(directory, text, cases, layout, left, trial.seconds(), allow_code, notes)


def refuse_taken(directory: Path) -> None:
    """Check that a study can be begun in a directory.

    Args:
        directory: to keep it in.

    Raises:
        InputError: something is there already, or nothing can be written there.
    """
    name = printable(str(directory))
    if (directory / STORE_NAME).exists():
        raise InputError(f"-o {name}: holds a study already; continue it with --resume, or give a new directory")
    if directory.exists() and not directory.is_dir():
        raise InputError(f"-o {name}: is a file; give a new directory with -o")
    refuse_unwritable(directory)
    if directory.is_dir() and any(directory.iterdir()):
        raise InputError(f"-o {name}: is not empty, and holds no study; give a new directory with -o")


def _checked(runs: int | None, cases: Cases) -> int:
    if runs is None:
        raise InputError("say how many runs each case is flown with, as --runs 1000")
    if runs < 1:
        raise InputError(f"--runs {runs}: give at least 1")
    if runs * cases.size > MOST_MISSIONS:
        what = f"{runs} runs" if not cases.axes else f"{runs} runs of {cases.size} cases"
        raise InputError(f"{what} are more missions than a study may have, {MOST_MISSIONS:,}; give fewer")
    if cases.mission.seed + runs + SPARE > LARGEST_SEED:
        raise InputError(
            f"{runs} runs from seed {cases.mission.seed} on go beyond the largest seed; give a smaller one"
        )
    return runs


def _refuse_too_large(directory: Path, layout: Layout) -> None:
    size, free = bytes_needed(layout), bytes_free(directory)
    if size > free:
        raise InputError(
            f"the study takes up to {in_bytes(size)}, and {in_bytes(free)} are free where {printable(str(directory))}"
            " is; make room, fly fewer runs, or choose another disk with -o DIR"
        )


def in_bytes(size: float) -> str:
    """A size [bytes] for people.

    Args:
        size: [bytes]
    """
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} TB"


def installed_version() -> str:
    """The version of cardume."""
    try:
        return metadata.version("cardume")
    except metadata.PackageNotFoundError:
        return "unknown"
