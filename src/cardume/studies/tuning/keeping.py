"""What a tuning leaves behind: the mission that it recommends, every try, and what they say; complete or not at all.

DIR/mission.yaml     the mission to fly
DIR/summary.json     start, best, and the evidence on fresh seeds
DIR/tries.csv        every try
DIR/search.png       and .svg, what the caller draws
"""

import csv
import io
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from cardume.missions.results import Destination, choose_destination, write_atomically
from cardume.missions.summary import read_kept, to_json
from cardume.simulation.flight import METRICS
from cardume.studies.tuning.searching import Try
from cardume.studies.tuning.tune import Tuning

FORMAT_VERSION = 1
FILE_NAME, MISSION_NAME, TABLE_NAME = "summary.json", "mission.yaml", "tries.csv"


def tuning_destination(name: str, given: Path | None) -> Destination:
    """Where a tuning will be kept; see `choose_destination`.

    Args:
        name: that the user has for it.
        given: the directory that the user wants.

    Raises:
        InputError: it holds something else, is no directory, or cannot be written to.
    """
    return choose_destination(name, given, read_tuning)


def read_tuning(directory: Path) -> dict[str, Any]:
    """What an earlier tuning left in a directory.

    Args:
        directory: of the tuning.

    Raises:
        DataError: missing, damaged, or not written by cardume.
    """
    return read_kept(directory / FILE_NAME, "cardume_tune", "a tuning", "tune again")


def keep_tuning(
    destination: Destination,
    name: str,
    tuning: Tuning,
    *,
    words: Sequence[str] = (),
    version: str,
    draw: Callable[[Path], None] | None = None,
) -> tuple[Path, dict[str, Any]]:
    """Write everything.

    Args:
        destination: from `tuning_destination`.
        name: that it was chosen for.
        tuning: what was found.
        words: what it says.
        version: of cardume.
        draw: fills the folder it is given with figures.

    Returns:
        The directory, and what summary.json says.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """

    def fill(folder: Path, final: Path) -> dict[str, Any]:
        (folder / MISSION_NAME).write_text(tuning.recommended.to_yaml(final), encoding="utf-8")
        (folder / TABLE_NAME).write_text(to_csv(tuning), encoding="utf-8", newline="")
        if draw is not None:
            draw(folder)
        files = sorted([*(path.name for path in folder.iterdir()), FILE_NAME])
        summary = summarize_tuning(tuning, words=words, version=version, files=files)
        (folder / FILE_NAME).write_text(to_json(summary), encoding="utf-8")
        return summary

    return write_atomically(destination, name, fill)


def to_csv(tuning: Tuning) -> str:
    """One row for each try, in order; what is no number is empty.

    Args:
        tuning: what was found.
    """
    units = [METRICS[metric.rpartition(".")[2]].unit for metric in tuning.metrics]
    titles = [f"{knob.key} [{knob.unit}]" if knob.unit else knob.key for knob in tuning.knobs]
    titles += [f"{metric} [{unit}]" if unit else metric for metric, unit in zip(tuning.metrics, units, strict=True)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["try", *titles, "requirements_met", "runs_with_numbers"])
    for number, one in enumerate(tuning.tries):
        numbers = [repr(value) if math.isfinite(value) else "" for value in (*one.values, *one.metrics)]
        writer.writerow([number, *numbers, repr(one.met), repr(one.counted)])
    return text.getvalue()


def summarize_tuning(
    tuning: Tuning, *, words: Sequence[str] = (), version: str, files: Sequence[str] = ()
) -> dict[str, Any]:
    """A tuning as plain values; what is no number becomes None.

    Args:
        tuning: what was found.
        words: what it says.
        version: of cardume.
        files: written beside the summary.
    """
    return {
        "cardume_tune": FORMAT_VERSION,
        "version": version,
        "mission": tuning.mission.name,
        "metrics": list(tuning.metrics),
        "units": {metric: METRICS[metric.rpartition(".")[2]].unit for metric in tuning.metrics},
        "of_the_runs": "mean" if tuning.quantile is None else f"quantile {tuning.quantile:g}",
        "runs": tuning.runs,
        "evaluations": len(tuning.tries),
        "interrupted": tuning.is_interrupted,
        "knobs": [{"key": k.key, "unit": k.unit, "low": k.low, "high": k.high} for k in tuning.knobs],
        "start": _try(tuning, tuning.start),
        "best": _try(tuning, tuning.best),
        "front": [_try(tuning, one) for one in tuning.front],
        "is_better": tuning.is_better,
        "evidence": _evidence(tuning),
        "conclusions": list(words),
        "files": list(files),
    }


def _try(tuning: Tuning, one: Try) -> dict[str, Any]:
    return {
        "values": {knob.key: value for knob, value in zip(tuning.knobs, one.values, strict=True)},
        "metrics": {metric: _plain(value) for metric, value in zip(tuning.metrics, one.metrics, strict=True)},
        "requirements_met": one.met,
        "runs_with_numbers": one.counted,
    }


def _evidence(tuning: Tuning) -> dict[str, Any] | None:
    if tuning.evidence is None:
        return None
    start, best = tuning.evidence.start, tuning.evidence.best
    return {
        "runs": len(start),
        "first_seed": int(start.seeds[0]),
        "requirements_met": {"start": int(start.met.all(axis=1).sum()), "best": int(best.met.all(axis=1).sum())},
        "differences": {
            metric: {key: _plain(value) for key, value in difference._asdict().items()}
            for metric, difference in zip(tuning.metrics, tuning.evidence.differences, strict=True)
        },
    }


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
