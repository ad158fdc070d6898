"""A study of about a minute on two threads, and the same on two Dask workers, their start included."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cardume
from benchmarks.row import Row
from benchmarks.timing import Effort, Progress

TARGET = 15.0  # [%]
SECONDS = 60.0
TRIED = 128  # missions flown for their rate
MISSION = "paper/figure-5"
DRAWN = ("current.speed={uniform: [0 m/s, 0.2 m/s]}", "acoustics.loss={uniform: [0, 0.4]}")


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """How long both take, and by how much the workers are slower."""
    overrides = [*DRAWN, "duration=10 s"] if effort.is_smoke else list(DRAWN)
    mission = cardume.load(MISSION, overrides)
    runs, turns = 8, 1
    if not effort.is_smoke:
        progress("rate", 0, 1)
        _seconds(mission, TRIED, threads=2)
        runs, turns = max(TRIED, int(SECONDS * TRIED / _seconds(mission, TRIED, threads=2))), 2
    taken: dict[str, list[float]] = {"threads": [], "workers": []}
    for turn in range(turns):
        for name in list(taken) if turn % 2 == 0 else reversed(list(taken)):
            progress(f"{runs} missions, 2 {name}", turn, turns)
            taken[name].append(_seconds(mission, runs, **{name: 2}))
    best = {name: min(seconds) for name, seconds in taken.items()}
    yield Row(workload="study", case="figure-5, 2 threads", value=best["threads"], unit="s", remark=f"{runs} missions")
    yield Row(workload="study", case="figure-5, 2 Dask workers", value=best["workers"], unit="s")
    yield Row(
        workload="study",
        case="Dask, beside threads",
        value=100.0 * (best["workers"] / best["threads"] - 1.0),
        unit="%",
        target=TARGET,
    )


def _seconds(mission: Any, runs: int, **how: int) -> float:
    """What a study takes [s], from its command to its data set."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        cardume.study(mission, runs, directory=Path(folder, "study"), **how)  # type: ignore[arg-type]
        return time.perf_counter() - begin
