"""A study in the background: the mission under many seeds, told portion by portion, until it is done or stopped.

Seeds are those that `cardume study` takes: the mission's own and the ones after it.
"""

import math
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import CardumeError
from cardume.missions.mission import Mission
from cardume.report.study.blocks import chance_interval
from cardume.report.study.common import percent
from cardume.simulation.flight import METRICS
from cardume.studies.answers.requirements import Chance
from cardume.studies.constants import FLEET
from cardume.studies.flying import fly_seeds, num_processors
from cardume.studies.run_table import RunTable
from cardume.studies.statistics import share_interval

FIRST, LATER = 4, 12  # missions in a portion: the first numbers come soon
MOST_RUNS = 100_000

Tell = Callable[[dict[str, Any]], None]


class Study:
    """Flies in a thread of its own, and leaves one processor to the page.

    Args:
        mission: without sweeps.
        runs: how many seeds, from the mission's own on.
        tell: gets what the page shows, from the thread of the study.
        allow_code: folders from which laws may be imported.
    """

    def __init__(self, mission: Mission, runs: int, tell: Tell, allow_code: Iterable[Path] = ()) -> None:
        self._mission, self._runs, self._tell = mission, min(max(1, runs), MOST_RUNS), tell
        self._allow_code = tuple(allow_code)
        self._met = self._failed = 0  # missions so far
        self._is_stopped = threading.Event()
        self._thread = threading.Thread(target=self._fly, name="study", daemon=True)

    def start(self) -> None:
        """Begin to fly."""
        self._thread.start()

    def stop(self, wait: float = 0.0) -> None:
        """End it; nothing more is told.

        Args:
            wait: [s] at most, for the thread to end.
        """
        self._is_stopped.set()
        if wait > 0.0 and self._thread.is_alive():
            self._thread.join(wait)

    def _fly(self) -> None:
        done = 0
        try:
            while done < self._runs and not self._is_stopped.is_set():
                count = min(FIRST if done == 0 else LATER, self._runs - done)
                table = fly_seeds(
                    self._mission,
                    self._mission.seed + np.arange(done, done + count, dtype=np.int64),
                    allow_code=self._allow_code,
                    threads=max(1, num_processors() - 1),
                    lanes=False,
                    should_stop=self._is_stopped.is_set,
                    progress=self._note,
                )
                done += len(table)
                if not self._is_stopped.is_set():
                    self._tell(self._portion(table, done))
        except CardumeError as problem:
            self._tell({"is": "study", "problem": str(problem), "done": done, "total": self._runs})
        except Exception as problem:
            self._tell({"is": "study", "problem": f"a bug in cardume: {problem!r}", "done": done, "total": self._runs})

    def _note(self, stage: str, done: int, total: int) -> None:
        if stage == "compile" and done < total:
            self._tell({"is": "progress", "stage": "compile", "done": done, "total": total})

    def _portion(self, table: RunTable, done: int) -> dict[str, Any]:
        failed = np.array([bool(text) for text in table.failure])
        self._failed += int(failed.sum())
        self._met += int((table.met.all(axis=1) & ~failed).sum())
        chance = Chance(self._met, done, *share_interval(self._met, done))
        return {
            "is": "study",
            "done": done,
            "total": self._runs,
            "metrics": {
                name.removeprefix(FLEET): [_plain(value) for value in values]
                for name, values in table.metrics.items()
                if name.startswith(FLEET)
            },
            "met": f"{percent(chance.share)} ({chance_interval(chance)})" if table.requirements else None,
            "failed": self._failed,
        }


def metrics_for_page() -> dict[str, dict[str, str]]:
    """What the page needs to know of each metric."""
    return {
        name: {"unit": metric.unit, "meaning": metric.meaning, "wanted": metric.wanted}
        for name, metric in METRICS.items()
    }


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
