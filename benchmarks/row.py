"""One measured figure, and how a run of the benchmarks is kept in a file."""

import json
import math
import os
import platform
import statistics
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.calibration import Calibration, identity
from cardume.compiler import source_stamp

ROOT = Path(__file__).parents[1]
FORMAT = 1
RATE = "Mvs/s"  # million vehicle-steps per second; a vehicle-step is one plant step of one vehicle
TIMES = "x"  # as fast as something else in the same run
MORE_IS_BETTER = (RATE, TIMES)


@dataclass(frozen=True, kw_only=True)
class Row:
    """A figure with its target.

    Attributes:
        workload: which file of this package measured it.
        case: what was measured, readable.
        build: "scalar" or "lanes" where a table puts the two side by side.
        value: the best of several, in `unit`; NaN: not measured, `remark` says why.
        unit: ms, s, %, RATE or TIMES; more is better for the last two.
        target: what the figure has to reach; None: it is only reported.
        median: the middle of several, in `unit`; NaN: there was one.
        cpu: the best in processor time, in `unit`: as if nothing else ran here.
        ratio: time in calibration loops for as many vehicle-steps; a process counts as one loop.
        remark: shown below the table.
    """

    workload: str
    case: str
    value: float
    unit: str
    build: str = ""
    target: float | None = None
    median: float = math.nan
    cpu: float = math.nan
    ratio: float = math.nan
    remark: str = ""

    @property
    def key(self) -> tuple[str, str, str]:
        """What makes it the same figure in another run."""
        return self.workload, self.case, self.build

    @property
    def verdict(self) -> str:
        """Whether the target is met; "at best": by the best run and not by the median."""
        if self.target is None or math.isnan(self.value):
            return ""
        if not self._reaches(self.value):
            return "no"
        return "at best" if not math.isnan(self.median) and not self._reaches(self.median) else "yes"

    def _reaches(self, value: float) -> bool:
        wanted = self.target if self.target is not None else math.nan
        return value >= wanted if self.unit in MORE_IS_BETTER else value <= wanted


def run_record(rows: Sequence[Row], calibration: Calibration, is_smoke: bool) -> dict[str, Any]:
    """What a run leaves for comparisons.

    Args:
        rows: its figures.
        calibration: as it was used.
        is_smoke: whether the figures mean nothing.

    Returns:
        A dictionary for JSON; what was not measured is null.
    """
    wall, cpu = ([getattr(taken, kind) * 1e3 for taken in calibration.seen] for kind in ("wall", "cpu"))
    return {
        "format": FORMAT,
        "smoke": is_smoke,
        "commit": _commit(),
        "sources": source_stamp(),
        "python": platform.python_version(),
        "machine": platform.machine(),
        "num_cpus": os.cpu_count(),
        "calibration": {
            "loop": identity(),
            "best_ms": min(cpu),
            "median_ms": statistics.median(cpu),
            "waiting": sum(wall) / sum(cpu),
        },
        "rows": [{key: _plain(value) for key, value in asdict(row).items()} for row in rows],
    }


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and math.isnan(value) else value


def _commit() -> str:
    """The commit, with a + where files differ from it; empty outside a checkout."""
    try:
        say = ["git", "describe", "--always", "--exclude=*", "--dirty=+"]
        return subprocess.run(say, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def save(record: dict[str, Any], file: Path) -> None:
    """Write a run to a file."""
    file.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


def rows_of(record: dict[str, Any]) -> list[Row]:
    """The figures of a run that was kept."""
    empty = {"value": math.nan}
    return [Row(**(empty | {k: v for k, v in row.items() if v is not None})) for row in record["rows"]]


def load(file: Path) -> dict[str, Any]:
    """Read a run from a file.

    Raises:
        ValueError: it is no such file.
    """
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        rows_of(record)
    except (OSError, ValueError, KeyError, TypeError) as problem:
        raise ValueError(f"{file} is no file that --json wrote: {problem}") from None
    if record.get("format") != FORMAT:
        raise ValueError(f"{file} has format {record.get('format')}, this is {FORMAT}; measure that commit again")
    return dict(record)
