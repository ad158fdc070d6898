"""What a comparison leaves behind: every number of every run, what they say, and a figure; complete or not at all.

DIR/compare.csv     one row per arm and seed, one column per metric
DIR/compare.json    arms, means, differences and intervals
DIR/compare.png     and .svg, what the caller draws
"""

import csv
import io
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from cardume.missions.results import Destination, keep_together
from cardume.missions.summary import read_kept
from cardume.simulation.flight import METRICS
from cardume.studies.comparing import Comparison
from cardume.studies.statistics import Estimate

FORMAT_VERSION = 1
FILE_NAME = "compare.json"
TABLE_NAME = "compare.csv"


def keep_comparison(
    destination: Destination,
    name: str,
    comparison: Comparison,
    *,
    words: Sequence[str] = (),
    version: str,
    draw: Callable[[Path], None] | None = None,
) -> tuple[Path, dict[str, Any]]:
    """Write everything.

    Args:
        destination: from `choose_destination`, with `read_comparison`.
        name: that it was chosen for.
        comparison: what was flown.
        words: what it says.
        version: of cardume.
        draw: fills the folder it is given with figures.

    Returns:
        The directory, and what compare.json says.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """

    return keep_together(
        destination,
        name,
        FILE_NAME,
        lambda _final: {TABLE_NAME: to_csv(comparison)},
        lambda files: summarize_comparison(comparison, words=words, version=version, files=files),
        draw,
    )


def read_comparison(directory: Path) -> dict[str, Any]:
    """What an earlier comparison left in a directory.

    Args:
        directory: of the comparison.

    Raises:
        DataError: missing, damaged, or not written by cardume.
    """
    return read_kept(directory / FILE_NAME, "cardume_compare", "a comparison", "compare again")


def to_csv(comparison: Comparison) -> str:
    """One row per arm and seed: all metrics of the fleet, and what was asked for of single vehicles.

    Args:
        comparison: what was flown.
    """
    names = [*METRICS, *(metric for metric in comparison.metrics if "." in metric)]
    rows = []
    values = [comparison.values(name) for name in names]
    for k, (arm, runs) in enumerate(zip(comparison.arms, comparison.runs, strict=True)):
        for j, seed in enumerate(comparison.seeds):
            met = int(runs.met[j].all()) if runs.requirements else ""
            numbers = ["" if math.isnan(of[k, j]) else repr(float(of[k, j])) for of in values]
            rows.append([arm.label, seed, met, runs.failure[j], *numbers])
    kept = [k for k in range(len(names)) if any(row[4 + k] for row in rows)]
    units = [METRICS[name.rpartition(".")[2]].unit for name in names]
    titles = [f"{names[k]} [{units[k]}]" if units[k] else names[k] for k in kept]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["arm", "seed", "requirements_met", "failure", *titles])
    writer.writerows([*row[:4], *(row[4 + k] for k in kept)] for row in rows)
    return text.getvalue()


def summarize_comparison(
    comparison: Comparison, *, words: Sequence[str] = (), version: str, files: Sequence[str] = ()
) -> dict[str, Any]:
    """A comparison as plain values; what is no number becomes None.

    Args:
        comparison: what was flown.
        words: what it says.
        version: of cardume.
        files: written beside the summary.
    """
    return {
        "cardume_compare": FORMAT_VERSION,
        "version": version,
        "varied": list(comparison.varied),
        "seeds": list(comparison.seeds),
        "asked": comparison.asked,
        "interrupted": comparison.is_interrupted,
        "confidence": 0.95,
        "shared_confidence": comparison.shared_confidence,
        "units": {metric: METRICS[metric.rpartition(".")[2]].unit for metric in comparison.metrics},
        "arms": [_arm(comparison, place) for place in range(len(comparison.arms))],
        "conclusions": list(words),
        "files": list(files),
    }


def _arm(comparison: Comparison, place: int) -> dict[str, Any]:
    arm, met = comparison.arms[place], comparison.met(place)
    told: dict[str, Any] = {
        "label": arm.label,
        "mission": arm.given,
        "changes": list(arm.changes),
        "requirements_met": None if met is None else met[0],
        "failures": [{"seed": seed, "failure": why} for seed, why in comparison.failures(place)],
        "metrics": {metric: _plain(comparison.estimates[metric][place]) for metric in comparison.metrics},
    }
    if place:
        told["differences"] = {
            metric: _plain(comparison.differences[metric][place - 1]) | {"real": comparison.is_real[metric][place - 1]}
            for metric in comparison.metrics
        }
    return told


def _plain(estimate: Estimate) -> dict[str, float | int | None]:
    found = {key: value if math.isfinite(value) else None for key, value in estimate._asdict().items()}
    return found | {"size": estimate.size}
