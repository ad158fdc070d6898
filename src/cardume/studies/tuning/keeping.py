"""What a tuning leaves behind: the mission that it recommends, every try, and what they say; complete or not at all.

DIR/mission.yaml     the mission to fly
DIR/summary.json     start, best, and the evidence on fresh seeds
DIR/tries.csv        every try
DIR/search.png       and .svg, what the caller draws
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from cardume.missions.atomic import write_file
from cardume.missions.results import Destination, ResultsError, choose_destination, keep_together, refusal
from cardume.simulation.flight import METRICS
from cardume.studies.tuning.resuming import FILE_NAME, TABLE_NAME, described, read_tuning, to_csv
from cardume.studies.tuning.searching import Try
from cardume.studies.tuning.trying import Settings
from cardume.studies.tuning.tune import Tuning

FORMAT_VERSION = 1
MISSION_NAME = "mission.yaml"
HOW_ON = "what was tried before is kept: mend that, and continue with --resume"


class Journal:
    """Keeps tries while they are made, so that a search that is killed continues where it was.

    With the first try an earlier tuning makes place.

    Args:
        destination: from `choose_destination`, with `read_tuning`.
        name: that it was chosen for.
        version: of cardume.
    """

    def __init__(self, destination: Destination, name: str, version: str) -> None:
        self._destination, self._name, self._version = destination, name, version
        self._is_begun = False

    def __call__(self, settings: Settings, tries: Sequence[Try]) -> None:
        """Write all tries; the file holds those before or these, whatever happens meanwhile.

        Args:
            settings: of the search.
            tries: so far.

        Raises:
            ResultsError: the disk is full, or refused otherwise.
        """
        text = to_csv(settings, tries)
        if self._is_begun:
            try:
                write_file(self._destination.directory / TABLE_NAME, text.encode())
            except OSError as problem:
                raise ResultsError(refusal(self._destination.directory, problem, HOW_ON)) from None
            return
        about = {"cardume_tune": FORMAT_VERSION, "version": self._version, "mission": settings.mission.name}
        about |= {"interrupted": True, "settings": described(settings)}
        directory, _ = keep_together(
            self._destination,
            self._name,
            FILE_NAME,
            lambda _: {TABLE_NAME: text},
            lambda files: about | {"files": files},
        )
        self._destination, self._is_begun = choose_destination(self._name, directory, read_tuning), True

    @property
    def destination(self) -> Destination:
        """Where the whole tuning goes, in the place of its tries."""
        return self._destination


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
        destination: from `choose_destination`, with `read_tuning`.
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

    return keep_together(
        destination,
        name,
        FILE_NAME,
        lambda final: {
            MISSION_NAME: tuning.recommended.to_yaml(final),
            TABLE_NAME: to_csv(tuning.settings, tuning.tries),
        },
        lambda files: summarize_tuning(tuning, words=words, version=version, files=files),
        draw,
    )


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
        "settings": described(tuning.settings),
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
        "requirements_met": {"start": int(start.all_met.sum()), "best": int(best.all_met.sum())},
        "differences": {
            metric: {key: _plain(value) for key, value in difference._asdict().items()} | {"real": change != 0}
            for metric, difference, change in zip(
                tuning.metrics, tuning.evidence.differences, tuning.evidence.changes, strict=True
            )
        },
    }


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
