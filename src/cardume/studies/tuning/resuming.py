"""How a tuning continues: that it is the same one, and what was tried already."""

import csv
import hashlib
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cardume.errors import DataError, InputError
from cardume.missions.summary import read_kept
from cardume.simulation.flight import METRICS
from cardume.studies.distributing import stamp
from cardume.studies.files import digests_of, named_files, refuse_changed, refuse_stale
from cardume.studies.tuning.searching import Try
from cardume.studies.tuning.trying import Known, Settings
from cardume.units import printable

FILE_NAME, TABLE_NAME = "summary.json", "tries.csv"
OTHERS = ("requirements_met", "runs_with_numbers")  # columns after those of keys and metrics


def described(settings: Settings) -> dict[str, Any]:
    """What is searched as plain values: a search with the same ones ends with the same.

    Args:
        settings: of the search.
    """
    return {
        "mission": hashlib.sha256(settings.mission.to_yaml().encode()).hexdigest(),
        "vary": [[knob.key, knob.low, knob.high] for knob in settings.knobs],
        "for": list(settings.metrics),
        "quantile": settings.quantile,
        "met": settings.goal.met,
        "runs": settings.runs,
        "evaluations": settings.evaluations,
        "seed": settings.first,
        "engine": stamp(),
        "files": digests_of(named_files(settings.mission, settings.folders)),
    }


def read_tuning(directory: Path) -> dict[str, Any]:
    """What an earlier tuning left in a directory.

    Args:
        directory: of the tuning.

    Raises:
        DataError: missing, damaged, or not written by cardume.
    """
    return read_kept(directory / FILE_NAME, "cardume_tune", "a tuning", "tune again")


def known_tries(directory: Path, settings: Settings) -> Known:
    """What was tried already, by its values.

    Args:
        directory: of the tuning that continues.
        settings: that it must have.

    Raises:
        DataError: it is damaged.
        InputError: it is another search.
    """
    name = printable(str(directory))
    kept, now = read_tuning(directory).get("settings"), described(settings)
    if not isinstance(kept, dict) or not isinstance(kept.get("files"), dict):
        raise DataError(f"{name} does not say what was tuned; tune again in a new directory")
    advice = "bring back what it was, or tune again in a new directory"
    refuse_changed(kept["files"], now["files"], f"the tuning in {name}", advice)
    refuse_stale(named_files(settings.mission, settings.folders))
    for key, value in now.items():
        if kept.get(key) != value:
            raise InputError(f"the tuning in {name} {_other(key, kept.get(key), value)}; {advice}")
    return {found.values: found for found in _read_tries(directory, settings)}


def to_csv(settings: Settings, tries: Sequence[Try]) -> str:
    """One row for each try, in order; what is no number is empty.

    Args:
        settings: of the search.
        tries: that were made.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_titles(settings))
    for number, one in enumerate(tries):
        numbers = [repr(value) if math.isfinite(value) else "" for value in (*one.values, *one.metrics)]
        writer.writerow([number, *numbers, repr(one.met), repr(one.counted)])
    return text.getvalue()


def _titles(settings: Settings) -> list[str]:
    units: Mapping[str, str] = {metric: METRICS[metric.rpartition(".")[2]].unit for metric in settings.metrics}
    named = [(knob.key, knob.unit) for knob in settings.knobs] + list(units.items())
    return ["try", *(f"{name} [{unit}]" if unit else name for name, unit in named), *OTHERS]


def _read_tries(directory: Path, settings: Settings) -> list[Try]:
    file, size = directory / TABLE_NAME, len(settings.knobs)
    try:
        titles, *rows = csv.reader(file.read_text(encoding="utf-8").splitlines())
        if titles != _titles(settings):
            raise ValueError("other columns")
        found = []
        for number, row in enumerate(rows):
            place, *values = (math.nan if text == "" else float(text) for text in row)
            if place != number or len(row) != len(titles):
                raise ValueError(f"row {number}")
            found.append(Try(tuple(values[:size]), tuple(values[size:-2]), values[-2], values[-1]))
        return found
    except OSError as problem:
        raise DataError(f"{printable(str(file))} cannot be read: {problem.strerror}; tune again") from None
    except ValueError as problem:
        raise DataError(f"{printable(str(file))} is damaged ({printable(str(problem))}); tune again") from None


def _other(key: str, kept: Any, now: Any) -> str:
    """What is another, in words."""
    if key == "mission":
        return "is of another mission, or of other values of it"
    if key == "engine":
        return f"was made by another cardume (sources {printable(str(kept))}; here {now}), whose numbers may differ"
    return f"has {printable(str(kept))} for --{key}, and {printable(str(now))} is given"
