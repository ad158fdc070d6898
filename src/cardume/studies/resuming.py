"""How a study continues: that it is the same one, and which of its portions are complete."""

import difflib
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from cardume.errors import DataError, InputError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.studies.beginning import Begun, installed_version
from cardume.studies.cases import cases_of
from cardume.studies.distributing import stamp
from cardume.studies.files import digests_of, named_files, refuse_changed, refuse_stale
from cardume.studies.flying import Progress
from cardume.studies.forecast import Trial
from cardume.studies.layout import LAST, Layout, Portion
from cardume.studies.ledger import Ledger, digest_of, read_ledger, write_ledger
from cardume.studies.store import (
    STORE_NAME,
    describing_files,
    files_of,
    layout_of,
    read_attributes,
    remove_partial_files,
)
from cardume.units import printable

LONGEST_DIFFERENCE = 60  # lines


def resume_at(
    stack: ExitStack,
    directory: Path,
    mission: Mission,
    runs: int | None,
    sampling: str | None,
    allow_code: tuple[str, ...],
    progress: Progress,
) -> Begun:
    """A study that continues: what its ledger and its files agree upon is not flown again.

    Args:
        stack: that will let go of it.
        directory: that it is in.
        mission: that it must be of.
        runs: that it must have; None where that is not said.
        sampling: that it must have; None where that is not said.
        allow_code: folders from which laws may be imported.
        progress: called with "compile" or "verify", how much is done, and how much there is.

    Raises:
        DataError: it is damaged, or of another version.
        InputError: it is another study, or another process flies it.
    """
    attrs = read_attributes(directory)
    _refuse_another(directory, attrs, mission, runs, sampling)
    _refuse_other_files(directory, attrs, mission, allow_code)
    text = attrs["mission"]
    cases = cases_of(parse_mission(text, catalog(allow_code), source=f"the mission of the study in {directory}"))
    ledger = stack.enter_context(Ledger(directory))
    layout = layout_of(directory, cases)
    remove_partial_files(directory)
    described, noted = read_ledger(directory)
    now = digest_of(describing_files(directory, layout))
    if described and now != described:
        raise DataError(
            f"the study in {printable(str(directory))} is damaged: what describes it is not what was written there;"
            f" bring {STORE_NAME} back from a copy, or fly it again in a new directory"
        )
    portions = dict(enumerate(layout.portions()))
    kept = _complete(directory, layout, portions, noted, progress)
    if not described:
        write_ledger(directory, now, {number: noted[number] for number in kept})
    left = {number: portion for number, portion in portions.items() if number not in kept}
    for portion in left.values():  # damaged or not: until it is flown again, nobody may take it for flown
        files_of(directory, layout, portion)[LAST].unlink(missing_ok=True)
    notes = _damage_words(noted, kept, described)
    seconds = 0.0
    if left:
        seconds = Trial(cases, layout.seeds, layout.chances, allow_code, progress).seconds()
    return Begun(directory, text, cases, layout, left, seconds, allow_code, notes, ledger)


def _refuse_another(
    directory: Path, attrs: Mapping[str, Any], mission: Mission, runs: int | None, sampling: str | None
) -> None:
    """Only the very study that was begun is continued, or half of its numbers would be those of another."""
    name = printable(str(directory))
    text = mission.to_yaml()
    if text != attrs["mission"]:
        lines = difflib.unified_diff(
            attrs["mission"].splitlines(), text.splitlines(), "as it was begun", "as it is now", n=1, lineterm=""
        )
        shown = [*lines]
        cut = [f"... and {len(shown) - LONGEST_DIFFERENCE} more lines"] if len(shown) > LONGEST_DIFFERENCE else []
        raise InputError(
            f"the study in {name} is of another mission; undo this, or begin a new study in another directory:\n"
            + "\n".join([*map(printable, shown[:LONGEST_DIFFERENCE]), *cut])
        )
    if runs is not None and runs != attrs["runs"]:
        raise InputError(
            f"the study in {name} has {attrs['runs']} runs, and --runs {runs} is given; leave it out to continue, or"
            " begin a new study in another directory"
        )
    if sampling is not None and sampling != attrs["sampling"]:
        raise InputError(
            f"the study in {name} is sampled by {attrs['sampling']}, and --sampling {sampling} is given; leave it out"
            " to continue"
        )
    if attrs["engine"] != stamp():
        raise InputError(
            f"the study in {name} was begun by another cardume ({attrs['version']}, sources {attrs['engine']}; here"
            f" {installed_version()}, {stamp()}), whose numbers may differ; continue it with that one, or"
            " begin a new study"
        )


def _refuse_other_files(
    directory: Path, attrs: Mapping[str, Any], mission: Mission, allow_code: tuple[str, ...]
) -> None:
    named = named_files(mission, allow_code)
    advice = "bring back what it was, or begin a new study in another directory"
    refuse_changed(attrs["files"], digests_of(named), f"the study in {printable(str(directory))}", advice)
    refuse_stale(named)


def _complete(
    directory: Path, layout: Layout, portions: Mapping[int, Portion], noted: Mapping[int, str], progress: Progress
) -> set[int]:
    """The portions whose files are what the ledger says."""
    found = set()
    for done, (number, digest) in enumerate(noted.items()):
        progress("verify", done, len(noted))
        if number in portions and digest_of(files_of(directory, layout, portions[number]).values()) == digest:
            found.add(number)
    if noted:
        progress("verify", len(noted), len(noted))
    return found


def _damage_words(noted: Mapping[int, str], kept: set[int], described: str) -> tuple[str, ...]:
    damaged = len(noted) - len(kept)
    words = []
    if not described:
        words.append("the ledger was damaged; what it could not vouch for is flown again")
    if damaged:
        words.append(f"{damaged} of {len(noted)} portions were damaged on the disk, and are flown again")
    return tuple(words)
