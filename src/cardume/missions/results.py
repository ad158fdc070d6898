"""What a run leaves behind: a directory with everything in it, or nothing.

DIR/log.nc          the flight, row by row
DIR/summary.json    its numbers and the verdict
DIR/mission.yaml    the mission with every default written
DIR/figures/, DIR/report.html    what the caller draws
"""

import errno
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from cardume.errors import CardumeError, DataError, InputError
from cardume.missions.atomic import make_parents, new_directory, remove_if_empty, renewed_directory, write_file
from cardume.missions.log import write_log
from cardume.missions.mission import Mission
from cardume.missions.summary import FILE_NAME, judge, read_summary, summarize, to_json
from cardume.simulation.flight import Flight
from cardume.units import printable

Filled = TypeVar("Filled")
RUNS = Path("runs")
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class ResultsError(CardumeError):
    """The mission was flown, but its results could not be kept."""

    exit_code = 3


class Destination(NamedTuple):
    """Where results will go."""

    directory: Path
    is_numbered: bool = False  # take the next number if somebody else takes this one meanwhile
    is_there: bool = False  # already, empty or with an earlier run
    ours: tuple[str, ...] = ()  # entries of the earlier run, which make place


def choose_destination(
    mission_name: str, given: Path | None = None, read: Callable[[Path], dict[str, Any]] = read_summary
) -> Destination:
    """Decide, before anything is flown, where the results will go, and refuse what cannot work.

    Without a directory given it is the next free one of `runs/NAME/001`, `002`, ...; one that is
    given may be new, empty, or hold an earlier run of cardume and nothing else.

    Args:
        mission_name: safe as the name of a folder.
        given: the directory that the user wants.
        read: gives what an earlier run left to say in a directory, and which `files` are its own.

    Raises:
        InputError: it holds something else, is no directory, or cannot be written to.
    """
    if given is None:
        parent = RUNS / mission_name
        destination = Destination(parent / f"{last_number(parent) + 1:03d}", is_numbered=True)
    else:
        destination = Destination(given, is_there=given.is_dir(), ours=_earlier_run(given, read))
    refuse_unwritable(destination.directory)
    return destination


def write_results(
    destination: Destination,
    mission: Mission,
    flight: Flight,
    *,
    version: str,
    draw: Callable[[Path], None] | None = None,
) -> tuple[Path, dict[str, Any]]:
    """Write everything, complete or not at all.

    Args:
        destination: from `choose_destination`.
        mission: as flown.
        flight: what was flown, however it ended.
        version: of cardume.
        draw: adds pictures to the folder of the run, in which log and mission are already.

    Returns:
        The directory, and the summary as written there.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """
    return write_atomically(
        destination,
        mission.name,
        lambda folder, final: _fill(folder, final, mission, flight, version, draw),
    )


def write_atomically(destination: Destination, name: str, fill: Callable[[Path, Path], Filled]) -> tuple[Path, Filled]:
    """Fill a destination, complete or not at all.

    Args:
        destination: from `choose_destination`.
        name: that it was chosen for.
        fill: writes into the first folder what will lie in the second.

    Returns:
        The directory, and what `fill` returned.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """
    while True:
        try:
            with _opened(destination) as folder:
                filled = fill(folder, destination.directory)
            return destination.directory, filled
        except FileExistsError as problem:
            if not destination.is_numbered:
                raise ResultsError(refusal(destination.directory, problem)) from None
            destination = choose_destination(name)
        except OSError as problem:
            raise ResultsError(refusal(destination.directory, problem)) from problem


def keep_together(
    destination: Destination,
    name: str,
    file: str,
    texts: Callable[[Path], Mapping[str, str]],
    summarize: Callable[[list[str]], dict[str, Any]],
    draw: Callable[[Path], None] | None = None,
) -> tuple[Path, dict[str, Any]]:
    """Write texts, pictures, and a summary that lists all of them; complete or not at all.

    Args:
        destination: from `choose_destination`.
        name: that it was chosen for.
        file: of the summary.
        texts: by file name, for the directory in which they will lie.
        summarize: gives the summary for the files that were written.
        draw: fills the folder it is given with figures.

    Returns:
        The directory, and the summary.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """

    def fill(folder: Path, final: Path) -> dict[str, Any]:
        for title, text in texts(final).items():
            (folder / title).write_text(text, encoding="utf-8", newline="")
        if draw is not None:
            draw(folder)
        summary = summarize(sorted([*(path.name for path in folder.iterdir()), file]))
        (folder / file).write_text(to_json(summary), encoding="utf-8")
        return summary

    return write_atomically(destination, name, fill)


@contextmanager
def numbered_directory(parent: Path) -> Iterator[Path]:
    """Take the next free `001`, `002`, ... at once, so that nobody else does; given back if the block fails, if empty.

    Args:
        parent: of it; made if it is not there.
    """
    made = make_parents(parent)
    number = last_number(parent) + 1
    while True:
        directory = parent / f"{number:03d}"
        try:
            directory.mkdir()
            break
        except FileExistsError:
            number += 1
    try:
        yield directory
    except BaseException:
        for folder in (directory, *made):
            remove_if_empty(folder)
        raise


def last_number(parent: Path) -> int:
    """The largest number among the directories `001`, `002`, ... of a parent; 0 where there is none.

    Args:
        parent: of them.
    """
    try:
        return max((int(name) for name in os.listdir(parent) if name.isascii() and name.isdigit()), default=0)
    except OSError:
        return 0


def _opened(destination: Destination) -> AbstractContextManager[Path]:
    if destination.is_there:
        return renewed_directory(destination.directory, destination.ours)
    return new_directory(destination.directory)


def _fill(
    folder: Path,
    final: Path,
    mission: Mission,
    flight: Flight,
    version: str,
    draw: Callable[[Path], None] | None,
) -> dict[str, Any]:
    resolved = f"# As flown by cardume {version}, every default written.\n{mission.to_yaml(final)}"
    (folder / "mission.yaml").write_text(resolved, encoding="utf-8")
    write_log(folder / "log.nc", flight, mission=resolved, version=version)
    if draw is not None:
        draw(folder)
    files = sorted([*_files(folder), FILE_NAME])
    verdicts = judge(mission.require, flight.metrics)
    summary = summarize(flight, verdicts, duration=mission.duration, version=version, files=files)
    (folder / FILE_NAME).write_text(to_json(summary), encoding="utf-8")
    return summary


def note_files(directory: Path, names: Sequence[str]) -> None:
    """Add files to those that the summary of a run lists as ours.

    Args:
        directory: of the run.
        names: relative to it.

    Raises:
        OSError: the disk refused.
    """
    summary = read_summary(directory)
    summary["files"] = sorted({*summary.get("files", ()), *names})
    write_file(directory / FILE_NAME, to_json(summary).encode("ascii"))


def _files(folder: Path) -> list[str]:
    """Every file below a folder, relative to it."""
    return [path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir()]


def _earlier_run(directory: Path, read: Callable[[Path], dict[str, Any]]) -> tuple[str, ...]:
    """The entries of an earlier run in a directory; none where it is new or empty."""
    name = printable(str(directory))
    advice = "give a new directory with -o"
    if not directory.exists():
        return ()
    if not directory.is_dir():
        raise InputError(f"-o {name}: is a file; {advice}")
    try:
        if not os.listdir(directory):
            return ()
        listed = set(read(directory).get("files", ()))
        found = set(_files(directory))  # only now: this may be somebody's whole disk
    except OSError as problem:
        raise InputError(f"-o {name}: cannot be read: {problem.strerror}; {advice}") from None
    except DataError:
        raise InputError(f"-o {name}: is not empty, and not a run of cardume; {advice}") from None
    if others := sorted(found - listed):
        raise InputError(f"-o {name}: holds {printable(others[0])}, which cardume did not write there; {advice}")
    return tuple(sorted({Path(file).parts[0] for file in found}))


def refuse_unwritable(directory: Path) -> None:
    """Say before the flight, not after it, that its results could not be kept.

    Args:
        directory: to keep them in.

    Raises:
        InputError: nothing can be written there.
    """
    place = next(path for path in (directory, *directory.absolute().parents) if path.exists())
    if not place.is_dir():
        raise InputError(
            f"{printable(str(place))} is a file, so no results fit below it; choose another place with -o DIR"
        )
    if not os.access(place, os.W_OK | os.X_OK):
        raise InputError(f"no permission to write in {printable(str(place))}; choose another place with -o DIR")


def refusal(directory: Path, problem: OSError, advice: str = "") -> str:
    """That results cannot be written, and what to do.

    Args:
        directory: of them.
        problem: what the disk said.
        advice: what to do, where something was kept; else nothing was.
    """
    name = printable(str(directory))
    reason = printable(problem.strerror or str(problem))
    if problem.errno in FULL:
        advice = advice or "nothing was kept there: make room, or choose another disk with -o DIR, and run again"
        return f"the disk of {name} is full ({reason}); {advice}"
    advice = advice or "nothing was kept there: choose another place with -o DIR"
    return f"the results could not be written to {name}: {reason}; {advice}"
